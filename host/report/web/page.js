// Helpers of a report's page: its data, numbers and text as they are printed, controls, tables.
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

function svg(tag, attributes, ...children) {
  const node = document.createElementNS('http://www.w3.org/2000/svg', tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  node.append(...children);
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

// rows: arrays of cells, a cell being { text, class, head, span, rows, title, label }; the label is shown where a narrow
// page stacks the cells.
function table(headRows, bodyRows) {
  const cell = (spec, head) =>
    element(head || spec.head ? 'th' : 'td',
            { class: spec.class, colspan: spec.span, rowspan: spec.rows, scope: spec.head ? 'row' : null, title: spec.title, 'data-label': spec.label },
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
