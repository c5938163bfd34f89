// SPDX-License-Identifier: BSD-3-Clause
// Everything about one object: classes, place, size, sightings, evidence.

const EVIDENCE = {
  filter: 'Existence filter, log odds',
  sightings: 'Key poses that saw it, log',
  directions: 'Directions it was seen from, log',
  score: 'Mean score of its detections',
  label: 'Share of its class among the labels',
  scatter: 'Scatter of the sightings, σ',
  turned: 'Share of sightings turned across',
  size: 'Size against its class, σ',
  measured: 'Length known from sightings, not its class',
  detected: 'Detected where it was in view, log odds',
  contested: 'Boxes that another object explains',
  outdone: 'Boxes that another label fits better',
  mislabelled: 'Boxes with a surer label of another kind',
  crossed: 'Volume that rays cross',
  filled: 'Volume where rays end',
  spread: 'Length along which rays end',
  beside_crossed: 'Wall beside it crossed',
  beside_filled: 'Wall beside it filled',
  above_filled: 'Space above it filled',
  uneven: 'Crossed at one height only',
  beams_crossed: 'Footprint that lidar beams cross',
};

function meter(name, share) {
  return h('div', {class: 'meter'}, h('span', {}, name), bar(share), h('b', {}, percent(share)));
}

function facts(rows) {
  return h(
      'dl', {class: 'facts'},
      rows.filter((row) => row && row[1] !== null).map(([name,
                                                         value]) => [h('dt', {}, name), h('dd', {}, value)]));
}

function placeFacts(object) {
  const ellipse = ellipseOf(object), [x, y, z] = object.place, [w, d, hgt] = object.size;
  const turn =
      object.yaw === null ? 'not measured' : `${degrees(object.yaw)} ± ${degrees(object.yaw_sigma_rad)}`;
  return facts([
    ['Place x, y, z', `${fixed(x, 2)}, ${fixed(y, 2)}, ${fixed(z, 2)}\u00a0m`],
    ['Width, depth, height', `${fixed(w, 2)} × ${fixed(d, 2)} × ${fixed(hgt, 2)}\u00a0m`],
    ['Yaw of the front', turn],
    ['95 % ellipse, half axes', `${fixed(ellipse.major * 100, 1)} × ${fixed(ellipse.minor * 100, 1)} cm`],
    ['σ of the height', `${fixed(object.z_sigma_m * 100, 1)} cm`],
    [
      'Shape',
      object.model && object.model !== object.class ? `${object.shape}, ${words(object.model)}` : object.shape
    ],
  ]);
}

/// Sightings over the run as small columns.
function seenChart(run, seen) {
  const parts = seen.over_time, most = Math.max(...parts), width = 300 / parts.length;
  const label = `Seen from ${clock(seen.first)} to ${clock(seen.last)} of ${clock(run.duration)}`;
  return s(
      'svg',
      {class: 'seen', viewBox: '0 0 300 34', preserveAspectRatio: 'none', role: 'img', 'aria-label': label},
      s('line', {x1: 0, x2: 300, y1: 33.5, y2: 33.5}),
      parts.map(
          (count, i) => count ? s('rect', {
            x: i * width + 0.4,
            width: width - 0.8,
            y: 33 - 32 * count / most,
            height: 32 * count / most
          }) :
                                null));
}

function sightingsPart(run, object) {
  const seen = object.sightings;
  if (!seen)
    return [
      h('h4', {}, 'Sightings'),
      h('p', {class: 'none'},
        run.missing['associations.jsonl'] ? `associations.jsonl ${run.missing['associations.jsonl']}.` :
                                            'No association of this run names it.')
    ];
  const nameOf = (id) => {
    const other = run.objects.find((o) => o.id === id);
    return other ? objectTitle(other) : `landmark ${id}`;
  };
  const rivals = seen.rivals.filter((rival) => rival.sum > 0.05);
  return [
    h('h4', {}, 'Sightings'), seenChart(run, seen), facts([
      ['Seen', `${whole(seen.count)} times, ${clock(seen.first)}–${clock(seen.last)}`],
      [
        'Probability of the choice',
        `mean ${percent(seen.mean_probability)}, least ${percent(seen.least_probability)}`
      ],
      ['In doubt (below 90 %)', `${seen.doubtful} of ${seen.count}`],
      rivals.length ?
          [
            'Could have been',
            rivals.map((rival) => `${nameOf(rival.id)} (${fixed(rival.sum, 1)})`).join(', ')
          ] :
          null,
    ])
  ];
}

function evidencePart(object) {
  const names = Object.keys(object.evidence);
  if (!names.length) return [h('h4', {}, 'Evidence'), h('p', {class: 'none'}, 'Not in candidates.json.')];
  return h(
      'details', {}, h('summary', {}, 'Evidence', h('span', {class: 'tag'}, names.length)),
      facts(names.map((name) => [EVIDENCE[name] || words(name), fixed(object.evidence[name], 2)])));
}

function objectDetail(run, object, close) {
  const posterior = Object.entries(object.posterior).sort((a, b) => b[1] - a[1]);
  return h(
      'article', {
        class: 'detail',
        id: 'detail',
        '--class': classColour(run, object.class),
        'aria-label': objectTitle(object)
      },
      h('div', {class: 'detail-head'}, h('span', {class: `swatch ${object.shape}`, 'aria-hidden': 'true'}),
        h('h3', {}, objectTitle(object)),
        h('button', {type: 'button', class: 'quiet', onclick: close, 'aria-label': 'Close the details'},
          'Close')),
      object.in_map ? null :
                      h('p', {class: 'note'}, 'A candidate: its existence is too improbable for the map.'),
      object.view ?
          h('img',
            {src: `data:image/jpeg;base64,${object.view}`, alt: `Best view of ${objectTitle(object)}`}) :
          null,
      h('div', {}, meter('Existence', object.existence), h('h4', {class: 'hidden-text'}, 'Classes'),
        posterior.map(([name, p]) => meter(words(name), p))),
      placeFacts(object), h('div', {}, sightingsPart(run, object)), h('div', {}, evidencePart(object)));
}
