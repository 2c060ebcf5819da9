// The report of the work: one page without scripts that opens offline, with every figure that the studio shows, its
// unit, the charts as pictures, and the command that repeats it. The motion and the project are in it as they are saved.
'use strict';

const REPORT_CHART = { width: 460, height: 200 };
const REPORT_STYLE = `
body { max-width: 1020px; padding-bottom: 40px; }
h2 { margin: 26px 0 6px; border-top: 1px solid var(--line); padding-top: 14px; }
h3 { margin-top: 14px; color: var(--ink); font-weight: 600; }
figure { margin: 0; min-width: 0; }
figure svg { display: block; width: 100%; height: auto; }
figcaption { font-weight: 600; }
#mechanism { max-width: 620px; cursor: default; }
table { width: auto; min-width: min(100%, 420px); margin-top: 8px; }
pre { padding: 10px 14px; background: var(--faint); border-radius: 6px; font: 12.5px/1.5 ui-monospace, Menlo, Consolas, monospace; white-space: pre-wrap; overflow-wrap: anywhere; }
.wide { overflow-x: auto; }
@media print { h2 { break-after: avoid; } figure, tr { break-inside: avoid; } }`;

// A chart as a picture of its own size; it is never part of the page.
function picture(chart) {
  const node = svg('svg', {});
  placeSizes.set(node, REPORT_CHART);
  drawChart(node, chart);
  placeSizes.delete(node);
  return element('figure', {}, element('figcaption', {}, chart.name), node);
}

const pictures = charts => element('div', { class: 'pair' }, ...charts.map(picture));
const repeated = (text, command) => element('p', { class: 'repeat' }, `${text} `, element('code', {}, command));

// Cells that begin with a digit or a sign are numbers, but for the unit 1.
function reportTable(heads, rows) {
  const cell = text => element('td', { class: /^[−\d]/.test(text) && text !== '1' ? 'number' : null }, text);
  return element('div', { class: 'wide' }, element('table', {}, element('thead', {}, element('tr', {}, ...heads.map(head => element('th', { scope: 'col' }, head)))),
    element('tbody', {}, ...rows.map(([first, ...others]) => element('tr', {}, element('th', { scope: 'row' }, first), ...others.map(cell))))));
}

const ofCam = () => state.cams.length > 1 ? ` --cam ${shellWord(state.name)}` : '';
const machineOption = () => ` --machine ${shellWord(machineName.replace(/[.]toml$/, ''))}`;
const shellWord = text => /^[\w./-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`;

function motionReport() {
  const u = shownUnits(), columns = readCurves(), parts = [element('h2', {}, 'Motion')], motion = shellWord(motionName);
  const parameters = segment => Object.entries(segment.values).map(([key, value]) => `${readable(key)} = ${shownNumber(value)}`).join(', ') || '–';
  parts.push(reportTable(['Segment', 'Law', 'Ends at', 'Position', 'Stroke', 'Parameters', 'Forced speed at its end'], state.segments.map((segment, k) => [String(k + 1), readable(segment.law),
    withUnit(endOf(k) * u.master, u.masterUnit), withUnit(positionOf(k) * u.slave, u.slaveUnit), withUnit(segment.stroke * u.slave, u.slaveUnit), parameters(segment),
    segment.speed === null ? 'free' : withUnit(segment.speed * u.slave / u.master, state.master === state.slave ? '' : `${u.slaveUnit}/${u.masterUnit}`)])));
  if (state.tracks.length) parts.push(element('h3', {}, 'Switch tracks'), reportTable(['Track', 'On', 'On compensation', 'Off compensation', 'Hysteresis'], state.tracks.map(track => [track.name,
    track.windows.map(([first, last]) => `${withUnit(first * u.master, u.masterUnit)} to ${withUnit(last * u.master, u.masterUnit)}`).join(', '), withUnit(1e3 * track.on, 'ms'), withUnit(1e3 * track.off, 'ms'), withUnit(track.hysteresis * u.master, u.masterUnit)])));
  const charts = ['position', 'speed', 'acceleration', 'jerk', 'product', ...(state.machine ? ['effort'] : []), 'spectrum'].map(key => curveChart(key, columns, u));
  parts.push(element('h3', {}, `Curves at ${speedText()} of the master`), pictures(charts), reportTable(['Curve', 'Lowest', 'Highest', 'Unit'], charts.map(({ name, yLabel, series: [{ ys }] }) => {
    const [low, high] = ys.reduce(([a, b], y) => [Math.min(a, y), Math.max(b, y)], [Infinity, -Infinity]);
    return [name, shownNumber(low), shownNumber(high), yLabel];
  })));
  parts.push(state.machine ? repeated('Curves, torque and spectrum are repeated by', `stiction cam design ${motion}${ofCam()}${machineOption()} --speed "${speedText()}" --out design`)
    : repeated('The curves are repeated by', `stiction cam studio ${motion} --speed "${speedText()}" --out studio.html`));
  parts.push(element('h2', {}, 'Rules'), element('ul', { id: 'rules' }, ...[...at('rules').children].map(row => row.cloneNode(true))),
    repeated('Repeated by', `stiction cam check ${motion}${ofCam()}${state.machine ? `${machineOption()} --speed "${speedText()}"` : ''}`));
  return parts;
}

function machineReport() {
  if (!state.machine) return [];
  const parts = [element('h2', {}, `Machine: ${state.machine.name}`), element('p', { class: 'quiet' }, at('machine-sentence').textContent)];
  if (!shownRun) return [...parts, element('p', { class: 'bad' }, at('figures').innerText), repeated('Repeated by', repeatingCommand())];
  parts.push(pictures([machineChart()]), reportTable(['Figure', 'Value', 'Unit'], figureRows(shownRun.run).map(row => [row.text, row.value, row.unit])), repeated('Repeated by', repeatingCommand()));
  if (kept) parts.push(element('p', { class: 'quiet' }, 'The grey curve is the run that was kept to be compared with.'));
  if (swept) {
    const { xs, ys } = swept.series[0], u = shownUnits();
    parts.push(element('h3', {}, 'Sweep of the speed'), pictures([swept]), reportTable([swept.xLabel, swept.yLabel, 'Repeated by'], Array.from(xs, (x, k) => [shownNumber(x), shownNumber(ys[k]), repeatingCommand(x / u.speed)])));
  }
  return parts;
}

function stepReport() {
  if (!stepCam?.made) return [];
  const command = `stiction cam step ${shellWord(`${stepCam.name}.toml`)} --out shop`, drawing = at('mechanism').cloneNode(true), contacts = at('contacts').cloneNode(true);
  const arcs = stepCam.made.arcs.map(arc => [`${arc.valley ? 'valley' : 'peak'}, cam ${arc.cam + 1}`, withUnit(arc.begin * DEGREE, '°'), withUnit(arc.end * DEGREE % 360, '°'), withUnit(1e3 * arc.depth, 'mm'), withUnit(arc.blend * DEGREE, '°'), arc.alone ? 'of its own' : 'of its kind']);
  return [element('h2', {}, 'Step cam'), element('p', { class: 'quiet' }, at('step-sentence').textContent), element('h3', {}, `The mechanism with the cam at ${angle.toFixed(1)}°`), element('figure', {}, drawing), contacts,
    element('h3', {}, 'Over a turn of the cam'), pictures(STEP_CHARTS.map(turnChart)), element('p', { class: 'quiet' }, 'Blue: the contact that pushes on, or after relief; green: the one that holds back, or before relief.'),
    element('h3', {}, 'Relief'), pictures([0, 1].map(cam => reliefChart(cam, stepCam.reliefTop))), reportTable(['Arc', 'From', 'To', 'Depth', 'Blend', 'Relief'], arcs),
    element('h3', {}, 'Figures'), reportTable(['Figure', 'Value', 'Unit'], stepCam.figures.map(row => [row.text, row.value.replaceAll('-', '−'), row.unit])), repeated('All of it is repeated by', command)];
}

// The report as HTML. What still waits to be computed is computed first, so that all of it is of the same motion.
function reportPage() {
  refreshStep();
  drawStepFigures();
  clearTimeout(machineTimer);
  drawMachine();
  const head = element('head', {}, element('meta', { charset: 'utf-8' }), element('meta', { name: 'viewport', content: 'width=device-width, initial-scale=1' }),
    element('meta', { 'http-equiv': 'Content-Security-Policy', content: "default-src 'none'; style-src 'unsafe-inline'" }), element('meta', { name: 'generator', content: `stiction ${DATA.version}` }),
    element('title', {}, `Cam ${state.name}: report`), element('style', {}, document.querySelector('head > style').textContent + REPORT_STYLE));
  const files = [[motionName, engine.call('motion_text').text], ...(stepCam ? [[`${stepCam.name}.toml`, engine.call('step_text').text]] : [])];
  const body = element('body', {}, element('header', { class: 'bar' }, element('div', { class: 'name' }, element('p', { class: 'kind' }, 'Cam studio: report'), element('h1', {}, state.name))),
    element('p', {}, `Motion ${motionName}${state.machine ? `, machine ${machineName}` : ''}${stepCam ? `, step cam ${stepCam.name}.toml` : ''}; speed of the master ${speedText()}.`),
    ...motionReport(), ...machineReport(), ...stepReport(), element('h2', {}, 'Files'), element('p', { class: 'quiet' }, 'The commands above read these files.'),
    ...files.flatMap(([name, text]) => [element('h3', {}, name), element('pre', {}, text)]), element('footer', {}, element('p', { class: 'quiet' }, `stiction ${DATA.version}`)));
  const html = element('html', { lang: 'en', 'data-scheme': 'light' }, head, body);
  return `<!doctype html>\n${html.outerHTML}\n`;
}

const saveReport = () => attempt(() => offer(`${state.name}-report.html`, 'text/html', reportPage()));
