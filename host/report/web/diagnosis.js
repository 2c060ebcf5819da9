// The page of a diagnosis: measured and simulated signals, each cause with its evidence, rejected causes, the residual.
'use strict';

const minus = words => words.replace(/-(?=\d|x\b)/g, '−');  // of numbers and of the direction -x

function bare(drawn) {
  drawn.className = 'bare';
  return drawn;
}

// ---- all causes in one table ----

const THUMBNAIL = { width: 132, height: 44, points: 400 };  // pixels

// The first chart of a cause as a small picture: its shape, without scales.
function thumbnail(i) {
  const chart = DATA.charts.find(each => each.place === `cause-charts-${i}`);
  if (!chart) return '–';
  const along = x => chart.logarithmic_x ? Math.log10(x) : x;
  const picked = chart.series.map(series => {
    const kept = Array.from(series.y.keys()).filter(k => Number.isFinite(series.y[k]) && Number.isFinite(along(series.x[k])));
    return kept.filter((_, k) => k % Math.ceil(kept.length / THUMBNAIL.points) === 0).map(k => [along(series.x[k]), series.y[k]]);
  });
  const range = which => extremes(picked.flat().map(point => point[which]));
  const [[left, right], [low, high]] = [range(0), range(1)];
  const place = ([x, y]) => [(x - left) / (right - left || 1) * (THUMBNAIL.width - 6) + 3, (high - y) / (high - low || 1) * (THUMBNAIL.height - 6) + 3].map(each => each.toFixed(1));
  const drawn = chart.series.map((series, k) => {
    const { colour } = seriesStyles[series.name];
    return series.points ? svg('g', { style: `fill:${colour}` }, ...picked[k].map(point => svg('circle', { cx: place(point)[0], cy: place(point)[1], r: 1.3 })))
      : svg('polyline', { points: picked[k].map(point => place(point).join(',')).join(' '), style: `fill:none;stroke:${colour};stroke-width:1.4` });
  });
  const picture = svg('svg', { class: 'thumbnail', viewBox: `0 0 ${THUMBNAIL.width} ${THUMBNAIL.height}`, role: 'img', 'aria-label': `${chart.title}: ${chart.y_label} over ${chart.x_label}` }, ...drawn);
  return element('a', { href: `#cause-charts-${i}`, title: `${chart.title}: ${chart.y_label} over ${chart.x_label}` }, picture);
}

const extremes = values => values.reduce(([low, high], value) => [Math.min(low, value), Math.max(high, value)], [Infinity, -Infinity]);

const SHOWN_VALUES = 4;
function valueLines(cause) {
  const line = row => element('div', {}, `${row.label} `, element('strong', {}, minus(row.value)), `${row.half ? ` ± ${row.half}` : ''} ${row.unit}`);
  const more = cause.parameters.length - SHOWN_VALUES;
  return [...cause.parameters.slice(0, SHOWN_VALUES).map(line), ...(more > 0 ? [element('div', { class: 'quiet' }, `${more} more below`)] : [])];
}

function explained(cause) {
  return [element('div', {}, element('strong', {}, `${cause.explains} %`), ` of the ${cause.residual}`),
          ...(cause.sure ? [element('div', {}, cause.sure)] : []),
          element('div', {}, `${minus(cause.gain)} % less on held-out data (95 %: ${minus(cause.gain_interval)} %)`),
          ...(cause.part ? [element('div', {}, `up to ${cause.part} ${DATA.residuals.position_unit} of position error` +
              (cause.small_below ? ` (small: below ${cause.small_below} ${DATA.residuals.position_unit})` : ''))] : []),
          ...(cause.withheld ? [element('div', {}, 'not in extended.toml')] : [])];
}

function drawSummary() {
  const { baseline, extended, noise, force_unit, position_unit } = DATA.residuals;
  document.getElementById('summary-what').textContent = DATA.causes.length ? DATA.causes.some((cause) => cause.part) ? 'sorted by what each does to the position' : 'sorted by explained variance' : 'none found';
  const rows = DATA.causes.map((cause, i) => classed('first', [
    { text: element('a', { href: `#cause-${i}` }, `${i + 1}  ${cause.title}`), head: true, class: 'text wrap' }, text(cause.axis, { class: 'text', label: 'Axis' }),
    text(thumbnail(i), { class: 'text', label: 'Plot' }), text(valueLines(cause), { class: 'text wrap', label: 'Value ± uncertainty (95 %)' }),
    text(explained(cause), { class: 'text wrap', label: 'Explains' }), text(cause.advice, { class: 'text wrap advice', label: 'What to do at the machine' })]));
  const head = ['Cause', 'Axis', 'Plot', 'Value ± uncertainty (95 %)', 'Explains', 'What to do at the machine'].map(each => text(each, { class: 'text' }));
  const drawn = table([head], rows);
  drawn.className = 'stacked';
  if (rows.length) show('summary', drawn);
  const figures = [`Residual force on the held-out data: ${baseline.force} ${force_unit} rms with the given machine file, ${extended.force} ${force_unit} rms with the extended one`];
  if (baseline.position) figures.push(`position error of the simulation: ${baseline.position} ${position_unit} rms with the given machine file, ${extended.position} ${position_unit} rms with the extended one`);
  if (noise) figures.push(`noise alone leaves ${noise.force} ${force_unit} and ${noise.position} ${position_unit} rms`);
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
  if (next.spectrum) show('next-spectrum', minus(next.spectrum));
  else document.getElementById('next-spectrum').remove();
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
drawSchemeSwitch();
