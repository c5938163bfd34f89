// SPDX-License-Identifier: BSD-3-Clause
// The map: world coordinates on the screen, selection, scale bar. Layers and gestures have files of their
// own.

/// Corners of all that the map shows, m.
function boundsOf(run) {
  const box = {x0: Infinity, y0: Infinity, x1: -Infinity, y1: -Infinity};
  const take = (x, y) => {
    box.x0 = Math.min(box.x0, x);
    box.x1 = Math.max(box.x1, x);
    box.y0 = Math.min(box.y0, y);
    box.y1 = Math.max(box.y1, y);
  };
  for (const path of [run.path, run.path.length ? [] : run.live_path])
    for (let i = 0; i < path.length; i += 4) take(path[i + 1], path[i + 2]);
  for (const object of run.objects)
    if (object.in_map) object.footprint.forEach(([x, y]) => take(x, y));
  if (run.grid && run.grid.known) run.grid.known.forEach(([x, y]) => take(x, y));
  if (!(box.x1 > box.x0 || box.y1 > box.y0)) return {x0: -2, y0: -2, x1: 2, y1: 2};
  return box;
}

function placeView(map) {
  const {view, size} = map;
  map.world.setAttribute(
      'transform',
      `translate(${size.w / 2 - view.x * view.scale} ${size.h / 2 + view.y * view.scale}) scale(${
          view.scale} ${- view.scale})`);
  for (const label of map.labels) {
    const [x, y] = toScreen(map, label.x, label.y);
    label.element.setAttribute('x', x);
    label.element.setAttribute('y', y);
    label.element.textContent = view.scale * label.size > 78 ? label.long : label.short;
  }
  if (map.cursor) map.cursor.setAttribute('r', 7 / view.scale);
  const cell = map.run.grid ? map.run.grid.cell_m * view.scale : 0;
  map.svg.classList.toggle('coarse', cell > 3);
  map.world.querySelectorAll('image').forEach((image) => image.classList.toggle('crisp', cell > 3));
  const step = niceStep(110 / view.scale, 1),
        unit = step < 1 ? `${fixed(step * 100, 0)} cm` : `${whole(step)} m`;
  map.scale.replaceChildren(unit, h('i'));
  map.scale.style.width = `calc(${100 * step * view.scale / size.w}% + 1rem)`;
}

function toScreen(map, x, y) {
  return [
    map.size.w / 2 + (x - map.view.x) * map.view.scale, map.size.h / 2 - (y - map.view.y) * map.view.scale
  ];
}

/// Sets the view and tells whoever shows the same place.
function setView(map, view, quietly) {
  map.view = {...view, scale: Math.max(1, Math.min(4000, view.scale))};
  placeView(map);
  if (!quietly && map.hooks.onView) map.hooks.onView(map.view);
}

function fitView(map, quietly) {
  const box = boundsOf(map.run), w = box.x1 - box.x0, hgt = box.y1 - box.y0;
  const scale = Math.min((map.size.w - 60) / Math.max(w, 0.5), (map.size.h - 70) / Math.max(hgt, 0.5));
  map.fitted = true;
  setView(map, {x: (box.x0 + box.x1) / 2, y: (box.y0 + box.y1) / 2, scale}, quietly);
}

/// Zooms by a factor about a point of the screen; the middle without one.
function zoomView(map, factor, at = [map.size.w / 2, map.size.h / 2]) {
  const {view, size} = map, scale = Math.max(1, Math.min(4000, view.scale * factor));
  const k = 1 / view.scale - 1 / scale;
  map.fitted = false;
  setView(map, {x: view.x + (at[0] - size.w / 2) * k, y: view.y - (at[1] - size.h / 2) * k, scale});
}

function panView(map, dx, dy) {
  map.fitted = false;
  setView(map, {...map.view, x: map.view.x - dx / map.view.scale, y: map.view.y + dy / map.view.scale});
}

/// Fits all again, or keeps the middle; a sheet shows at least what the window shows.
function resized(map, w, height, onSheet) {
  const before = map.size;
  map.size = {w, h: height};
  if (onSheet && !map.inWindow) map.inWindow = {view: map.view, size: before};
  const {inWindow} = map;
  if (!onSheet) map.inWindow = null;
  if (map.fitted) {
    fitView(map, onSheet);
  } else if (onSheet) {
    const share = Math.min(w / inWindow.size.w, height / inWindow.size.h);
    setView(map, {...inWindow.view, scale: inWindow.view.scale * share}, true);
  } else {
    if (inWindow) map.view = inWindow.view;
    placeView(map);
  }
}

function markObject(map, id, name, on) {
  const shape = map.shapes.get(id);
  if (shape) shape.classList.toggle(name, on);
}

function selectOnMap(map, id) {
  for (const [key, shape] of map.shapes) {
    shape.classList.toggle('selected', key === id);
    shape.setAttribute('aria-pressed', key === id);
  }
}

/// Position of the robot at time t, between the points of the thinned path.
function poseAt(path, t) {
  if (!path.length) return null;
  let low = 0, high = path.length / 4 - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (path[middle * 4] <= t)
      low = middle;
    else
      high = middle;
  }
  const a = path.slice(low * 4, low * 4 + 4), b = path.slice(high * 4, high * 4 + 4);
  const share = b[0] > a[0] ? Math.max(0, Math.min(1, (t - a[0]) / (b[0] - a[0]))) : 0;
  return [a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2])];
}

function showRobotAt(map, t) {
  const place = t === null ? null : poseAt(map.run.path, t);
  map.cursor.style.display = place ? '' : 'none';
  if (!place) return;
  map.cursor.setAttribute('cx', place[0]);
  map.cursor.setAttribute('cy', place[1]);
}

function mapButtons(map) {
  const button = (label, path, action) =>
      h('button', {type: 'button', 'aria-label': label, title: label, onclick: action},
        s('svg', {viewBox: '0 0 16 16', 'aria-hidden': 'true'}, s('path', {d: path})));
  return h(
      'div', {class: 'map-tools'}, button('Zoom in', 'M8 2v12M2 8h12', () => zoomView(map, 1.5)),
      button('Zoom out', 'M2 8h12', () => zoomView(map, 1 / 1.5)),
      button('Show all', 'M2 6V2h4M10 2h4v4M14 10v4h-4M6 14H2v-4', () => fitView(map)));
}

function createMap(run, hooks = {}) {
  const map = {
    run,
    hooks,
    size: {w: 800, h: 500},
    view: {x: 0, y: 0, scale: 50},
    shapes: new Map(),
    labels: [],
    fitted: true
  };
  map.world = s('g', {class: 'world'});
  map.labelLayer = s('g', {class: 'labels', 'aria-hidden': 'true'});
  map.svg =
      s('svg', {
        class: 'map',
        tabindex: '0',
        role: 'group',
        'aria-label':
            `Map of ${run.recording || run.name}. Arrow keys move it, plus and minus zoom, 0 shows all.`
      },
        map.world, map.labelLayer);
  map.scale = h('div', {class: 'scale-bar', 'aria-hidden': 'true'});
  addLayers(map);
  addGestures(map);
  map.box = h('div', {class: 'map-box'}, map.svg, map.scale, mapButtons(map));
  drawnToSize(map.svg, SHEET.map, (w, height, onSheet) => resized(map, w, height, onSheet));
  return map;
}
