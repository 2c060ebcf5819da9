// The report of the work: what the page shows, picture and figure with its unit, and the command that repeats it, as a page
// of its own that opens offline. studio.js and step.js have what it tells.
'use strict';

const NOT_IN_REPORT = '.handle, .cursor';

// A chart or a drawing as it is on the page, without what is there to be moved.
function picture(node, name) {
  if (!node.childElementCount) return null;
  const copy = node.cloneNode(true), { width, height } = node.getBoundingClientRect();
  copy.removeAttribute('id');
  copy.setAttribute('role', 'img');
  copy.querySelectorAll('[id]').forEach(each => each.removeAttribute('id'));
  copy.querySelectorAll(NOT_IN_REPORT).forEach(each => each.remove());
  if (!copy.hasAttribute('viewBox')) copy.setAttribute('viewBox', `0 0 ${Math.max(240, width)} ${Math.max(100, height)}`);
  // As large as it was: text is no larger in one picture than in another.
  if (!node.hasAttribute('viewBox')) copy.setAttribute('style', `max-width: ${Math.max(240, width)}px`);
  return element('figure', {}, element('figcaption', {}, name), copy);
}

const pictures = (...figures) => element('div', { class: 'pictures' }, ...figures);

function tableOf(head, rows) {
  return element('table', {}, element('thead', {}, element('tr', {}, ...head.map(text => element('th', { scope: 'col' }, text)))),
    element('tbody', {}, ...rows.map(([first, ...rest]) => element('tr', {}, element('th', { scope: 'row' }, first), ...rest.map(text => element('td', {}, text))))));
}

const repeatedBy = command => element('p', { class: 'quiet repeat' }, 'Repeated by ', element('code', {}, command));
const sectionOf = (name, ...parts) => element('section', {}, element('h2', {}, name), ...parts);
const figureTable = rows => tableOf(['Figure', 'Value', 'Unit'], rows.map(row => [row.text, row.value, row.unit]));
// The text of a cell or a heading on the page: of a field its value.
const textOf = node => node.querySelector?.('input')?.value ?? node.textContent;
const rowsShown = id => [...at(id).tBodies[0].rows].map(row => [...row.cells].map(textOf));
const headShown = id => [...at(id).tHead.rows[0].cells].map(textOf);

function motionSection() {
  const u = shownUnits(), machine = machineName?.replace(/[.]toml$/, '');
  const segments = state.segments.map((segment, k) => [String(k + 1), segment.law, withUnit(endOf(k) * u.master, u.masterUnit), withUnit(positionOf(k) * u.slave, u.slaveUnit), withUnit(segment.stroke * u.slave, u.slaveUnit)]);
  const curves = ['Position', 'Speed', 'Acceleration', 'Jerk', at('fourth').selectedOptions[0].textContent];
  return [sectionOf('Motion', tableOf(['Segment', 'Law', 'Ends at', 'Position', 'Stroke'], segments), pictures(...curves.map((name, k) => picture(at(`chart-${k}`), name)))),
    sectionOf('Rules', repeatedBy(`stiction cam check ${motionName}${machine ? ` --machine ${machine}` : ''} --speed "${speedText()}"`),
      element('ul', {}, ...[...at('rules').children].map(row => element('li', {}, `${row.classList.contains('broken') ? 'broken: ' : ''}${row.lastChild.textContent}`))))];
}

function machineSection() {
  if (!shownRun) return [];
  const compared = kept ? ' Grey: the run that is kept to be compared with.' : '';
  return [sectionOf(`Machine: ${state.machine.name}`, repeatedBy(repeatingCommand()), figureTable(figureRows(shownRun.run)), pictures(picture(at('chart-5'), `${at('machine-chart-name').textContent}.${compared}`),
    at('swept').hidden ? null : picture(at('chart-6'), at('sweep-name').textContent)))];
}

function stepSection() {
  refreshStep();
  if (!stepCam?.made) return [];
  drawStepFigures();
  const charts = chosenCharts.map((key, k) => [STEP_CHARTS.find(each => each.key === key), at(`turn-chart-${k}`)]).filter(([shown]) => shown);
  return [sectionOf(`Step cam: ${stepCam.name}`, repeatedBy(at('step-command').textContent), figureTable(stepCam.figures),
    picture(at('mechanism'), at('mechanism').getAttribute('aria-label')), tableOf(headShown('contacts'), rowsShown('contacts')),
    pictures(...charts.map(([shown, node]) => picture(node, shown.columns.length > 1 ? `${shown.name}; blue ${shown.key === 'count' ? 'after' : 'on'}, green ${shown.key === 'count' ? 'before' : 'back'}` : shown.name)),
      ...[0, 1].map(cam => picture(at(`relief-${cam}`), `Relief of cam ${cam + 1}`))), tableOf(headShown('arcs'), rowsShown('arcs')),
    ...GROUPS.map(([name, groups]) => [name, stepCam.numbers.filter(number => groups.includes(number.group) && number.value !== null)]).filter(([, numbers]) => numbers.length)
      .flatMap(([name, numbers]) => [element('h3', {}, name), tableOf(['Number', 'Value', 'Unit'], numbers.map(number => [number.text, shownNumber(number.value, 9), shownUnit(number.unit)]))]))];
}

// The whole page, UTF-8.
function reportPage() {
  const main = element('main', { class: 'report' }, element('p', { class: 'kind' }, 'Cam studio: report'), element('h1', {}, state.name),
    element('p', {}, `Motion: ${motionName}. Speed of the master: ${speedText()}.`), ...motionSection(), ...machineSection(), ...stepSection(),
    element('footer', {}, element('p', { class: 'quiet' }, `Written by stiction ${DATA.version}.`)));
  const style = document.querySelector('head > style').textContent;
  return `<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n<meta name="viewport" content="width=device-width, initial-scale=1">\n`
    + `<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'">\n<title>${element('p', {}, `Report: ${state.name}`).innerHTML}</title>\n<style>${style}</style>\n</head>\n<body>\n${main.outerHTML}\n</body>\n</html>\n`;
}
