// SPDX-License-Identifier: BSD-3-Clause
// What is drawn for the width of the window is drawn once more, for a sheet, while it is printed. The layout of
// the sheet is not known by then: the viewBox fits the drawing into it.

const SHEET = {
  width: 680,  // px: A4 and Letter between their margins
  chart: 210,
  map: 500
};

/// Calls draw(w, height, on a sheet?) with the element's size, whenever that changes, and with the one for a sheet.
function drawnToSize(element, sheetHeight, draw) {
  const drawAt = (w, height, onSheet) => {
    element.setAttribute('viewBox', `0 0 ${w} ${height}`);
    draw(w, height, onSheet);
  };
  const drawHere = () => {
    const box = element.getBoundingClientRect();
    if (box.width && box.height) drawAt(box.width, box.height, false);
  };
  new ResizeObserver(drawHere).observe(element);
  element.addEventListener('sheet', () => drawAt(SHEET.width, sheetHeight, true));
  element.addEventListener('window', drawHere);
}

function startPrinting() {
  const tell = (name) =>
      document.querySelectorAll('svg.chart, svg.map').forEach((svg) => svg.dispatchEvent(new Event(name)));
  const opened = new Set();  // folds that paper shows open
  addEventListener('beforeprint', () => {
    for (const fold of document.querySelectorAll('details.printed:not([open])')) {
      fold.open = true;
      opened.add(fold);
    }
    tell('sheet');
  });
  addEventListener('afterprint', () => {
    opened.forEach((fold) => fold.open = false);
    opened.clear();
    tell('window');
  });
}
