// Two cursors on a chart: each sits on a point of a series; the readout says both places and their difference. They are
// moved by the mouse, the nearer one follows, or by the keyboard.
'use strict';

const CURSOR_NAMES = ['A', 'B'];
const CURSOR_KEYS = 'Drag to move the nearer one. Keys: arrows left and right move it by a point (with Shift: ten), up and down change the series, a and b choose, Escape ends.';

const axisName = (trace, which) => trace[`${which}axis`] || which;  // "x", "y2"
const layoutAxis = (figure, trace, which) => document.getElementById(figure.id)._fullLayout[axisName(trace, which).replace(/^([xy])/, '$1axis')];
const readable = trace => trace.hoverinfo !== 'skip' && trace.x.length > 0;

// Where a point lies in the chart's element, in pixels.
function pixelOf(figure, { curve, point }) {
  const trace = figure.traces[curve], x = layoutAxis(figure, trace, 'x'), y = layoutAxis(figure, trace, 'y');
  return [x._offset + x.d2p(trace.x[point]), y._offset + y.d2p(trace.y[point])];
}

// The point of all shown series that is nearest to a place in the chart, of those in the same part of the chart.
function nearestPoint(figure, left, top) {
  let best = null, least = Infinity;
  figure.traces.forEach((trace, curve) => {
    if (!readable(trace)) return;
    const x = layoutAxis(figure, trace, 'x'), y = layoutAxis(figure, trace, 'y');
    const outside = (axis, at) => Math.max(0, axis._offset - at, at - axis._offset - axis._length);
    const far = 1e6 * (outside(x, left) + outside(y, top));
    for (let point = 0; point < trace.x.length; ++point) {
      const dx = x._offset + x.d2p(trace.x[point]) - left, dy = y._offset + y.d2p(trace.y[point]) - top;
      const distance = far + 4 * dx * dx + dy * dy;  // the abscissa counts more
      if (distance < least) [best, least] = [{ curve, point }, distance];
    }
  });
  return best;
}

// ---- marks and words ----

function cursorMarks(figure) {
  const marks = { shapes: [], annotations: [] };
  if (!figure.cursors) return marks;
  figure.cursors.forEach(({ curve, point }, i) => {
    const trace = figure.traces[curve], xref = axisName(trace, 'x'), yref = axisName(trace, 'y');
    const x = trace.x[point], y = trace.y[point], log = layoutAxis(figure, trace, 'x')?.type === 'log';
    marks.shapes.push({ type: 'line', xref, yref: `${yref} domain`, x0: x, x1: x, y0: 0, y1: 1, line: { color: INK, width: 1, dash: i ? 'dot' : 'dash' } });
    marks.annotations.push({ text: CURSOR_NAMES[i], xref, yref, x: log ? Math.log10(x) : x, y, showarrow: true, arrowhead: 6, arrowsize: 1, arrowwidth: 1.4,
                             arrowcolor: INK, ax: 0, ay: -24, bgcolor: i === figure.active ? INK : 'var(--paper)', bordercolor: INK, borderpad: 2,
                             font: { size: 12, color: i === figure.active ? 'var(--paper)' : INK } });
  });
  return marks;
}

const number = value => Number.isFinite(value) ? String(Number(value.toPrecision(5))).replace('-', '−') : '–';

function readout(figure) {
  const places = figure.cursors.map(({ curve, point }) => {
    const trace = figure.traces[curve];
    const [x, y] = ['x', 'y'].map(which => quantity(axisTitle(figure, trace, which)));
    return { name: unplain(trace.name), x: trace.x[point], y: trace.y[point], abscissa: x, ordinate: y };
  });
  const [a, b] = places, item = (term, ...words) => [element('dt', {}, term), element('dd', {}, ...words)];
  const says = place => `${place.name}: ${place.abscissa[0]} ${number(place.x)} ${place.abscissa[1]}, ${place.ordinate[0]} ${number(place.y)} ${place.ordinate[1]}`;
  const difference = (of, unit) => a[unit][1] === b[unit][1] ? `${number(b[of] - a[of])} ${b[unit][1]}` : '– (different units)';
  figure.readout.replaceChildren(...item('A', says(a)), ...item('B', says(b)),
    ...item('B − A', `Δx ${difference('x', 'abscissa')}, Δy ${difference('y', 'ordinate')}`));
}

// The whole title of the axis on which a trace is drawn; charts without an abscissa of their own borrow the one below.
function axisTitle(figure, trace, which) {
  const title = unplain(layoutAxis(figure, trace, which)?.title?.text || '');
  return title || (which === 'x' ? figure.abscissa || '' : '');
}

// ---- moving them ----

function moveCursor(figure, to) {
  if (!to) return;
  figure.cursors[figure.active] = to;
  redraw(figure);
  readout(figure);
}

function placeCursors(figure) {
  const curve = figure.traces.findIndex(readable);
  if (curve < 0) return false;
  const trace = figure.traces[curve], axis = layoutAxis(figure, trace, 'x');
  const at = share => {
    const left = axis._length * share;
    return Array.from(trace.x).reduce((best, x, i) => Math.abs(axis.d2p(x) - left) < Math.abs(axis.d2p(trace.x[best]) - left) ? i : best, 0);
  };
  figure.active = 0;
  figure.cursors = [{ curve, point: at(1 / 3) }, { curve, point: at(2 / 3) }];
  return true;
}

function hideCursors(figure) {
  figure.cursors = null;
  figure.readout.hidden = true;
  figure.button.setAttribute('aria-pressed', 'false');
  document.getElementById(figure.id).removeAttribute('tabindex');
}

function toggleCursors(figure) {
  const node = document.getElementById(figure.id);
  if (figure.cursors) {
    hideCursors(figure);
    return redraw(figure);
  }
  if (!placeCursors(figure)) return undefined;
  figure.button.setAttribute('aria-pressed', 'true');
  figure.readout.hidden = false;
  redraw(figure);
  readout(figure);
  node.tabIndex = 0;
  node.setAttribute('aria-label', `Chart with two cursors. ${CURSOR_KEYS}`);
  return node.focus({ preventScroll: true });
}

function cursorByKey(figure, event) {
  const { curve, point } = figure.cursors[figure.active], last = figure.traces[curve].x.length - 1;
  const step = event.shiftKey ? 10 : 1;
  const along = by => ({ curve, point: Math.min(last, Math.max(0, point + by)) });
  // The point of the next readable series with the nearest abscissa.
  const beside = by => {
    const readables = [...figure.traces.keys()].filter(k => readable(figure.traces[k]));
    const to = readables[(readables.indexOf(curve) + by + readables.length) % readables.length], x = figure.traces[curve].x[point];
    return { curve: to, point: Array.from(figure.traces[to].x).reduce((best, each, i, all) => Math.abs(each - x) < Math.abs(all[best] - x) ? i : best, 0) };
  };
  const moves = { ArrowLeft: () => along(-step), ArrowRight: () => along(step), ArrowUp: () => beside(-1), ArrowDown: () => beside(1) };
  if (event.key === 'Escape') figure.button.click();
  else if (event.key === 'a' || event.key === 'b') figure.active = event.key === 'a' ? 0 : 1, moveCursor(figure, figure.cursors[figure.active]);
  else if (moves[event.key]) moveCursor(figure, moves[event.key]());
  else return;
  event.preventDefault();
}

// Mouse, pen and finger; the chart library sees nothing of them while the cursors are shown.
function listenToCursors(id) {
  const node = document.getElementById(id);
  let dragging = false;
  const follow = event => {
    const figure = FIGURES.get(id), box = node.getBoundingClientRect();
    moveCursor(figure, nearestPoint(figure, event.clientX - box.left, event.clientY - box.top));
  };
  node.addEventListener('pointerdown', event => {
    const figure = FIGURES.get(id);
    if (!figure.cursors) return;
    const left = event.clientX - node.getBoundingClientRect().left;
    const [a, b] = figure.cursors.map(cursor => Math.abs(pixelOf(figure, cursor)[0] - left));
    if (a !== b) figure.active = a < b ? 0 : 1;
    dragging = true;
    node.setPointerCapture(event.pointerId);
    follow(event);
    event.stopPropagation();
  }, true);
  node.addEventListener('pointermove', event => { if (dragging) follow(event); }, true);
  for (const end of ['pointerup', 'pointercancel']) node.addEventListener(end, () => { dragging = false; }, true);
  node.addEventListener('keydown', event => { if (FIGURES.get(id).cursors) cursorByKey(FIGURES.get(id), event); });
}
