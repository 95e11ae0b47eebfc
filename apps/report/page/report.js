// SPDX-License-Identifier: MIT
// Puts the parts together: a point or a row leads to its pair.
'use strict';

(() => {
  function showRecord(record, scroll = true) {
    if (!record) return;
    pairView.show(record);
    recordTable.mark(record);
    if (scroll) {
      byId('pair').scrollIntoView({block: 'start'});
      byId('pair-title').focus({preventScroll: true});
    }
  }

  /// Of the pairs behind a point the one of median F1, among those in 3D if there are any.
  function showPoint(experiment, level, method) {
    recordTable.filter(experiment, level, method);
    const behind = records.filter(r => r.place === experiment && r.level === level && r.method === method);
    const drawn = behind.filter(pairView.has),
          from = (drawn.length ? drawn : behind).sort((a, b) => (a.f1 || 0) - (b.f1 || 0) || a.row - b.row);
    showRecord(from[(from.length - 1) >> 1]);
  }

  function summarize() {
    const {pairs, exclusions, failed} = data.totals;
    byId('summary').textContent = [
      counted(data.runs.length, 'run'), counted(data.experiments.length, 'experiment'), counted(pairs, 'pair'),
      counted(methods.length - bounds.length, 'grouper'), counted(data.totals.records, 'record'),
      counted(exclusions, 'exclusion of a pair at a level', 'exclusions of a pair at a level'),
      counted(failed, 'failed record'), `${counted(data.scenes.length, 'pair')} in 3D`
    ].join(' · ');
    byId('sample-note').hidden = !isSampled;
    const carried = unique(records.map(r => `${r.run}/${r.dataset}/${r.pair}`)).length;
    byId('sample-note').textContent = `This page carries ${records.length.toLocaleString('en')} of ${
        counted(data.totals.records, 'record')}, those of ${carried.toLocaleString('en')} of ${
        counted(pairs, 'pair')}: the pairs in 3D; then, of every level in turn, a pair that failed or whose truth does ` +
        'not fit, and one of the others, drawn at random. Panels, numbers, findings and the counts above are those of ' +
        'all records, which are in records.csv of each study.';
  }

  function showFindings() {
    const verdicts = data.verdicts;
    if (verdicts === null) {
      byId('findings-note').textContent = 'No findings were evaluated for this page.';
      return;
    }
    const names = unique(verdicts.flatMap(Object.keys)),
          text = value => value === null || value === undefined ? '–' :
        typeof value === 'object'                               ? JSON.stringify(value) :
        isNumber(value) && !Number.isInteger(value)             ? value.toFixed(3) :
                                                                  String(value);
    const tally = {};
    for (const {verdict} of verdicts) tally[verdict] = (tally[verdict] || 0) + 1;
    byId('findings-note').textContent =
        Object.entries(tally).map(([verdict, count]) => `${count} ${verdict}`).join(' · ');
    byId('findings-table')
        .tHead.append(element('tr', {}, ...names.map(name => element('th', {scope: 'col', class: 'text'}, name))));
    byId('findings-table')
        .tBodies[0]
        .append(...verdicts.map(
            verdict => element('tr', {}, ...names.map(name => {
              const shown = text(verdict[name]);
              return name === 'verdict' ?
                  element('td', {class: 'text'}, element('span', {class: `verdict ${shown.split(' ')[0]}`}, shown)) :
                  element('td', {class: shown.length > 40 ? 'long' : 'text'}, shown);
            }))));
  }

  function factList(facts) {
    const shown = value => Array.isArray(value) && value.every(item => typeof item !== 'object') ? value.join(' ') :
        value !== null && typeof value === 'object'                                              ? factList(value) :
        value === null                                                                           ? '–' :
                                                                                                   String(value);
    return element(
        'dl', {class: 'facts'},
        ...Object.entries(facts).flatMap(
            ([name, value]) => [element('dt', {}, name.replaceAll('_', ' ')), element('dd', {}, shown(value))]));
  }

  summarize();
  panels.start(showPoint);
  pairView.start(showRecord);
  recordTable.start(showRecord);
  choices.start();
  showFindings();
  byId('run-facts').append(...data.runs.flatMap(run => [element('h3', {}, run.folder), factList(run.facts)]));
  const first = data.scenes.find(scene => !scene.problem) || data.scenes[0];
  if (first)
    showRecord(
        records.find(r => r.run === first.run && r.selection === first.selection && !bounds.includes(r.method)), false);
  else {
    byId('pair-view').hidden = true;
    byId('pair-note').textContent = 'This page has no pair in 3D.';
  }
})();
