// SPDX-License-Identifier: BSD-3-Clause
// Several runs side by side: figures, maps that move together, keys that differ.

// Of the objects of the map, not of boxes or cells, which have a precision, too; final before live.
function objectEvaluation(run, name) {
  const files = run.evaluations.filter((e) => name in e.figures && 'yaw_pairs' in e.figures);
  return files.find((e) => !e.file.includes('live')) || files[0];
}

function comparedFigures() {
  const evaluated = (name) => (run) => {
    const file = objectEvaluation(run, name);
    return file ? file.figures[name] : null;
  };
  const ate = (key) => (run) => run[key] && run[key].ate_m.rmse;
  return [
    ['Error (ATE RMSE), final', ate('final_errors'), metres, -1],
    ['Error (ATE RMSE), live', ate('live_errors'), metres, -1],
    ['Movement in 1 s, final', (run) => run.final_errors && run.final_errors.rpe_trans_m.rmse, metres, -1],
    ['Objects in the map', (run) => run.objects.filter((o) => o.in_map).length, whole, 0],
    ['Precision of the objects', evaluated('precision'), percent, 1],
    ['Recall of the objects', evaluated('recall'), percent, 1],
    ['Error of their places', evaluated('position_error_mean_m'), metres, -1],
    ['Right associations', evaluated('association_accuracy'), percent, 1],
    ['Recording', (run) => run.duration, duration, 0],
    ['Way', (run) => run.length_m, metres, 0],
    ['Loop closures', (run) => run.counts.loop_closures, whole, 0],
    ['Frames lost', (run) => run.counts.frames > 0 ? run.counts.frames_lost : null, whole, -1],
    ['Scans unmatched', (run) => run.counts.scans > 0 ? run.counts.scans_unmatched : null, whole, -1],
    ['Time', (run) => run.wall_s > 0 ? run.wall_s : null, duration, -1],
    ['Memory, at most', (run) => run.peak_memory_mb, (v) => `${whole(v)} MB`, -1],
  ];
}

// What is lost, time and memory grow with the recording: the best of them is told of one recording alone.
const OF_ONE_RECORDING = ['Frames lost', 'Scans unmatched', 'Time', 'Memory, at most'];
function isOneRecording(runs) {
  return runs.every((run) => run.recording === runs[0].recording && Math.abs(run.duration - runs[0].duration) < 1);
}

function figureTable(runs) {
  const rows = [];
  for (const [name, value, format, direction] of comparedFigures()) {
    const better = OF_ONE_RECORDING.includes(name) && !isOneRecording(runs) ? 0 : direction;
    const values = runs.map((run) => value(run)), known = values.filter(isNumber);
    if (!known.length) continue;
    const texts = values.map((v) => isNumber(v) ? format(v) : NONE), differ = new Set(known.map(format)).size > 1;
    const best = better && differ ? format(better > 0 ? Math.max(...known) : Math.min(...known)) : null;
    const mark = (text) => text === best ? h('span', {class: 'hidden-text'}, ' (best)') : null;
    rows.push([name, ...texts.map((text) => h('span', {class: text === best ? 'best' : null}, text, mark(text)))]);
  }
  return h(
      'div', {class: 'card pad'},
      table(
          'A dot marks the best of a row',
          [{title: ''}, ...runs.map((run) => ({title: run.name, number: true}))], rows));
}

function comparedMaps(runs) {
  const maps = [];
  let turning = false;
  const follow = (from) => (view) => {
    if (turning) return;
    turning = true;
    maps.filter((map) => map.run !== from).forEach((map) => {
      map.fitted = false;
      setView(map, view, true);
    });
    turning = false;
  };
  const cards = runs.map((run) => {
    const map = createMap(run, {});
    map.svg.classList.add('hide-live', 'hide-candidates', 'hide-closures', 'hide-ellipses');
    for (const event of ['pointerdown', 'wheel', 'keydown', 'click'])
      map.box.addEventListener(event, () => map.hooks.onView = follow(run), true);
    maps.push(map);
    return h('div', {class: 'card'}, h('h3', {}, run.name), map.box);
  });
  return h('div', {class: 'maps'}, cards);
}

function differingKeys(runs) {
  const values = new Map();
  runs.forEach((run, i) => run.config.forEach((row) => {
    const name = `${row.section}.${row.key}`;
    if (!values.has(name)) values.set(name, runs.map(() => null));
    values.get(name)[i] = row.value;
  }));
  const rows = [...values]
                   .filter(([, all]) => new Set(all).size > 1)
                   .map(([name, all]) => [name, ...all.map((v) => v === null ? NONE : v || '(empty)')]);
  return h(
      'div', {class: 'card pad config'}, h('h3', {}, 'Keys of the configuration that differ'),
      rows.length ? table(null, [{title: 'key'}, ...runs.map((run) => ({title: run.name}))], rows) :
                    h('p', {class: 'none'}, 'None.'));
}

function compareSection(runs) {
  return [
    h('div', {class: 'title'}, h('h1', {}, `${runs.length} runs side by side`)),
    section(
        'compare', 'Comparison', 'The maps move together. Below, one run at a time with all its details.',
        figureTable(runs), comparedMaps(runs), h('div', {style: 'margin-top: 1.25rem'}, differingKeys(runs)))
  ];
}

function runChoice(runs, choose) {
  const buttons = runs.map(
      (run, i) =>
          h('button', {type: 'button', class: 'quiet', 'aria-pressed': 'false', onclick: () => choose(i)},
            run.name));
  return {
    buttons,
    element:
        h('div', {
          class: 'switches',
          role: 'group',
          'aria-label': 'Run that is shown below',
          style: 'margin: 3.25rem 0 1.5rem'
        },
          buttons)
  };
}
