// SPDX-License-Identifier: MIT
// The data of the page, and helpers for all its parts.
'use strict';

const data = JSON.parse(document.getElementById('data').textContent);
// Panels in the paper's order, others behind them.
data.experiments.sort((a, b) => (a.figure || '~').localeCompare(b.figure || '~'));

/// An element with attributes and children; texts become text, never markup. An attribute that is false or null is left
/// out.
function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === 'function')
      made.addEventListener(name, value);
    else if (name === 'style')  // as an attribute the policy of the page refuses it
      made.style.cssText = value;
    else if (value !== false && value !== null)
      made.setAttribute(name, value === true ? '' : value);
  }
  made.append(...children);
  return made;
}
const byId = id => document.getElementById(id);
const unique = values => [...new Set(values)];
const isNumber = value => typeof value === 'number';

/// A number with so many decimals; a dash where there is none.
const fixed = (value, decimals) => isNumber(value) ? value.toFixed(decimals) : '–';
const capitalized = text => text.charAt(0).toUpperCase() + text.slice(1);
const counted = (count, one, many = one + 's') => `${count.toLocaleString('en')} ${count === 1 ? one : many}`;

// Records, one object each.
const records = (() => {
  const columns = data.records, worded = ['experiment', 'dataset', 'level', 'pair', 'method', 'status', 'selection'];
  return (columns.run || []).map((_, row) => {
    const record = {row};
    for (const name in columns)
      record[name] = worded.includes(name) ? data.words[columns[name][row]] : columns[name][row];
    return record;
  });
})();
const isSampled = records.length < data.totals.records;
const experimentOf = record => data.experiments.find(e => e.run === record.run && e.name === record.experiment);
const experimentTitle = experiment => (experiment.figure ? `(${experiment.figure}) ` : '') + experiment.title;
for (const record of records) {
  record.place = experimentOf(record);
  record.state = record.status.split(':')[0];  // 'failed' and 'too large' with the cause behind it
}

// Every grouper has one colour, one marker and one dash: those of the figures, whose markers have gnuplot's numbers. Chart.js
// knows no pentagons (14 and 15).
const bounds = unique(data.experiments.flatMap(e => e.bounds));
const methods = unique([...data.experiments.flatMap(e => e.methods), ...bounds]);
const markers = [
  'line', 'cross', 'crossRot', 'star', 'rect', 'rect', 'circle', 'circle', 'triangle', 'triangle', 'triangle', 'triangle',
  'rectRot', 'rectRot', 'rectRounded', 'star'
];
const styles = new Map(Object.entries(data.styles).map(([method, {label, color, point, dash}]) => [method, {
  label,
  color,
  marker: markers[point],
  rotation: point === 10 || point === 11 ? 180 : 0,
  open: point >= 4 && point % 2 === 0,
  dash: (dash.match(/\d+/g) || []).map(Number)
}]));
const labelOf = method => (styles.get(method) || {label: method}).label;

/// Bytes of a base64 text.
const bytesOf = text => Uint8Array.from(atob(text), character => character.charCodeAt(0));
