// SPDX-License-Identifier: MIT
// What the page was written with, and the few words that all its parts share.
'use strict';

const data = JSON.parse(document.getElementById('data').textContent);

/// An element with attributes and children; texts become text, never markup. An attribute that is false or null is left out.
function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === 'function') made.addEventListener(name, value);
    else if (value !== false && value !== null) made.setAttribute(name, value === true ? '' : value);
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
    for (const name in columns) record[name] = worded.includes(name) ? data.words[columns[name][row]] : columns[name][row];
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
const styles = new Map(methods.map((method, place) => {
  if (bounds.includes(method)) return [method, {color: '#8b949d', marker: 'line', dash: method === 'oracle' ? [2, 3] : [7, 3]}];
  const colors = ['#E69F00', '#56B4E9', '#009E73', '#0072B2', '#D55E00', '#CC79A7', '#000000', '#8C6D1F'];
  const markers = [['circle', 0], ['rect', 0], ['triangle', 0], ['rectRot', 0], ['triangle', 180], ['crossRot', 0], ['star', 0], ['cross', 0]];
  const known = ['ss', 'nnsr', 'ransac', 'st', 'gc', 'hough', 'si'].indexOf(method);
  const others = methods.filter(m => !bounds.includes(m) && !['ss', 'nnsr', 'ransac', 'st', 'gc', 'hough', 'si'].includes(m));
  const number = known >= 0 ? known : 7 + others.indexOf(method);
  const [marker, rotation] = markers[number % 8];
  return [method, {color: colors[number % 8], marker, rotation, dash: number < 8 ? [] : [5, 2]}];
}));

/// Bytes of a base64 text.
const bytesOf = text => Uint8Array.from(atob(text), character => character.charCodeAt(0));
