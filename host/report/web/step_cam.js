// The page of a step cam: the mechanism at an angle of the cam, what its contacts carry there, and charts that show the
// same angle.
'use strict';

const MECHANISM = DATA.mechanism;
const ROWS = [{ name: 'cam 1 and its rollers', colour: 'var(--blue)' }, { name: 'cam 2 and its rollers', colour: 'var(--orange)' }];
const FIELDS = ['at', 'cam', 'roller', 'needed', 'gap', 'pressureAngle', 'force', 'pressure', 'x', 'y'];
const RADIANS = Math.PI / 180;
const LONGEST_FORCE = 0.35;  // of the axis distance, drawn for the largest force of the turn

// ---- data ----

const turned = decodeFloats(MECHANISM.turned_deg);
// Contacts by the index of the angle.
const contactsAt = (() => {
  const numbers = decodeFloats(MECHANISM.contacts), all = Array.from(turned, () => []);
  for (let i = 0; i < numbers.length; i += FIELDS.length) {
    const contact = Object.fromEntries(FIELDS.map((field, k) => [field, numbers[i + k]]));
    all[contact.at].push(contact);
  }
  return all;
})();
const largestForce = Math.max(1e-9, ...contactsAt.flat().map(contact => contact.force));
const indexOf = angle => Math.round(angle / MECHANISM.step_deg) % turned.length;

// ---- drawing; y points down in it, so angles turn clockwise ----

const outline = ({ x, y }) => {
  const xs = decodeFloats(x), ys = decodeFloats(y);
  return `M${Array.from(xs, (each, i) => `${each.toFixed(3)} ${(-ys[i]).toFixed(3)}`).join('L')}Z`;
};

function rollerCentre(row, roller, index) {
  const v = (MECHANISM.bases_deg[row] + roller * MECHANISM.pitch_deg + turned[index]) * RADIANS;
  return [MECHANISM.axis_distance_mm - MECHANISM.arm_mm * Math.cos(v), -MECHANISM.arm_mm * Math.sin(v)];
}

// What stays in the drawing; what moves is in the groups "cams" and "moving".
function placeDrawing() {
  const { axis_distance_mm: a, arm_mm: b, roller_radius_mm: c, hub_radius_mm: hub } = MECHANISM;
  const radii = MECHANISM.profiles.flatMap(({ x, y }) => { const ys = decodeFloats(y); return Array.from(decodeFloats(x), (each, i) => Math.hypot(each, ys[i])); });
  const reach = Math.max(...radii), high = Math.max(reach, b + c) + 6, left = -reach - 6, right = a + b + c + 6;
  const thin = { fill: 'none', 'vector-effect': 'non-scaling-stroke', 'stroke-width': 1 };
  const cams = svg('g', { id: 'cams' }, ...MECHANISM.profiles.map((profile, row) =>
    svg('path', { d: outline(profile), class: 'cam', style: `stroke:${ROWS[row].colour};fill:${ROWS[row].colour}`, 'vector-effect': 'non-scaling-stroke' })),
    svg('path', { d: `M0 0H${reach}`, ...thin, style: `stroke:${INK}`, 'stroke-dasharray': '2 4' }));
  show('drawing', svg('svg', { viewBox: `${left} ${-high} ${right - left} ${2 * high}`, role: 'img', 'aria-label': 'The mechanism at the chosen angle of the cam' },
    svg('path', { d: `M${left} 0H${right}`, ...thin, style: `stroke:${GRID}` }), cams,
    svg('circle', { cx: 0, cy: 0, r: hub || 2, ...thin, style: `stroke:${RULE}` }),
    svg('circle', { cx: a, cy: 0, r: b, ...thin, style: `stroke:${GRID}` }), svg('circle', { cx: a, cy: 0, r: 2, style: `fill:${INK}` }),
    svg('g', { id: 'moving' })));
}

function movingParts(index) {
  const { axis_distance_mm: a, roller_radius_mm: c, rollers } = MECHANISM, parts = [];
  ROWS.forEach(({ colour }, row) => {
    for (let roller = 0; roller < rollers; ++roller) {
      const [x, y] = rollerCentre(row, roller, index);
      parts.push(svg('path', { d: `M${a} 0L${x} ${y}`, style: `stroke:${RULE}`, 'vector-effect': 'non-scaling-stroke' }),
                 svg('circle', { cx: x, cy: y, r: c, class: 'roller', style: `stroke:${colour}`, 'vector-effect': 'non-scaling-stroke' }));
    }
  });
  contactsAt[index].forEach((contact, i) => {
    const [x, y] = rollerCentre(contact.cam - 1, contact.roller - 1, index), at = [contact.x, -contact.y];
    const size = Math.hypot(x - at[0], y - at[1]), along = [(x - at[0]) / size, (y - at[1]) / size];
    const length = LONGEST_FORCE * a * contact.force / largestForce;
    parts.push(svg('path', { d: `M${at[0]} ${at[1]}l${along[0] * length} ${along[1] * length}`, class: 'force', style: `stroke:${INK}`, 'vector-effect': 'non-scaling-stroke' }),
               svg('circle', { cx: at[0], cy: at[1], r: 1.6, style: `fill:${contact.needed ? INK : DIFFERS}` }),
               svg('text', { x: at[0] - 6 * along[0], y: at[1] - 6 * along[1] + 2, class: 'letter' }, letterOf(i)));
  });
  return parts;
}

// ---- table of contacts ----

const DIFFERS = 'var(--differs)';
const letterOf = i => String.fromCharCode(65 + i);

function drawContacts(index) {
  const head = ['', 'Cam', 'Roller', 'Pressure angle, °', 'Force, N', 'Hertz pressure, MPa', 'Gap, µm', ''].map(words => text(words));
  head[7].class = 'text';
  const rows = contactsAt[index].map((contact, i) => [
    { text: letterOf(i), head: true }, text(String(contact.cam)), text(String(contact.roller)), text(formatNumber(contact.pressureAngle, 2)),
    text(formatNumber(contact.force, 1)), text(formatNumber(contact.pressure, 1)), text(formatNumber(contact.gap, 2)),
    text(contact.needed ? 'needed' : 'not needed', { class: 'text' })]);
  show('contacts', table([head], rows));
}

// ---- turning ----

const slider = document.getElementById('angle');
let shown = 0, waiting = false;

// The line at the angle in every chart; the magnified abscissa stays.
function markCharts() {
  DATA.charts.forEach((chart, i) => {
    const figure = FIGURES.get(chartId(i)), x = shown * MECHANISM.step_deg;
    figure.layout = { ...figure.layout, shapes: [...marksOf(chart).shapes, { type: 'line', name: 'cam angle', yref: 'paper', x0: x, x1: x, y0: 0, y1: 1, line: { color: INK, width: 1.5 } }] };
    redraw(figure);
  });
}

function drawAngle() {
  const angle = shown * MECHANISM.step_deg, contacts = contactsAt[shown];
  document.getElementById('cams').setAttribute('transform', `rotate(${angle})`);
  document.getElementById('moving').replaceChildren(...movingParts(shown));
  document.getElementById('angle-value').textContent = `${formatNumber(angle, 1)}°`;
  document.getElementById('mechanism-state').textContent = `cam at ${formatNumber(angle, 1)}°, carousel at ${formatNumber(Math.abs(turned[shown]), 2)}°; ${contacts.length} rollers touch`;
  drawContacts(shown);
}

// At once what is cheap, the charts once a frame.
function turnTo(angle) {
  shown = indexOf(((angle % 360) + 360) % 360);
  slider.value = shown * MECHANISM.step_deg;
  drawAngle();
  if (waiting) return;
  waiting = true;
  requestAnimationFrame(() => { waiting = false; markCharts(); });
}

function listenToTurns() {
  slider.step = MECHANISM.step_deg;
  slider.addEventListener('input', () => turnTo(Number(slider.value)));
  document.getElementById('drawing').addEventListener('wheel', event => {
    event.preventDefault();
    const steps = event.shiftKey ? 1 : Math.max(1, Math.round(1 / MECHANISM.step_deg));
    turnTo((shown + Math.sign(event.deltaY || event.deltaX) * steps) * MECHANISM.step_deg);
  }, { passive: false });
  DATA.charts.forEach((_, i) => document.getElementById(chartId(i)).on('plotly_click', event => turnTo(event.points[0].x)));
}

// ---- the rest of the page ----

function drawShown() {
  const drawn = () => { drawCharts(); markCharts(); };
  toggles('choose-series', DATA.series.map(series => ({ name: series.name, label: series.label, swatch: seriesSwatch(series) })), hidden, drawn);
}

function drawResults() {
  const rows = DATA.figures.map(row => classed('first', [{ text: row.text, head: true, class: 'figure' }, text(row.value.replaceAll('-', '−'), { class: 'value' }), text(row.unit, { class: 'text unit' })]));
  const drawn = table([[text('Figure', { class: 'text' }), text('Value'), text('Unit', { class: 'text unit' })]], rows);
  drawn.className = 'bare';
  show('results', drawn);
  show('notes', ...DATA.notes.map(note => element('p', { class: 'caption' }, note)));
}

drawConditions();
show('mechanism-key', ...ROWS.map(row => element('span', {}, swatch(row), ` ${row.name}`)));
placeDrawing();
drawShown();
placeCharts();
drawCharts();
linkAbscissae();
listenToTurns();
turnTo(0);
drawResults();
drawMachine();
drawForPaper();
drawSchemeSwitch();
