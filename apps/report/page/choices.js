// SPDX-License-Identifier: MIT
// Which grouper to use, by data set, and what was found beside the paper's findings.
'use strict';

const choices = (() => {
  const charts = [];
  const interval = ({low, high}) => `${fixed(low, 2)} to ${fixed(high, 2)}`;

  /// Success against time; the groupers that no other beats in both are joined.
  function drawFront(choice, place) {
    const timed = choice.methods.filter(m => isNumber(m.median_ms) && m.median_ms > 0);
    if (timed.length === 0) return;
    const canvas = element('canvas', {
      role: 'img',
      'aria-label': `Success against median time of ${timed.length} groupers on ${choice.dataset}; the numbers are in the table beside it.`
    });
    place.append(element(
        'figure', {}, element('figcaption', {}, 'Success against median time'), element('div', {class: 'plot'}, canvas)));
    const front = timed.filter(m => m.front).sort((a, b) => a.median_ms - b.median_ms);
    const pointOf = m => ({x: m.median_ms, y: m.success});
    const chart = new Chart(canvas, {
      type: 'scatter',
      data: {
        datasets: [
          ...timed.map(m => {
            const style = styles.get(m.method);
            return {
              label: labelOf(m.method),
              data: [pointOf(m)],
              pointStyle: style.marker,
              rotation: style.rotation,
              pointRadius: 5,
              pointBorderWidth: 1.5,
              pointBorderColor: style.color,
              pointBackgroundColor: style.open ? '#fff' : style.color
            };
          }),
          {label: '', data: front.map(pointOf), showLine: true, pointRadius: 0, pointHitRadius: 0, borderColor: '#9aa5ae', borderWidth: 1.2}
        ]
      },
      options: {
        maintainAspectRatio: false,
        layout: {padding: {top: 6, right: 8}},
        scales: {
          x: {type: 'logarithmic', title: {display: true, text: 'median time of grouping (ms)'}, grid: {display: false},
              ticks: {callback: value => [1, 10].some(d => Number.isInteger(Math.log10(value / d))) ? String(Number(value.toPrecision(1))) : ''}},
          y: {min: -0.03, max: 1.03, title: {display: true, text: 'success'}, grid: {color: '#eceff1'},
              ticks: {includeBounds: false, callback: value => Number(value.toFixed(3))}}
        },
        plugins: {
          legend: {display: false},
          tooltip: {displayColors: false, callbacks: {label: item => `${item.dataset.label} ${fixed(item.raw.y, 3)}, ${Number(item.raw.x.toPrecision(3))} ms`}}
        }
      }
    });
    charts.push(chart);
  }

  function methodTable(choice) {
    const head = ['grouper', 'success', '95 %', 'median ms'];
    const rows = [...choice.methods, ...(choice.perfect ? [choice.perfect] : [])];
    const rowOf = m => element(
        'tr', {class: m.front && 'front'},
        element('td', {class: 'text'}, m === choice.perfect ? 'all correct matches' : labelOf(m.method)), element('td', {}, fixed(m.success, 3)),
        element('td', {}, interval(m)), element('td', {}, isNumber(m.median_ms) && m !== choice.perfect ? String(Number(m.median_ms.toPrecision(3))) : '–'));
    return element(
        'div', {class: 'wide'},
        element('table', {}, element('thead', {}, element('tr', {}, ...head.map((h, i) => element('th', {scope: 'col', class: i === 0 && 'text'}, h)))),
                element('tbody', {}, ...rows.map(rowOf))));
  }

  /// The best grouper of each cell, and its ties in small letters.
  function cellTable(choice) {
    const columns = unique(choice.cells.map(c => c.matches)), rows = unique(choice.cells.map(c => c.correct));
    columns.sort((a, b) => parseFloat(a) - parseFloat(b));
    const cellOf = (correct, matches) => {
      const cell = choice.cells.find(c => c.correct === correct && c.matches === matches);
      if (!cell) return element('td', {class: 'quiet'}, '–');
      const [best, ...ties] = cell.best;
      if (!best || best.success === 0)
        return element('td', {class: 'text'}, 'none registers any', element('br'), element('span', {class: 'quiet'}, counted(cell.pairs, 'pair')));
      return element(
          'td', {class: 'text choice'}, element('strong', {}, labelOf(best.method)), ` ${fixed(best.success, 2)} (${interval(best)})`, element('br'),
          element('span', {class: 'quiet'}, `${counted(cell.pairs, 'pair')}${
              ties.length ? `; not distinguishable: ${ties.map(t => labelOf(t.method)).join(', ')}` : ''}`));
    };
    return element(
        'div', {class: 'wide'},
        element('table', {class: 'cells'}, element('thead', {}, element('tr', {}, element('th', {scope: 'col', class: 'text'}, 'correct matches'),
                ...columns.map(c => element('th', {scope: 'col', class: 'text'}, `${c} matches`)))),
            element('tbody', {}, ...rows.map(r => element('tr', {}, element('th', {scope: 'row', class: 'text'}, r), ...columns.map(c => cellOf(r, c)))))));
  }

  function showFound() {
    const head = ['statement', 'data', 'pairs', 'margin', '95 %', ''];
    byId('found-table').tHead.append(element('tr', {}, ...head.map((h, i) => element('th', {scope: 'col', class: i < 2 && 'text'}, h))));
    byId('found-table').tBodies[0].append(...data.found.map(f => element(
        'tr', {}, element('td', {class: 'long'}, f.text), element('td', {class: 'text'}, f.dataset), element('td', {}, String(f.pairs)),
        element('td', {}, fixed(f.margin, 3)), element('td', {}, `${fixed(f.low, 3)} to ${fixed(f.high, 3)}`),
        element('td', {class: 'text'}, f.low > 0 ? 'clear' : f.high < 0 ? 'the opposite' : 'open'))));
    if (data.found.length === 0) byId('found').hidden = true;
  }

  function start() {
    for (const choice of data.choices) {
      const beside = element('div', {class: 'panels'});
      byId('choice-sets').append(
          element('h3', {}, choice.dataset, ' ', element('span', {class: 'quiet'}, counted(choice.pairs, 'pair'))), beside, cellTable(choice));
      drawFront(choice, beside);
      beside.append(methodTable(choice));
    }
    if (data.choices.length === 0) byId('choices').hidden = true;
    showFound();
  }

  return {start, charts};
})();
