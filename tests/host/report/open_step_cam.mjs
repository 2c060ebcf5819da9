// Opens the page of a step cam in a browser and checks what a reader would see: charts with the extremes of the page's
// data, one magnified with all others, and a mechanism that turns by slider, wheel and a click into a chart, with the
// contacts of that angle in drawing and table, and the same angle in every chart.
// usage: node open_step_cam.mjs FILE.html [--screenshot FILE.png] [--width PIXELS] [--pdf FILE.pdf]
// Browser and exit codes: opened_page.mjs.
import { becomes, expect, openPage, traces } from './opened_page.mjs';

const FIELDS = 10;  // numbers of a contact
const chartIds = data => data.charts.map((_, i) => `chart-${i}`);

function decoded(floats) {
  const bytes = Buffer.from(floats, 'base64');
  return Array.from({ length: bytes.length / 4 }, (_, i) => bytes.readFloatLE(4 * i));
}

const extremes = values => values.reduce(([low, high], value) => [Math.min(low, value), Math.max(high, value)], [Infinity, -Infinity]).join(' to ');

// The contacts of the data at an angle of the cam, apart from the page's own reading.
function contactsOf(data, angle) {
  const numbers = decoded(data.mechanism.contacts), index = Math.round(angle / data.mechanism.step_deg), rows = [];
  for (let i = 0; i < numbers.length; i += FIELDS)
    if (numbers[i] === index) rows.push(numbers.slice(i, i + FIELDS));
  return rows;
}

const shownAngle = async page => Number((await page.locator('#angle-value').innerText()).replace('°', ''));

async function setSlider(page, angle) {
  await page.locator('#angle').evaluate((input, value) => { input.value = value; input.dispatchEvent(new Event('input', { bubbles: true })); }, String(angle));
}

async function checkCharts(page, data) {
  const labels = Object.fromEntries(data.series.map(series => [series.name, series.label]));
  expect(data.charts.length === 4, `the page has ${data.charts.length} charts`);
  for (const [i, chart] of data.charts.entries()) {
    const found = await traces(page, `chart-${i}`);
    expect(found.length === 2 && found.map(trace => trace.name).join() === chart.series.map(series => labels[series.name]).join(), `chart '${chart.title}' draws ${found.map(trace => trace.name).join(', ') || 'nothing'}`);
    found.forEach((trace, k) => {
      const [drawn, given] = [trace.y, decoded(chart.series[k].y)].map(extremes);
      expect(trace.y.every(Number.isFinite) && drawn === given, `'${trace.name}' of '${chart.title}' is drawn from ${drawn}, its data go from ${given}`);
    });
  }
}

// Where the drawing has its letters, against the places of the contacts in the data.
async function checkAngle(page, data, angle) {
  const wanted = contactsOf(data, angle);
  expect(wanted.length >= 2, `the data have ${wanted.length} contacts at ${angle}°`);
  const rows = await page.locator('#contacts tbody tr').evaluateAll(rows => rows.map(row => [...row.cells].map(cell => cell.textContent)));
  expect(rows.length === wanted.length, `the table has ${rows.length} contacts at ${angle}°, the data ${wanted.length}`);
  if (rows.length === wanted.length) wanted.forEach(([, cam, roller, needed, gap, pressureAngle, force, pressure], i) => {
    const says = rows[i].slice(1, 7).map(cell => Number(cell.replace('−', '-')));
    [cam, roller, pressureAngle, force, pressure, gap].forEach((value, k) => expect(Math.abs(says[k] - value) <= 0.051, `contact ${i} at ${angle}° says ${says[k]}, the data ${value}`));
    expect(rows[i][7] === (needed ? 'needed' : 'not needed'), `contact ${i} at ${angle}° is said to be ${rows[i][7]}`);
  });
  const drawing = await page.evaluate(() => ({ turn: document.getElementById('cams').getAttribute('transform'), letters: document.querySelectorAll('#moving text').length, rollers: document.querySelectorAll('#moving .roller').length,
    // Each mark of a contact lies on a roller's circle.
    off: Math.max(...[...document.querySelectorAll('#moving circle:not(.roller)')].map(mark => Math.min(...[...document.querySelectorAll('#moving .roller')].map(roller =>
      Math.abs(Math.hypot(mark.cx.baseVal.value - roller.cx.baseVal.value, mark.cy.baseVal.value - roller.cy.baseVal.value) - roller.r.baseVal.value))))) }));
  expect(drawing.turn === `rotate(${angle})`, `the cams are drawn with ${drawing.turn} at ${angle}°`);
  expect(drawing.letters === wanted.length && drawing.rollers === 2 * data.mechanism.rollers, `the drawing has ${drawing.letters} contacts and ${drawing.rollers} rollers at ${angle}°`);
  expect(drawing.off < 0.01, `a contact is drawn ${drawing.off} mm beside its roller at ${angle}°`);
  const marked = ([ids, x]) => ids.every(id => document.getElementById(id).layout.shapes.some(shape => shape.name === 'cam angle' && Math.abs(shape.x0 - x) < 1e-6));
  expect(await becomes(page, marked, [chartIds(data), angle]), `not every chart marks ${angle}°`);
}

async function checkTurning(page, data) {
  const step = data.mechanism.step_deg, some = Math.round(100 / step) * step;
  for (const angle of [some, 0, 2 * some]) {
    await setSlider(page, angle);
    expect(Math.abs(await shownAngle(page) - angle) < 0.06, `the slider at ${angle}° shows ${await shownAngle(page)}°`);
    await checkAngle(page, data, Number((Math.round(angle / step) * step)));
  }
  const before = await shownAngle(page);
  await page.locator('#drawing svg').scrollIntoViewIfNeeded();
  await page.locator('#drawing svg').hover();
  await page.mouse.wheel(0, 100);
  expect(await becomes(page, value => document.getElementById('angle-value').textContent !== value, `${before.toFixed(1)}°`, 10000), 'the wheel does not turn the cam');
  expect(Math.abs(await shownAngle(page) - before - 1) < step, `the wheel turns the cam from ${before}° to ${await shownAngle(page)}°`);
  // The end of the turn is its begin.
  await setSlider(page, 360);
  await checkAngle(page, data, 0);
  await page.locator('#chart-1').scrollIntoViewIfNeeded();
  // A click takes the curve that is under the pointer.
  const at = await page.evaluate(() => {
    const node = document.getElementById('chart-1'), box = node.getBoundingClientRect(), { xaxis, yaxis } = node._fullLayout, trace = node.data[0], i = Math.round(0.31 * trace.x.length);
    return { left: box.left + xaxis._offset + xaxis.d2p(trace.x[i]), top: box.top + yaxis._offset + yaxis.d2p(trace.y[i]), x: trace.x[i] };
  });
  await page.mouse.move(at.left, at.top);
  await becomes(page, () => document.querySelector('#chart-1 .hoverlayer').childElementCount > 0, null, 10000);
  await page.mouse.click(at.left, at.top);
  expect(await becomes(page, x => Math.abs(Number(document.getElementById('angle-value').textContent.replace('°', '')) - x) < 3, at.x, 10000), `a click at ${at.x}° of a chart shows ${await shownAngle(page)}°`);
}

async function checkMagnifying(page, data) {
  const range = id => page.evaluate(id => document.getElementById(id).layout.xaxis.range.map(each => each.toPrecision(6)).join(), id);
  const shown = ([ids, range, equal]) => ids.every(id => (document.getElementById(id).layout.xaxis.range.map(each => each.toPrecision(6)).join() === range) === equal);
  const before = await range('chart-0');
  await page.locator('#chart-0').scrollIntoViewIfNeeded();
  const box = await page.locator('#chart-0 .nsewdrag').boundingBox();
  await page.mouse.move(box.x + 0.3 * box.width, box.y + 0.5 * box.height);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 0.5 * box.height, { steps: 4 });
  await page.mouse.up();
  if (!await becomes(page, shown, [['chart-0'], before, false])) return expect(false, 'dragging over a chart does not magnify it');
  const magnified = await range('chart-0');
  expect(await becomes(page, shown, [chartIds(data), magnified, true]), 'not every chart follows the magnified abscissa');
  await setSlider(page, 200);
  await checkAngle(page, data, 200);
  expect(await becomes(page, shown, [chartIds(data), magnified, true], 5000), 'turning the cam ends the magnification');
}

async function checkSwitches(page, data) {
  const first = page.locator('#choose-series input').first();
  await first.uncheck({ force: true });
  expect((await traces(page, 'chart-0')).length === 1, 'a series that is switched off is still drawn');
  const marked = () => document.getElementById('chart-0').layout.shapes.some(shape => shape.name === 'cam angle');
  expect(await becomes(page, marked, null, 5000), 'a chart that is drawn again has lost the angle');
  await first.check({ force: true });
}

await openPage('open_step_cam', '', async (page, data) => {
  await checkCharts(page, data);
  await checkTurning(page, data);
  await checkSwitches(page, data);
  await checkMagnifying(page, data);
  const values = await page.locator('#results td.value').allInnerTexts();
  expect(values.length === data.figures.length && values.every(Boolean), `the table has ${values.length} figures, the data ${data.figures.length}`);
});
