// The step cam of the studio: its mechanism at any angle of the cam, charts that show the same angle, relief that is
// dragged, the project's numbers, and files for the shop. studio.js has the page that it is a part of.
'use strict';

const STEP_DELAY = 250;  // ms without a step before the figures are computed
const STEP_COLUMNS = { turn: 13, contacts: 10, profiles: 4 };
const STEP_CHARTS = [
  { key: 'angle', name: 'Pressure angle', unit: '°', factor: DEGREE, columns: [7, 10], zero: true },
  { key: 'force', name: 'Contact force', unit: 'N', factor: 1, columns: [8, 11], zero: true },
  { key: 'pressure', name: 'Hertz pressure', unit: 'MPa', factor: 1e-6, columns: [9, 12], zero: true },
  { key: 'count', name: 'Rollers that touch', unit: '1', factor: 1, columns: [6, 5], zero: true },
  { key: 'output', name: 'Torque of the carousel', unit: 'N m', factor: 1, columns: [2] },
  { key: 'input', name: 'Torque of the cam shaft', unit: 'N m', factor: 1, columns: [3] },
  { key: 'bearing', name: 'Load of the bearings', unit: 'N', factor: 1, columns: [4], zero: true },
  { key: 'carousel', name: 'Angle of the carousel', unit: '°', factor: DEGREE, columns: [1] },
];
const MOST_CHARTS = 4, STEP_ROWS = ['cam 1 and its rollers', 'cam 2 and its rollers'];
const GROUPS = [
  ['Mechanism', ['mechanism']], ['Load', ['load']], ['Relief', ['relief', 'relief.valley', 'relief.peak']],
  ['Materials', ['cam_material', 'roller_material']], ['Wheel and files', ['']], ['Tolerances', ['tolerance']], ['Electronic cam to compare with', ['electronic']],
];
const SECONDS_OF_A_TURN = 12;

let stepCam = null, stepTimer = 0, angle = 0, turned = 0, reliefDrag = null, selectedArc = 0, stepNames = '';
let chosenCharts = ['angle', 'force', 'pressure', 'count'];

// ---- what the programme has ----

function rowsOf(table, columns) {
  return Array.from({ length: table.length / columns }, (_, i) => table.subarray(i * columns, (i + 1) * columns));
}

// The data of the step cam as it is now; all that is drawn comes from here.
function readStep() {
  stepCam = JSON.parse(engine.call('step_state').text);
  if (!stepCam?.made) return;
  stepCam.turn = rowsOf(engine.call('step_turn').table, STEP_COLUMNS.turn);
  stepCam.contacts = stepCam.turn.map(() => []);
  for (const row of rowsOf(engine.call('step_contacts').table, STEP_COLUMNS.contacts)) stepCam.contacts[row[0]].push(row);
  stepCam.profiles = [[], []];
  for (const row of rowsOf(engine.call('step_profiles').table, STEP_COLUMNS.profiles)) stepCam.profiles[row[0]].push(row);
  stepCam.largestForce = Math.max(1e-9, ...stepCam.contacts.flat().map(row => row[6]));
}

const indexOfAngle = () => Math.round(angle / (stepCam.made.step * DEGREE)) % stepCam.turn.length;

// ---- the mechanism; y points down in a drawing, so that its angles turn clockwise, as the cam does ----

const still = { fill: 'none', 'vector-effect': 'non-scaling-stroke' };

function outlineOf(profile) {
  return `M${profile.map(([, at, , radius]) => `${(1e3 * radius * Math.cos(at)).toFixed(3)} ${(-1e3 * radius * Math.sin(at)).toFixed(3)}`).join('L')}Z`;
}

// The arcs that relief lowers, thicker.
function arcOutline(cam, { begin, end }) {
  const places = stepCam.profiles[cam].flatMap(([, at, , radius]) => [at, at + 2 * Math.PI].filter(each => each >= begin && each <= end).map(each => [each, radius])).sort((a, b) => a[0] - b[0]);
  return places.length ? `M${places.map(([at, radius]) => `${(1e3 * radius * Math.cos(at)).toFixed(3)} ${(-1e3 * radius * Math.sin(at)).toFixed(3)}`).join('L')}` : '';
}

function drawMechanism() {
  const a = 1e3 * stepCam.axis_distance, b = 1e3 * stepCam.arm, c = 1e3 * stepCam.roller_radius, reach = 1e3 * Math.max(...stepCam.profiles.flat().map(row => row[3]));
  const high = Math.max(reach, b + c) + 6, left = -reach - 6, right = a + b + c + 6, node = at('mechanism');
  node.setAttribute('viewBox', `${left} ${-high} ${right - left} ${2 * high}`);
  node.setAttribute('role', 'img');
  node.replaceChildren(svg('path', { ...still, class: 'thin', d: `M${left} 0H${right}` }),
    svg('g', { id: 'turning' }, ...stepCam.profiles.map((profile, row) => svg('path', { class: `cam row-${row}`, d: outlineOf(profile), 'vector-effect': 'non-scaling-stroke' })),
      ...stepCam.made.arcs.map((arc, k) => svg('path', { ...still, class: `lowered row-${arc.cam} ${k === selectedArc ? 'selected' : ''}`, d: arcOutline(arc.cam, arc) })),
      svg('path', { ...still, class: 'zero-line', d: `M0 0H${reach}` })),
    svg('circle', { ...still, class: 'thin', cx: 0, cy: 0, r: 1e3 * stepCam.hub_radius || 2 }), svg('circle', { ...still, class: 'thin', cx: a, cy: 0, r: b }), svg('g', { id: 'moving' }));
  drawAngle();
}

function rollerAt(row, roller, way) {
  const v = stepCam.bases[row] + roller * stepCam.pitch + way;
  return [1e3 * (stepCam.axis_distance - stepCam.arm * Math.cos(v)), -1e3 * stepCam.arm * Math.sin(v)];
}

const letter = i => String.fromCharCode(65 + i);

// The drawing, the contacts and the lines in the charts at the angle.
function drawAngle() {
  const index = indexOfAngle(), [, way] = stepCam.turn[index], contacts = stepCam.contacts[index], parts = [], a = 1e3 * stepCam.axis_distance;
  at('angle').value = angle;
  at('angle-value').textContent = `${angle.toFixed(1)}°`;
  at('turning').setAttribute('transform', `rotate(${angle})`);
  for (const row of [0, 1])
    for (let roller = 0; roller < stepCam.rollers; ++roller) {
      const [x, y] = rollerAt(row, roller, way);
      parts.push(svg('path', { ...still, class: 'thin', d: `M${a} 0L${x} ${y}` }), svg('circle', { class: `roller row-${row}`, cx: x, cy: y, r: 1e3 * stepCam.roller_radius, 'vector-effect': 'non-scaling-stroke' }));
    }
  contacts.forEach((contact, i) => {
    const [x, y] = rollerAt(contact[1], contact[2], way), place = [1e3 * contact[8], -1e3 * contact[9]], size = Math.hypot(x - place[0], y - place[1]);
    const along = [(x - place[0]) / size, (y - place[1]) / size], length = 0.35 * a * contact[6] / stepCam.largestForce;
    parts.push(svg('path', { ...still, class: 'force', d: `M${place[0]} ${place[1]}l${along[0] * length} ${along[1] * length}` }),
      svg('circle', { class: contact[3] ? 'contact' : 'contact spare', cx: place[0], cy: place[1], r: 1.6 }), svg('text', { class: 'letter', x: place[0] - 6 * along[0], y: place[1] - 6 * along[1] + 2 }, letter(i)));
  });
  at('moving').replaceChildren(...parts);
  const carousel = `carousel at ${shownNumber(Math.abs(way) * DEGREE)}°, ${contacts.length} rollers touch`;
  at('carousel').textContent = carousel;
  at('mechanism').setAttribute('aria-label', `The mechanism with the cam at ${angle.toFixed(1)}°: ${carousel}`);
  at('contacts').tBodies[0].replaceChildren(...contacts.map((contact, i) => element('tr', {}, element('th', { scope: 'row' }, `${letter(i)}${contact[3] ? '' : ', not needed'}`),
    element('td', {}, `${contact[1] + 1}, ${contact[2] + 1}`), ...[[contact[5] * DEGREE, '°'], [contact[6], 'N'], [1e-6 * contact[7], 'MPa'], [Math.round(1e8 * contact[4]) / 100 + 0, 'µm']].map(([value, unit]) => element('td', { class: 'number' }, withUnit(value, unit))))));
  for (const chart of document.querySelectorAll('#turn-charts svg')) markAngle(chart);
}

function turnTo(degrees) {
  angle = Math.round(10 * (((degrees % 360) + 360) % 360)) / 10 % 360;
  drawAngle();
}

let turnFrame = 0;
function turnOn(on) {
  at('turn').setAttribute('aria-pressed', String(on));
  at('turn').textContent = on ? 'Stop' : 'Turn';
  cancelAnimationFrame(turnFrame);
  if (!on) return;
  let last = performance.now();
  const next = now => {
    if (!stepCam?.made) return turnOn(false);
    turnTo(angle + 360 * (now - last) / (1e3 * SECONDS_OF_A_TURN));
    last = now;
    turnFrame = requestAnimationFrame(next);
  };
  turnFrame = requestAnimationFrame(next);
}

// ---- charts over the turn, at most four ----

function placeTurnCharts() {
  at('turn-charts').replaceChildren(...Array.from({ length: MOST_CHARTS }, (_, k) => {
    const select = element('select', { 'aria-label': `Chart ${k + 1} of ${MOST_CHARTS}` }, ...STEP_CHARTS.map(({ key, name }) => element('option', { value: key }, name)), element('option', { value: '' }, 'no chart'));
    select.value = chosenCharts[k];
    select.addEventListener('change', () => { chosenCharts[k] = select.value; forgetSizes(); drawTurnCharts(); });
    return element('div', { class: 'chart' }, element('div', { class: 'heading' }, select, element('span', { class: 'quiet', id: `turn-value-${k}` })), svg('svg', { id: `turn-chart-${k}` }));
  }));
}

// The chart of one of STEP_CHARTS, as drawChart() takes it.
function turnChart(shown) {
  const xs = stepCam.turn.map(row => row[0] * DEGREE), series = shown.columns.map((column, i) => ({ xs, ys: stepCam.turn.map(row => row[column] * shown.factor), class: i ? 'second' : '' }));
  const values = series.flatMap(each => each.ys).filter(Number.isFinite);
  return { x: [0, 360], y: rangeOf(values, shown.zero ? [0] : []), xTicks: masterTicks(360, true), xLabel: 'cam, °', yLabel: shown.unit, series, name: shown.name, label: labelOf(shown.name, values, shown.unit) };
}

function drawTurnCharts() {
  for (let k = 0; k < MOST_CHARTS; ++k) {
    const node = at(`turn-chart-${k}`), shown = STEP_CHARTS.find(each => each.key === chosenCharts[k]);
    node.parentNode.classList.toggle('empty', !shown);
    if (!shown) { node.replaceChildren(); at(`turn-value-${k}`).textContent = ''; continue; }
    node.chartFrame = drawChart(node, { ...turnChart(shown), cursor: angle });
    markAngle(node);
  }
}

// The line at the angle, and what the curves have there.
function markAngle(node) {
  const k = Number(node.id.slice(-1)), shown = STEP_CHARTS.find(each => each.key === chosenCharts[k]);
  if (!shown || !node.chartFrame) return;
  const { px, top, bottom } = node.chartFrame, values = shown.columns.map(column => stepCam.turn[indexOfAngle()][column] * shown.factor);
  node.querySelector('.cursor')?.setAttribute('d', `M${px(angle)} ${top}V${bottom}`);
  at(`turn-value-${k}`).replaceChildren(...values.flatMap((value, i) => [i ? ' ' : '', element('span', { class: i ? 'second' : 'first' }, `${{ count: ['after', 'before'], angle: ['on', 'back'], force: ['on', 'back'], pressure: ['on', 'back'] }[shown.key]?.[i] || ''} ${withUnit(value, shown.unit === '1' ? '' : shown.unit)}`)]));
}

// ---- relief ----

const reliefName = arc => `${arc.valley ? 'Valley' : 'Peak'} of cam ${arc.cam + 1} at ${shownNumber(arc.begin * DEGREE)}°`;

// What is taken off the profile of `cam`, in µm up to `top`.
function reliefChart(cam, top) {
  const profile = stepCam.profiles[cam], xs = profile.map(row => row[1] * DEGREE), ys = profile.map(row => 1e6 * (row[2] - row[3]));
  const bands = stepCam.made.arcs.filter(arc => arc.cam === cam).flatMap(arc => arc.end > 2 * Math.PI ? [[arc.begin * DEGREE, 360], [0, arc.end * DEGREE - 360]] : [[arc.begin * DEGREE, arc.end * DEGREE]]);
  return { x: [0, 360], y: [0, top], xTicks: masterTicks(360, true), xLabel: 'profile, °', yLabel: 'µm', series: [{ xs, ys, class: cam ? 'orange' : '' }], bands, name: `Relief of cam ${cam + 1}`, label: labelOf(`Relief of cam ${cam + 1}`, ys, 'µm') };
}

function drawRelief() {
  const focused = document.activeElement?.dataset?.arc, focusedBlend = document.activeElement?.dataset?.blend;
  const deepest = Math.max(20, ...stepCam.made.arcs.map(arc => 1e6 * arc.depth));
  if (!reliefDrag) stepCam.reliefTop = 1.25 * deepest;
  else stepCam.reliefTop = reliefDrag.top;
  for (const cam of [0, 1]) {
    const node = at(`relief-${cam}`), own = stepCam.made.arcs.map((arc, k) => [arc, k]).filter(([arc]) => arc.cam === cam);
    const frame = drawChart(node, { ...reliefChart(cam, stepCam.reliefTop), handles: true });
    node.chartFrame = frame;
    for (const [arc, k] of own) {
      const add = (x, y, attributes, text) => {
        const handle = svg('g', { class: `handle ${k === selectedArc ? 'selected' : ''}`, tabindex: '0', role: 'slider', ...attributes }, svg('title', {}, text), svg('circle', { class: 'reach', cx: x, cy: y, r: 14 }), svg('circle', { class: 'knob', cx: x, cy: y, r: 5.5 }));
        node.append(handle);
        return handle;
      };
      const depth = add(frame.px(0.5 * (arc.begin + arc.end) * DEGREE % 360), frame.py(Math.min(1e6 * arc.depth, stepCam.reliefTop)), { 'data-arc': k, 'aria-label': `${reliefName(arc)}: depth`, 'aria-valuemin': 0, 'aria-valuemax': 1, 'aria-valuenow': 1e3 * arc.depth, 'aria-valuetext': `${withUnit(1e3 * arc.depth, 'mm')}, blend ${withUnit(arc.blend * DEGREE, '°')}` }, `${reliefName(arc)}: ${withUnit(1e3 * arc.depth, 'mm')}`);
      if (focused === String(k)) depth.focus({ preventScroll: true });
      if (k !== selectedArc || !(arc.depth > 0)) continue;
      const blend = add(frame.px((arc.begin + Math.min(arc.blend, arc.end - arc.begin)) * DEGREE % 360), frame.py(0.4 * 1e6 * arc.depth), { 'data-blend': k, 'aria-label': `${reliefName(arc)}: blend`, 'aria-valuemin': 0, 'aria-valuemax': (arc.end - arc.begin) * DEGREE, 'aria-valuenow': arc.blend * DEGREE, 'aria-valuetext': withUnit(arc.blend * DEGREE, '°') }, `${reliefName(arc)}: blend ${withUnit(arc.blend * DEGREE, '°')}`);
      if (focusedBlend === String(k)) blend.focus({ preventScroll: true });
    }
  }
  drawArcs();
}

function drawArcs() {
  const focused = document.activeElement?.dataset?.relief;
  at('arcs').tBodies[0].replaceChildren(...stepCam.made.arcs.map((arc, k) => {
    const input = (what, value, factor) => {
      const field = element('input', { type: 'number', step: 'any', min: 0, value: plainNumber(Number((value * factor).toPrecision(9))), 'aria-label': `${reliefName(arc)}: ${what}`, 'data-relief': `${what}-${k}` });
      field.addEventListener('change', () => changeRelief(k, what, Number(field.value) / factor, false));
      return element('td', { class: 'number' }, field);
    };
    const row = element('tr', { class: k === selectedArc ? 'selected' : null }, element('th', { scope: 'row' }, `${arc.valley ? 'valley' : 'peak'}, cam ${arc.cam + 1}`),
      element('td', { class: 'number' }, withUnit(arc.begin * DEGREE, '°')), element('td', { class: 'number' }, withUnit(arc.end * DEGREE % 360, '°')), input('depth', arc.depth, 1e3), input('blend', arc.blend, DEGREE), element('td', {}, arc.alone ? 'of its own' : 'of its kind'));
    row.addEventListener('focusin', () => { if (selectedArc !== k) { selectedArc = k; at('arcs').querySelectorAll('tbody tr').forEach((each, i) => each.classList.toggle('selected', i === k)); } });
    return row;
  }));
  if (focused) at('arcs').querySelector(`[data-relief="${focused}"]`)?.focus();
}

// `value` in m or rad.
function changeRelief(arc, what, value, goesOn) {
  const done = attempt(() => {
    if (!Number.isFinite(value) || value < 0) throw new Error(`found no number of at least 0 for the ${what}; expected one`);
    engine.call('relief', { text: what, at: arc, x: value, flag: (goesOn ? 1 : 0) | (at('relief-scope').value === 'alone' ? 2 : 0) });
  });
  selectedArc = arc;
  refreshStep();
  refreshHistory();
  return done;
}

function reliefKey(event) {
  const handle = event.target.closest?.('[data-arc], [data-blend]'), direction = { ArrowUp: ['depth', 1], ArrowDown: ['depth', -1], ArrowRight: ['blend', 1], ArrowLeft: ['blend', -1] }[event.key];
  if (!handle || !direction) return;
  event.preventDefault();
  const k = Number(handle.dataset.arc ?? handle.dataset.blend), [what, sign] = direction, fine = event.shiftKey ? 0.1 : 1;
  // Hundredths of a millimetre, half degrees; what was a round number stays one.
  const factor = what === 'depth' ? 1e3 : DEGREE, value = stepCam.made.arcs[k][what] * factor + sign * fine * (what === 'depth' ? 0.01 : 0.5);
  changeRelief(k, what, Math.max(0, Number(value.toPrecision(9))) / factor, false);
}

function startReliefDrag(event) {
  const handle = event.target.closest?.('[data-arc], [data-blend]');
  if (!handle) return;
  event.preventDefault();
  const node = event.currentTarget, what = handle.dataset.arc === undefined ? 'blend' : 'depth';
  selectedArc = Number(handle.dataset.arc ?? handle.dataset.blend);
  reliefDrag = { arc: selectedArc, what, node, moved: false, top: stepCam.reliefTop, to: null };
  node.setPointerCapture(event.pointerId);
  drawRelief();
  node.querySelector(what === 'depth' ? `[data-arc="${selectedArc}"]` : `[data-blend="${selectedArc}"]`)?.focus({ preventScroll: true });
}

function dragRelief(event) {
  if (!reliefDrag) return;
  const first = reliefDrag.to === null;
  reliefDrag.to = { x: event.clientX, y: event.clientY };
  if (!first) return;
  requestAnimationFrame(() => {
    if (!reliefDrag?.to) return;
    const { arc, what, node, to } = reliefDrag, frame = node.chartFrame, shown = stepCam.made.arcs[arc];
    reliefDrag.to = null;
    // Whole micrometres and hundredths of a degree.
    const value = what === 'depth' ? Math.max(0, Math.round(frame.y(to.y))) / 1e6 : Math.max(0, Math.round(100 * ((frame.x(to.x) - shown.begin * DEGREE + 360) % 360))) / 100 / DEGREE;
    if (changeRelief(arc, what, value, reliefDrag.moved)) reliefDrag.moved = true;
  });
}

function endReliefDrag() {
  if (!reliefDrag) return;
  reliefDrag = null;
  refreshStep();
}

// ---- the project's numbers ----

function stepField(number) {
  const unit = { deg: '°', rpm: '/min', 'kg m^2': 'kg m²', um: 'µm', 'N/um': 'N/µm' }[number.unit] ?? number.unit;
  return field(number.text, number.value, unit, value => {
    attempt(() => engine.call('step_number', { text: number.name, x: value ?? 0, flag: value === null ? 0 : 1 }));
    refreshStep();
    refreshHistory();
  }, { placeholder: 'none', title: number.name, key: number.name });
}

function stepChoice(choice) {
  const options = choice.options.length ? choice.options : laws.filter(law => law.task === 'R-R' && law.kind === 'rise').map(law => law.name);
  const select = element('select', { 'data-field': choice.name }, ...options.map(option => element('option', { value: option }, { true: 'yes', false: 'no' }[option] || readable(option))));
  select.value = choice.value;
  select.addEventListener('change', () => {
    attempt(() => engine.call('step_choice', { text: `${choice.name}\0${select.value}` }));
    refreshStep();
    refreshHistory();
  });
  return element('label', {}, choice.text, select);
}

function drawGroups() {
  const focused = document.activeElement?.dataset?.field, open = new Set([...at('step-groups').querySelectorAll('details[open]')].map(each => each.dataset.group));
  at('step-groups').replaceChildren(...GROUPS.map(([name, groups], k) => element('details', { 'data-group': name, open: open.has(name) || (!open.size && k === 0) }, element('summary', {}, name),
    element('div', { class: 'fields' }, ...stepCam.numbers.filter(number => groups.includes(number.group)).map(stepField), ...stepCam.choices.filter(choice => groups.includes(choice.group)).map(stepChoice)))));
  if (focused) at('step-groups').querySelector(`[data-field="${CSS.escape(focused)}"]`)?.focus();
}

// ---- files ----

function shopFiles() {
  const { bytes, table } = engine.call('step_files', { text: `stiction ${DATA.version}` }), decoder = new TextDecoder(), files = [];
  let begin = 0;
  for (let k = 0; k < table.length; k += 2) {
    const name = decoder.decode(bytes.subarray(begin, begin + table[k]));
    begin += table[k];
    files.push({ name, bytes: bytes.subarray(begin, begin + table[k + 1]) });
    begin += table[k + 1];
  }
  return files;
}

function saveShopFile() {
  attempt(() => {
    const files = shopFiles(), wanted = at('step-file').value;
    if (wanted === 'all') return offer(`${stepCam.name}.zip`, 'application/zip', zipOf(files));
    const found = files.find(file => file.name === wanted);
    offer(found.name, 'application/octet-stream', found.bytes);
  });
}

// Files one behind the other without compression, as PKWARE's APPNOTE 6.3 has it.
function zipOf(files) {
  const crcTable = Array.from({ length: 256 }, (_, byte) => { let word = byte; for (let bit = 0; bit < 8; ++bit) word = word & 1 ? (word >>> 1) ^ 0xedb88320 : word >>> 1; return word >>> 0; });
  const crc = bytes => { let value = 0xffffffff; for (const byte of bytes) value = (value >>> 8) ^ crcTable[(value ^ byte) & 255]; return (value ^ 0xffffffff) >>> 0; };
  const encoder = new TextEncoder(), parts = [], entries = [];
  let place = 0;
  const push = bytes => { parts.push(bytes); place += bytes.length; };
  const record = (signature, numbers) => {
    const bytes = new Uint8Array(4 + numbers.reduce((sum, [size]) => sum + size, 0)), view = new DataView(bytes.buffer);
    view.setUint32(0, signature, true);
    let at = 4;
    for (const [size, value] of numbers) { if (size === 2) view.setUint16(at, value, true); else view.setUint32(at, value, true); at += size; }
    return bytes;
  };
  const UTF8 = 0x800, DAY = 0x21;  // 1 January 1980: the same files are the same archive
  for (const { name, bytes } of files) {
    const named = encoder.encode(name), common = [[2, 20], [2, UTF8], [2, 0], [2, 0], [2, DAY], [4, crc(bytes)], [4, bytes.length], [4, bytes.length], [2, named.length], [2, 0]];
    entries.push([record(0x02014b50, [[2, 20], ...common, [2, 0], [2, 0], [2, 0], [4, 0], [4, place]]), named]);
    push(record(0x04034b50, common));
    push(named);
    push(bytes);
  }
  const begin = place;
  for (const [head, named] of entries) { push(head); push(named); }
  push(record(0x06054b50, [[2, 0], [2, 0], [2, files.length], [2, files.length], [4, place - begin], [4, begin], [2, 0]]));
  const archive = new Uint8Array(place);
  let at = 0;
  for (const part of parts) { archive.set(part, at); at += part.length; }
  return archive;
}

// ---- all of it ----

function drawStepFigures() {
  if (!stepCam?.made) return;
  const figures = stepCam.figures = JSON.parse(engine.call('step_figures').text);
  at('step-figures').tBodies[0].replaceChildren(...figures.map(row => element('tr', {}, element('th', { scope: 'row' }, row.text), element('td', { class: 'number' }, row.value.replaceAll('-', '−')), element('td', {}, row.unit))));
  const key = `${stepCam.name} ${stepCam.motion}`;
  if (key === stepNames) return;
  stepNames = key;
  at('step-file').replaceChildren(element('option', { value: 'all' }, 'all, as a ZIP archive'), ...shopFiles().map(({ name }) => element('option', { value: name }, name)));
}

function refreshStep() {
  if (state.step) readStep();
  else stepCam = null;
  const made = Boolean(stepCam?.made);
  at('step-new').hidden = Boolean(stepCam);
  at('step-save').disabled = !stepCam;
  at('step-made').hidden = !made;
  at('step-edited').hidden = !stepCam;
  at('step-results').hidden = !made;
  at('step-problem').hidden = !stepCam?.problem;
  at('step-problem').textContent = stepCam?.problem ? `The step cam cannot be made: ${stepCam.problem}.` : '';
  at('step-sentence').textContent = !stepCam ? 'Two cams that turn a carousel by this motion: open a project, or begin a new one.'
    : `project ${stepCam.name}${stepCam.measured ? ', of a measured lift' : `, of the motion ${stepCam.motion}`}${made ? `; ${shownNumber(stepCam.made.stroke * DEGREE)}° in a turn, ${stepCam.made.mirrored ? 'cam 2 is cam 1 mirrored' : 'two profiles of their own'}` : ''}`;
  if (!made) turnOn(false);
  if (stepCam) { if (!reliefDrag) drawGroups(); at('step-command').textContent = `stiction cam step ${stepCam.name}.toml --out shop`; }
  if (!made) return;
  selectedArc = Math.min(selectedArc, Math.max(0, stepCam.made.arcs.length - 1));
  for (let k = 0; k < MOST_CHARTS; ++k) sizeOf(at(`turn-chart-${k}`));
  drawMechanism();
  drawTurnCharts();
  drawRelief();
  clearTimeout(stepTimer);
  stepTimer = setTimeout(drawStepFigures, STEP_DELAY);
}

let stepSoonTimer = 0;
function stepSoon() {
  clearTimeout(stepSoonTimer);
  clearTimeout(stepTimer);
  if (state.step) stepSoonTimer = setTimeout(refreshStep, MACHINE_DELAY);
  else refreshStep();
}

function listenToStep() {
  placeTurnCharts();
  at('step-new').addEventListener('click', () => { if (attempt(() => engine.call('new_step'))) { refresh(); at('step-save').focus(); } });
  at('step-save').addEventListener('click', () => attempt(() => offer(`${stepCam.name}.toml`, 'application/toml', engine.call('step_text').text)));
  at('step-export').addEventListener('click', saveShopFile);
  at('angle').addEventListener('input', () => turnTo(Number(at('angle').value)));
  at('turn').addEventListener('click', () => turnOn(at('turn').getAttribute('aria-pressed') !== 'true'));
  at('mechanism').addEventListener('wheel', event => { event.preventDefault(); turnTo(angle + Math.sign(event.deltaY || event.deltaX) * (event.shiftKey ? 0.1 : 1)); }, { passive: false });
  // The cam follows the pointer around its axis.
  let held = null;
  const pointerAngle = event => {
    const matrix = at('mechanism').getScreenCTM(), point = new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix.inverse());
    return Math.atan2(point.y, point.x) * DEGREE;
  };
  at('mechanism').addEventListener('pointerdown', event => { event.preventDefault(); held = angle - pointerAngle(event); at('mechanism').setPointerCapture(event.pointerId); });
  at('mechanism').addEventListener('pointermove', event => { if (held !== null) turnTo(held + pointerAngle(event)); });
  for (const name of ['pointerup', 'pointercancel']) at('mechanism').addEventListener(name, () => { held = null; });
  at('turn-charts').addEventListener('click', event => {
    const node = event.target.closest('svg');
    if (node?.chartFrame) turnTo(Math.min(359.9, Math.max(0, node.chartFrame.x(event.clientX))));
  });
  for (const cam of [0, 1]) {
    const node = at(`relief-${cam}`);
    node.addEventListener('pointerdown', startReliefDrag);
    node.addEventListener('pointermove', dragRelief);
    node.addEventListener('pointerup', endReliefDrag);
    node.addEventListener('pointercancel', endReliefDrag);
    node.addEventListener('keydown', reliefKey);
    node.addEventListener('focusin', event => {
      const handle = event.target.closest('[data-arc]');
      if (handle && !reliefDrag && Number(handle.dataset.arc) !== selectedArc) { selectedArc = Number(handle.dataset.arc); drawRelief(); }
    });
  }
}
