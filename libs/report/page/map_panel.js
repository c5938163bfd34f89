// SPDX-License-Identifier: BSD-3-Clause
// The map with its switches, the objects beside it, and what is selected in both.

function layersOf(run) {
  const candidates = run.objects.filter((object) => !object.in_map).length;
  return [
    ['grid', 'Grid', true, run.grid],
    ['path', 'Path', true, run.path.length],
    ['live', 'Live path', false, run.live_path.length],
    ['truth', 'True path', true, run.truth_path.length],
    ['closures', 'Loop closures', false, run.closures.length],
    ['objects', 'Objects', true, run.objects.length > candidates],
    ['labels', 'Numbers', true, run.objects.length > candidates],
    ['ellipses', 'Uncertainty', false, run.objects.length],
    ['candidates', 'Not in the map', false, candidates],
  ].filter((layer) => layer[3]);
}

function layerSwitches(map) {
  const set = (name, on) => map.svg.classList.toggle(`hide-${name}`, !on);
  return h(
      'div', {class: 'switches', role: 'group', 'aria-label': 'Layers of the map'},
      layersOf(map.run).map(([name, title, on]) => {
        set(name, on);
        return h(
            'button', {
              type: 'button',
              class: 'quiet',
              'data-layer': name,
              'aria-pressed': String(on),
              onclick: (event) => {
                const now = event.currentTarget.getAttribute('aria-pressed') !== 'true';
                event.currentTarget.setAttribute('aria-pressed', String(now));
                set(name, now);
              }
            },
            title);
      }));
}

function timeRamp(run) {
  const canvas = h('canvas', {width: 112, height: 8, 'aria-hidden': 'true'}),
        context = canvas.getContext('2d');
  for (let x = 0; x < 112; ++x) {
    context.fillStyle = rampColour(x / 111);
    context.fillRect(x, 0, 1, 8);
  }
  return h('span', {class: 'ramp'}, h('span', {}, 'Path: 0:00'), canvas, h('span', {}, clock(run.duration)));
}

/// Turns layers on where something hidden is to be seen.
function reveal(panel, object) {
  const name = object.in_map ? 'objects' : 'candidates',
        button = panel.foot.querySelector(`[data-layer="${name}"]`);
  if (button && button.getAttribute('aria-pressed') !== 'true') button.click();
}

function selectObject(panel, id, focus) {
  const object = panel.run.objects.find((o) => o.id === id) || null;
  panel.selected = object ? id : null;
  selectOnMap(panel.map, panel.selected);
  markRows(panel, panel.selected);
  panel.detail.replaceChildren(
      ...(object ? [objectDetail(panel.run, object, () => selectObject(panel, null))] : []));
  panel.live.textContent = object ? `Selected: ${objectTitle(object)}` : '';
  if (!object) return;
  reveal(panel, object);
  if (focus === 'list') centreIfAway(panel.map, object);
  panel.side.scrollTop = 0;
}

function centreIfAway(map, object) {
  const [x, y] = toScreen(map, ...object.place), margin = 30;
  if (x < margin || y < margin || x > map.size.w - margin || y > map.size.h - margin)
    setView(map, {...map.view, x: object.place[0], y: object.place[1]});
}

function mapSection(run) {
  const panel = {run, selected: null};
  panel.map = createMap(run, {
    onSelect: (id) => selectObject(panel, id, 'map'),
    onHover: (id) => panel.rows.forEach((row, key) => row.classList.toggle('hover', key === id)),
  });
  panel.detail = h('div', {class: 'detail-place'});
  panel.live = h('p', {class: 'hidden-text', 'aria-live': 'polite'});
  panel.side = h('div', {class: 'objects-side'}, panel.detail, objectList(panel));
  panel.foot =
      h('div', {class: 'map-foot'}, layerSwitches(panel.map), run.path.length ? timeRamp(run) : null);
  const lead = 'Drag to move, wheel or pinch to zoom; choose an object on the map or in the list.';
  const parts = run.path.length || run.grid || run.objects.length ?
      h('div', {class: 'card map-and-objects'}, h('div', {class: 'map-side'}, panel.map.box, panel.foot),
        panel.side) :
      missingNote(run, ['trajectory.tum', 'map.yaml', 'landmarks.json']);
  return {panel, element: section('map', 'Map and objects', lead, parts, panel.live)};
}
