// SPDX-License-Identifier: MIT
// What the page was written with, and the few words that all its parts share.
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
const experimentOf = record => data.experiments.find(e => e.run === record.run && e.name === record.experiment);
const experimentTitle = experiment => (experiment.figure ? `(${experiment.figure}) ` : '') + experiment.title;
for (const record of records) {
  record.place = experimentOf(record);
  const least = record.place ? record.place.least_true_matches : 1;
  record.excluded = isNumber(record.true_matches) && record.true_matches < least;
}

// Every grouper has one colour (Okabe and Ito's, for every kind of sight), one marker and one dash, in all of the page.
const bounds = unique(data.experiments.flatMap(e => e.bounds));
const methods = unique([...data.experiments.flatMap(e => e.methods), ...bounds]);
const knownStyles = {
  ss: {label: 'SS', color: '#000000', marker: 'circle', dash: [5, 3]},
  nnsr: {label: 'NNSR', color: '#e69f00', marker: 'rect', dash: []},
  ransac: {label: 'RANSAC', color: '#0072b2', marker: 'triangle', dash: []},
  st: {label: 'ST', color: '#cc79a7', marker: 'triangle', rotation: 180, dash: [9, 3]},
  gc: {label: 'GC', color: '#009e73', marker: 'rectRot', dash: []},
  hough: {label: '3DHV', color: '#56b4e9', marker: 'star', dash: [6, 2, 1, 2]},
  si: {label: 'SI', color: '#d55e00', marker: 'circle', open: true, dash: [3, 2]},
  oracle: {label: 'oracle', color: '#888888', marker: 'line', dash: [2, 3]},
  floor: {label: 'floor', color: '#888888', marker: 'line', dash: [7, 4]},
};
const furtherColors = ['#882255', '#999933', '#332288', '#aa4499', '#117733', '#661100', '#6699cc', '#aa4466'];
const furtherMarkers = ['crossRot', 'cross', 'rectRounded', 'star', 'triangle'];
const styles = new Map(methods.map(method => {
  const place = methods.filter(m => !(m in knownStyles)).indexOf(method);
  return [
    method, knownStyles[method] || {
      label: method,
      color: furtherColors[place % 8],
      marker: furtherMarkers[place % 5],
      dash: place < 8 ? [] : [4, 2]
    }
  ];
}));
const labelOf = method => (styles.get(method) || {label: method}).label;

/// Bytes of a base64 text.
const bytesOf = text => Uint8Array.from(atob(text), character => character.charCodeAt(0));
