// SPDX-License-Identifier: BSD-3-Clause
// Theme switch, colours of classes and of time.

const RAMP = [[84, 72, 208], [178, 66, 148], [238, 138, 58]];  // grows lighter: also told apart without hues
const OTHER_CLASSES = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#b58900', '#56b4e9'];
const GRID_COLOURS = {
  light: {wall: [42, 49, 56], free: [255, 255, 255]},
  dark: {wall: [178, 190, 200], free: [36, 44, 52]}
};

function rampColour(share) {
  const at = Math.max(0, Math.min(1, share)) * (RAMP.length - 1),
        i = Math.min(RAMP.length - 2, Math.floor(at));
  const mixed = RAMP[i].map((from, k) => Math.round(from + (at - i) * (RAMP[i + 1][k] - from)));
  return `rgb(${mixed.join(',')})`;
}

function classColour(run, name) {
  if (run.colours[name]) return run.colours[name];
  const known = [...new Set(run.objects.map((object) => object.class))].sort();
  return OTHER_CLASSES[Math.max(0, known.indexOf(name)) % OTHER_CLASSES.length];
}

function storedTheme() {
  try {
    return localStorage.getItem('roomgraph-theme');
  } catch {
    return null;  // files may have no storage
  }
}

function currentTheme() { return document.documentElement.dataset.theme; }

function setTheme(theme) {
  document.documentElement.dataset.theme = theme;
  const button = byId('theme');
  button.textContent = theme === 'dark' ? 'Light' : 'Dark';
  button.setAttribute('aria-label', `Switch to ${theme === 'dark' ? 'light' : 'dark'} colours`);
}

function startTheme() {
  const system = matchMedia('(prefers-color-scheme: dark)');
  const wanted = () => storedTheme() || (system.matches ? 'dark' : 'light');
  setTheme(wanted());
  system.addEventListener('change', () => setTheme(wanted()));
  byId('theme').addEventListener('click', () => {
    const theme = currentTheme() === 'dark' ? 'light' : 'dark';
    try {
      localStorage.setItem('roomgraph-theme', theme);
    } catch {
      // then it holds for this page only
    }
    setTheme(theme);
  });
  let before = null;
  addEventListener('beforeprint', () => {
    before = currentTheme();
    setTheme('light');
  });
  addEventListener('afterprint', () => setTheme(before || wanted()));
}

/// The grey grid in the colours of a theme; what is unknown is transparent.
function paintedGrid(image, theme) {
  const canvas = h('canvas', {width: image.naturalWidth, height: image.naturalHeight});
  const context = canvas.getContext('2d', {willReadFrequently: true});
  context.drawImage(image, 0, 0);
  const pixels = context.getImageData(0, 0, canvas.width, canvas.height), data = pixels.data;
  const {wall, free} = GRID_COLOURS[theme];
  for (let i = 0; i < data.length; i += 4) {
    const grey = data[i], colour = grey < 64 ? wall : free;
    data[i] = colour[0];
    data[i + 1] = colour[1];
    data[i + 2] = colour[2];
    data[i + 3] = grey >= 64 && grey < 192 ? 0 : 255;
  }
  context.putImageData(pixels, 0, 0);
  return canvas.toDataURL('image/png');
}
