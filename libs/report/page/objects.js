// SPDX-License-Identifier: BSD-3-Clause
// The list of objects beside the map.

function objectRow(panel, object) {
  const {run, map} = panel, kind = object.in_map ? '' : 'candidate-row';
  const row = h(
      'button', {
        type: 'button',
        class: kind,
        'data-id': object.id,
        'aria-pressed': 'false',
        '--class': classColour(run, object.class),
        onclick: () => selectObject(panel, panel.selected === object.id ? null : object.id, 'list'),
        onpointerenter: () => markObject(map, object.id, 'hover', true),
        onpointerleave: () => markObject(map, object.id, 'hover', false)
      },
      h('span', {class: `swatch ${object.shape}`, 'aria-hidden': 'true'}), h('span', {}, objectTitle(object)),
      h('small', {}, h('span', {class: 'hidden-text'}, 'existence '), percent(object.existence)));
  panel.rows.set(object.id, row);
  return h('li', {}, row);
}

function byClass(a, b) { return a.class.localeCompare(b.class) || a.id - b.id; }

function objectList(panel) {
  panel.rows = new Map();
  const {run} = panel, mapped = run.objects.filter((o) => o.in_map).sort(byClass);
  const others = run.objects.filter((o) => !o.in_map).sort((a, b) => b.existence - a.existence);
  const list = (objects, label) =>
      h('ul', {class: 'object-list', 'aria-label': label}, objects.map((o) => objectRow(panel, o)));
  return [
    h('h3', {}, mapped.length === 1 ? '1 object' : `${mapped.length} objects`),
    mapped.length ? list(mapped, 'Objects in the map') : h('p', {class: 'none pad'}, whyNoObjects(run)),
    others.length ? h('details', {},
                      h('summary', {}, 'Seen, but not in the map', h('span', {class: 'tag'}, others.length)),
                      list(others, 'Candidates that are not in the map')) :
                    null,
  ];
}

function whyNoObjects(run) {
  const cause = run.missing['landmarks.json'];
  return cause ? `landmarks.json ${cause}.` : 'The run found none.';
}

function markRows(panel, id) {
  for (const [key, row] of panel.rows) {
    row.setAttribute('aria-pressed', String(key === id));
    if (key !== id) continue;
    const details = row.closest('details');
    if (details) details.open = true;
  }
}
