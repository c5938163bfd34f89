// SPDX-License-Identifier: BSD-3-Clause
// Numbers, times and names as people read them.

const NONE = '–';

function isNumber(value) { return typeof value === 'number' && Number.isFinite(value); }

function fixed(value, digits) {
  if (!isNumber(value)) return NONE;
  const text = value.toLocaleString('en', {minimumFractionDigits: digits, maximumFractionDigits: digits});
  return text.replace(/^-(?=[0.]*$)/, '');  // no "-0.00"
}

function whole(value) { return fixed(value, 0); }

/// Digits that tell multiples of `step` apart.
function digitsOf(step) { return Math.max(0, Math.ceil(-Math.log10(step) - 1e-9)); }

function metres(value) {
  if (!isNumber(value)) return NONE;
  return value < 1 ? `${fixed(value * 100, value < 0.1 ? 2 : 1)}\u00a0cm` : `${fixed(value, 2)}\u00a0m`;
}

function percent(value) {
  if (!isNumber(value)) return NONE;
  const fine = value < 0.0995 || value > 0.9895, digits = fine && value >= 0.0005 && value < 0.9995 ? 1 : 0;
  return `${fixed(value * 100, digits)}\u00a0%`;
}

/// Seconds since the start as m:ss, or h:mm:ss.
function clock(seconds) {
  if (!isNumber(seconds)) return NONE;
  const total = Math.round(seconds), pad = (n) => String(n).padStart(2, '0');
  const hours = Math.floor(total / 3600), minutes = Math.floor(total / 60) % 60;
  return hours ? `${hours}:${pad(minutes)}:${pad(total % 60)}` : `${minutes}:${pad(total % 60)}`;
}

function duration(seconds) {
  if (!isNumber(seconds)) return NONE;
  return seconds < 100 ? `${fixed(seconds, 1)}\u00a0s` :
                         `${clock(seconds)}\u00a0min`.replace(/^(\d+:\d\d:\d\d).min/, '$1\u00a0h');
}

function milliseconds(ms) {
  if (!isNumber(ms)) return NONE;
  if (ms >= 1000) return `${fixed(ms / 1000, ms >= 10000 ? 1 : 2)}\u00a0s`;
  return `${fixed(ms, ms >= 10 ? 1 : ms >= 0.1 ? 2 : 3)}\u00a0ms`;
}

function degrees(radians) { return isNumber(radians) ? `${fixed(radians * 180 / Math.PI, 1)}°` : NONE; }

/// "swivel_chair" -> "swivel chair".
function words(name) { return String(name).replace(/_/g, ' '); }

/// Date of a stamp, when it can be one.
function dateOf(stamp) {
  if (!(stamp > 6e8 && stamp < 7e9)) return null;
  return new Date(stamp * 1000).toISOString().replace('T', ' ').slice(0, 16) + ' UTC';
}

/// Round step so that about `wanted` of them make `range`.
function niceStep(range, wanted) {
  const rough = range / Math.max(1, wanted), power = 10 ** Math.floor(Math.log10(rough));
  return [1, 2, 5, 10].map((factor) => factor * power).find((step) => step >= rough * 0.999);
}

/// Step of a time axis: seconds, minutes or hours that people count in.
function timeStep(range, wanted) {
  const steps = [1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200];
  return steps.find((step) => step >= range / wanted) || niceStep(range, wanted);
}

function lastOf(path, name) {
  const parts = String(path).split('/').filter(Boolean);
  return parts.length ? parts[parts.length - 1] : name;
}
