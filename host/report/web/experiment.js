// The page of an experiment: its charts with the series that are switched on, and its figures.
'use strict';

// ---- figures ----

// Where the value lies: a band of the tolerance around the expected value, a dot for the value; an arrow where it lies
// beyond the drawing.
function toleranceMark(row) {
  if (row.offset === null) return '';
  const reach = 2.4, width = 96, scale = width / 2 / reach, middle = width / 2;
  const colour = row.holds ? INK : DIFFERS, x = middle + scale * row.offset, side = Math.sign(row.offset), edge = middle + side * (middle - 1);
  const value = Math.abs(row.offset) <= reach - 0.2 ? svg('circle', { cx: x, cy: 7, r: 3.5, style: `fill:${colour}` })
    : svg('path', { d: `M${edge} 7l${-8 * side} -4.5v9z`, style: `fill:${colour}` });
  return svg('svg', { class: 'tolerance', viewBox: `0 0 ${width} 14`, 'aria-hidden': 'true' },
             svg('path', { d: `M0 7H${width}`, style: `stroke:${GRID}` }), svg('rect', { x: middle - scale, y: 1.5, width: 2 * scale, height: 11, rx: 2, style: 'fill:var(--line)' }),
             svg('path', { d: `M${middle} 1.5v11`, style: `stroke:${QUIET}` }), value);
}

const minus = number => number.replace('-', '−');
const DIFFERS = 'var(--differs)';

function markCell(row) {
  if (row.holds === null) return text('—', { class: 'text none', title: 'the machine file states no expected value' });
  return row.holds ? text('✓ as expected', { class: 'text' }) : text('✗ differs', { class: 'text differs' });
}

function figureCells(rows, i, columns) {
  const row = rows[i], same = other => other && other.text === row.text && other.unit === row.unit;
  const first = !same(rows[i - 1]), sameSource = other => same(other) && other.source === row.source;
  const cells = [];
  if (first) cells.push({ text: row.text, head: true, class: 'figure', rows: rows.filter(same).length });
  const model = row.friction ? [swatch(MODEL_STYLES[row.friction] || { colour: QUIET }), row.friction_label] : '';
  if (columns.friction) cells.push(text(model, { class: 'text' }));
  cells.push(text(minus(row.value), { class: row.holds === false ? 'value differs' : 'value' }), text(row.unit, { class: 'text unit' }));
  if (columns.expected)
    cells.push(text(minus(row.expected) || '', { class: 'gap' }), text(row.tolerance && `± ${row.tolerance}`, { class: 'text' }),
               text(toleranceMark(row), { class: 'text' }), markCell(row));
  if (columns.expected && !sameSource(rows[i - 1])) {  // one source for the rows that share it
    const after = rows.slice(i).findIndex(other => !sameSource(other));
    cells.push(text(row.source, { class: 'text wrap source', rows: after < 0 ? rows.length - i : after }));
  }
  return first ? classed('first', cells) : cells;
}

// Figures of which nothing is expected, one column a model.
function matrix(rows) {
  const models = [...new Map(rows.map(row => [row.friction, row.friction_label]))];
  const key = row => JSON.stringify([row.text, row.unit]);
  const value = row => text(row ? minus(row.value) : '–', { class: row ? 'value matrix' : 'none matrix' });
  const body = [...new Set(rows.map(key))].map(each => {
    const of = rows.filter(row => key(row) === each);
    return classed('first', [{ text: of[0].text, head: true, class: 'figure' }, text(of[0].unit, { class: 'text unit' }),
                             ...models.map(([model]) => value(of.find(row => row.friction === model)))]);
  });
  const head = [text('Figure', { class: 'text' }), text('Unit', { class: 'text unit' }),
                ...models.map(([model, name]) => ({ text: [swatch(MODEL_STYLES[model] || { colour: QUIET }), name], class: 'matrix' }))];
  return table([head], body);
}

function drawFigures() {
  const rows = DATA.figures, expected = rows.filter(row => row.holds !== null);
  document.getElementById('results-what').textContent = DATA.verdict;
  const columns = { friction: rows.some(row => row.friction), expected: expected.length > 0 };
  if (!columns.expected && rows.length && rows.every(row => row.friction)) {
    const drawn = matrix(rows);
    drawn.className = 'bare';
    return show('results', drawn);
  }
  const head = [text('Figure', { class: 'text' })];
  if (columns.friction) head.push(text('Friction', { class: 'text' }));
  head.push(text('Value'), text('Unit', { class: 'text unit' }));
  if (columns.expected)
    head.push(text('Expected', { class: 'gap' }), text('', { class: 'text' }), text('', { class: 'text' }), text('', { class: 'text' }), text('Source', { class: 'text' }));
  const drawn = table([head], rows.map((_, i) => figureCells(rows, i, columns)));
  if (!columns.expected) drawn.className = 'bare';
  show('results', drawn);
  if (columns.expected)
    show('results-caption', 'Band: expected value and tolerance; dot: value; arrow: value outside of the drawing. ',
         ...(expected.every(row => row.holds) ? [] : [element('mark', {}, 'Marked'), ': outside the tolerance.']));
}

// "k_s" of the sentences in the head with its subscript.
for (const sentence of document.querySelectorAll('.says :is(p, li)')) sentence.replaceChildren(symbolText(sentence.textContent));
drawConditions();
drawSeriesChoice();
placeCharts();
drawCharts();
linkAbscissae();
drawFigures();
drawMachine();
drawForPaper();
drawSchemeSwitch();
