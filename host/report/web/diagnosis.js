// The page of a diagnosis: measured and simulated signals, each cause with its evidence, rejected causes, the residual.
'use strict';

const minus = words => words.replace(/-(?=\d|x\b)/g, '−');  // of numbers and of the direction -x

function bare(drawn) {
  drawn.className = 'bare';
  return drawn;
}

// ---- all causes in one table ----

function drawSummary() {
  const { baseline, extended } = DATA.residuals;
  document.getElementById('summary-what').textContent = DATA.causes.length ? 'sorted by explained variance' : 'none found';
  const rows = DATA.causes.map((cause, i) => classed('first', [
    { text: element('a', { href: `#cause-${i}` }, `${i + 1}  ${cause.title}`), head: true, class: 'figure' }, text(cause.axis, { class: 'text' }),
    text(cause.explains, { class: 'value' }), text(minus(cause.gain)), text(minus(cause.gain_interval), { class: 'text unit' }),
    text(cause.part || '–')]));
  const head = [text('Cause', { class: 'text' }), text('Axis', { class: 'text' }), text('Explains, %'), text('Residual force reduced by, %'),
                text('95 % interval', { class: 'text unit' }), text('Position error, µm')];
  if (rows.length) show('summary', bare(table([head], rows)));
  const figures = [`Residual force on the held-out data: ${baseline.force} N rms with the given machine file, ${extended.force} N rms with the extended one`];
  if (baseline.position) figures.push(`position error of the simulation: ${baseline.position} µm rms with the given machine file, ${extended.position} µm rms with the extended one`);
  show('summary-caption', `${figures.join('; ')}. ${DATA.holdout}`);
}

// ---- measured rows of the machine file ----

function drawRows() {
  if (!DATA.rows.length) return document.getElementById('rows-section').remove();
  const pair = (value, off) => value === null ? [text('–', { class: 'gap none' }), text('')] :
    [text(value, { class: 'gap' }), text(minus(off), { class: Math.abs(Number(off)) > 10 ? 'differs' : 'unit' })];
  const half = cells => [text(cells.measured, { class: 'gap value' }), ...pair(cells.published, cells.published_off),
                         ...pair(cells.machine_file, cells.machine_file_off), ...pair(cells.extended, cells.extended_off)];
  const heads = () => [text('measured', { class: 'gap' }), ...['published', 'file', 'extended'].flatMap(name => [text(name, { class: 'gap' }), text('%')])];
  let axis = '';
  show('rows', table(
    [[text('', { span: 2 }), text('Error at reversals, µm', { class: 'group', span: 7 }), text('Largest current, A', { class: 'group', span: 7 }), text('')],
     [text('Axis', { class: 'text' }), text('m/min'), ...heads(), ...heads(), text('Changed most by', { class: 'text gap' })]],
    DATA.rows.map(row => {
      const cells = [{ text: row.axis === axis ? '' : row.axis, head: true }, text(row.feed), ...half(row.error), ...half(row.current),
                     text(minus(row.causes) + (row.training ? ' (training)' : ''), { class: 'text gap wrap' })];
      const first = row.axis !== axis;
      axis = row.axis;
      return first ? classed('first', cells) : cells;
    })));
}

// ---- one section a cause ----

function parameters(cause) {
  const head = [text('Parameter', { class: 'text' }), text('Value'), text('95 % from'), text('to'), text('Unit', { class: 'text unit' })];
  return bare(table([head], cause.parameters.map(row => classed('first', [
    { text: row.label, head: true, class: 'figure' }, text(minus(row.value), { class: 'value' }),
    text(row.low === null ? '–' : minus(row.low)), text(row.high === null ? '–' : minus(row.high)), text(row.unit, { class: 'text unit' })]))));
}

function confusions(cause) {
  if (!cause.confused_with.length) return element('p', {}, 'These data separate it from all other known causes.');
  return bare(table([[text('Similar cause', { class: 'text' }), text('Separated by', { class: 'text' })]],
    cause.confused_with.map(row => classed('first', [{ text: row.title, head: true, class: 'figure' }, text(row.separate_by, { class: 'text wrap' })]))));
}

function causeSection(cause, i) {
  const minor = words => element('h3', { class: 'minor' }, words);
  return element('section', { id: `cause-${i}`, class: 'cause' },
    element('div', { class: 'heading' }, element('h2', {}, `${i + 1}  ${cause.title}`), element('span', { class: 'quiet' }, `axis ${cause.axis}, ${cause.name}`)),
    element('p', { class: 'detail' }, minus(cause.meaning)),
    element('div', { class: 'pair facts' },
      element('div', {}, minor('Value'), element('div', { class: 'scroll' }, parameters(cause)), minor('Evidence'),
              element('p', {}, minus(cause.evidence)), element('p', {}, minus(cause.figures))),
      element('div', {}, minor('Effect on the part'), element('p', {}, cause.on_part), minor('May be confused with'), confusions(cause),
              minor('What to do'), element('p', {}, cause.advice), element('p', { class: 'caption' }, `More: ${cause.page}`))),
    element('div', { id: `cause-charts-${i}`, class: 'pair charts' }));
}

function drawRejected() {
  if (!DATA.rejected.length) return document.getElementById('rejected-section').remove();
  show('rejected', bare(table([[text('Cause', { class: 'text' }), text('Why it is not named', { class: 'text' })]],
    DATA.rejected.map(row => classed('first', [{ text: row.title, head: true, class: 'figure' }, text(minus(row.why), { class: 'text wrap' })])))));
}

// ---- what to record next ----

function drawNext() {
  const next = DATA.next;
  if (!next) return document.getElementById('next-section').remove();
  show('next-axis', `axis ${next.axis}`);
  for (const id of ['next-what', 'next-table', 'next-caption', 'next-charts']) if (!next.what) document.getElementById(id).remove();
  if (next.what) {
    show('next-what', minus(next.what));
    const proposed = i => next.proposed && i === 1;
    show('next-table', bare(table(
      [[text('Trajectory', { class: 'text' }), text('s'), ...next.questions.map(question => text(question, { class: 'wrap question' }))]],
      next.rows.map((row, i) => classed('first', [
        { text: row.name + (proposed(i) ? ' (proposed)' : ''), head: true, class: 'figure' }, text(row.duration || ''),
        ...row.standard_errors.map(value => text(value, { class: proposed(i) ? 'value' : null }))])))));
  }
  if (next.elsewhere.length) show('next-elsewhere', bare(table(
    [[text('Not separable by any motion of this axis', { class: 'text' }), text('Separating experiment', { class: 'text' })]],
    next.elsewhere.map(row => classed('first', [{ text: row.title, head: true, class: 'figure' }, text(row.separate_by, { class: 'text wrap' })])))));
}

document.getElementById('causes').replaceChildren(...DATA.causes.map(causeSection));
document.getElementById('picture-what').textContent = DATA.picture;
if (!DATA.charts.some(chart => chart.place === 'before-after')) document.getElementById('picture-section').remove();
show('unexplained', DATA.unexplained);
show('notes', ...DATA.notes.map(note => element('li', {}, minus(note))));
drawConditions();
drawRows();
drawSummary();
drawNext();
drawRejected();
drawSeriesChoice();
placeCharts();
drawCharts();
linkAbscissae();
drawMachine();
drawForPaper();
