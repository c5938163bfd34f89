// SPDX-License-Identifier: BSD-3-Clause
// Wheel, drag, pinch and keys of a map.

const LEAST_DRAG = 4;  // px; less is a click

function pointOf(map, event) {
  const box = map.svg.getBoundingClientRect();
  return [event.clientX - box.left, event.clientY - box.top];
}

function addGestures(map) {
  const held = new Map();
  let moved = 0;
  map.svg.addEventListener('wheel', (event) => {
    event.preventDefault();
    const lines = event.deltaMode === 1 ? 16 : 1;
    zoomView(
        map, Math.exp(-Math.max(-300, Math.min(300, event.deltaY * lines)) * 0.002), pointOf(map, event));
  }, {passive: false});
  map.svg.addEventListener('pointerdown', (event) => {
    if (event.button > 0) return;
    held.set(event.pointerId, pointOf(map, event));
    moved = 0;
    hideTip();
  });
  map.svg.addEventListener('pointermove', (event) => {
    if (!held.has(event.pointerId)) return;
    moved = dragged(map, held, event, moved);
  });
  const release = (event) => held.delete(event.pointerId);
  map.svg.addEventListener('pointerup', release);
  map.svg.addEventListener('pointercancel', release);
  map.svg.addEventListener('pointerleave', release);
  map.svg.addEventListener('click', (event) => {
    if (moved > LEAST_DRAG)
      event.stopPropagation();
    else if (!event.target.closest('.object') && map.hooks.onSelect)
      map.hooks.onSelect(null);
  }, true);
  map.svg.addEventListener('dblclick', (event) => zoomView(map, 2, pointOf(map, event)));
  map.svg.addEventListener('keydown', (event) => keyOnMap(map, event));
}

/// Moves the map by one pointer, zooms by the distance of two; returns how far it has moved in all.
function dragged(map, held, event, moved) {
  const from = held.get(event.pointerId), to = pointOf(map, event);
  const others = [...held.keys()].filter((id) => id !== event.pointerId);
  held.set(event.pointerId, to);
  const step = Math.hypot(to[0] - from[0], to[1] - from[1]), total = moved + step;
  if (others.length) {
    const other = held.get(others[0]),
          distance = (p) => Math.max(10, Math.hypot(p[0] - other[0], p[1] - other[1]));
    const middle = [(to[0] + other[0]) / 2, (to[1] + other[1]) / 2];
    panView(map, (to[0] - from[0]) / 2, (to[1] - from[1]) / 2);
    zoomView(map, distance(to) / distance(from), middle);
  } else if (total > LEAST_DRAG) {
    if (!map.svg.hasPointerCapture(event.pointerId)) map.svg.setPointerCapture(event.pointerId);
    panView(map, to[0] - from[0], to[1] - from[1]);
  }
  return total;
}

function keyOnMap(map, event) {
  const step = 60, actions = {
    ArrowLeft: () => panView(map, step, 0),
    ArrowRight: () => panView(map, -step, 0),
    ArrowUp: () => panView(map, 0, step),
    ArrowDown: () => panView(map, 0, -step),
    '+': () => zoomView(map, 1.4),
    '=': () => zoomView(map, 1.4),
    '-': () => zoomView(map, 1 / 1.4),
    0: () => fitView(map),
    Escape: () => map.hooks.onSelect && map.hooks.onSelect(null),
  };
  if (event.ctrlKey || event.metaKey || event.altKey || !actions[event.key]) return;
  event.preventDefault();
  actions[event.key]();
}
