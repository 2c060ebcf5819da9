// Charts as SVG that are drawn within a frame: axes, curves, levels and marks. Numbers come in display units.
'use strict';

const NARROWEST_RANGE = 1e-12;

// Sizes of the charts' places, which are asked for once: asking between two drawings lays the page out each time.
let placeSizes = new Map();
const forgetSizes = () => { placeSizes = new Map(); };

function sizeOf(node) {
  if (!placeSizes.has(node)) {
    const box = node.getBoundingClientRect();
    placeSizes.set(node, { width: box.width, height: box.height });
  }
  return placeSizes.get(node);
}

function element(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes))
    if (value !== null && value !== undefined && value !== false) node.setAttribute(name, value === true ? '' : value);
  node.append(...children.filter(child => child !== null && child !== undefined));
  return node;
}

function svg(tag, attributes, ...children) {
  const node = document.createElementNS('http://www.w3.org/2000/svg', tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  node.append(...children);
  return node;
}

// Four digits, with a true minus.
function shownNumber(value, digits = 4) {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  const size = Math.abs(value), text = size !== 0 && (size >= 1e6 || size < 1e-4) ? value.toExponential(digits - 1) : String(Number(value.toPrecision(digits)));
  return text.replace('-', '−');
}

// With its unit; degrees follow their number without a blank.
const withUnit = (value, unit) => `${shownNumber(value)}${unit.startsWith('°') ? '' : '\u00a0'}${unit.replace('^2', '²').replace('^3', '³')}`;

// Round places between two values, about `count` of them.
function ticksBetween(low, high, count) {
  const rough = (high - low) / count, decade = 10 ** Math.floor(Math.log10(rough));
  const step = decade * [1, 2, 2.5, 5, 10].find(each => each * decade >= rough * (1 - 1e-9));
  const ticks = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) ticks.push(Number((k * step).toPrecision(12)));
  return ticks;
}

// Those of a turn in parts of it.
function masterTicks(cycle, rotary) {
  if (!rotary) return ticksBetween(0, cycle, 6);
  const step = [15, 30, 45, 60, 90, 180, 360].find(each => cycle / each <= 8.5) || cycle / 6;
  return Array.from({ length: Math.floor(cycle / step + 1e-9) + 1 }, (_, k) => k * step);
}

function rangeOf(values, more = []) {
  let low = Infinity, high = -Infinity;
  for (const value of values) { if (value < low) low = value; if (value > high) high = value; }
  for (const value of more) { low = Math.min(low, value); high = Math.max(high, value); }
  if (!(high - low > NARROWEST_RANGE)) { low -= 1; high += 1; }
  const margin = 0.06 * (high - low);
  return [low - margin, high + margin];
}

// Draws into the svg `node`: chart = { x: range, y: range, xTicks, xLabel, yLabel, series: [{ xs, ys, class, bars }], levels,
// marks: [{ x, y, text }], label }. Returns the frame, with the conversions of handles.
function drawChart(node, chart) {
  const box = sizeOf(node), width = Math.max(240, box.width), height = Math.max(100, box.height);
  const frame = { left: 58, right: width - 12, top: 22, bottom: height - 34 };
  const [x0, x1] = chart.x, [y0, y1] = chart.y;
  const px = x => frame.left + (x - x0) / (x1 - x0) * (frame.right - frame.left);
  const py = y => frame.bottom - (y - y0) / (y1 - y0) * (frame.bottom - frame.top);
  const parts = [];
  for (const tick of ticksBetween(y0, y1, Math.max(4, Math.round((frame.bottom - frame.top) / 42))))
    parts.push(svg('path', { class: Math.abs(tick) < 1e-9 * (y1 - y0) ? 'zero' : 'grid', d: `M${frame.left} ${py(tick)}H${frame.right}` }),
               svg('text', { class: 'tick end', x: frame.left - 6, y: py(tick) + 4 }, shownNumber(tick)));
  let labelled = -Infinity;
  for (const tick of chart.xTicks || ticksBetween(x0, x1, 6)) {
    parts.push(svg('path', { class: 'grid', d: `M${px(tick)} ${frame.top}V${frame.bottom}` }));
    if (px(tick) - labelled < 34) continue;
    labelled = px(tick);
    parts.push(svg('text', { class: 'tick middle', x: px(tick), y: frame.bottom + 15 }, shownNumber(tick)));
  }
  parts.push(svg('text', { class: 'axis end', x: frame.right, y: height - 4 }, chart.xLabel),
             svg('text', { class: 'axis', x: 4, y: 12 }, chart.yLabel));
  for (const [begin, end] of chart.bands || [])
    parts.push(svg('rect', { class: 'band', x: px(begin), y: frame.top, width: Math.max(1, px(end) - px(begin)), height: frame.bottom - frame.top }));
  if (chart.cursor !== undefined) parts.push(svg('path', { class: 'cursor', d: `M${px(chart.cursor)} ${frame.top}V${frame.bottom}` }));
  for (const level of chart.levels || [])
    if (level >= y0 && level <= y1) parts.push(svg('path', { class: 'level', d: `M${frame.left} ${py(level)}H${frame.right}` }));
  for (const series of chart.series) {
    let path = '', drawing = false;
    for (let i = 0; i < series.xs.length; ++i) {
      if (!Number.isFinite(series.ys[i])) { drawing = false; continue; }  // a gap
      const x = px(series.xs[i]).toFixed(1), y = py(series.ys[i]).toFixed(1);
      path += series.bars ? `M${x} ${py(0).toFixed(1)}V${y}` : `${drawing ? 'L' : 'M'}${x} ${y}`;
      drawing = true;
    }
    if (path) parts.push(svg('path', { class: `curve ${series.class || ''} ${series.bars ? 'bars' : ''}`, d: path }));
  }
  for (const mark of chart.marks || []) {
    const x = px(mark.x), y = Math.min(frame.bottom, Math.max(frame.top, py(mark.y)));
    parts.push(svg('g', { class: 'broken' }, svg('title', {}, mark.text), svg('path', { d: `M${x} ${frame.top}V${frame.bottom}` }),
                   svg('path', { class: 'point', d: `M${x} ${y - 6}l6 6l-6 6l-6 -6z` })));
  }
  node.replaceChildren(...parts);
  node.setAttribute('viewBox', `0 0 ${width} ${height}`);
  node.setAttribute('role', chart.handles ? 'group' : 'img');
  node.setAttribute('aria-label', chart.label);
  const scale = width / (box.width || width);
  return { px, py, top: frame.top, bottom: frame.bottom, x: clientX => x0 + ((clientX - node.getBoundingClientRect().left) * scale - frame.left) / (frame.right - frame.left) * (x1 - x0),
           y: clientY => y0 + (frame.bottom - (clientY - node.getBoundingClientRect().top) * scale) / (frame.bottom - frame.top) * (y1 - y0) };
}
