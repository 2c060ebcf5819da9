// The page of an experiment: its charts with the series that are switched on, and its figures.
'use strict';

const hidden = new Set();  // names of series
const VARIANT_DASHES = ['6px 3px', '2px 3px', '9px 3px 2px 3px'];

// ---- series ----

// A model's own colour for the model and, dashed, for its variants ("lugre, 5400 N/s"); black for what was measured.
const seriesStyles = (() => {
  const styles = stylesOf(DATA.series.map(series => series.model || series.name).filter(name => name !== 'measured'));
  const variants = {};
  return Object.fromEntries(DATA.series.map(({ name, model }) => {
    if (name === 'measured') return [name, { colour: MEASURED.color, symbol: MEASURED.symbol }];
    if (!model || model === name) return [name, styles[name]];
    const count = variants[model] = (variants[model] || 0) + 1;
    return [name, { ...styles[model], symbol: styles[model].symbol + '-open', dash: VARIANT_DASHES[(count - 1) % VARIANT_DASHES.length] }];
  }));
})();
const seriesLabels = Object.fromEntries(DATA.series.map(series => [series.name, series.label]));

for (const chart of DATA.charts)
  for (const series of chart.series)
    for (const axis of ['x', 'y']) series[axis] = decodeFloats(series[axis]);

function seriesSwatch({ name, points }) {
  const { colour, symbol } = seriesStyles[name];
  if (!points) return swatch(seriesStyles[name]);
  const open = symbol.endsWith('-open');
  return element('span', { class: name === 'measured' ? 'dot diamond' : 'dot', style: `border-color:${colour};background:${open ? '#fff' : colour}` });
}

function drawSeriesChoice() {
  const models = DATA.series.every(series => series.model || series.name === 'measured');
  document.getElementById('choose-name').textContent = models ? 'Friction model' : 'Shown';
  toggles('choose-series', DATA.series.map(series => ({ name: series.name, label: series.label, swatch: seriesSwatch(series) })), hidden, drawCharts);
}

// ---- charts ----

const overTime = chart => /^time\b/.test(chart.x_label);
const chartId = i => `chart-${i}`;
const plain = words => words.replaceAll('&', '&amp;').replaceAll('<', '&lt;');  // the chart library reads tags

// "deviation, µm": what is shown, and its unit.
function quantity(axisLabel) {
  const comma = axisLabel.lastIndexOf(', ');
  return comma < 0 ? [axisLabel, ''] : [axisLabel.slice(0, comma), axisLabel.slice(comma + 1)];
}

// A long label stands in two lines beside a low chart.
function twoLines(axisLabel) {
  if (axisLabel.length <= 24) return plain(axisLabel);
  const spaces = [...axisLabel.matchAll(/ /g)].map(match => match.index), middle = axisLabel.length / 2;
  const at = spaces.reduce((best, each) => Math.abs(each - middle) < Math.abs(best - middle) ? each : best, -1);
  return at < 0 ? plain(axisLabel) : `${plain(axisLabel.slice(0, at))}<br>${plain(axisLabel.slice(at + 1))}`;
}

// Smallest and largest finite abscissa of the charts, of those above `above`.
function extent(charts, above = -Infinity) {
  let low = Infinity, high = -Infinity;
  for (const series of charts.flatMap(chart => chart.series))
    for (const x of series.x)
      if (Number.isFinite(x) && x > above) [low, high] = [Math.min(low, x), Math.max(high, x)];
  return [low, high];
}

// Charts over the same time run from the first instant to the last of any, or to the next round one if it is near;
// others leave some room beside their curves.
function abscissaStyle(chart) {
  if (chart.x_range) return { range: chart.x_range };
  if (chart.logarithmic_x) {
    const [low, high] = extent([chart], 0), room = 0.03 * Math.log10(high / low);
    return { type: 'log', range: [Math.log10(low) - room, Math.log10(high) + room], dtick: high / low > 3000 ? 1 : 'D2', tickformat: '~g',
             minor: { ticks: 'outside', ticklen: 2, tickcolor: '#9aa5b1', showgrid: /^frequency\b/.test(chart.x_label), gridcolor: '#f3f5f7' } };
  }
  const [low, high] = extent(overTime(chart) ? DATA.charts.filter(each => each.x_label === chart.x_label) : [chart]);
  if (!(low < high)) return {};
  if (!overTime(chart)) return { range: [low - 0.03 * (high - low), high + 0.03 * (high - low)] };
  const round = Number(high.toPrecision(2));
  return { range: [low, Math.abs(round - high) < 1e-3 * (high - low) ? round : high] };
}

// Curves that coincide stay visible: of charts over time the first ones are drawn broader, under the last ones.
const lineWidth = (chart, k, count) => overTime(chart) ? 1.5 + 0.6 * Math.min(count - 1 - k, 4) : 1.6;

function traceOf(chart, series, width) {
  const { colour, symbol, dash } = seriesStyles[series.name];
  const name = seriesLabels[series.name], [abscissa, x_unit] = quantity(chart.x_label), [ordinate, y_unit] = quantity(chart.y_label);
  if (series.bars)
    return { name, type: 'bar', x: series.x, y: series.y, marker: { color: colour },
             hovertemplate: `${plain(name)}<br>${plain(ordinate)} %{y:.4~g}${plain(y_unit)}<br>${plain(abscissa)} %{x:.4~g}${plain(x_unit)}<extra></extra>` };
  const few = series.x.length > 2 && series.x.length <= 40;  // each point was computed on its own
  return { name, x: series.x, y: series.y, mode: series.points ? 'markers' : few ? 'lines+markers' : 'lines', cliponaxis: !series.points,
           line: { color: colour, width, dash, simplify: false }, marker: { symbol, color: colour, size: series.points ? 9 : 6, line: { width: 1.3, color: colour } },
           hovertemplate: `${plain(name)}<br>${plain(ordinate)} %{y:.4~g}${plain(y_unit)}<br>${plain(abscissa)} %{x:.4~g}${plain(x_unit)}<extra></extra>` };
}

// Charts over time stand one below the other, so that the same instant is at the same place; others two in a row.
function placeCharts() {
  let beside = 0;  // charts since the last wide one
  show('charts', ...DATA.charts.map((chart, i) => {
    const last = i + 1 === DATA.charts.length || overTime(DATA.charts[i + 1]);
    const wide = chart.wide || overTime(chart) || (last && beside % 2 === 0);
    beside = wide ? 0 : beside + 1;
    const low = DATA.charts.filter(overTime).length > 1 && overTime(chart);
    return element('div', { class: [wide ? 'wide' : null, chart.title ? null : 'below'].filter(Boolean).join(' ') || null },
                   chart.title ? element('h2', {}, chart.title) : null,
                   element('div', { id: chartId(i), class: `plot ${chart.height || (low ? 'low' : 'tall')}` }),
                   chart.caption ? element('p', { class: 'caption' }, symbolText(chart.caption)) : null);
  }));
}

// The chart below over the same abscissa, which then stands there; a chart without a title belongs to the one above.
function hasOneBelow(i) {
  const below = DATA.charts[i + (DATA.charts[i].wide ? 1 : 2)];
  return below !== undefined && !below.title && below.x_label === DATA.charts[i].x_label;
}

// Levels across the chart and distances at one abscissa, as lines and as words.
function marksOf(chart) {
  const place = x => chart.logarithmic_x ? Math.log10(x) : x;
  const line = more => ({ type: 'line', line: { color: QUIET, width: 1, dash: 'dash' }, ...more });
  return {
    shapes: [...chart.levels.map(level => line({ xref: 'paper', x0: 0, x1: 1, y0: level, y1: level })),
             ...chart.distances.map(each => line({ x0: each.x, x1: each.x, y0: each.from, y1: each.to, line: { color: INK, width: 2 } }))],
    annotations: chart.distances.map(each => label(plain(each.label), place(each.x), (each.from + each.to) / 2,
                                                       { xanchor: 'left', xshift: 5, font: { size: 12, color: INK }, bgcolor: 'rgba(255,255,255,.8)' })),
  };
}

function ordinateStyle(chart) {
  const style = { zeroline: !chart.levels.some(level => level === 0), zerolinecolor: '#9aa5b1', nticks: 7 };
  if (chart.y_range) style.range = chart.y_range;
  if (chart.y_step) style.dtick = chart.y_step;
  return style;
}

function drawCharts() {
  DATA.charts.forEach((chart, i) => {
    const shown = chart.series.filter(series => !hidden.has(series.name));
    const above = hasOneBelow(i);
    drawChart(chartId(i), shown.map((series, k) => traceOf(chart, series, lineWidth(chart, k, shown.length))), {
      margin: { l: 76, r: 24, t: 10, b: above ? 12 : 46 }, uirevision: 'magnified', ...marksOf(chart),
      xaxis: axisStyle(above ? '' : plain(chart.x_label), { ...abscissaStyle(chart), ...(above ? { showticklabels: false } : {}) }),
      yaxis: axisStyle(twoLines(chart.y_label), ordinateStyle(chart)),
    }, { all: Boolean(chart.x_range) });
  });
}

// A magnified abscissa is magnified in all charts that have it.
function linkAbscissae() {
  let following = false;
  const follow = (from, event) => {
    const ranges = Object.fromEntries(Object.entries(event).filter(([key]) => /^xaxis\.(range|autorange)/.test(key)));
    if (following || !Object.keys(ranges).length) return;
    following = true;
    const others = DATA.charts.map((chart, i) => i).filter(i => i !== from && DATA.charts[i].x_label === DATA.charts[from].x_label);
    Promise.all(others.map(i => Plotly.relayout(chartId(i), ranges))).finally(() => { following = false; });
  };
  DATA.charts.forEach((_, i) => document.getElementById(chartId(i)).on('plotly_relayout', event => follow(i, event)));
}

// ---- figures ----

function svg(tag, attributes, ...children) {
  const node = document.createElementNS('http://www.w3.org/2000/svg', tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  node.append(...children);
  return node;
}

// Where the value lies: a band of the tolerance around the expected value, a dot for the value; an arrow where it lies
// beyond the drawing.
function toleranceMark(row) {
  if (row.offset === null) return '';
  const reach = 2.4, width = 96, scale = width / 2 / reach, middle = width / 2;
  const colour = row.holds ? INK : DIFFERS, x = middle + scale * row.offset, side = Math.sign(row.offset), edge = middle + side * (middle - 1);
  const value = Math.abs(row.offset) <= reach - 0.2 ? svg('circle', { cx: x, cy: 7, r: 3.5, fill: colour })
    : svg('path', { d: `M${edge} 7l${-8 * side} -4.5v9z`, fill: colour });
  return svg('svg', { class: 'tolerance', viewBox: `0 0 ${width} 14`, 'aria-hidden': 'true' },
             svg('path', { d: `M0 7H${width}`, stroke: GRID }), svg('rect', { x: middle - scale, y: 1.5, width: 2 * scale, height: 11, rx: 2, fill: '#dbe2e9' }),
             svg('path', { d: `M${middle} 1.5v11`, stroke: QUIET }), value);
}

const minus = number => number.replace('-', '−');
const DIFFERS = '#b3400a';

function markCell(row) {
  if (row.holds === null) return text('—', { class: 'text none', title: 'nothing is expected of this figure' });
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
    show('results-caption', 'Band: expected value and tolerance; dot: the value, an arrow where it lies further off. ',
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
