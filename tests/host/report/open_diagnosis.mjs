// Opens the report of a diagnosis in a browser and checks what a reader would see: every chart drawn with all its
// series, every cause with value, evidence, effect on the part, confusions and advice, what was rejected, what is left.
// usage: node open_diagnosis.mjs FILE.html [--screenshot FILE.png] [--width PIXELS] [--pdf FILE.pdf]
// Browser and exit codes: opened_page.mjs.
import { expect, openPage, traces } from './opened_page.mjs';

await openPage('open_diagnosis', '', async (page, data) => {
  const rows = id => page.locator(`#${id} tbody tr`).count();
  for (const [i, chart] of data.charts.entries()) {
    const drawn = await traces(page, `chart-${i}`);
    expect(drawn.length === chart.series.length && drawn.every(trace => trace.y.length > 2), `the chart "${chart.title}" is not drawn`);
    expect(await page.locator(`#${chart.place} #chart-${i}`).count() === 1, `the chart "${chart.title}" stands in another place`);
    expect(/,|^time/.test(chart.x_label) && chart.y_label.includes(','), `the chart "${chart.title}" has an axis without unit`);
  }
  expect(await page.locator('section.cause').count() === data.causes.length, 'not every cause has its section');
  if (data.causes.length) expect(await rows('summary') === data.causes.length, 'not every cause stands in the summary');
  const summary = data.causes.length ? await page.locator('#summary').innerText() : '';
  for (const [i, cause] of data.causes.entries()) {
    if (cause.sure) expect(summary.includes(cause.sure), `the summary does not say "${cause.sure}"`);
    const says = await page.locator(`#cause-${i}`).innerText();
    for (const words of [cause.title, cause.on_part, cause.advice, ...cause.confused_with.map(row => row.separate_by)])
      expect(says.includes(words), `the section of ${cause.name} does not say "${words}"`);
    for (const row of cause.parameters)
      if (row.low !== null) expect(Number(row.low) <= Number(row.value) && Number(row.value) <= Number(row.high), `${row.label} lies outside its interval`);
  }
  if (data.rows.length) expect(await rows('rows') === data.rows.length, 'not every measured row is listed');
  else expect(await page.locator('#rows-section').count() === 0, 'an empty table of measured rows is shown');
  if (data.next) {
    const says = await page.locator('#next-section').innerText();
    if (data.next.what) {
      expect(await rows('next-table') === data.next.rows.length, 'not every trajectory is listed');
      expect(says.includes(data.next.questions[0]), 'what is open is not said');
    }
    if (data.next.spectrum) {
      expect(says.includes(data.next.spectrum), 'the spectrum of the proposed cam is not said');
      expect(says.includes('stiction simulate cam') && says.includes('next_measurement_cam.toml'), 'it is not said what simulates the cam');
    } else expect(await page.locator('#next-spectrum').count() === 0, 'an empty spectrum is shown');
    for (const row of data.next.elsewhere) expect(says.includes(row.separate_by), `"${row.separate_by}" is not said`);
  } else expect(await page.locator('#next-section').count() === 0, 'an empty proposal is shown');
  if (data.rejected.length) expect(await rows('rejected') === data.rejected.length, 'not every rejected cause is listed');
  else expect(await page.locator('#rejected-section').count() === 0, 'an empty table of rejected causes is shown');
  expect((await page.locator('#unexplained').innerText()).length > 20, 'nothing is said of what remains');
  expect(await page.locator('#notes li').count() === data.notes.length, 'not every note is listed');
});
