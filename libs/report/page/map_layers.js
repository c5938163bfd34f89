// SPDX-License-Identifier: BSD-3-Clause
// What lies on the map: grid, paths, loop closures, objects with their labels and ellipses.

const TIME_STEPS = 48, CHI2_95 = 5.991;  // of two degrees of freedom

function pointsOf(path, begin = 0, end = path.length / 4) {
  const out = [];
  for (let i = begin; i < end; ++i) out.push(`${path[4 * i + 1]},${path[4 * i + 2]}`);
  return out.join(' ');
}

function addGrid(map, group) {
  const {grid} = map.run, picture = new Image();
  const place =
      `matrix(${grid.cell_m} 0 0 ${- grid.cell_m} ${grid.x_min} ${grid.y_min + grid.height * grid.cell_m})`;
  picture.addEventListener('load', () => {
    for (const theme of ['light', 'dark'])
      group.append(s('image', {
        class: theme,
        href: paintedGrid(picture, theme),
        width: grid.width,
        height: grid.height,
        transform: place,
        preserveAspectRatio: 'none'
      }));
    grid.known = knownCorners(picture, grid);
    if (map.fitted) fitView(map);
  });
  picture.src = `data:image/png;base64,${grid.png}`;
}

/// Corners of the part of the grid that is not unknown, m.
function knownCorners(image, grid) {
  const canvas = h('canvas', {width: grid.width, height: grid.height}),
        context = canvas.getContext('2d', {willReadFrequently: true});
  context.drawImage(image, 0, 0);
  const {data} = context.getImageData(0, 0, grid.width, grid.height);
  let [u0, v0, u1, v1] = [grid.width, grid.height, -1, -1];
  for (let v = 0; v < grid.height; ++v)
    for (let u = 0; u < grid.width; ++u) {
      const grey = data[4 * (v * grid.width + u)];
      if (grey >= 64 && grey < 192) continue;
      u0 = Math.min(u0, u);
      u1 = Math.max(u1, u);
      v0 = Math.min(v0, v);
      v1 = Math.max(v1, v);
    }
  if (u1 < 0) return [];
  const x = (u) => grid.x_min + u * grid.cell_m, y = (v) => grid.y_min + (grid.height - v) * grid.cell_m;
  return [[x(u0), y(v0)], [x(u1 + 1), y(v1 + 1)]];
}

/// The path in pieces of equal time, each in its colour, cut between poses where need be; nothing is drawn where poses are missing.
function pathPieces(run) {
  const {path} = run, count = path.length / 4, pieces = [];
  const stepAt = (t) => Math.min(TIME_STEPS - 1, Math.floor(t / Math.max(run.duration, 1e-9) * TIME_STEPS));
  const gapAt = (i) =>
      run.gaps.some(([from]) => from >= path[4 * i] - 1e-3 && from < path[4 * (i + 1)] - 1e-3);
  const pointAt = (i, ratio = 0) => [1, 2].map((k) => path[4 * i + k] + (ratio ? ratio * (path[4 * i + 4 + k] - path[4 * i + k]) : 0));
  let points = [], step = 0;
  const finish = () => {
    if (points.length > 1)
      pieces.push(s('polyline', {points: points.map((p) => p.join(',')).join(' '), stroke: rampColour(step / (TIME_STEPS - 1))}));
  };
  for (let i = 0; i < count; ++i) {
    const t = path[4 * i], joined = i > 0 && !(run.gaps.length && gapAt(i - 1));
    if (!joined) {
      finish();
      points = [], step = stepAt(t);
    }
    while (joined && step < stepAt(t)) {
      const before = path[4 * (i - 1)], boundary = (step + 1) * run.duration / TIME_STEPS;
      const cut = pointAt(i - 1, Math.min(1, Math.max(0, (boundary - before) / (t - before))));
      points.push(cut);
      finish();
      points = [cut], ++step;
    }
    points.push(pointAt(i));
  }
  finish();
  return pieces;
}

function closureLines(run) {
  return s('path', {
    class: 'closures',
    d: run.closures.map(({a, b}) => `M${a[0]} ${a[1]}L${b[0]} ${b[1]}`).join('')
  });
}

/// The ellipse that holds the centre with 95 %, from the eigenvectors of its covariance.
function ellipseOf(object) {
  const [xx, xy, yy] = object.covariance, mean = (xx + yy) / 2, spread = Math.hypot((xx - yy) / 2, xy);
  const radius = (variance) => Math.sqrt(Math.max(variance, 0) * CHI2_95);
  return {major: radius(mean + spread), minor: radius(mean - spread), angle: Math.atan2(2 * xy, xx - yy) / 2};
}

function ellipseShape(object) {
  const {major, minor, angle} = ellipseOf(object), points = [];
  for (let i = 0; i < 40; ++i) {
    const a = i / 40 * 2 * Math.PI, u = major * Math.cos(a), v = minor * Math.sin(a);
    points.push(`${object.place[0] + u * Math.cos(angle) - v * Math.sin(angle)},${
        object.place[1] + u * Math.sin(angle) + v * Math.cos(angle)}`);
  }
  return s('polygon', {class: 'ellipse', points: points.join(' ')});
}

/// Along the longer side through the middle: how a door or a picture is drawn.
function leafOf(object) {
  const f = object.footprint;
  if (f.length !== 4) return null;
  const middle = (a, b) => [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2],
        length = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]);
  const [a, b] = length(f[0], f[1]) > length(f[1], f[2]) ? [middle(f[1], f[2]), middle(f[3], f[0])] :
                                                           [middle(f[0], f[1]), middle(f[2], f[3])];
  return s('line', {class: 'leaf', x1: a[0], y1: a[1], x2: b[0], y2: b[1]});
}

function frontOf(object) {
  if (object.yaw === null || object.shape === 'planar') return null;
  const [x, y] = object.place, half = Math.max(0.12, object.size[1] / 2), c = Math.cos(object.yaw),
            si = Math.sin(object.yaw);
  const tip = [x + c * half, y + si * half], wing = 0.09;
  const back = (side) => `${tip[0] - wing * (c - side * si)} ${tip[1] - wing * (si + side * c)}`;
  return s(
      'path',
      {class: 'front', d: `M${x} ${y}L${tip[0]} ${tip[1]}M${back(1)}L${tip[0]} ${tip[1]}L${back(-1)}`});
}

function objectTitle(object) { return `${words(object.class)} ${object.id}`; }

function objectShape(map, object) {
  const {hooks} = map, points = object.footprint.map((p) => p.join(',')).join(' '),
        planar = object.shape === 'planar';
  const kinds =
      ['object', object.in_map ? 'mapped' : 'candidate', planar && 'door'].filter(Boolean).join(' ');
  const group =
      s('g', {
        class: kinds,
        '--class': classColour(map.run, object.class),
        'data-id': object.id,
        role: 'button',
        tabindex: '0',
        'aria-pressed': 'false',
        'aria-label': `${objectTitle(object)}, existence ${percent(object.existence)}`
      },
        s('polygon', {class: 'hit', points}), s('polygon', {class: 'shape', points}),
        planar && leafOf(object), frontOf(object), ellipseShape(object));
  const select = () => hooks.onSelect && hooks.onSelect(object.id);
  const hover = (on) => hooks.onHover && hooks.onHover(on ? object.id : null);
  group.addEventListener('click', select);
  group.addEventListener('keydown', (event) => {
    if (event.key !== 'Enter' && event.key !== ' ') return;
    event.preventDefault();
    event.stopPropagation();
    select();
  });
  group.addEventListener(
      'pointermove',
      (event) => !event.buttons &&
          showTip(
              `${objectTitle(object)} · existence ${percent(object.existence)}`, event.clientX,
              event.clientY));
  group.addEventListener('pointerenter', () => hover(true));
  group.addEventListener('pointerleave', () => {
    hover(false);
    hideTip();
  });
  map.shapes.set(object.id, group);
  return group;
}

function addLabels(map) {
  for (const object of map.run.objects.filter((o) => o.in_map)) {
    const element = s('text', {class: 'label'});
    map.labels.push({
      element,
      x: object.place[0],
      y: object.place[1],
      size: Math.max(object.size[0], object.size[1]),
      short: String(object.id),
      long: objectTitle(object)
    });
    map.labelLayer.append(element);
  }
}

function addLayers(map) {
  const {run, world} = map, grid = s('g', {class: 'grid'});
  world.append(grid);
  if (run.grid) addGrid(map, grid);
  world.append(closureLines(run));
  if (run.truth_path.length) world.append(s('polyline', {class: 'truth', points: pointsOf(run.truth_path)}));
  world.append(s('polyline', {class: 'live', points: pointsOf(run.live_path)}));
  world.append(s('g', {class: 'path'}, pathPieces(run)));
  const order =
      [...run.objects].sort((a, b) => a.in_map - b.in_map || b.size[0] * b.size[1] - a.size[0] * a.size[1]);
  world.append(s('g', {class: 'objects'}, order.map((object) => objectShape(map, object))));
  map.cursor = s('circle', {class: 'cursor', r: 0.1});
  map.cursor.style.display = 'none';
  world.append(map.cursor);
  addLabels(map);
}
