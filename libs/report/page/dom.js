// SPDX-License-Identifier: BSD-3-Clause
// Elements from data: texts go in as texts, never as HTML.

const SVG = 'http://www.w3.org/2000/svg';

function fill(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes || {})) {
    if (value === null || value === undefined || value === false) continue;
    if (name.startsWith('on'))
      element.addEventListener(name.slice(2), value);
    else if (name.startsWith('--'))
      element.style.setProperty(name, value);
    else
      element.setAttribute(name, value === true ? '' : value);
  }
  element.append(
      ...children.flat(3).filter((child) => child !== null && child !== undefined && child !== false));
  return element;
}

function h(tag, attributes, ...children) { return fill(document.createElement(tag), attributes, children); }

function s(tag, attributes, ...children) {
  return fill(document.createElementNS(SVG, tag), attributes, children);
}

function byId(id) { return document.getElementById(id); }

function section(id, title, lead, ...children) {
  return h(
      'section', {id, 'aria-labelledby': `${id}-title`}, h('h2', {id: `${id}-title`}, title),
      lead && h('p', {class: 'lead'}, lead), children);
}

/// Rows of cells; numbers stand to the right. `columns`: {title, number}.
function table(caption, columns, rows, attributes = {}) {
  const cell = (column, value, first) =>
      h(first ? 'th' : 'td', {class: column.number ? 'num' : null, scope: first ? 'row' : null}, value);
  return h(
      'div', {class: 'scroll'},
      h('table', attributes, caption && h('caption', {}, caption),
        h('thead', {},
          h('tr', {class: 'head'},
            columns.map(
                (column) => h('th', {scope: 'col', class: column.number ? 'num' : null}, column.title)))),
        h('tbody', {},
          rows.map((row) => h('tr', {}, row.map((value, i) => cell(columns[i], value, i === 0)))))));
}

/// A share in [0, 1] as a bar; the number stands beside it, so screen readers skip it.
function bar(share) {
  const inner = h('i');
  inner.style.width = `${Math.max(0, Math.min(1, share || 0)) * 100}%`;
  return h('span', {class: 'bar', 'aria-hidden': 'true'}, inner);
}

function showTip(text, x, y) {
  const tip = byId('tip');
  tip.textContent = text;
  tip.hidden = false;
  const box = tip.getBoundingClientRect();
  tip.style.left = `${Math.max(8, Math.min(x + 14, innerWidth - box.width - 8))}px`;
  tip.style.top = `${y + 18 + box.height > innerHeight ? y - box.height - 12 : y + 18}px`;
}

function hideTip() { byId('tip').hidden = true; }
