// SPDX-License-Identifier: MIT
// The panels of every experiment: one line per grouper over the levels.
'use strict';

const metrics = [
  ...data.measures.filter(measure => measure.panel),
  {name: 'median_ms', axis: 'median time of grouping (ms)', title: 'median time of grouping (ms)', logarithmic: true},
];

const panels = (() => {
  const charts = [];
  const hidden = new Set(bounds);
  let choosePoint = () => {};

  Chart.defaults.font.family = getComputedStyle(document.body).fontFamily;
  Chart.defaults.font.size = 11;
  Chart.defaults.color = '#5c6670';
  Chart.defaults.animation = false;

  const meanOf = (experiment, level, method) => experiment.means.find(m => m.level === level && m.method === method);

  const valueOf = (metric, value) => metric.logarithmic ? String(Number(value.toPrecision(3))) : fixed(value, 3);

  function linesOf(mean) {
    const share =
        metrics.filter(m => isNumber(mean[m.name])).map(m => `${m.title} ${valueOf(m, mean[m.name])}`);
    const counts = ['pairs', 'excluded', 'empty', 'failed', 'runs']
                       .filter(name => isNumber(mean[name]))
                       .map(name => `${name} ${mean[name]}`);
    return [...share, counts.join(', ')];
  }

  function datasetOf(experiment, metric, method) {
    const style = styles.get(method);
    return {
      label: method,
      data: experiment.levels.map(level => {
        const value = (meanOf(experiment, level, method) || {})[metric.name];
        return isNumber(value) ? value : null;
      }),
      borderColor: style.color,
      backgroundColor: style.color,
      pointBackgroundColor: style.open ? '#fff' : style.color,
      borderWidth: 1.6,
      borderDash: style.dash,
      pointStyle: style.marker,
      rotation: style.rotation,
      pointBorderColor: style.color,
      pointRadius: bounds.includes(method) ? 0 : 4,
      pointHoverRadius: 6,
      pointHitRadius: 7,
      pointBorderWidth: 1.5,
      spanGaps: false,
      clip: 7,
      hidden: hidden.has(method),
    };
  }

  // Arrows move through the points of a panel, Enter opens one, Escape resets the zoom.
  function addKeys(chart, describe) {
    let series = 0, column = -1;
    chart.canvas.addEventListener('keydown', event => {
      const shown = chart.data.datasets.map((_, i) => i).filter(i => chart.isDatasetVisible(i));
      const steps = {ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowDown: [0, 1], ArrowUp: [0, -1]}[event.key];
      if (event.key === 'Escape') return panelZoom.reset(chart);
      if (event.key === 'Enter' && column >= 0)
        return choosePoint(chart.experiment, chart.data.labels[column], chart.data.datasets[series].label);
      if (!steps || shown.length === 0) return;
      event.preventDefault();
      column = Math.max(0, Math.min(chart.data.labels.length - 1, column + steps[0]));
      series = shown[(Math.max(0, shown.indexOf(series)) + steps[1] + shown.length) % shown.length];
      const active = chart.data.datasets[series].data[column] === null ? [] : [{datasetIndex: series, index: column}];
      chart.setActiveElements(active);
      chart.tooltip.setActiveElements(active, {x: 0, y: 0});
      chart.update();
      byId('announcement').textContent = describe(series, column).join(', ');
    });
  }

  function addPanel(experiment, metric, grid) {
    const canvas = element('canvas', {
      tabindex: 0,
      role: 'img',
      'aria-label': `${capitalized(metric.axis)} of ${experiment.methods.length} groupers against ${
          experiment.axis}; the numbers are in the table below. Arrow keys walk through the points.`
    });
    grid.append(
        element('figure', {}, element('figcaption', {}, capitalized(metric.axis)), element('div', {class: 'plot'}, canvas)));
    const shown = [...experiment.methods, ...experiment.bounds];
    const describe = (series, column) => {
      const mean = meanOf(experiment, experiment.levels[column], shown[series]);
      return [`${labelOf(shown[series])} at ${experiment.levels[column]}`, ...(mean ? linesOf(mean) : ['no value'])];
    };
    const range = metric.logarithmic ? {min: undefined, max: undefined} :
                                       {min: -0.03, max: 1.03};  // room for markers at the ends
    const chart = new Chart(canvas, {
      type: 'line',
      data: {labels: experiment.levels, datasets: shown.map(method => datasetOf(experiment, metric, method))},
      options: {
        maintainAspectRatio: false,
        interaction: {mode: 'nearest', intersect: true},
        layout: {padding: {top: 6, right: 8}},
        scales: {
          x: {
            title: {display: true, text: experiment.axis},
            grid: {display: false},
            ticks: {maxRotation: 40},
            offset: true
          },
          y: {
            ...range,
            type: metric.logarithmic ? 'logarithmic' : 'linear',
            grid: {color: '#eceff1'},
            ticks: {
              maxTicksLimit: 8,
              includeBounds: false,
              callback: value => metric.logarithmic ? value : Number(value.toFixed(3))
            }
          },
        },
        plugins: {
          legend: {display: false},
          tooltip: {
            backgroundColor: 'rgba(29, 35, 41, .93)',
            usePointStyle: true,
            displayColors: false,
            callbacks: {
              // Points on top of each other share one tooltip: then a line each.
              title: items => items.length > 1 ? `${items.length} groupers at ${items[0].label}` :
                  items.length ? describe(items[0].datasetIndex, items[0].dataIndex)[0] :
                                 '',
              label: item => item.chart.tooltip.dataPoints.length > 1 ?
                  `${labelOf(item.dataset.label)} ${valueOf(metric, item.raw)}` :
                  describe(item.datasetIndex, item.dataIndex).slice(1)
            }
          },
        },
        onClick: (_, points) => {
          if (points.length && !chart.dragged)
            choosePoint(experiment, experiment.levels[points[0].index], shown[points[0].datasetIndex]);
        },
        onHover: (event, points) => {
          event.native.target.style.cursor = points.length ? 'pointer' : 'crosshair';
        },
      },
      plugins: [panelZoom.plugin],
    });
    Object.assign(chart, {range, experiment, metric: metric.name});
    addKeys(chart, describe);
    charts.push(chart);
  }

  function noteOf(experiment) {
    const perLevel = experiment.levels.map(level => experiment.means.find(m => m.level === level)).filter(Boolean);
    if (perLevel.length === 0) return 'No level of this experiment has a result.';
    const gaps = perLevel.length < experiment.levels.length ?
        ` ${counted(experiment.levels.length - perLevel.length, 'level')} without a result: gaps.` :
        '';
    if (perLevel.every(m => !isNumber(m.pairs))) return `Measured alone, on one thread.${gaps}`;
    const sum = (rows, name) => rows.reduce((total, row) => total + (row[name] || 0), 0);
    const pairs = perLevel.map(m => m.pairs), low = Math.min(...pairs), high = Math.max(...pairs);
    const own = experiment.means.filter(m => experiment.methods.includes(m.method));
    return `${low === high ? low : `${low} to ${high}`} pairs a level; a match is right within ${
               experiment.attribute === 'threshold_pr' ? 'the threshold' : `${experiment.threshold_pr} pr`}; ` +
        `${sum(perLevel, 'excluded')} excluded (fewer than ${
               counted(experiment.least_true_matches, 'correct match', 'correct matches')}); ` +
        `${counted(sum(own, 'empty'), 'empty selection')}; ${counted(experiment.failed, 'failure')}.` + gaps;
  }

  /// Filled when it is opened: a study has thousands of numbers.
  function tableOf(experiment) {
    if (experiment.means.length === 0) return '';
    const names = unique(experiment.means.flatMap(Object.keys));
    const textual = ['level', 'method'];
    const cellOf = (mean, name) => name === 'method' ? labelOf(mean.method) :
        name === 'level' || Number.isInteger(mean[name]) ? String(mean[name]) :
                                                           fixed(mean[name], 4);
    const rowOf = mean => element(
        'tr', {},
        ...names.map(name => element('td', {class: textual.includes(name) && 'text'}, cellOf(mean, name))));
    const head = names.map(name => element('th', {scope: 'col', class: textual.includes(name) && 'text'}, name));
    const place = element('div', {class: 'wide'}), details = element('details', {}, element('summary', {}, 'Numbers'), place);
    details.addEventListener('toggle', () => {
      place.append(element(
          'table', {}, element('thead', {}, element('tr', {}, ...head)),
          element('tbody', {}, ...experiment.means.map(rowOf))));
    }, {once: true});
    return details;
  }

  function swatch(style) {
    const canvas = element('canvas', {width: 60, height: 32, 'aria-hidden': 'true'}), pen = canvas.getContext('2d');
    pen.scale(2, 2);
    Object.assign(pen, {strokeStyle: style.color, fillStyle: style.color, lineWidth: 1.6});
    pen.setLineDash(style.dash);
    pen.stroke(new Path2D('M1 8H29'));
    pen.setLineDash([]);
    if (style.open) pen.fillStyle = '#fff';
    if (style.marker !== 'line')
      Chart.helpers.drawPoint(
          pen, {pointStyle: style.marker, rotation: style.rotation, radius: 4.5, borderWidth: 1.5}, 15, 8);
    return canvas;
  }

  function toggle(method, button) {
    if (!hidden.delete(method)) hidden.add(method);
    button.setAttribute('aria-pressed', String(!hidden.has(method)));
    for (const chart of charts) {
      chart.data.datasets.forEach((dataset, i) => chart.setDatasetVisibility(i, !hidden.has(dataset.label)));
      chart.update();
    }
  }

  function start(onPoint) {
    choosePoint = onPoint;
    for (const method of methods) {
      const button = element(
          'button', {type: 'button', 'aria-pressed': String(!hidden.has(method)), click: () => toggle(method, button)},
          swatch(styles.get(method)), labelOf(method));
      byId('legend').append(button);
    }
    for (const experiment of data.experiments) {
      const grid = element('div', {class: 'panels'});
      const run = data.runs.length > 1 ? `, run ${data.runs[experiment.run].folder}` : '';
      byId('panels').append(
          element(
              'h3', {}, experimentTitle(experiment), ' ',
              element('span', {class: 'quiet'}, `${experiment.dataset}${run}`)),
          element('p', {class: 'note'}, noteOf(experiment)), grid);
      for (const metric of metrics)
        if (experiment.means.some(mean => isNumber(mean[metric.name]))) addPanel(experiment, metric, grid);
      byId('panels').append(tableOf(experiment));
    }
  }

  return {start, charts};
})();
