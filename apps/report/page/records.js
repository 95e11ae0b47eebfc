// SPDX-License-Identifier: MIT
// The table of all pairs: sorted by any column, filtered, a page at a time.
'use strict';

const recordTable = (() => {
  const onPage = 25;
  let choose = () => {}, shown = [], page = 0, chosen = null;
  const order = {column: null, descending: false};

  const columns = [
    {title: 'Experiment', text: true, value: r => r.place ? experimentTitle(r.place) : r.experiment},
    {title: 'Level', text: true, value: r => r.level, key: r => r.place ? r.place.levels.indexOf(r.level) : -1},
    {title: 'Pair', text: true, value: r => r.pair},
    {title: 'Grouper', text: true, value: r => labelOf(r.method), key: r => methods.indexOf(r.method)},
    ...data.measures.filter(measure => measure.record).map(({name, title, unit, decimals}) => ({
      title: capitalized(title) + (unit ? ` (${unit})` : ''), decimals, value: r => r[name]
    })),
    {title: 'Status', text: true, value: r => r.excluded ? `excluded; ${r.status}` : r.status},
  ].filter(column => column.text || records.some(record => isNumber(column.value(record))));

  const outcomes = {
    'success (mean error up to 5 pr)': r => isNumber(r.refined_mean_error_pr) && r.refined_mean_error_pr <= 5,
    'no success': r => !r.excluded && !(isNumber(r.refined_mean_error_pr) && r.refined_mean_error_pr <= 5),
    'empty selection': r => r.selected === 0,
    'excluded pair': r => r.excluded,
    'failed': r => r.state === 'failed',
  };

  const fill = (id, options) =>
      byId(id).replaceChildren(...options.map(([value, text]) => element('option', {value}, text)));
  const fillLevels = () => {
    const experiment = data.experiments[Number(byId('filter-experiment').value)];
    fill('filter-level', [['', 'all'], ...(experiment ? experiment.levels.map(level => [level, level]) : [])]);
  };

  function compare(a, b) {
    const column = order.column, key = column.key || column.value;
    const [x, y] = [key(a), key(b)];
    const absent = value => value === null || value === undefined;
    if (absent(x) || absent(y)) return absent(x) - absent(y) || a.row - b.row;  // what is absent comes last, either way
    const sign = x < y ? -1 : x > y ? 1 : 0;
    return (order.descending ? -sign : sign) || a.row - b.row;
  }

  function refresh() {
    const experiment = data.experiments[Number(byId('filter-experiment').value)], level = byId('filter-level').value;
    const method = byId('filter-method').value, outcome = outcomes[byId('filter-outcome').value],
          part = byId('filter-pair').value.toLowerCase();
    shown = records.filter(
        r => (byId('filter-experiment').value === '' || r.place === experiment) &&
            (level === '' || r.level === level) && (method === '' || r.method === method) && (!outcome || outcome(r)) &&
            r.pair.toLowerCase().includes(part));
    if (order.column) shown.sort(compare);
    page = 0;
    draw();
  }

  function rowOf(record) {
    const row = element('tr', {class: record === chosen && 'chosen', click: () => choose(record)});
    for (const column of columns) {
      const value = column.value(record);
      const text = column.text ? value : fixed(value, column.decimals);
      if (column.title === 'Pair')
        row.append(element(
            'td', {class: 'text'},
            element(
                'button', {type: 'button', title: pairView.has(record) ? 'in 3D' : 'not in 3D on this page'}, text)));
      else
        row.append(element(
            'td', {
              class:
                  (column.text ? 'text' : '') + (column.title === 'Status' && !/^(refined)$/.test(text) ? ' bad' : '')
            },
            text));
    }
    return row;
  }

  function draw() {
    const pages = Math.max(1, Math.ceil(shown.length / onPage));
    page = Math.max(0, Math.min(pages - 1, page));
    byId('records-table').tBodies[0].replaceChildren(...shown.slice(page * onPage, (page + 1) * onPage).map(rowOf));
    byId('records-count').textContent =
        `${counted(shown.length, 'row')} of ${records.length.toLocaleString('en')}: a pair, a level and a grouper each${
            isSampled ? ` (a sample of ${data.totals.records.toLocaleString('en')})` : ''}`;
    byId('page-number').textContent = `page ${page + 1} of ${pages}`;
    byId('earlier').disabled = page === 0;
    byId('later').disabled = page === pages - 1;
    byId('records-table')
        .tHead.querySelectorAll('th')
        .forEach(
            (cell, i) => cell.setAttribute(
                'aria-sort',
                columns[i] !== order.column ? 'none' :
                    order.descending        ? 'descending' :
                                              'ascending'));
  }

  function sortBy(column) {
    if (order.column === column)
      order.descending = !order.descending;
    else
      Object.assign(order, {column, descending: false});
    refresh();
  }

  function filter(experiment, level, method) {
    byId('filter-experiment').value = String(data.experiments.indexOf(experiment));
    fillLevels();
    byId('filter-level').value = level;
    byId('filter-method').value = method;
    byId('filter-outcome').value = byId('filter-pair').value = '';
    refresh();
  }

  function mark(record) {
    chosen = record;
    draw();
  }

  function start(onRow) {
    choose = onRow;
    byId('records-table')
        .tHead.append(element(
            'tr', {},
            ...columns.map(
                column => element(
                    'th', {scope: 'col', class: column.text && 'text'},
                    element('button', {type: 'button', click: () => sortBy(column)}, column.title)))));
    fill('filter-experiment', [
      ['', 'all'],
      ...data.experiments.map(
          (e, i) => [i, experimentTitle(e) + (data.runs.length > 1 ? `, ${data.runs[e.run].folder}` : '')])
    ]);
    fill('filter-method', [['', 'all'], ...methods.map(method => [method, labelOf(method)])]);
    fill('filter-outcome', [['', 'all'], ...Object.keys(outcomes).map(name => [name, name])]);
    fillLevels();
    byId('filter-experiment').addEventListener('change', () => {
      fillLevels();
      refresh();
    });
    for (const id of ['filter-level', 'filter-method', 'filter-outcome']) byId(id).addEventListener('change', refresh);
    byId('filter-pair').addEventListener('input', refresh);
    byId('reset-filters').addEventListener('click', () => {
      for (const id of ['filter-experiment', 'filter-method', 'filter-outcome', 'filter-pair']) byId(id).value = '';
      fillLevels();
      refresh();
    });
    byId('earlier').addEventListener('click', () => {
      --page;
      draw();
    });
    byId('later').addEventListener('click', () => {
      ++page;
      draw();
    });
    refresh();
  }

  return {start, filter, mark};
})();
