// SPDX-License-Identifier: BSD-3-Clause
// Puts the page together from its data.

const SECTIONS = [
  ['map', 'Map'], ['accuracy', 'Accuracy'], ['time', 'Time'], ['events', 'Events'],
  ['config', 'Configuration']
];

function showRun(run, level) {
  const {panel, element} = mapSection(run), onTime = (t) => showRobotAt(panel.map, t);
  const notes = notesOf(run);
  byId('run').replaceChildren(
      runHead(run, level), keyFigures(run),
      ...(notes ? [h('div', {style: 'margin-top: 1.25rem'}, notes)] : []), element,
      accuracySection(run, onTime), timeSection(run, onTime), eventsSection(run), configSection(run));
  hideTip();
}

function showRuns(runs) {
  const choice = runChoice(runs, (i) => {
    choice.buttons.forEach((button, k) => button.setAttribute('aria-pressed', String(k === i)));
    showRun(runs[i], 'h2');
  });
  byId('title').replaceChildren();
  byId('compare').replaceChildren(...compareSection(runs), choice.element);
  choice.buttons[0].click();
}

function start() {
  startTheme();
  const {runs} = JSON.parse(byId('data').textContent), several = runs.length > 1;
  document.title = several ? `${runs.length} runs – roomgraph` : `${titleOf(runs[0])} – roomgraph`;
  byId('nav').replaceChildren(...(several ? [['compare', 'Comparison'], ...SECTIONS] : SECTIONS)
                                  .map(([id, title]) => h('li', {}, h('a', {href: `#${id}`}, title))));
  if (several)
    showRuns(runs);
  else
    showRun(runs[0], 'h1');
  byId('footer').textContent =
      'Positions in metres in the frame of the map; times from the first pose.';
  startPrinting();
  document.documentElement.dataset.ready = String(Math.round(performance.now()));
}

start();
