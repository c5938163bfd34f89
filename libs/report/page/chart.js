// SPDX-License-Identifier: BSD-3-Clause
// Curves over time with bands from smallest to largest value, and a reading under the pointer.

const MARGIN = {
  left: 46,
  right: 10,
  top: 8,
  bottom: 26
};

function largestOf(series) {
  return Math.max(
      ...series.map((one) => one.data.high.reduce((most, v) => v !== null && v > most ? v : most, 0)));
}

/// Pieces of the series without holes: lists of [x, low, high].
function stretches(data, x, y) {
  const out = [], longest = 3;  // empty parts that a line may cross
  let open = null, empty = 0;
  data.high.forEach((high, i) => {
    empty = high === null ? empty + 1 : 0;
    if (empty > longest) open = null;
    if (high === null) return;
    if (!open) out.push(open = []);
    open.push([x(data.from + (i + 0.5) * data.step), y(data.low[i]), y(high)]);
  });
  return out;
}

function seriesShape(one, x, y) {
  const group = s('g', {class: one.other ? 'other' : 'main'});
  for (const points of stretches(one.data, x, y)) {
    const top = points.map((p) => `${p[0].toFixed(1)},${p[2].toFixed(1)}`),
          low = points.map((p) => `${p[0].toFixed(1)},${p[1].toFixed(1)}`);
    group.append(s('polygon', {class: 'band', points: [...top, ...low.reverse()].join(' ')}));
    group.append(s('polyline', {
      class: 'curve',
      points: points.map((p) => `${p[0].toFixed(1)},${((p[1] + p[2]) / 2).toFixed(1)}`).join(' ')
    }));
  }
  return group;
}

function axes(chart, x, y, top) {
  const {w, h: height, options} = chart, parts = [];
  const step = niceStep(top, 6);
  for (let v = 0; v <= top * 1.0001; v += step)
    parts.push(
        s('line', {class: 'grid-line', x1: MARGIN.left, x2: w - MARGIN.right, y1: y(v), y2: y(v)}),
        s('text', {x: MARGIN.left - 8, y: y(v) + 4, 'text-anchor': 'end'}, options.tick(v, step)));
  const tick = timeStep(options.duration, Math.max(2, w / 110));
  for (let t = 0; t <= options.duration * 1.0001; t += tick)
    parts.push(s('text', {x: x(t), y: height - 6, 'text-anchor': t === 0 ? 'start' : 'middle'}, clock(t)));
  return parts;
}

function valueAt(data, t) {
  const i = Math.min(data.high.length - 1, Math.max(0, Math.floor((t - data.from) / data.step)));
  for (const k of [i, i - 1, i + 1])
    if (isNumber(data.high[k])) return data.high[k];
  return null;
}

function readAt(chart, t) {
  const {options, readout, cross} = chart;
  if (options.onTime) options.onTime(t);
  cross.style.display = t === null ? 'none' : '';
  if (t === null) {
    readout.textContent = '';
    return;
  }
  cross.setAttribute('x1', chart.x(t));
  cross.setAttribute('x2', chart.x(t));
  readout.textContent = [
    clock(t), ...options.series.map((one) => {
      const value = valueAt(one.data, t);
      return `${one.name} ${value === null ? NONE : options.value(value)}`;
    })
  ].join('  ·  ');
}

function drawChart(chart, w, height) {
  [chart.w, chart.h] = [w, height];
  const {options} = chart, largest = largestOf(options.series) || 1, top = largest * 1.06;
  chart.x = (t) => MARGIN.left + t / Math.max(options.duration, 1e-9) * (w - MARGIN.left - MARGIN.right);
  const y = (v) => height - MARGIN.bottom - v / top * (height - MARGIN.top - MARGIN.bottom);
  chart.cross = s('line', {class: 'cross', y1: MARGIN.top, y2: height - MARGIN.bottom});
  chart.cross.style.display = 'none';
  chart.svg.replaceChildren(
      ...axes(chart, chart.x, y, top),
      ...options.series.slice().reverse().map((one) => seriesShape(one, chart.x, y)), chart.cross);
}

function addReading(chart) {
  const {svg, options} = chart;
  const timeOf = (event) => {
    const share = (event.clientX - svg.getBoundingClientRect().left - MARGIN.left) /
        (chart.w - MARGIN.left - MARGIN.right);
    return Math.max(0, Math.min(1, share)) * options.duration;
  };
  let at = 0;
  svg.addEventListener('pointermove', (event) => readAt(chart, at = timeOf(event)));
  svg.addEventListener('pointerdown', (event) => readAt(chart, at = timeOf(event)));
  svg.addEventListener('pointerleave', () => readAt(chart, null));
  svg.addEventListener('blur', () => readAt(chart, null));
  svg.addEventListener('keydown', (event) => {
    const move = {ArrowLeft: -1, ArrowRight: 1}[event.key];
    if (!move) return;
    event.preventDefault();
    at = Math.max(0, Math.min(options.duration, at + move * options.duration / 60));
    readAt(chart, at);
  });
}

function legendOf(series) {
  if (series.length < 2) return null;
  return h(
      'div', {class: 'legend'},
      series.map(
          (one) =>
              h('span', {class: one.other ? 'other' : ''},
                s('svg', {viewBox: '0 0 26 8', 'aria-hidden': 'true'},
                  s('line', {x1: 0, x2: 26, y1: 4, y2: 4})),
                one.name)));
}

/// options: title, summary, series [{name, data, other}], duration, value(v), tick(v, step), onTime(t).
function createChart(options) {
  const chart = {options, w: 600, h: 240};
  chart.svg = s('svg', {
    class: 'chart',
    role: 'img',
    tabindex: '0',
    'aria-label': `${options.title}. ${options.summary} Left and right arrows read values.`
  });
  chart.readout = h('p', {class: 'readout', 'aria-live': 'polite'});
  chart.x = () => 0;
  chart.cross = s('line');
  addReading(chart);
  drawnToSize(chart.svg, SHEET.chart, (w, height) => drawChart(chart, w, height));
  return h(
      'figure', {class: 'card pad', style: 'margin: 0'},
      h('div', {class: 'chart-head'}, h('h3', {}, options.title), legendOf(options.series)), chart.svg,
      chart.readout);
}

function hasValues(series) { return Boolean(series && series.high.some((v) => v !== null)); }

/// Share that was right over what was believed; on the diagonal, probabilities are what they say.
function reliabilityChart(evaluation) {
  const size = 240, at = (v) => 34 + v * (size - 44), up = (v) => size - 26 - v * (size - 36),
        most = Math.max(...evaluation.reliability.map((b) => b.count));
  const label = evaluation.reliability
                    .map((b) => `believed ${percent(b.mean)}, right ${percent(b.correct)} of ${b.count}`)
                    .join('; ');
  return s(
      'svg', {
        class: 'chart',
        viewBox: `0 0 ${size} ${size}`,
        style: 'height: 17rem',
        role: 'img',
        'aria-label': `Reliability: ${label}`
      },
      [0, 0.5, 1].map(
          (v) =>
              [s('line', {class: 'grid-line', x1: at(0), x2: at(1), y1: up(v), y2: up(v)}),
               s('text', {x: at(v), y: size - 8, 'text-anchor': 'middle'}, v * 100),
               s('text', {x: 26, y: up(v) + 4, 'text-anchor': 'end'}, v * 100)]),
      s('line', {class: 'ideal', x1: at(0), x2: at(1), y1: up(0), y2: up(1)}),
      evaluation.reliability.map(
          (b) =>
              s('circle',
                {class: 'dot', cx: at(b.mean), cy: up(b.correct), r: 4 + 6 * Math.sqrt(b.count / most)},
                s('title', {}, `believed ${percent(b.mean)}, right ${percent(b.correct)} of ${b.count}`))));
}
