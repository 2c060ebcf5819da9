// Helpers of a report's page: its data, numbers and text as they are printed, controls, tables, and what all charts
// have in common.
'use strict';

const DATA = JSON.parse(document.getElementById('data').textContent);

// ---- numbers and text ----

// 32-bit little-endian floats in base64 (page.hpp, base64_floats).
function decodeFloats(text) {
  const bytes = Uint8Array.from(atob(text), c => c.charCodeAt(0));
  const view = new DataView(bytes.buffer);
  return Float32Array.from({ length: bytes.length / 4 }, (_, i) => view.getFloat32(4 * i, true));
}

function formatNumber(value, digits) {
  if (value === null || value === undefined) return '–';
  const text = value.toFixed(digits);
  return (Number(text) === 0 ? text.replace('-', '') : text).replace('-', '−');
}

// The smallest of 1, 2, 5, 10, ... that is not below the value.
function roundUpNice(value) {
  const decade = 10 ** Math.floor(Math.log10(value));
  return decade * [1, 2, 5, 10].find(step => step * decade >= value * (1 - 1e-9));
}

// ---- elements ----

function element(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (name === 'style') node.style.cssText = value;
    else node.setAttribute(name, value === true ? '' : value);
  }
  node.append(...children.filter(child => child !== null && child !== undefined));
  return node;
}

// "K_v", "zeta_s" as K and zeta with a subscript; "fast_period" stays a name.
const GREEK = { mu: 'μ', zeta: 'ζ', tau: 'τ' };
function symbolText(text) {
  const node = element('span');
  text.split(/\b((?:mu|zeta|tau|[A-Za-z])_[A-Za-z0-9]+)\b/).forEach((part, i) => {
    if (i % 2 === 0) return node.append(part);
    const [symbol, index] = part.split('_');
    node.append(GREEK[symbol] || symbol, element('sub', {}, index));
  });
  return node;
}

function show(id, ...children) {
  document.getElementById(id).replaceChildren(...children);
}

// A row of buttons of which one is chosen. options: [{ value, label, disabled, title }].
function segments(id, options, chosen, choose) {
  const focused = document.getElementById(id).contains(document.activeElement);
  show(id, ...options.map(option => {
    const input = element('input', { type: 'radio', name: id, value: option.value, checked: option.value === chosen,
                                     disabled: option.disabled });
    input.addEventListener('change', () => choose(option.value));
    return element('label', { title: option.title }, input, option.label);
  }));
  if (focused) document.querySelector(`#${id} :checked`)?.focus();
}

// A row of buttons that show and hide what they name. items: [{ name, label, swatch }]; hidden: the set of names that is
// changed before `changed` is called.
function toggles(id, items, hidden, changed) {
  show(id, ...items.map(({ name, label, swatch }) => {
    const input = element('input', { type: 'checkbox', value: name, checked: !hidden.has(name) });
    input.addEventListener('change', () => {
      input.checked ? hidden.delete(name) : hidden.add(name);
      changed();
    });
    return element('label', {}, input, swatch, label);
  }));
}

// rows: arrays of cells, a cell being { text, class, head, span, rows }.
function table(headRows, bodyRows) {
  const cell = (spec, head) =>
    element(head || spec.head ? 'th' : 'td',
            { class: spec.class, colspan: spec.span, rowspan: spec.rows, scope: spec.head ? 'row' : null, title: spec.title },
            ...[].concat(spec.text));
  const row = (specs, head) => {
    const node = element('tr', { class: specs.class }, ...specs.map(spec => cell(spec, head)));
    return node;
  };
  return element('table', {}, element('thead', {}, ...headRows.map(specs => row(specs, true))),
                 element('tbody', {}, ...bodyRows.map(specs => row(specs, false))));
}

const text = (content, more = {}) => ({ text: content, ...more });

// The same row of cells with a class of its own.
function classed(name, cells) {
  cells.class = name;
  return cells;
}

// ---- charts ----

const INK = '#16202c';
const QUIET = '#5c6875';
const GRID = '#e6eaee';
const FONT = '"Segoe UI", "Helvetica Neue", Helvetica, Arial, system-ui, sans-serif';

function axisStyle(title, more = {}) {
  return { title: { text: title, font: { size: 12.5, color: INK }, standoff: 8 }, gridcolor: GRID, zeroline: false,
           linecolor: '#9aa5b1', ticks: 'outside', ticklen: 4, tickcolor: '#9aa5b1', tickfont: { size: 12, color: QUIET },
           automargin: false, ...more };
}

// A double click leads back to the first view; from there, with `all`, to everything.
function drawChart(id, traces, layout, { all = false } = {}) {
  const base = { font: { family: FONT, size: 12, color: INK }, paper_bgcolor: 'rgba(0,0,0,0)', plot_bgcolor: '#fff',
                 showlegend: false, hovermode: 'closest', dragmode: 'zoom', autosize: true,
                 hoverlabel: { bgcolor: '#fff', bordercolor: '#9aa5b1', font: { family: FONT, size: 12, color: INK } } };
  return Plotly.react(id, traces, { ...base, ...layout }, { displayModeBar: false, showTips: false, responsive: true, doubleClick: all ? 'reset+autosize' : 'reset' });
}

function label(text, x, y, more = {}) {
  return { text, x, y, showarrow: false, font: { size: 12, color: QUIET }, ...more };
}

// On paper the page has another width: the charts are drawn at that width before printing and at the window's after.
function drawForPaper() {
  const fit = paper => {
    document.documentElement.classList.toggle('paper', paper);
    for (const chart of document.querySelectorAll('.js-plotly-plot'))
      Plotly.relayout(chart, paper ? { autosize: false, width: chart.clientWidth, height: chart.clientHeight }
                                   : { autosize: true, width: null, height: null });
  };
  addEventListener('beforeprint', () => fit(true));
  addEventListener('afterprint', () => fit(false));
}
