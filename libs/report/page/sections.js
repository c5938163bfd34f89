// SPDX-License-Identifier: BSD-3-Clause
// Title, figures, accuracy, time and memory.

function missingNote(run, files) {
  const parts = files.map((file) => run.missing[file] && `${file} ${run.missing[file]}`).filter(Boolean);
  return parts.length ? h('p', {class: 'note'}, `${parts.join('; ')}.`) :
                        h('p', {class: 'none'}, 'The run has none.');
}

function figureBox(name, value, unit, more) {
  return h(
      'div', {}, h('dt', {}, name), h('dd', {}, value, unit && h('small', {}, unit)),
      more && h('p', {}, more));
}

// Of all stages, some of which run beside each other: not the time that the run took.
function workSeconds(run) { return run.stages.reduce((sum, stage) => sum + stage.total_ms, 0) / 1000; }

function timeBox(run) {
  if (run.wall_s > 0)
    return figureBox(
        'Time', duration(run.wall_s), null, run.duration > 0 ? `${fixed(run.duration / run.wall_s, 1)} × real time` : null);
  const work = workSeconds(run);
  return work > 0 ? figureBox('Work', duration(work), null, 'of all stages') : null;
}

function keyFigures(run) {
  const {counts} = run, mapped = run.objects.filter((o) => o.in_map),
        errors = run.final_errors;
  const classes = new Set(mapped.map((o) => o.class)).size;
  const lost = (counts.frames_lost || 0) + (counts.scans_unmatched || 0);
  return h(
      'dl', {class: 'figures card'},
      figureBox(
          'Recording', duration(run.duration), null,
          run.interrupted === 'yes' ? 'interrupted' : `${whole(run.poses)} poses`),
      figureBox(
          'Way', fixed(run.length_m, 1), 'm',
          run.duration > 0 ? `${fixed(run.length_m / run.duration, 2)} m/s on average` : null),
      figureBox(
          'Objects', whole(mapped.length), null,
          `${classes} ${classes === 1 ? 'class' : 'classes'}, ${
              run.objects.length - mapped.length} not sure enough`),
      errors ? figureBox('Error', fixed(errors.ate_m.rmse * 100, 1), 'cm', 'ATE, RMSE') : null,
      isNumber(counts.loop_closures) ?
          figureBox(
              'Loop closures', whole(counts.loop_closures), null, `${whole(counts.key_poses)} key poses`) :
          null,
      isNumber(counts.frames) ?
          figureBox(
              'Lost', whole(lost), null, `of ${whole(counts.frames)} images, ${whole(counts.scans)} scans`) :
          null,
      timeBox(run),
      run.peak_memory_mb ? figureBox('Memory', whole(run.peak_memory_mb), 'MB', 'at most') : null);
}

function notesOf(run) {
  const notes = [...run.warnings];
  const files = Object.entries(run.missing);
  notes.push(...gravest(run));
  if (run.interrupted === 'yes')
    notes.unshift('The run was interrupted: all this covers what was replayed until then.');
  if (files.length)
    notes.push(`Left out, because a file ${files.length === 1 ? 'is' : 'are'} missing or broken: ${
                   files.map(([name, why]) => `${name} (${why})`).join(', ')}.`
                   .replace('a file are', 'files are'));
  return notes.length ? h('ul', {class: 'notes', 'aria-label': 'Warnings'},
                          notes.map((note) => h('li', {class: 'note'}, note))) :
                        null;
}

function titleOf(run) {
  return run.recording || (run.input && lastOf(run.input, run.name)) || lastOf(run.name, 'Run');
}

function runHead(run, level) {
  const meta = [
    dateOf(run.start), run.name && `results in ${run.name}`,
    run.version && run.version !== ' ()' ? `roomgraph ${run.version}` : null
  ];
  return h(
      'div', {class: 'title'}, h(level, {}, titleOf(run)),
      h('p', {class: 'meta'}, meta.filter(Boolean).map((text) => h('span', {}, text))));
}

function errorTable(run) {
  const columns =
      ['', 'RMSE', 'mean', 'median', '95 %', 'largest'].map((title, i) => ({title, number: i > 0}));
  const row =
      (name, e, format) => [name, ...['rmse', 'mean', 'median', 'p95', 'max'].map((key) => format(e[key]))];
  const turn = (v) => `${fixed(v, 2)}°`, rows = [];
  for (const [name, errors] of [['final', run.final_errors], ['live', run.live_errors]]) {
    if (!errors) continue;
    rows.push(
        row(`Position (ATE), ${name}`, errors.ate_m, metres),
        row(`Movement in 1 s, ${name}`, errors.rpe_trans_m, metres),
        row(`Turn in 1 s, ${name}`, errors.rpe_rot_deg, turn));
  }
  return h('div', {class: 'card pad'}, table('After alignment in space, without scale', columns, rows));
}

function pairOf(run, key) {
  return [
    {name: 'final', data: run.final_errors && run.final_errors[key]},
    {name: 'live', data: run.live_errors && run.live_errors[key], other: true}
  ].filter((one) => hasValues(one.data));
}

function curve(run, title, series, summary, value, tick, onTime) {
  return hasValues(series[0] && series[0].data) ?
      createChart({title, series, summary, duration: run.duration, value, tick, onTime}) :
      null;
}

function accuracySection(run, onTime) {
  const cm = (v, step) => step < 1 ? `${fixed(v * 100, digitsOf(100 * step))} cm` : `${whole(v)} m`,
        turn = (v, step) => `${fixed(v, step ? digitsOf(step) : 1)}°`;
  const parts = [];
  if (run.final_errors || run.live_errors) {
    const e = run.final_errors;
    if (run.truth_is_of_camera)
      parts.push(h('p', {class: 'none'}, 'The true path is that of the camera, as its directions tell: errors are those of the camera.'));
    parts.push(
        errorTable(run),
        h('div', {class: 'two'},
          curve(
              run, 'Error of the position', pairOf(run, 'position_m'),
              e ? `Final: RMSE ${metres(e.ate_m.rmse)}, largest ${metres(e.ate_m.max)}.` : '', metres, cm,
              onTime),
          curve(run, 'Error of the direction', pairOf(run, 'rotation_deg'), '', turn, turn, onTime)));
  } else {
    parts.push(h('p', {class: 'none'}, 'No true trajectory was given (--truth): errors cannot be told.'));
  }
  parts.push(curve(
      run, 'What hindsight moved: live against final position', [{name: 'moved', data: run.hindsight_m}],
      `Largest ${metres(largestOf([{data: run.hindsight_m}]))}.`, metres, cm, onTime));
  parts.push(evaluationPart(run));
  return section(
      'accuracy', 'Accuracy', 'Live is the pose as it was known at that moment; final has all hindsight.',
      h('div', {class: 'stack'}, parts));
}

function evaluationPart(run) {
  const told = run.evaluations.filter((e) => e.reliability.length);
  const reliable = told.find((e) => !e.file.includes('live')) || told[0];
  const diagram = reliable ?
      h('figure', {class: 'card pad', style: 'margin: 0'}, h('h3', {}, 'Reliability of the association'),
        h('p', {class: 'none'},
          'Believed probability (across) and share that was right (up), in per cent; the size of a dot says how many decisions.'),
        reliabilityChart(reliable)) :
      h('p', {class: 'none'},
        'No reliability of the association: it comes from “evaluate objects --truth-boxes … --json FILE” with FILE in the folder of the run.');
  const figures = run.evaluations.map(
      (e) =>
          h('details', {}, h('summary', {}, e.file, h('span', {class: 'tag'}, Object.keys(e.figures).length)),
            table(
                null, [{title: 'figure'}, {title: 'value', number: true}],
                Object.entries(e.figures).map(
                    ([name, v]) => [words(name), fixed(v, Number.isInteger(v) ? 0 : 4)]),
                {'aria-label': e.file})));
  return h(
      'div', {class: 'two'}, diagram,
      figures.length ? h('div', {class: 'card pad'}, h('h3', {}, 'Figures of evaluations'), figures) : null);
}

function stageTable(run) {
  const sum = workSeconds(run) * 1000, columns = [
    'Stage', 'calls', 'mean', 'longest', 'in all', 'processor', 'share', ''
  ].map((title, i) => ({title, number: i > 0 && i < 7}));
  return table(
      'By the clock, some stages beside each other; “processor”: of the thread that a stage runs in', columns,
      run.stages.map(
          (stage) =>
              [stage.name, whole(stage.calls), milliseconds(stage.mean_ms), milliseconds(stage.max_ms),
               milliseconds(stage.total_ms), stage.cpu_ms ? milliseconds(stage.cpu_ms) : NONE,
               percent(stage.total_ms / sum), bar(stage.total_ms / sum)]));
}

function timeSection(run, onTime) {
  const parts =
      [run.stages.length ? h('div', {class: 'card pad long'}, stageTable(run)) :
                           missingNote(run, ['summary.json'])];
  const tick = (v, step) => step >= 1000 ?
      `${fixed(v / 1000, 0)} s` :
      `${fixed(v, digitsOf(step))} ms`.replace(/^(\d+),(\d)00 ms$/, '$1.$2 s');
  parts.push(curve(
      run, 'Work on one record, without what is done once', [{name: 'work', data: run.record_ms}],
      `Largest ${milliseconds(largestOf([{data: run.record_ms}]))}.`, milliseconds, tick, onTime));
  const megabytes = (v) => `${whole(v)}\u00a0MB`;
  parts.push(curve(
      run, 'Memory over time (MB)', [{name: 'held', data: run.memory_mb}],
      `Largest ${megabytes(largestOf([{data: run.memory_mb}]))}.`, megabytes, whole, onTime));
  const memory = run.peak_memory_mb ? `The program held ${whole(run.peak_memory_mb)} MB at most.` : null;
  return section('time', 'Time and memory', memory, h('div', {class: 'stack'}, parts));
}
