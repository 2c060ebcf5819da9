// The studio's page: the motion and its handles, the laws, the rules, the machine, files. All numbers come from the
// compiled programme (engine.js); here they are only shown in degrees, millimetres and revolutions a minute.
'use strict';

const DATA = JSON.parse(document.getElementById('data').textContent);
const DEGREE = 180 / Math.PI, RPM = 60 / (2 * Math.PI);
const CURVE_POINTS = 600, HARMONICS = 40, COLUMNS = 7;
const MACHINE_DELAY = 60;  // ms without a step before the machine runs
const at = id => document.getElementById(id);

let engine = null, state = null, laws = [], thumbnails = [], selected = 0, selectedTrack = 0, dragging = null, frozen = null, kept = null, shownRun = null;
let motionName = DATA.motion?.name || 'motion.toml', machineName = DATA.machine?.name || null;
let masterSpeed = DATA.speed, machineTimer = 0;
let hadNone = false;
const times = { curves: 0, machine: 0 };  // ms, of the last drawing

// ---- units ----

const shownUnits = () => {
  const angle = state.master === 'rotary', turn = state.slave === 'rotary';
  return { master: angle ? DEGREE : 1e3, masterUnit: angle ? '°' : 'mm', slave: turn ? DEGREE : 1e3, slaveUnit: turn ? '°' : 'mm',
           speed: angle ? RPM : 1, speedUnit: angle ? 'rpm' : 'm/s', small: turn ? DEGREE : 1e6, smallUnit: turn ? '°' : 'µm',
           product: angle ? (turn ? '1' : 'm²/rad³') : turn ? 'rad²/m³' : '1/m', effort: state.machine?.effort_unit === 'N' ? 'N' : 'N m' };
};

// A text for the command line and for the fields, without rounding what was typed.
const plainNumber = value => String(Number(value.toPrecision(12)));

// ---- steps ----

function say(text, bad = false) {
  at('message').textContent = text;
  at('message').hidden = !text;
  at('message').className = bad ? 'bad' : '';
}

// Runs `act`; what it refuses is said, and the motion stays.
function attempt(act) {
  try {
    act();
    say('');
    return true;
  } catch (error) {
    say(error.message.replace(/^found/, 'Found'), true);
    return false;
  }
}

function edit(verb, where, { key = '', x = 0, y = 0, goesOn = false } = {}) {
  return attempt(() => engine.call('edit', { text: `${verb}\0${key}`, at: where, x, y, flag: goesOn ? 1 : 0 }));
}

function step(verb, where, more) {
  const done = edit(verb, where, more);
  refresh();
  return done;
}

function history(call) {
  engine.call(call);
  say('');
  refresh();
}

// ---- curves ----

function curveColumns(table) {
  const rows = table.length / COLUMNS, columns = Array.from({ length: COLUMNS }, () => new Float64Array(rows));
  for (let i = 0; i < rows; ++i)
    for (let k = 0; k < COLUMNS; ++k) columns[k][i] = table[i * COLUMNS + k];
  return columns;
}

const scaled = (values, factor) => Float64Array.from(values, value => value * factor);

// The broken rules that belong to a chart: jumps of its derivative, and limits by their names.
function marksOf(order, names, factor, u) {
  const marks = state.jumps.filter(jump => jump.order === order && order < 3).map(jump => ({
    x: jump.place * u.master, y: 0, text: `${['Position', 'Speed', 'Acceleration'][order]} jumps ${jump.where} at ${withUnit(jump.place * u.master, u.masterUnit)}` }));
  for (const limit of state.limits.filter(limit => limit.broken && names.includes(limit.name)))
    marks.push({ x: limit.place * u.master, y: limit.found * factor, text: `${limit.name}: ${withUnit(limit.found, limit.unit)}, allowed ${shownNumber(limit.allowed)}` });
  return marks;
}

// Only where they are near: a far level would flatten the curve.
function levelsOf(names, factor, ys) {
  const [low, high] = rangeOf(ys), size = high - low;
  return state.limits.filter(limit => names.includes(limit.name) && limit.allowed !== null).flatMap(limit => [limit.allowed * factor, -limit.allowed * factor])
    .filter(level => level > low - 0.6 * size && level < high + 0.6 * size);
}

const labelOf = (name, ys, unit) => {
  const [low, high] = ys.reduce(([a, b], y) => [Math.min(a, y), Math.max(b, y)], [Infinity, -Infinity]);
  return `${name} over a cycle, from ${shownNumber(low)} to ${shownNumber(high)} ${unit}`;
};

// The speed, acceleration and jerk, and the further curves, as drawChart() takes them, by their keys: of a set of columns.
function curveChart(key, columns, u) {
  const w = masterSpeed, cycle = state.cycle * u.master;
  const chart = (name, unit, ys, marks, levels = []) => ({ x: [0, cycle], xTicks: masterTicks(cycle, state.master === 'rotary'), xLabel: `master, ${u.masterUnit}`,
    y: rangeOf(ys, levels), yLabel: unit, series: [{ xs: scaled(columns[0], u.master), ys }], marks, levels, name, label: labelOf(name, ys, unit) });
  if (key === 'position') return chart('Position', u.slaveUnit, scaled(columns[1], u.slave), marksOf(0, ['travel'], u.slave, u));
  if (key === 'product') return chart('Product of speed and acceleration', u.product, columns[5], []);
  if (key === 'effort') {
    const efforts = state.limits.map(limit => limit.name).filter(name => /torque|force/.test(name));
    return chart(`${u.effort === 'N' ? 'Force' : 'Torque'} of the motor`, u.effort, columns[6], marksOf(9, efforts, 1, u), levelsOf(efforts, 1, columns[6]));
  }
  if (key === 'spectrum') {
    const ys = scaled(engine.call('harmonics', { at: HARMONICS }).table, u.slave * w * w), first = w / state.cycle;
    return { x: [0, (HARMONICS + 1) * first], y: [0, rangeOf(ys)[1]], xLabel: 'frequency, Hz', yLabel: `${u.slaveUnit}/s²`, name: 'Spectrum of the acceleration',
      series: [{ xs: Float64Array.from(ys, (_, k) => (k + 1) * first), ys, bars: true }], label: `Spectrum of the acceleration, ${HARMONICS} harmonics, largest ${shownNumber(Math.max(...ys))} ${u.slaveUnit}/s²` };
  }
  const order = ['position', 'speed', 'acceleration', 'jerk'].indexOf(key), limits = order < 3 ? [key] : [], ys = scaled(columns[order + 1], u.slave * w ** order);
  return chart(['', 'Speed', 'Acceleration', 'Jerk'][order], u.slaveUnit + ['', '/s', '/s²', '/s³'][order], ys, marksOf(order, limits, u.slave, u), levelsOf(limits, u.slave, ys));
}

const readCurves = () => curveColumns(engine.call('curves', { x: masterSpeed, at: CURVE_POINTS }).table);

function drawCurves() {
  const focused = document.activeElement?.dataset?.handle;  // drawing replaces it
  const u = shownUnits(), columns = readCurves(), position = curveChart('position', columns, u);
  if (!frozen) frozen = position.y;
  const frame = drawChart(at('chart-0'), { ...position, y: frozen, handles: true });
  if (!dragging) frozen = null;
  placeHandles(frame, u, focused);
  ['speed', 'acceleration', 'jerk', at('fourth').value].forEach((key, k) => drawChart(at(`chart-${k + 1}`), curveChart(key, columns, u)));
}

// ---- handles ----

const endOf = k => state.segments[k].begin + state.segments[k].length;
const positionOf = k => state.segments[k].from + state.segments[k].rise;

// Of each boundary between two segments; at the end of the cycle where an endless cam may end higher.
function handleCount() { return state.segments.length - 1 + (state.modulo !== null || !state.periodic ? 1 : 0); }

function placeHandles(frame, u, focused) {
  const chart = at('chart-0'), n = state.segments.length;
  chart.handleFrame = frame;
  for (let k = 0; k < handleCount(); ++k) {
    const x = frame.px(endOf(k) * u.master), y = frame.py(positionOf(k) * u.slave);
    const where = `${withUnit(endOf(k) * u.master, u.masterUnit)}, ${withUnit(positionOf(k) * u.slave, u.slaveUnit)}`;
    const handle = svg('g', { class: `handle ${k === selected ? 'selected' : ''}`, tabindex: '0', role: 'slider', 'data-handle': k,
      'aria-label': `End of segment ${k + 1}`, 'aria-valuemin': 0, 'aria-valuemax': state.cycle * u.master, 'aria-valuenow': endOf(k) * u.master, 'aria-valuetext': where },
      svg('title', {}, `End of segment ${k + 1}: ${where}`), svg('circle', { class: 'reach', cx: x, cy: y, r: 16 }), svg('circle', { class: 'knob', cx: x, cy: y, r: 6.5 }));
    chart.append(handle);
    if (focused === String(k)) handle.focus({ preventScroll: true });
  }
}

const rangeOfPositions = () => Math.max(1e-9, Math.abs(state.modulo || 0), ...state.segments.map(segment => Math.abs(segment.stroke)));

function moveHandle(k, x, y, goesOn) {
  const last = k === state.segments.length - 1;
  return edit(last ? 'level' : 'drag', k, { x, y, goesOn });
}

function handleKey(event) {
  const handle = event.target.closest?.('[data-handle]');
  const direction = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
  if (!handle || !direction) return;
  event.preventDefault();
  const k = Number(handle.dataset.handle), u = shownUnits(), fine = event.shiftKey ? 0.1 : 1;
  select(k);
  // Whole degrees, or hundredths of the cycle and of the stroke.
  const stepX = state.master === 'rotary' ? 1 / DEGREE : state.cycle / 100, stepY = state.slave === 'rotary' ? 1 / DEGREE : rangeOfPositions() / 100;
  moveHandle(k, endOf(k) + direction[0] * fine * stepX, positionOf(k) + direction[1] * fine * stepY, false);
  refresh();
}

function startDrag(event) {
  const handle = event.target.closest?.('[data-handle]');
  if (!handle) return;
  event.preventDefault();
  const k = Number(handle.dataset.handle), chart = at('chart-0');
  select(k);
  frozen = curveChart('position', readCurves(), shownUnits()).y;
  dragging = { k, moved: false };
  chart.setPointerCapture(event.pointerId);
  refresh();
  at('chart-0').querySelector(`[data-handle="${k}"]`)?.focus({ preventScroll: true });
}

let waiting = null;
function drag(event) {
  if (!dragging) return;
  const first = waiting === null;
  waiting = { x: event.clientX, y: event.clientY };
  if (first) requestAnimationFrame(() => {
    const to = waiting;
    waiting = null;
    if (!dragging) return;
    const u = shownUnits(), frame = at('chart-0').handleFrame;
    if (moveHandle(dragging.k, frame.x(to.x) / u.master, frame.y(to.y) / u.slave, dragging.moved)) dragging.moved = true;
    refresh();
  });
}

function endDrag() {
  if (!dragging) return;
  dragging = null;
  frozen = null;
  refresh();
}

// ---- segments and their values ----

function select(k) {
  selected = Math.min(Math.max(0, k), state.segments.length - 1);
}

const lawOf = segment => laws.find(law => law.name === segment.law);
const rests = segment => segment.law === 'linear' && segment.stroke === 0;
const readable = name => name.replaceAll('_', ' ');

function drawSegments() {
  const u = shownUnits();
  at('segments').tBodies[0].replaceChildren(...state.segments.map((segment, k) => {
    const choose = element('button', { type: 'button', class: 'plain', 'aria-pressed': String(k === selected), 'data-segment': k }, String(k + 1));
    choose.setAttribute('aria-label', `Segment ${k + 1}, ${rests(segment) ? 'rest' : readable(segment.law)}`);
    const row = element('tr', { class: k === selected ? 'selected' : null }, element('td', {}, choose), element('td', {}, rests(segment) ? 'rest' : readable(segment.law)),
      element('td', { class: 'number' }, `${withUnit(endOf(k) * u.master, u.masterUnit)}`), element('td', { class: 'number' }, `${withUnit(positionOf(k) * u.slave, u.slaveUnit)}`));
    row.addEventListener('click', () => { select(k); refresh(); at('segments').querySelector(`[data-segment="${k}"]`).focus(); });
    return row;
  }));
}

// A law whose coefficients are its parameters has no curve of its own.
function lawCurve(k) {
  try {
    return engine.call('law_curve', { at: k }).table;
  } catch {
    return [0, 0];
  }
}

function thumbnail(k) {
  const table = thumbnails[k] ||= lawCurve(k), points = [];
  let low = Infinity, high = -Infinity;
  for (let i = 1; i < table.length; i += 2) { low = Math.min(low, table[i]); high = Math.max(high, table[i]); }
  for (let i = 0; i < table.length; i += 2) points.push(`${(3 + 58 * table[i]).toFixed(1)} ${(37 - 34 * (table[i + 1] - low) / (high - low || 1)).toFixed(1)}`);
  return svg('svg', { viewBox: '0 0 64 40', class: 'thumbnail', 'aria-hidden': 'true' }, svg('path', { d: `M${points.join('L')}` }));
}

// A field with a unit: `act` takes what was typed, in display units; nothing typed: null.
function field(label, value, unit, act, { placeholder = '', title = '', key = label } = {}) {
  const input = element('input', { type: 'number', step: 'any', value: value === null ? '' : plainNumber(value), placeholder, title, 'data-field': key });
  input.addEventListener('change', () => act(input.value.trim() === '' ? null : Number(input.value)));
  return element('label', {}, label, element('span', { class: 'with-unit' }, input, element('span', { class: 'unit' }, unit)));
}

function drawSelected() {
  const k = selected, segment = state.segments[k], law = lawOf(segment), u = shownUnits(), last = k === state.segments.length - 1;
  const focused = document.activeElement?.dataset?.field;
  at('selected-name').textContent = `Segment ${k + 1} of ${state.segments.length}`;
  const name = rests(segment) ? 'rest' : law ? readable(law.name) : 'table of points';
  at('law').replaceChildren(law ? thumbnail(laws.indexOf(law)) : '', element('span', {}, name), element('span', { class: 'quiet' }, law && !rests(segment) ? law.task : ''));
  at('law').setAttribute('aria-label', `Law: ${name}. Choose a law`);
  const fields = [];
  if (!last) fields.push(field('Ends at', endOf(k) * u.master, u.masterUnit, value => value !== null && step('drag', k, { x: value / u.master, y: positionOf(k) })));
  else fields.push(field('Cycle', state.cycle * u.master, u.masterUnit, value => value !== null && step('cycle', 0, { x: value / u.master })));
  fields.push(field('Position at its end', positionOf(k) * u.slave, u.slaveUnit, value => value !== null && step('level', k, { y: value / u.slave })));
  fields.push(field('Stroke', segment.stroke * u.slave, u.slaveUnit, value => value !== null && step('level', k, { y: segment.from + value / u.slave })));
  if (k === 0) fields.push(field('Start', state.start * u.slave, u.slaveUnit, value => value !== null && step('start', 0, { x: value / u.slave })));
  if (k === 0 && state.periodic) fields.push(field('Endless, modulo', state.modulo === null ? null : state.modulo * u.slave, u.slaveUnit, value => step('modulo', 0, { x: (value ?? 0) / u.slave }),
    { placeholder: 'none', title: 'whole multiples of it are the same place: a cycle may end further on by them' }));
  for (const parameter of law?.parameters || []) {
    if (parameter.list) continue;
    const given = segment.values[parameter.key], name = { lambda: 'λ', c: 'c' }[parameter.key] || readable(parameter.key);
    fields.push(field(name, given === undefined ? null : given, '', value => value === null ? step('default', k, { key: parameter.key }) : step('value', k, { key: parameter.key, x: value }),
      { placeholder: parameter.default === null ? '' : plainNumber(parameter.default), title: parameter.text }));
  }
  const ratio = u.slave / u.master, unit = state.master === state.slave ? '' : `${u.slaveUnit}/${u.masterUnit}`;
  fields.push(field('Forced speed at its end', segment.speed === null ? null : segment.speed * ratio, unit,
    value => value === null ? step('free', k) : step('speed', k, { x: value / ratio }), { placeholder: 'free', title: 'of the slave over the master' }));
  at('values').replaceChildren(...fields);
  if (focused) at('values').querySelector(`[data-field="${CSS.escape(focused)}"]`)?.focus();
}

function openLaws() {
  const wanted = at('find').value.toLowerCase().trim();
  at('law-list').replaceChildren(...laws.map((law, k) => [law, k]).filter(([law]) => `${law.name} ${law.english} ${law.task}`.toLowerCase().replaceAll('_', ' ').includes(wanted)).map(([law, k]) => {
    const button = element('button', { type: 'button', class: law.name === state.segments[selected].law ? 'law-choice selected' : 'law-choice', 'data-law': law.name, title: law.formula },
      thumbnail(k), element('span', {}, readable(law.name)), element('span', { class: 'quiet' }, `${law.task}${law.kind === 'rise' ? '' : ', returns'}`));
    button.addEventListener('click', () => { at('laws').close(); step('law', selected, { key: law.name }); at('law').focus(); });
    return button;
  }));
}

// ---- switch tracks ----

function drawTracks() {
  const u = shownUnits(), focused = document.activeElement?.dataset?.field;
  const named = (verb, where, more) => { step(verb, where, more); };
  selectedTrack = Math.min(selectedTrack, Math.max(0, state.tracks.length - 1));
  at('tracks').replaceChildren(...state.tracks.map((track, k) => {
    const name = element('input', { type: 'text', value: track.name, 'data-field': `track ${k}`, maxlength: 60 });
    name.addEventListener('change', () => named('track-name', k, { key: name.value }));
    const remove = element('button', { type: 'button', 'aria-label': `Remove track ${track.name}` }, 'Remove'), more = element('button', { type: 'button', 'aria-label': `Add a window to track ${track.name}` }, 'Add window');
    remove.addEventListener('click', () => { named('untrack', k); at('add-track').focus(); });
    more.addEventListener('click', () => named('window', k, { key: String(track.windows.length), x: 0, y: state.cycle / 2 }));
    const windows = track.windows.flatMap(([first, last], i) => {
      const change = (x, y) => named('window', k, { key: String(i), x, y });
      const fields = [field('On from', first * u.master, u.masterUnit, value => value !== null && change(value / u.master, last), { key: `track ${k} on ${i}`, title: `window ${i + 1} of track ${track.name}` }),
        field('to', last * u.master, u.masterUnit, value => value !== null && change(first, value / u.master), { key: `track ${k} off ${i}`, title: 'before its begin: on around the seam' })];
      if (track.windows.length > 1) {
        const less = element('button', { type: 'button', class: 'plain', 'aria-label': `Remove window ${i + 1} of track ${track.name}` }, '✕');
        less.addEventListener('click', () => named('unwindow', k, { key: String(i) }));
        fields[1].querySelector('.with-unit').append(less);
      }
      return fields;
    });
    const value = (verb, text, now, factor, unit, title) => field(text, now * factor, unit, given => named(verb, k, { x: (given ?? 0) / factor }), { key: `track ${k} ${verb}`, title });
    return element('details', { 'data-track': k, open: k === selectedTrack }, element('summary', {}, track.name, element('span', { class: 'quiet' }, ` ${track.windows.map(([first, last]) => `${withUnit(first * u.master, u.masterUnit)} to ${withUnit(last * u.master, u.masterUnit)}`).join(', ')}`)),
      element('div', { class: 'fields' }, element('label', {}, 'Name', name), element('span', { class: 'group' }, more, remove), ...windows,
        value('on_compensation', 'On compensation', track.on, 1e3, 'ms', 'negative switches earlier'), value('off_compensation', 'Off compensation', track.off, 1e3, 'ms', 'negative switches earlier'),
        value('hysteresis', 'Hysteresis', track.hysteresis, u.master, u.masterUnit, 'over the master')));
  }));
  if (!state.tracks.length) at('tracks').replaceChildren(element('p', { class: 'quiet' }, 'None.'));
  at('tracks').querySelectorAll('details').forEach(each => each.addEventListener('toggle', () => { if (each.open) selectedTrack = Number(each.dataset.track); }));
  if (focused) at('tracks').querySelector(`[data-field="${CSS.escape(focused)}"]`)?.focus();
}

function addTrack() {
  const used = new Set(state.tracks.map(track => track.name));
  let number = state.tracks.length + 1;
  while (used.has(`track ${number}`)) ++number;
  selectedTrack = state.tracks.length;
  step('track', 0, { key: `track ${number}`, x: 0, y: state.cycle / 2 });
}

// ---- rules ----

function drawRules() {
  const u = shownUnits(), rows = [];
  const add = (bad, text) => rows.push(element('li', { class: bad ? 'broken' : 'kept' }, element('span', { class: 'sign', 'aria-hidden': 'true' }, bad ? '✕' : '✓'), element('span', {}, text)));
  for (const order of [0, 1, 2]) {
    const found = state.jumps.filter(jump => jump.order === order), name = ['Position', 'Speed', 'Acceleration'][order];
    if (!found.length) continue;
    add(true, `${name} jumps at ${[...new Set(found.map(jump => `${withUnit(jump.place * u.master, u.masterUnit)}`))].join(', ')}.`);
  }
  if (!rows.length) add(false, 'Position, speed and acceleration are continuous.');
  for (const limit of state.limits)
    add(limit.broken, limit.broken
      ? `${limit.name}: ${withUnit(limit.found, limit.unit)} at ${withUnit(limit.place * u.master, u.masterUnit)}; the axis allows ${shownNumber(limit.allowed)}${limit.highest_speed ? `, kept up to ${withUnit(limit.highest_speed * u.speed, u.speedUnit)}` : ''}.`
      : `${limit.name}: ${shownNumber(limit.found)} of ${withUnit(limit.allowed, limit.unit)}.`);
  at('rules').replaceChildren(...rows);
}

// ---- machine ----

const speedText = (speed = masterSpeed) => `${plainNumber(speed * shownUnits().speed)} ${shownUnits().speedUnit}`;

function repeatingCommand(speed = masterSpeed) {
  const machine = machineName.replace(/[.]toml$/, ''), stiffness = Number(at('stiffness').value) / 100;
  return `stiction simulate cam --machine ${shellWord(machine)} --cam ${shellWord(motionName)}${state.cams.length > 1 ? ` --name ${shellWord(state.name)}` : ''} --speed "${speedText(speed)}" --cycles ${at('cycles').value}${at('run').value === 'shaft' ? ' --model cascade' : ''}`
    + (stiffness !== 1 && at('run').value === 'shaft' ? ` --set "axis.${state.machine.axis}.transmission.stiffness=${Number((state.machine.stiffness * stiffness).toPrecision(9))} ${state.slave === 'rotary' ? 'N m/rad' : 'N/m'}"` : '');
}

function figureRows(run) {
  const u = shownUnits(), f = run.figures, rows = [];
  const add = (text, value, unit) => { if (value !== null && value !== undefined) rows.push({ text, value: shownNumber(value), unit }); };
  add(at('run').value === 'shaft' ? 'largest deviation of the load' : 'largest following error', f.peakError * u.small, u.smallUnit);
  add('mean of its magnitude', f.meanError * u.small, u.smallUnit);
  if (f.dwell !== null) add('residual over the dwell, peak to peak', f.dwell * u.small, u.smallUnit);
  if (f.dwellArea !== null) add('area over the dwell', f.dwellArea * u.slave * u.master, `${u.slaveUnit}·${u.masterUnit}`);
  if (f.motorError) add('following error of the motor', f.motorError * u.small, u.smallUnit);
  if (f.peakEffort) add('largest effort of the motor', f.peakEffort, u.effort);
  if (f.rmsEffort) add('effort, rms', f.rmsEffort, u.effort);
  if (state.motor) add('motor by the rigid model', state.motor, u.effort);
  return rows;
}

function machineChart() {
  const u = shownUnits(), { xs, ys } = shownRun, name = at('machine-chart-name').textContent;
  const series = [...(kept && kept.unit === u.smallUnit ? [{ ...kept, class: 'before' }] : []), { xs, ys, class: 'second' }];
  return { x: [0, state.cycle * u.master], xTicks: masterTicks(state.cycle * u.master, state.master === 'rotary'), xLabel: `master, ${u.masterUnit}`,
    y: rangeOf(series.flatMap(each => each.ys)), yLabel: u.smallUnit, series, name, label: labelOf(name, ys, u.smallUnit) };
}

function drawMachine() {
  const machine = state.machine;
  at('machine-name').textContent = machine ? machine.name : 'No machine';
  if (at('machine').classList.toggle('none', !machine) !== hadNone) { hadNone = !machine; forgetSizes(); }
  at('keep').disabled = at('sweep').disabled = !machine;
  at('shape').disabled = !machine?.elastic;
  if (!machine) {
    at('machine-sentence').textContent = 'Open a machine file, or write the page with --machine, to see what an axis does with this motion.';
    at('chart-5').replaceChildren();
    at('figures').tBodies[0].replaceChildren();
    at('command').textContent = `stiction cam check ${shellWord(motionName)}`;
    return;
  }
  at('machine-sentence').textContent = `axis ${machine.axis}${machine.frequency ? `, natural frequency ${shownNumber(machine.frequency * Math.sqrt(Number(at('stiffness').value) / 100))} Hz` : ''}`;
  at('stiffness').disabled = !machine.elastic || at('run').value !== 'shaft';
  at('command').textContent = repeatingCommand();
  const shaft = at('run').value === 'shaft', begun = performance.now(), u = shownUnits();
  let run = null;
  try {
    run = engine.run(shaft ? 'shaft' : 'follow', { x: masterSpeed, y: Number(at('stiffness').value) / 100, flag: Math.max(1, Math.min(20, Number(at('cycles').value) || 2)) });
  } catch (error) {
    shownRun = null;
    at('machine-chart-name').textContent = '';
    at('machine-chart').classList.add('idle');
    at('figures').tBodies[0].replaceChildren(element('tr', {}, element('td', { colspan: 3, class: 'bad' }, `The machine does not run: ${error.message}`)));
    return;
  }
  const every = Math.max(1, Math.floor(run.ticks.length / 3 / 1500)), xs = [], ys = [];
  for (let i = 0; i < run.ticks.length; i += 3 * every) { xs.push(run.ticks[i] * u.master); ys.push(run.ticks[i + 1] * u.small); }
  shownRun = { xs, ys, unit: u.smallUnit, run };
  at('machine-chart-name').textContent = shaft ? 'Deviation of the load in the last cycle' : 'Following error in the last cycle';
  if (at('machine-chart').classList.contains('idle')) { at('machine-chart').classList.remove('idle'); placeSizes.delete(at('chart-5')); }
  drawChart(at('chart-5'), machineChart());
  at('figures').tBodies[0].replaceChildren(...figureRows(run).map(row => element('tr', {}, element('th', { scope: 'row' }, row.text), element('td', { class: 'number' }, row.value), element('td', {}, row.unit))));
  times.machine = performance.now() - begun;
}

function machineSoon() {
  clearTimeout(machineTimer);
  machineTimer = setTimeout(drawMachine, MACHINE_DELAY);
}

// ---- sweep of the speed ----

const SWEEP = { points: 21, least: 0.5, most: 1.5 };
let sweeping = 0, swept = null;

// A run at each speed, one after the other so that the page stays alive; a change of the motion ends it.
function sweep() {
  if (!state.machine) return;
  const own = ++sweeping, u = shownUnits(), shaft = at('run').value === 'shaft', xs = [], ys = [];
  const cycles = Math.max(1, Math.min(20, Number(at('cycles').value) || 2)), stiffness = Number(at('stiffness').value) / 100;
  const name = shaft ? 'Residual over the dwell, peak to peak, over the speed' : 'Largest following error over the speed';
  const highest = Math.min(...state.limits.map(limit => limit.highest_speed ?? Infinity));
  at('swept').hidden = false;
  at('sweep-name').textContent = name;
  const next = k => {
    if (own !== sweeping) return;
    const speed = masterSpeed * (SWEEP.least + (SWEEP.most - SWEEP.least) * k / (SWEEP.points - 1));
    try {
      const { figures } = engine.run(shaft ? 'shaft' : 'follow', { x: speed, y: stiffness, flag: cycles });
      xs.push(speed * u.speed);
      ys.push((shaft && figures.dwell !== null ? figures.dwell : figures.peakError) * u.small);
    } catch { /* beyond what the axis does: a gap in the curve */ }
    swept = { x: [masterSpeed * SWEEP.least * u.speed, masterSpeed * SWEEP.most * u.speed], y: [0, rangeOf(ys, [0])[1]], xLabel: `speed of the master, ${u.speedUnit}`, yLabel: u.smallUnit, name,
      series: [{ xs, ys, class: 'second' }], marks: highest < masterSpeed * SWEEP.most && highest > masterSpeed * SWEEP.least ? [{ x: highest * u.speed, y: 0, text: `limits of the axis are kept up to ${withUnit(highest * u.speed, u.speedUnit)}` }] : [],
      label: xs.length ? labelOf(name, ys, u.smallUnit) : name };
    if (xs.length) drawChart(at('chart-6'), swept);
    if (k + 1 < SWEEP.points) setTimeout(next, 0, k + 1);
  };
  next(0);
}

// ---- methods against residual vibration ----

// The motion before stays to be compared with, and comes back by undo.
function shape() {
  const before = shownRun;
  const done = attempt(() => engine.call('shape', { text: at('method').value, x: masterSpeed }));
  if (!done) return;
  keepRun(before);
  refresh();
}

function keepRun(run) {
  kept = run;
  at('keep').textContent = kept ? 'End the comparison' : 'Compare with this';
}

// ---- all of it ----

function refresh() {
  ++sweeping;
  swept = null;
  at('swept').hidden = true;
  for (let k = 0; k < 6; ++k) sizeOf(at(`chart-${k}`));
  const begun = performance.now();
  state = JSON.parse(engine.call('state', { x: masterSpeed }).text);
  select(selected);
  at('cam-name').textContent = state.name;
  at('undo').disabled = !state.undo;
  at('redo').disabled = !state.redo;
  at('cams').hidden = state.cams.length < 2;
  at('cam').replaceChildren(...state.cams.map((name, k) => element('option', { value: k }, name)));
  at('cam').value = String(state.edited);
  at('speed-unit').textContent = shownUnits().speedUnit;
  at('remove').disabled = state.segments.length < 2;
  drawCurves();
  times.curves = performance.now() - begun;
  drawSegments();
  if (!dragging) drawSelected();
  if (!dragging) drawTracks();
  drawRules();
  machineSoon();
  stepSoon();
}

// After a step that leaves the motion as it was.
function refreshHistory() {
  state = JSON.parse(engine.call('state', { x: masterSpeed }).text);
  at('undo').disabled = !state.undo;
  at('redo').disabled = !state.redo;
}

// ---- files ----

function offer(name, type, content) {
  const link = element('a', { href: URL.createObjectURL(new Blob([content], { type })), download: name });
  document.body.append(link);
  link.click();
  link.remove();
}

const save = () => offer(motionName, 'application/toml', engine.call('motion_text').text);

function saveCurves() {
  const u = shownUnits(), columns = readCurves(), n = columns[0].length;
  const m = state.master === 'rotary' ? 'rad' : 'm', s = state.slave === 'rotary' ? 'rad' : 'm';
  const head = [`master[${m}]`, `s[${s}]`, `v[${s}/${m}]`, `a[${s}/${m}^2]`, `j[${s}/${m}^3]`, 'product', `effort[${u.effort}]`];
  const rows = Array.from({ length: n }, (_, i) => columns.map(column => String(column[i])).join(','));
  offer(motionName.replace(/[.]toml$/, '') + '.csv', 'text/csv', [`# cam: ${state.name}`, `# speed of the master: ${speedText()}`, head.join(','), ...rows].join('\r\n') + '\r\n');
}

// As `stiction cam table` and `stiction cam export` write them.
function saveExport() {
  const format = at('format').value, name = motionName.replace(/[.]toml$/, '');
  attempt(() => offer(format === 'table' ? `${name}.scam` : `${name}.${format}.txt`, 'application/octet-stream', engine.call('exported', { text: format }).bytes));
}

// A motion file, a machine file or a project of a step cam, told by its schema; anything else is refused by the reader of
// motion files.
const kindOf = text => (/^\s*schema\s*=\s*"stiction[.](machine|step-cam)\//m.exec(text) || [])[1] || 'motion';

async function openFile(file) {
  const text = await file.text(), kind = kindOf(text);
  const done = attempt(() => engine.call({ machine: 'load_machine', 'step-cam': 'load_step', motion: 'load_motion' }[kind], { text: `${file.name}\0${text}` }));
  if (!done) { say(`${at('message').textContent} The motion here is as it was.`, true); return; }
  if (kind === 'machine') machineName = file.name;
  if (kind === 'motion') { motionName = file.name; selected = 0; }
  keepRun(null);
  refresh();
  say(`${file.name} is open.`);
}

// Several at once: a project of a step cam behind the motion that it is of.
async function openFiles(files) {
  const known = await Promise.all([...files].map(async file => [file, kindOf(await file.text())]));
  for (const [file] of known.sort((a, b) => (a[1] === 'step-cam') - (b[1] === 'step-cam'))) await openFile(file);
}

// ---- listening ----

function listen() {
  at('undo').addEventListener('click', () => history('undo'));
  at('redo').addEventListener('click', () => history('redo'));
  at('open').addEventListener('click', () => at('file').click());
  at('file').addEventListener('change', () => { openFiles(at('file').files).finally(() => { at('file').value = ''; }); });
  at('save').addEventListener('click', save);
  at('points').addEventListener('click', saveCurves);
  at('report').addEventListener('click', saveReport);
  at('sweep').addEventListener('click', sweep);
  at('export').addEventListener('click', saveExport);
  at('speed').addEventListener('change', () => {
    const value = Number(at('speed').value);
    if (!(value > 0)) { at('speed').value = plainNumber(masterSpeed * shownUnits().speed); return say('Speed of the master: found nothing above 0; expected more than 0.', true); }
    masterSpeed = value / shownUnits().speed;
    say('');
    refresh();
  });
  at('fourth').addEventListener('change', drawCurves);
  at('cam').addEventListener('change', () => { attempt(() => engine.call('choose_cam', { at: Number(at('cam').value) })); selected = 0; keepRun(null); refresh(); at('cam').focus(); });
  at('add-track').addEventListener('click', addTrack);
  listenToStep();
  for (const id of ['run', 'cycles']) at(id).addEventListener('change', () => { if (id === 'run') keepRun(null); drawMachine(); });
  at('stiffness').addEventListener('input', () => { at('stiffness-value').textContent = `${at('stiffness').value} %`; machineSoon(); });
  at('keep').addEventListener('click', () => { keepRun(kept ? null : shownRun); drawMachine(); });
  at('shape').addEventListener('click', shape);
  at('insert').addEventListener('click', () => step('insert', selected));
  at('split').addEventListener('click', () => step('split', 0, { x: state.segments[selected].begin + 0.5 * state.segments[selected].length }));
  at('remove').addEventListener('click', () => step('remove', selected));
  at('law').addEventListener('click', () => { at('find').value = ''; openLaws(); at('laws').showModal(); at('find').focus(); });
  at('find').addEventListener('input', openLaws);
  at('close-laws').addEventListener('click', () => at('laws').close());
  const chart = at('chart-0');
  chart.addEventListener('pointerdown', startDrag);
  chart.addEventListener('pointermove', drag);
  chart.addEventListener('pointerup', endDrag);
  chart.addEventListener('pointercancel', endDrag);
  chart.addEventListener('keydown', handleKey);
  chart.addEventListener('focusin', event => {
    const handle = event.target.closest('[data-handle]');
    if (!handle || dragging || Number(handle.dataset.handle) === selected) return;
    select(Number(handle.dataset.handle));
    drawSegments();
    drawSelected();
    chart.querySelectorAll('[data-handle]').forEach(each => each.classList.toggle('selected', each === handle));
  });
  addEventListener('keydown', event => {
    if (!(event.ctrlKey || event.metaKey) || event.target.matches?.('input[type="text"], input[type="search"]')) return;
    const key = event.key.toLowerCase(), act = key === 'z' && !event.shiftKey ? () => history('undo') : key === 'y' || key === 'z' ? () => history('redo') : key === 's' ? save : null;
    if (!act) return;
    event.preventDefault();
    act();
  });
  addEventListener('dragover', event => event.preventDefault());
  addEventListener('drop', event => { event.preventDefault(); openFiles(event.dataTransfer.files); });
  let size = '';
  new ResizeObserver(() => {
    const now = `${at('studio').clientWidth}`;
    if (now !== size && state) { size = now; forgetSizes(); drawCurves(); machineSoon(); stepSoon(); }
  }).observe(at('studio'));
}

function drawSchemes() {
  const names = { auto: 'As the system', light: 'Light', dark: 'Dark' };
  at('schemes').replaceChildren(...Object.entries(names).map(([scheme, name]) => {
    const input = element('input', { type: 'radio', name: 'scheme', value: scheme, checked: chosenScheme() === scheme });
    input.addEventListener('change', () => { keepScheme(scheme); applyScheme(scheme); });
    return element('label', {}, input, element('span', {}, name));
  }));
  prefersDark.addEventListener('change', () => applyScheme(chosenScheme()));
}

async function begin() {
  drawSchemes();
  at('origin').textContent = `stiction ${DATA.version}, ${DATA.date}: ${DATA.command}`;
  try {
    engine = await createEngine(Uint8Array.from(atob(at('programme').textContent), c => c.charCodeAt(0)));
  } catch (error) {
    at('still').hidden = false;
    at('cam-name').textContent = document.title.replace('Cam studio: ', '');
    document.querySelectorAll('.bar button, .bar input[type="number"]').forEach(each => { each.disabled = true; });
    return;
  }
  at('studio').hidden = false;
  laws = JSON.parse(engine.call('laws').text);
  if (DATA.motion) engine.call('load_motion', { text: `${DATA.motion.name}\0${DATA.motion.text}` });
  if (DATA.machine) engine.call('load_machine', { text: `${DATA.machine.name}\0${DATA.machine.text}` });
  if (DATA.step) engine.call('load_step', { text: `${DATA.step.name}\0${DATA.step.text}` });
  state = JSON.parse(engine.call('state', { x: masterSpeed }).text);
  at('speed').value = plainNumber(masterSpeed * shownUnits().speed);
  if (!state.machine?.elastic) at('run').value = 'follow';
  at('format').replaceChildren(element('option', { value: 'table' }, 'Drive’s table'), ...JSON.parse(engine.call('formats').text).map(format => element('option', { value: format.name, title: format.text }, format.name)));
  at('method').replaceChildren(...JSON.parse(engine.call('methods').text).slice(1).filter(method => method.name !== 'band-optimal').map(method => element('option', { value: method.name, title: `needs ${method.needs}` }, method.label)));
  listen();
  refresh();
}

begin();
