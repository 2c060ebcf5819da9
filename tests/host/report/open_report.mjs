// Opens a report of the circle in a browser and checks what a reader would see: every chart has its traces, another
// feed and another magnification draw other data, nothing is loaded from outside, the console is silent.
// usage: node open_report.mjs FILE.html [--screenshot FILE.png] [--width PIXELS] [--pdf FILE.pdf] [TRACE...]
//   TRACE: names that must stand in the charts, instead of those that the page's own data name.
// Browser and exit codes: opened_page.mjs.
import { expect, openPage, traces } from './opened_page.mjs';

let expectedNames = [];

async function drawn(page, chart) {
  return JSON.stringify(await traces(page, chart));
}

async function choose(page, control, value) {
  await page.locator(`#${control} input[value="${value}"]`).check({ force: true });
}

function labelsOf(data, runs) {
  const models = data.models.filter(model => runs.some(run => run.friction === model.name));
  return models.map(model => model.label);
}

async function checkTraces(page, data) {
  const here = data.runs.filter(run => run.feed === data.selected_feed && run.direction === data.directions[0]);
  const measuredHere = data.references.some(row => row.measured && row.axis === data.axes[0] && Math.abs(row.feed - data.selected_feed) < 1e-4 * row.feed);
  const measured = data.references.some(row => row.measured && data.axes.includes(row.axis));
  const labels = expectedNames.length ? expectedNames.filter(name => name !== 'measured') : labelsOf(data, here);
  const wanted = {
    ...(data.axes.length === 2 ? { polar: labels } : {}),
    quadrant: [...labels, ...(expectedNames.length ? expectedNames.includes('measured') : measuredHere) ? ['measured'] : []],
    lap: labels,
    peaks: [...(expectedNames.length ? labels : labelsOf(data, data.runs)), ...(expectedNames.length ? expectedNames.includes('measured') : measured) ? ['measured'] : []],
  };
  for (const [chart, names] of Object.entries(wanted)) {
    const found = await traces(page, chart);
    for (const name of names)
      expect(found.some(trace => trace.name.startsWith(name)), `chart '${chart}' has no trace '${name}'; it has: ${[...new Set(found.map(trace => trace.name))].join(', ') || 'none'}`);
    for (const trace of found)
      expect(trace.y.length > 0 && trace.y.every(Number.isFinite), `trace '${trace.name}' of chart '${chart}' is empty or not finite`);
  }
}

// The largest value drawn over the lap is the printed peak.
async function checkPeaks(page, data) {
  const found = await traces(page, 'lap');
  for (const run of data.runs.filter(each => each.feed === data.selected_feed && each.direction === data.directions[0])) {
    const label = data.models.find(model => model.name === run.friction).label;
    const peaks = found.filter(trace => trace.name === label).map(trace => Math.max(...trace.y.map(Math.abs)));
    const printed = [...run.axes.map(axis => axis.peak_error), ...run.axes.map(axis => axis.peak_current)];
    printed.forEach((peak, i) =>
      expect(Math.abs(peak - peaks[i]) <= 1e-5 * Math.abs(peak) + 1e-9, `'${label}' is drawn with a peak of ${peaks[i]}, printed with ${peak}`));
  }
}

async function checkControls(page, data) {
  const circle = data.axes.length === 2, overview = circle ? 'polar' : 'lap';
  const fresh = { lap: await drawn(page, 'lap'), quadrant: await drawn(page, 'quadrant') };
  if (circle) {
    fresh.polar = await drawn(page, 'polar');
    const otherMagnification = page.locator('#choose-magnification input:not(:checked):not(:disabled)').first();
    await choose(page, 'choose-magnification', await otherMagnification.getAttribute('value'));
    expect(await drawn(page, 'polar') !== fresh.polar, 'another magnification draws the same circle');
    expect(await drawn(page, 'lap') === fresh.lap, 'the magnification changes the lap');
  } else {
    expect(await page.locator('#polar, #iso-values, #choose-magnification').count() === 0, 'a sine is shown as a circle');
  }
  await choose(page, 'choose-quadrant', circle ? 90 : 180);
  expect(await drawn(page, 'quadrant') !== fresh.quadrant, 'another quadrant draws the same errors');
  const otherFeed = data.feeds.find(feed => feed !== data.selected_feed);
  if (otherFeed !== undefined) {
    await choose(page, 'choose-feed', otherFeed);
    expect(await drawn(page, 'lap') !== fresh.lap, 'another feed draws the same lap');
  }
  if (data.directions.length > 1) {
    const one = (await traces(page, 'polar')).length;
    await choose(page, 'choose-direction', 'both');
    expect((await traces(page, 'polar')).length > one, 'both directions draw no more circles than one');
    await choose(page, 'choose-direction', data.directions[0]);
  }
  const shown = (await traces(page, overview)).length;
  await page.locator('#choose-models input').first().uncheck({ force: true });
  expect((await traces(page, overview)).length < shown, 'a model that is switched off is still drawn');
  await page.locator('#choose-models input').first().check({ force: true });
  await choose(page, 'choose-feed', data.selected_feed);
  await choose(page, 'choose-quadrant', 0);
  if (circle) await choose(page, 'choose-magnification', 1000).catch(() => {});  // may be disabled
}

// A lap passes each of the four reversals once; X reverses at 0 and 180 degrees, Y at 90 and 270. One axis has two.
async function checkReversals(page, data) {
  const marks = await page.evaluate(() => document.getElementById('lap').layout.annotations.map(mark => mark.text));
  const [x, y] = data.axes;
  for (const mark of [`${x} reverses, 0°`, `${x} reverses, 180°`, ...(y ? [`${y} reverses, 90°`, `${y} reverses, 270°`] : [])])
    expect(marks.filter(each => each === mark).length === 1, `the lap does not mark '${mark}' once; it marks: ${marks.join(', ')}`);
}

async function checkText(page, data) {
  const rows = await page.locator('#table tbody tr').count();
  expect(rows === data.table.length, `the table has ${rows} rows, the data ${data.table.length}`);
}

await openPage('open_report', '[TRACE...]', async (page, data, names) => {
  expectedNames = names;
  await checkTraces(page, data);
  await checkPeaks(page, data);
  await checkReversals(page, data);
  await checkText(page, data);
  await checkControls(page, data);
});
