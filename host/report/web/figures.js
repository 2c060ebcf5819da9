// What all charts of a report have in common: how they are drawn, in the colours of the scheme that is in use; on paper
// in those of the paper and at its width.
'use strict';

const INK = 'var(--ink)';
const QUIET = 'var(--quiet)';
const GRID = 'var(--grid)';
const RULE = 'var(--rule)';
const FONT = '"Segoe UI", "Helvetica Neue", Helvetica, Arial, system-ui, sans-serif';
const NARROW = 560;  // pixels; a chart below this width stacks its parts

// By the id of its element: what was asked to be drawn, with colours by name, and the cursors on it.
const FIGURES = new Map();

// ---- colours ----

// The chart library knows no "var(--ink)": each such text becomes the colour that colours.css has for it. Arrays of
// numbers are passed on as they are.
function resolved(value, style = getComputedStyle(document.documentElement)) {
  if (typeof value === 'string') return value.replace(/var\((--[\w-]+)\)/g, (_, name) => style.getPropertyValue(name).trim());
  if (ArrayBuffer.isView(value) || typeof value !== 'object' || value === null) return value;
  if (Array.isArray(value)) return typeof value[0] === 'object' || typeof value[0] === 'string' ? value.map(each => resolved(each, style)) : value;
  return Object.fromEntries(Object.entries(value).map(([key, each]) => [key, resolved(each, style)]));
}

// ---- parts of a layout ----

function axisStyle(title, more = {}) {
  return { title: { text: title, font: { size: 12.5, color: INK }, standoff: 8 }, gridcolor: GRID, zeroline: false,
           linecolor: RULE, ticks: 'outside', ticklen: 4, tickcolor: RULE, tickfont: { size: 12, color: QUIET },
           automargin: false, ...more };
}

function label(text, x, y, more = {}) {
  return { text, x, y, showarrow: false, font: { size: 12, color: QUIET }, ...more };
}

// "deviation, µm": what is shown, and its unit.
function quantity(axisLabel) {
  const comma = axisLabel.lastIndexOf(', ');
  return comma < 0 ? [axisLabel, ''] : [axisLabel.slice(0, comma), axisLabel.slice(comma + 2)];
}

const plain = words => words.replaceAll('&', '&amp;').replaceAll('<', '&lt;');  // the chart library reads tags
const unplain = words => words.replaceAll(/<br>/g, ' ').replaceAll('&lt;', '<').replaceAll('&amp;', '&');

// A long label is broken into two lines beside a low chart.
function twoLines(axisLabel) {
  if (axisLabel.length <= 24) return plain(axisLabel);
  const spaces = [...axisLabel.matchAll(/ /g)].map(match => match.index), middle = axisLabel.length / 2;
  const at = spaces.reduce((best, each) => Math.abs(each - middle) < Math.abs(best - middle) ? each : best, -1);
  return at < 0 ? plain(axisLabel) : `${plain(axisLabel.slice(0, at))}<br>${plain(axisLabel.slice(at + 1))}`;
}

// ---- drawing ----

let drawings = 0;

// Draws, or draws anew, the chart in the element `id`. `traces`: as the chart library takes them; `layout`: the same,
// or a function that makes it of whether the chart is narrow. Colours may be "var(--NAME)". A double click leads back to the
// first view; from there, with `all`, to everything.
function drawChart(id, traces, layout, { all = false } = {}) {
  const known = FIGURES.get(id);
  const figure = { cursors: null, ...known, id, traces, layout, all, drawing: ++drawings };
  if (figure.cursors?.some(({ curve, point }) => !(point < (traces[curve]?.x.length ?? 0)))) hideCursors(figure);
  FIGURES.set(id, figure);
  if (!known) addTools(figure);
  const drawn = redraw(figure);
  if (figure.cursors) readout(figure);
  return drawn;
}

function shownLayout(figure) {
  const element = document.getElementById(figure.id), narrow = element.clientWidth < NARROW;
  const layout = typeof figure.layout === 'function' ? figure.layout(narrow) : figure.layout;
  const marks = cursorMarks(figure);
  const paper = document.documentElement.classList.contains('paper');
  return { font: { family: FONT, size: 12, color: INK }, paper_bgcolor: 'rgba(0,0,0,0)', plot_bgcolor: 'var(--paper)',
           showlegend: false, hovermode: figure.cursors ? false : 'closest', dragmode: figure.cursors ? false : 'zoom',
           hoverlabel: { bgcolor: 'var(--paper)', bordercolor: RULE, font: { family: FONT, size: 12, color: INK } },
           uirevision: figure.drawing, ...layout,
           ...(paper ? { autosize: false, width: element.clientWidth, height: element.clientHeight } : { autosize: true }),
           shapes: [...(layout.shapes || []), ...marks.shapes], annotations: [...(layout.annotations || []), ...marks.annotations] };
}

function redraw(figure) {
  return Plotly.react(figure.id, resolved(figure.traces), resolved(shownLayout(figure)),
                      { displayModeBar: false, showTips: false, responsive: true, doubleClick: figure.all ? 'reset+autosize' : 'reset' });
}

const redrawAll = () => FIGURES.forEach(redraw);

// ---- dark and light, wide and narrow ----

function drawSchemeSwitch() {
  const choices = [{ value: 'auto', label: 'auto', title: 'as the system has it' }, { value: 'light', label: 'light' }, { value: 'dark', label: 'dark' }];
  const use = choice => {
    keepScheme(choice);
    applyScheme(choice);
    redrawAll();
  };
  segments('choose-scheme', choices, chosenScheme(), use);
  prefersDark.addEventListener('change', () => use(chosenScheme()));
  matchMedia(`(max-width: ${NARROW}px)`).addEventListener('change', redrawAll);
}

// ---- paper ----

// On paper the page has another width, is light, and nothing is folded: so it is drawn before printing, and as the
// window has it after.
function drawForPaper() {
  const folded = () => document.querySelectorAll('details.sheet-of-machine');
  const fit = paper => {
    document.documentElement.classList.toggle('paper', paper);
    applyScheme(chosenScheme());
    for (const each of folded()) {
      if (paper) each.dataset.open = each.open;
      each.open = paper || each.dataset.open === 'true';
    }
    redrawAll();
  };
  addEventListener('beforeprint', () => fit(true));
  addEventListener('afterprint', () => fit(false));
}
