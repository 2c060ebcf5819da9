// Charts of a result, wherever on the page they stand (DATA.charts, DATA.series), and the choice of their series.
'use strict';

const hidden = new Set();  // names of series
// A simulation before and after its machine file was extended; the ink for what was measured.
const ROLES = { before: { colour: 'var(--orange)', symbol: 'circle' }, after: { colour: 'var(--blue)', symbol: 'circle' },
                measured: { colour: MEASURED.color, symbol: MEASURED.symbol } };
const VARIANT_DASHES = ['6px 3px', '2px 3px', '9px 3px 2px 3px'];

// ---- series ----

// A role's colour; a model's own for the model and, dashed, for its variants ("lugre, 5400 N/s"); else the next free one.
const seriesStyles = (() => {
  const styles = stylesOf(DATA.series.filter(series => !series.role).map(series => series.model || series.name));
  const variants = {};
  return Object.fromEntries(DATA.series.map(({ name, model, role }) => {
    if (role) return [name, ROLES[role]];
    if (!model || model === name) return [name, styles[name]];
    const count = variants[model] = (variants[model] || 0) + 1;
    return [name, { ...styles[model], symbol: styles[model].symbol + '-open', dash: VARIANT_DASHES[(count - 1) % VARIANT_DASHES.length] }];
  }));
})();
const seriesLabels = Object.fromEntries(DATA.series.map(series => [series.name, series.label]));

for (const chart of DATA.charts)
  for (const series of chart.series)
    for (const axis of ['x', 'y']) series[axis] = decodeFloats(series[axis]);

function seriesSwatch({ name, points, role }) {
  const { colour, symbol } = seriesStyles[name];
  if (!points) return swatch(seriesStyles[name]);
  const open = symbol.endsWith('-open');
  return element('span', { class: role === 'measured' ? 'dot diamond' : 'dot', style: `border-color:${colour};background:${open ? 'var(--paper)' : colour}` });
}

function drawSeriesChoice() {
  const models = DATA.series.every(series => series.model || series.role === 'measured');
  document.getElementById('choose-name').textContent = models ? 'Friction model' : 'Shown';
  toggles('choose-series', DATA.series.map(series => ({ name: series.name, label: series.label, swatch: seriesSwatch(series) })), hidden, drawCharts);
}

// ---- charts ----

const overTime = chart => /^time\b/.test(chart.x_label);
// Whether one abscissa belongs to both: the same quantity of the same record.
const linked = (one, other) => one === other || Boolean(one.record && one.record === other.record && one.x_label === other.x_label);
const chartId = i => `chart-${i}`;
// Smallest and largest finite abscissa of the charts, of those above `above`.
function extent(charts, above = -Infinity) {
  let low = Infinity, high = -Infinity;
  for (const series of charts.flatMap(chart => chart.series))
    for (const x of series.x)
      if (Number.isFinite(x) && x > above) [low, high] = [Math.min(low, x), Math.max(high, x)];
  return [low, high];
}

// Charts over the time of the same record run from the first instant to the last of any, or to the next round one if it is near;
// others leave some room beside their curves.
function abscissaStyle(chart) {
  if (chart.x_range) return { range: chart.x_range };
  if (chart.logarithmic_x) {
    const [low, high] = extent([chart], 0), room = 0.03 * Math.log10(high / low);
    return { type: 'log', range: [Math.log10(low) - room, Math.log10(high) + room], dtick: high / low > 3000 ? 1 : 'D2', tickformat: '~g',
             minor: { ticks: 'outside', ticklen: 2, tickcolor: RULE, showgrid: /^frequency\b/.test(chart.x_label), gridcolor: 'var(--faint)' } };
  }
  const [low, high] = extent(overTime(chart) ? DATA.charts.filter(each => linked(each, chart)) : [chart]);
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
             hovertemplate: `${plain(name)}<br>${plain(ordinate)} %{y:.4~g} ${plain(y_unit)}<br>${plain(abscissa)} %{x:.4~g} ${plain(x_unit)}<extra></extra>` };
  const size = !series.points ? 6 : series.x.length > 200 ? 3 : 9;  // a cloud, or points each for itself
  const few = series.x.length > 2 && series.x.length <= 40;  // each point was computed on its own
  return { name, x: series.x, y: series.y, mode: series.points ? 'markers' : few ? 'lines+markers' : 'lines', cliponaxis: !series.points,
           line: { color: colour, width, dash, simplify: false }, marker: { symbol, color: colour, size, opacity: size === 3 ? 0.5 : 1, line: { width: 1.3, color: colour } },
           hovertemplate: `${plain(name)}<br>${plain(ordinate)} %{y:.4~g} ${plain(y_unit)}<br>${plain(abscissa)} %{x:.4~g} ${plain(x_unit)}<extra></extra>` };
}

// Charts over time stand one below the other, so that the same instant is at the same place; others two in a row.
// A chart's `place` is the id of the element that it goes into.
function placeCharts() {
  for (const place of new Set(DATA.charts.map(chart => chart.place))) placeIn(place, DATA.charts.filter(chart => chart.place === place));
}

function placeIn(place, charts) {
  let beside = 0;  // charts since the last wide one
  show(place, ...charts.map((chart, k) => {
    const i = DATA.charts.indexOf(chart), last = k + 1 === charts.length || overTime(charts[k + 1]);
    const wide = chart.wide || overTime(chart) || (last && beside % 2 === 0);
    beside = wide ? 0 : beside + 1;
    const low = DATA.charts.filter(overTime).length > 1 && overTime(chart);
    return element('div', { class: [wide ? 'wide' : null, chart.title ? null : 'below'].filter(Boolean).join(' ') || null },
                   chart.title ? element('h2', {}, chart.title) : null,
                   element('div', { id: chartId(i), class: `plot ${chart.height || (low ? 'low' : 'tall')}` }),
                   chart.caption ? element('p', { class: 'caption' }, symbolText(chart.caption)) : null);
  }));
}

// A chart without a title belongs to the one above: its title, and the quantity of the chart itself.
function titleAbove(i) {
  const chart = DATA.charts[i];
  if (chart.title) return chart.title;
  const above = DATA.charts[i - (chart.wide ? 1 : 2)] || DATA.charts[i - 1];
  return above ? `${titleAbove(DATA.charts.indexOf(above))}: ${quantity(chart.y_label)[0]}` : quantity(chart.y_label)[0];
}

// The chart below over the same abscissa, which then stands there; a chart without a title belongs to the one above.
function hasOneBelow(i) {
  const below = DATA.charts[i + (DATA.charts[i].wide ? 1 : 2)];
  return below !== undefined && below.place === DATA.charts[i].place && !below.title && below.x_label === DATA.charts[i].x_label;
}

// Levels across the chart and distances at one abscissa, as lines and as words, which are on the side with more room.
function marksOf(chart) {
  const place = x => chart.logarithmic_x ? Math.log10(x) : x;
  const [low, high] = abscissaStyle(chart).range || [-Infinity, Infinity];
  const side = x => place(x) - low > high - place(x) ? { xanchor: 'right', xshift: -5 } : { xanchor: 'left', xshift: 5 };
  const line = more => ({ type: 'line', line: { color: QUIET, width: 1, dash: 'dash' }, ...more });
  return {
    shapes: [...chart.levels.map(level => line({ xref: 'paper', x0: 0, x1: 1, y0: level, y1: level })),
             ...chart.distances.map(each => line({ x0: each.x, x1: each.x, y0: each.from, y1: each.to, line: { color: INK, width: 2 } }))],
    annotations: chart.distances.map(each => label(plain(each.label), place(each.x), (each.from + each.to) / 2,
                                                       { ...side(each.x), font: { size: 12, color: INK }, bgcolor: 'var(--veil)' })),
  };
}

function ordinateStyle(chart) {
  const style = { zeroline: !chart.levels.some(level => level === 0), zerolinecolor: RULE, nticks: 7 };
  if (chart.y_range) style.range = chart.y_range;
  if (chart.same_scale) style.scaleanchor = 'x';
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
    Object.assign(FIGURES.get(chartId(i)), { abscissa: chart.x_label, title: titleAbove(i) });
  });
}

// A magnified abscissa is magnified in all charts of the same record that have it. Those that have it already are left alone, which also
// ends the echo of each change; nothing is passed over while another change is still being drawn.
function linkAbscissae() {
  const abscissa = i => document.getElementById(chartId(i)).layout.xaxis;
  const same = (one, other) => one.autorange === true ? other.autorange === true : one.range.join() === other.range.join();
  const follow = (from, event) => {
    const ranges = Object.fromEntries(Object.entries(event).filter(([key]) => /^xaxis\.(range|autorange)/.test(key)));
    if (!Object.keys(ranges).length) return;
    DATA.charts.forEach((chart, i) => {
      if (i !== from && linked(chart, DATA.charts[from]) && !same(abscissa(from), abscissa(i))) Plotly.relayout(chartId(i), ranges);
    });
  };
  DATA.charts.forEach((_, i) => document.getElementById(chartId(i)).on('plotly_relayout', event => follow(i, event)));
}
