// Opens the report of an experiment in a browser and checks what a reader would see: every chart draws its series with
// the extremes that the page's data have, a series that is switched off leaves all charts, charts with the same
// abscissa are magnified together, and the figures stand in their table with the mark they deserve.
// usage: node open_experiment.mjs FILE.html [--screenshot FILE.png] [--width PIXELS] [--pdf FILE.pdf]
// Browser and exit codes: opened_page.mjs.
import { becomes, expect, openPage, traces } from './opened_page.mjs';

const chartIds = data => data.charts.map((_, i) => `chart-${i}`);

function decoded(floats) {
  const bytes = Buffer.from(floats, 'base64');
  return Array.from({ length: bytes.length / 4 }, (_, i) => bytes.readFloatLE(4 * i));
}

const extremes = values => values.reduce(([low, high], value) => [Math.min(low, value), Math.max(high, value)], [Infinity, -Infinity]).join(' to ');

async function checkCharts(page, data) {
  const labels = Object.fromEntries(data.series.map(series => [series.name, series.label]));
  for (const [i, chart] of data.charts.entries()) {
    const found = await traces(page, `chart-${i}`);
    expect(found.map(trace => trace.name).join() === chart.series.map(series => labels[series.name]).join(),
           `chart '${chart.title}' draws ${found.map(trace => trace.name).join(', ') || 'nothing'}`);
    found.forEach((trace, k) => {
      expect(trace.y.length > 0 && trace.y.every(Number.isFinite), `'${trace.name}' of '${chart.title}' is empty or not finite`);
      const [drawn, given] = [trace.y, decoded(chart.series[k].y)].map(extremes);
      expect(drawn === given, `'${trace.name}' of '${chart.title}' is drawn from ${drawn}, its data go from ${given}`);
    });
    const shown = await page.evaluate(id => [...document.querySelectorAll(`#${id} .xtitle, #${id} .ytitle`)].map(node => [...node.querySelectorAll('tspan')].map(line => line.textContent).join(' ') || node.textContent), `chart-${i}`);
    const below = data.charts[i + (chart.wide ? 1 : 2)];  // without a title: it has the abscissa of both
    for (const label of below && !below.title ? [chart.y_label] : [chart.x_label, chart.y_label])
      expect(shown.includes(label), `chart '${chart.title}' has no axis '${label}'; it has: ${shown.join(', ')}`);
  }
}

async function checkSwitches(page, data) {
  const count = async () => (await Promise.all(chartIds(data).map(id => traces(page, id)))).map(found => found.length);
  const all = await count();
  for (const { name, label } of data.series) {
    const input = page.locator('#choose-series input').nth(data.series.findIndex(series => series.name === name));
    await input.uncheck({ force: true });
    const without = await count();
    data.charts.forEach((chart, i) => expect(without[i] === all[i] - chart.series.filter(series => series.name === name).length,
                                             `'${label}' is switched off and still drawn in '${chart.title}'`));
    await input.check({ force: true });
  }
  expect((await count()).join() === all.join(), 'a series that is switched on again is not drawn again');
}

async function checkMagnifying(page, data) {
  const linked = chart => chart.x_label === data.charts[0].x_label && chart.record === data.charts[0].record;
  const ids = chartIds(data).filter((_, i) => linked(data.charts[i])), others = chartIds(data).filter((_, i) => !linked(data.charts[i]));
  const shown = ([ids, range, equal]) =>
    ids.every(id => (document.getElementById(id).layout.xaxis.range.map(each => each.toPrecision(6)).join() === range) === equal);
  const range = id => page.evaluate(id => document.getElementById(id).layout.xaxis.range.map(each => each.toPrecision(6)).join(), id);
  const before = await range(ids[0]), beside = (await Promise.all(others.map(range))).join(' ');
  await page.locator('#chart-0').scrollIntoViewIfNeeded();  // the findings above it may fill the window
  const box = await page.locator('#chart-0 .nsewdrag').boundingBox();
  await page.mouse.move(box.x + 0.3 * box.width, box.y + 0.5 * box.height);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 0.5 * box.height, { steps: 4 });
  await page.mouse.up();
  if (!await becomes(page, shown, [ids.slice(0, 1), before, false])) return expect(false, 'dragging over a chart does not magnify it');
  expect(await becomes(page, shown, [ids, await range(ids[0]), true]), 'not every chart of the record follows the magnified abscissa');
  expect((await Promise.all(others.map(range))).join(' ') === beside, 'a chart of another record or abscissa follows');
  // Two clicks are a double one only when the page sees them within 300 ms, which a busy machine may miss.
  let back = false;
  for (let tries = 0; tries < 10 && !back; ++tries) {
    await page.mouse.dblclick(box.x + 0.4 * box.width, box.y + 0.5 * box.height);
    back = await becomes(page, shown, [ids, before, true], 3000);
  }
  await page.mouse.move(0, 0);
  expect(back, 'not every chart comes back from its magnification');
}

async function checkFigures(page, data) {
  const rows = await page.locator('#results tbody tr').allInnerTexts();
  const values = await page.locator('#results td.value').allInnerTexts();
  expect(values.length === data.figures.length, `the table has ${values.length} figures, the data ${data.figures.length}`);
  if (rows.length === values.length) data.figures.forEach((figure, i) => {
    const row = rows[i] || '', before = data.figures[i - 1];
    const sourceAbove = before && ['text', 'unit', 'source'].every(key => before[key] === figure[key]);
    for (const part of [figure.value, figure.unit, figure.expected, sourceAbove ? '' : figure.source])
      expect(row.includes(part.replace('-', '−')) || row.includes(part), `row ${i} has no '${part}': ${row}`);
    const mark = figure.holds === null ? (data.figures.some(each => each.holds !== null) ? '—' : '') : figure.holds ? 'as expected' : 'differs';
    expect(row.includes(mark), `row ${i} does not say '${mark}': ${row}`);
  });
  else  // a matrix with one column a model
    for (const figure of data.figures)
      expect(rows.some(row => row.includes(figure.text) && row.includes(figure.value.replace('-', '−'))), `no row has '${figure.text}' with ${figure.value}`);
  const marked = await page.locator('#results td.differs.value').count();
  expect(marked === data.figures.filter(figure => figure.holds === false).length, `${marked} values are marked as different`);
  const sentence = await page.locator('.headline').innerText();
  if (data.figures.some(figure => figure.holds !== null)) expect(sentence.includes(data.verdict.slice(0, -1)), `the sentence '${sentence}' does not say '${data.verdict}'`);
}

await openPage('open_experiment', '', async (page, data) => {
  await checkCharts(page, data);
  await checkFigures(page, data);
  await checkSwitches(page, data);
  await checkMagnifying(page, data);
});
