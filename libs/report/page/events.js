// SPDX-License-Identifier: BSD-3-Clause
// What was lost, skipped or recognised on the way, and what is wrong with the recording.

const SHOWN_ROWS = 8;  // of a long list; the rest is behind a fold
const FOUND_BY = {
  tracking: 'images',
  lidar: 'scans',
  objects: 'objects'
};

function countTable(title, counts) {
  const rows = Object.entries(counts);
  return h(
      'div', {class: 'card pad'}, h('h3', {}, title),
      rows.length ? table(
                        null, [{title: 'what'}, {title: 'number', number: true}],
                        rows.map(([name, n]) => [words(name), whole(n)]), {'aria-label': title}) :
                    h('p', {class: 'none'}, 'None.'));
}

/// All entries in their order; of a long list the first by `worse`, and all behind a fold that is filled when it opens.
function listing(entries, columns, row, caption, worse) {
  const whole_table = (text) => table(text, columns, entries.map(row));
  if (entries.length <= SHOWN_ROWS) return whole_table(null);
  const fold = h('details', {}, h('summary', {}, 'All, in order of time', h('span', {class: 'tag'}, whole(entries.length))));
  fold.addEventListener('toggle', () => fold.append(whole_table(null)), {once: true});
  return [table(caption, columns, entries.slice().sort(worse).slice(0, SHOWN_ROWS).map(row)), fold];
}

function spanOf(from, to) { return `${clock(from)} – ${clock(to)}`; }

function closureKinds(run) {
  const kinds = new Map();
  run.closures.forEach(({kind}) => kinds.set(kind, (kinds.get(kind) || 0) + 1));
  return [...kinds].filter(([kind]) => kind).map(([kind, n]) => `${whole(n)} by ${FOUND_BY[kind] || kind}`).join(', ');
}

// Long runs: the graph that is written ties bodies of key poses, and has one edge for all closures of two of them.
const CONDENSED = 'The graph of a long run has one tie for all closures between the same two stretches of the path. ';

function condensed(run) { return run.closures.length > 0 && run.counts.loop_closures > run.closures.length; }

function closureTitle(run) {
  const listed = whole(run.closures.length);
  return `Loop closures (${condensed(run) ? `${run.closures.length > 1 ? `${listed} ties` : '1 tie'} of ${whole(run.counts.loop_closures)}` : listed})`;
}

function closurePart(run) {
  const inOrder = run.closures.slice().sort((a, b) => Math.max(...a.t) - Math.max(...b.t));
  const columns = [
    {title: 'key poses'}, {title: 'at'}, {title: 'found by'}, {title: 'off', number: true},
    {title: 'turned', number: true}, {title: 'off, in σ', number: true}
  ];
  const row = (c) =>
      [c.ids.join(' – '), spanOf(...c.t), FOUND_BY[c.kind] || c.kind || NONE, metres(c.off_m), degrees(c.off_rad),
       fixed(c.off_sigmas, 1)];
  return h(
      'div', {class: 'card pad long', id: 'closures'}, h('h3', {}, closureTitle(run)),
      run.closures.length ?
          [h('p', {class: 'none'},
             `${condensed(run) ? CONDENSED : ''}${closureKinds(run)}${closureKinds(run) && '. '}Off: what is left between the measured movement and the final poses.`),
           listing(inOrder, columns, row, 'Those that fit worst', (a, b) => b.off_sigmas - a.off_sigmas)] :
          missingNote(run, ['graph.g2o']));
}

function gapPart(run) {
  const longest = run.gaps.slice().sort((a, b) => b[1] - b[0] - (a[1] - a[0])).slice(0, SHOWN_ROWS);
  const rows = longest.map(([from, to]) => [spanOf(from, to), `${fixed(to - from, 1)} s`]);
  const sum = run.gaps.reduce((all, [from, to]) => all + to - from, 0);
  const caption = `${fixed(sum, 1)} s in all${run.gaps.length > rows.length ? '; the longest' : ''}`;
  const none = run.poses ? h('p', {class: 'none'}, `None: no gap of more than ${fixed(run.least_gap_s, 1)} s.`) :
                           missingNote(run, ['trajectory.tum']);
  return h(
      'div', {class: 'card pad'}, h('h3', {}, `Spans without a pose (${whole(run.gaps.length)})`),
      rows.length ? table(caption, [{title: 'between'}, {title: 'length', number: true}], rows) : none);
}

/// A lane of time with a mark for each span.
function lane(run, sensor) {
  const share = (t) => 100 * Math.max(0, Math.min(1, t / Math.max(run.duration, 1e-9)));
  const marks = run.lost.filter((span) => span.sensor === sensor).map((span) => {
    const mark = h('i', {class: span.records ? 'lost' : 'silent', title: `${spanOf(span.from, span.to)}: ${span.why}`});
    mark.style.left = `${share(span.from)}%`;
    mark.style.width = `max(2px, ${share(span.to) - share(span.from)}%)`;
    return mark;
  });
  return [h('span', {}, sensor), h('div', {class: 'lane'}, marks)];
}

function lostStrip(run, sensors) {
  const ends = [0, 0.25, 0.5, 0.75, 1].map((share) => h('span', {}, clock(share * run.duration)));
  const label = `When a sensor was no help: ${
      run.lost.length ? run.lost.slice(0, 20).map((span) => `${span.sensor} ${spanOf(span.from, span.to)}`).join('; ') :
                        'never'}`;
  return h(
      'div', {class: 'strip', role: 'img', 'aria-label': label}, sensors.map((sensor) => lane(run, sensor)), h('span'),
      h('div', {class: 'strip-time'}, ends));
}

function lostPart(run) {
  const title = 'Camera and lidar: lost, or without data';
  if (!run.lost)
    return h(
        'div', {class: 'card pad'}, h('h3', {}, title),
        run.missing['lost.jsonl'] ? missingNote(run, ['lost.jsonl']) :
                                    h('p', {class: 'none'}, 'The run did not write when they were (lost.jsonl).'));
  const sensors = [['camera', run.counts.frames], ['lidar', run.counts.scans]].filter(([, n]) => n).map(([name]) => name);
  const columns = [
    {title: 'from'}, {title: 'to'}, {title: 'sensor'}, {title: 'length', number: true},
    {title: 'records', number: true}, {title: 'why'}
  ];
  const row = (span) =>
      [clock(span.from), clock(span.to), span.sensor, `${fixed(span.to - span.from, 1)} s`, whole(span.records), span.why];
  return h(
      'div', {class: 'card pad long', id: 'lost'},
      h('div', {class: 'chart-head'}, h('h3', {}, title),
        h('div', {class: 'legend'}, h('span', {}, h('i', {class: 'lost'}), 'lost'),
          h('span', {}, h('i', {class: 'silent'}), 'no record'))),
      sensors.length ? lostStrip(run, sensors) : null,
      run.lost.length ? listing(run.lost, columns, row, 'The longest', (a, b) => b.to - b.from - (a.to - a.from)) :
                        h('p', {class: 'none'}, 'Never.'));
}

/// Warnings and errors about the recording, for the head of the page.
function gravest(run) {
  const grave = (run.findings || []).filter((found) => found.severity !== 'note');
  const shown = grave.slice(0, 4).map((found) => `${found.place}: ${found.what}`);
  return grave.length > shown.length ? [...shown, `${grave.length - shown.length} more are listed under Events.`] : shown;
}

function findingPart(run) {
  const rows = (run.findings || []).map((found) => [
    h('span', {class: found.severity === 'note' ? 'tag' : 'tag hot'}, found.severity), found.place,
    [found.what, found.hint ? h('small', {class: 'hint'}, found.hint) : null]
  ]);
  const none = run.findings ? 'Nothing is wrong with it, as far as “roomgraph info” can tell.' :
                              'It was not examined with the run; “roomgraph info” tells what is wrong with it.';
  return h(
      'div', {class: 'card pad', id: 'findings'}, h('h3', {}, `The recording (${whole(rows.length)})`),
      rows.length ? table('What “roomgraph info” says of it', [{title: ''}, {title: 'where'}, {title: 'what'}], rows) :
                    h('p', {class: 'none'}, none));
}

function eventsSection(run) {
  return section(
      'events', 'Events', 'What was lost, skipped or recognised on the way.',
      h('div', {class: 'stack'}, lostPart(run), closurePart(run), findingPart(run),
        h('div', {class: 'flow'}, gapPart(run), countTable('Records used', run.records_used),
          countTable('Records skipped', run.records_skipped),
          countTable('Why frames and scans were lost', run.reasons), countTable('All counts', run.counts))));
}
