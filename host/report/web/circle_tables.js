// The tables of the circle: peaks at the chosen feed, simulation beside publication and measurement, terms of ISO
// 230-4.
'use strict';

function modelCell(friction, direction, more = {}) {
  const clockwise = direction === 'cw' && DATA.directions.length > 1;
  return { text: [swatch(modelStyles[friction]), modelLabels[friction] + (clockwise ? '\u00a0↻' : '')], title: clockwise ? 'clockwise' : null, head: true, class: 'text', ...more };
}

function figure(value, digits, more = '') {
  const none = value === null || value === undefined;
  return { text: formatNumber(value, digits), class: [more, none ? 'none' : ''].join(' ').trim() || null };
}

// ---- peaks at the chosen feed ----

function drawFigures(state) {
  document.getElementById('figures-what').textContent = chosenText(state);
  const gap = i => i ? '' : 'gap';
  const head = [[text('', { class: 'text' }), ...DATA.axes.map(axis => text(`${axis} error, µm`)),
                 ...DATA.axes.map((axis, i) => text(`${axis} ${DATA.efforts[i].name}, ${DATA.efforts[i].unit}`, { class: gap(i) || null })),
                 ...(IS_CIRCLE ? [text('G, µm', { class: 'gap', title: 'circular error' })] : [])]];
  const body = chosenRuns(state).map(run => [
    modelCell(run.friction, run.direction), ...run.axes.map(axis => figure(axis.peak_error, 2)),
    ...run.axes.map((axis, i) => figure(axis.peak_current, 2, gap(i))), ...(IS_CIRCLE ? [figure(run.G, 2, 'gap')] : [])]);
  const measured = DATA.axes.map(axis => reference(axis, state.feed));
  if (measured.some(Boolean))
    body.push(classed('measured', [text('◆ measured', { head: true, class: 'text' }), ...measured.map(row => figure(row?.error, 1)),
                                   ...measured.map((row, i) => figure(row?.current, 1, i ? '' : 'gap')), ...(IS_CIRCLE ? [text('')] : [])]));
  show('figures', table(head, body));
}

// ---- simulation, publication, measurement ----

// Columns for references that the machine file does not have are left out.
const HAS = { published: DATA.references.some(row => !row.measured), measured: DATA.references.some(row => row.measured) };

const COMPARED = [
  { of: 'error', title: 'simul.', cell: (row, gap) => figure(row.error.simulated, 2, gap) },
  { of: 'error', title: 'quant.', cell: row => figure(row.quantised.simulated, 0, row.quantised.differs ? 'differs' : '') },
  { of: 'error', title: 'publ.', needs: 'published', cell: row => figure(row.error.published, 0) },
  { of: 'error', title: 'meas.', needs: 'measured', cell: row => figure(row.error.measured, 1) },
  { of: 'error', title: 'dev. %', needs: 'measured', cell: row => figure(row.error.deviation, 0) },
  { of: 'current', title: 'simul.', cell: (row, gap) => figure(row.current.simulated, 2, row.current.differs ? `${gap} differs` : gap) },
  { of: 'current', title: 'publ.', needs: 'published', cell: row => figure(row.current.published, 1) },
  { of: 'current', title: 'meas.', needs: 'measured', cell: row => figure(row.current.measured, 1) },
  { of: 'current', title: 'dev. %', needs: 'measured', cell: row => figure(row.current.deviation, 0) },
].filter(column => !column.needs || HAS[column.needs]);

function comparisonTable(axis) {
  const effort = DATA.efforts[DATA.axes.indexOf(axis)];
  const rows = DATA.table.filter(row => row.axis === axis)
    .sort((a, b) => DATA.models.findIndex(m => m.name === a.friction) - DATA.models.findIndex(m => m.name === b.friction) ||
                    b.direction.localeCompare(a.direction) * -1 || a.feed - b.feed);
  const count = of => COMPARED.filter(column => column.of === of).length;
  const gap = i => !i || COMPARED[i - 1].of !== COMPARED[i].of ? 'gap' : '';
  const head = [[text('', { span: 2 }), text('Peak error, µm', { span: count('error'), class: 'group gap' }),
                 text(`Peak ${effort.name}, ${effort.unit}`, { span: count('current'), class: 'group gap' })],
                [text('Friction', { class: 'text' }), text('m/min'), ...COMPARED.map((column, i) => text(column.title, { class: gap(i) || null }))]];
  const key = row => row.friction + row.direction;
  const body = rows.map((row, i) => {
    const first = !i || key(rows[i - 1]) !== key(row);
    const cells = first ? [modelCell(row.friction, row.direction, { rows: rows.filter(each => key(each) === key(row)).length, class: 'text wrap' })] : [];
    cells.push(text(String(row.feed)), ...COMPARED.map((column, k) => column.cell(row, gap(k))));
    return first ? classed('first', cells) : cells;
  });
  return element('div', { class: 'scroll' }, element('h3', {}, `${axis} axis`), table(head, body));
}

function drawComparison() {
  const parts = ['simulation', ...(HAS.published ? ['publication'] : []), ...(HAS.measured ? ['measurement'] : [])].join(', ');
  document.getElementById('table-title').textContent = parts[0].toUpperCase() + parts.slice(1);
  show('table', ...DATA.axes.map(comparisonTable));
  const words = { 'simul.': 'unquantised', 'quant.': 'rounded to increments of the position controller', 'publ.': 'published simulation',
                  'dev. %': '(measured − simulated) / measured for the unquantised peak' };
  const shown = Object.keys(words).filter(title => COMPARED.some(column => column.title === title));
  show('table-caption', shown.map(title => `${title}: ${words[title]}`).join('; ') + '. ',
       ...(HAS.published ? [element('mark', {}, 'Marked'), ': differs from the published simulation (quantised error by more than half an increment, current by more than 5 %).'] : []));
  if (HAS.measured) drawMeans();
}

function drawMeans() {
  const kinds = { error: [['error', 'simul.'], ['quantised', 'quant.'], ['error_published', 'publ.']], current: [['current', 'simul.'], ['current_published', 'publ.']] };
  const columns = Object.entries(kinds).flatMap(([group, list]) => DATA.axes.flatMap(axis =>
    list.filter(([, name]) => name !== 'publ.' || HAS.published).map(([key, name]) => ({ axis, key, name, group }))));
  const first = i => !i || columns[i - 1].axis !== columns[i].axis || columns[i - 1].group !== columns[i].group;
  const count = c => columns.filter(each => each.axis === c.axis && each.group === c.group).length;
  const head = [[text(''), ...columns.filter((_, i) => first(i)).map(c => text(`${c.axis} ${c.group === 'error' ? c.group : DATA.efforts[DATA.axes.indexOf(c.axis)].name}`, { span: count(c), class: 'group gap' }))],
                [text('Friction', { class: 'text' }), ...columns.map((c, i) => text(c.name, { class: first(i) ? 'gap' : null }))]];
  const body = DATA.models.map(model => [modelCell(model.name), ...columns.map((c, i) => {
    const mean = DATA.means.find(row => row.axis === c.axis && row.friction === model.name);
    return figure(mean?.[c.key], 1, first(i) ? 'gap' : '');
  })]);
  show('means', element('h2', { class: 'minor' }, 'Mean absolute deviation from the measurement, %'), table(head, body));
}

// ---- ISO 230-4 ----

const ISO_TERMS = [
  { key: ['G'], letter: 'G', words: ['circular deviation', 'circular deviation', 'circular error'], meaning: 'width of the annulus that contains one lap' },
  { key: ['F_max', 'F_min'], letter: 'F_max, F_min', words: ['radial deviation', 'radial deviation', 'radial error'], meaning: 'largest and smallest deviation from the programmed radius' },
  { key: ['G_b'], letter: 'G(b)', words: ['–', 'bi-directional circular deviation', 'bi-directional circular error'], meaning: 'width of the annulus that contains both directions' },
  { key: ['D'], letter: 'D', words: ['–', 'mean bi-directional radial deviation', 'mean bi-directional radial error'], meaning: 'mean radius of both directions minus the programmed radius' },
];

function drawIso() {
  const left = { class: 'text' }, wrap = { class: 'text wrap' };
  show('iso-words', table([[text('', left), text('1996', left), text('2005', left), text('2022', left), text('Meaning', left)]],
    ISO_TERMS.map(term => [{ text: symbolText(term.letter), head: true, class: 'text' }, ...term.words.map(word => text(word, wrap)), text(term.meaning, wrap)])));
  const one = ['G', 'F_max', 'F_min'], both = ['G_b', 'D'];
  const tables = [isoValues(one, DATA.directions)];
  if (DATA.runs.some(run => run.G_b !== undefined)) tables.push(isoValues(both, DATA.directions.slice(0, 1)));
  show('iso-values', ...tables);
}

// One row a model and direction, one column a feed under each term.
function isoValues(terms, directions) {
  const letter = key => key === 'G_b' ? 'G(b)' : key;
  const head = [[text('Values, µm', { class: 'text' }), ...terms.map(key => text(symbolText(letter(key)), { span: DATA.feeds.length, class: 'group gap' }))],
                [text('m/min', { class: 'text' }), ...terms.flatMap(() => DATA.feeds.map((feed, i) => text(String(feed), { class: i ? null : 'gap' })))]];
  const body = DATA.models.flatMap(model => directions.map(direction => {
    const at = feed => DATA.runs.find(run => run.friction === model.name && run.direction === direction && run.feed === feed);
    return [modelCell(model.name, direction), ...terms.flatMap(key => DATA.feeds.map((feed, i) => figure(at(feed)?.[key], 1, i ? '' : 'gap')))];
  }));
  return table(head, body);
}
