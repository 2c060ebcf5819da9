// Opens the report of an identification in a browser and checks what a reader would see: every parameter with its
// interval, what was not determined, the curve with its band and points, the residual of every log.
// usage: node open_identification.mjs FILE.html [--screenshot FILE.png] [--width PIXELS] [--pdf FILE.pdf]
// Browser and exit codes: opened_page.mjs.
import { expect, openPage, traces } from './opened_page.mjs';

await openPage('open_identification', '', async (page, data) => {
  const rows = id => page.locator(`#${id} tbody tr`).count();
  expect(await rows('parameters') === data.parameters.length, 'not every parameter stands in its table');
  for (const row of data.parameters)
    expect(Number(row.low) <= Number(row.value) && Number(row.value) <= Number(row.high), `${row.label} lies outside its interval`);
  if (data.open.length) expect(await rows('open') === data.open.length, 'not everything that is open stands in its table');
  if (data.curve) {
    const drawn = await traces(page, 'characteristic');
    const line = drawn.find(trace => trace.name === `${data.curve.curve} curve`);
    expect(line && line.y.length === data.curve.force.length && line.y.every(Number.isFinite), 'the sliding curve is not drawn');
    const points = drawn.filter(trace => trace.name.startsWith('measured')).reduce((sum, trace) => sum + trace.y.length, 0);
    expect(points === data.curve.measured.length && points > 0, `${points} measured points are drawn, the data have ${data.curve.measured.length}`);
    expect(data.curve.force.every((force, i) => data.curve.low[i] <= force && force <= data.curve.high[i]), 'the curve leaves its band');
  }
  if (data.band && data.band.cutoff.length > 1)
    for (const i of data.band.charts.keys()) {
      const [drawn] = await traces(page, `band-${i}`);
      expect(drawn && drawn.y.length === data.band.cutoff.length, `${drawn && drawn.y.length} cut-offs are drawn, ${data.band.cutoff.length} were tried`);
      const filled = drawn.x.filter((_, k) => drawn.symbols[k] === 'circle');
      expect(filled.length === 1 && filled[0] === data.band.cutoff[data.band.chosen], 'the chosen cut-off is not marked');
    }
  for (const i of data.residuals.keys()) {
    const [residual] = await traces(page, `residual-${i}`);
    expect(residual && residual.y.length > 10 && residual.y.every(Number.isFinite), `the residual of ${data.residuals[i].name} is not drawn`);
  }
  await page.locator('#choose-scheme input[value="dark"]').check({ force: true });
  // The browser keeps what a page stores a while after it says so: on a busy machine a page that is loaded at once may be
  // given what was stored before. What is never kept is not there a second later either.
  const isDark = () => page.evaluate(() => document.documentElement.dataset.scheme === 'dark');
  for (let tries = 0; tries < 5; ++tries) {
    await page.reload({ waitUntil: 'load' });
    if (await isDark()) break;
    await page.waitForTimeout(200);
  }
  expect(await isDark(), 'the chosen scheme is not kept');
  await page.locator('#choose-scheme input[value="auto"]').check({ force: true });
  expect(await page.evaluate(() => document.documentElement.dataset.scheme) === 'light', 'auto does not lead back to the scheme of the system');
});
