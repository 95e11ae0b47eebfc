// SPDX-License-Identifier: MIT
// Zooms a panel to what is drawn around.
'use strict';

const panelZoom = (() => {
  // A rectangle drawn with the mouse becomes the range of both axes.
  const plugin = {
    id: 'zoom',
    afterInit(chart) {
      const canvas = chart.canvas;
      canvas.addEventListener('mousedown', event => {
        if (event.button === 0)
          chart.box = {x0: event.offsetX, y0: event.offsetY, x1: event.offsetX, y1: event.offsetY};
      });
      canvas.addEventListener('mousemove', event => {
        if (!chart.box) return;
        Object.assign(chart.box, {x1: event.offsetX, y1: event.offsetY});
        chart.draw();
      });
      canvas.addEventListener('mouseleave', () => {
        chart.box = null;
        chart.draw();
      });
      canvas.addEventListener('mouseup', () => {
        const box = chart.box;
        chart.box = null;
        chart.dragged = Boolean(box) && Math.abs(box.x1 - box.x0) > 6 && Math.abs(box.y1 - box.y0) > 6;
        if (chart.dragged) zoomTo(chart, box);
      });
      canvas.addEventListener('dblclick', () => reset(chart));
    },
    afterDraw(chart) {
      if (!chart.box) return;
      const {x0, y0, x1, y1} = chart.box;
      chart.ctx.save();
      chart.ctx.fillStyle = 'rgba(11, 92, 173, .12)';
      chart.ctx.fillRect(x0, y0, x1 - x0, y1 - y0);
      chart.ctx.restore();
    },
  };

  function zoomTo(chart, {x0, y0, x1, y1}) {
    const {x, y} = chart.scales, last = chart.data.labels.length - 1;
    const columns = [x.getValueForPixel(Math.min(x0, x1)), x.getValueForPixel(Math.max(x0, x1))];
    let [first, end] = columns.map(column => Math.max(0, Math.min(last, column)));
    if (first === end) [first, end] = [Math.max(0, first - 1), Math.min(last, end + 1)];
    Object.assign(chart.options.scales.x, {min: first, max: end});
    Object.assign(
        chart.options.scales.y, {min: y.getValueForPixel(Math.max(y0, y1)), max: y.getValueForPixel(Math.min(y0, y1))});
    chart.update();
  }

  function reset(chart) {
    Object.assign(chart.options.scales.x, {min: undefined, max: undefined});
    Object.assign(chart.options.scales.y, chart.range);
    chart.update();
  }

  return {plugin, reset};
})();
