// What the scripts that open a report in a browser have in common: their command line, the browser, what they ask of
// any page (nothing is loaded from outside, the console is silent, page_checks.mjs holds in light, dark, on a narrow
// screen and on paper), and the verdict.
// usage: node SCRIPT.mjs FILE.html [--screenshot FILE.png] [--width PIXELS] [--pdf FILE.pdf] [MORE...]
// The browser is $CHROMIUM, else /usr/bin/chromium-headless-shell. Exit 0: all holds; 1: a message says what does not; 2: usage.
import { existsSync, readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { parseArgs } from 'node:util';

import { axesWithoutUnit, confusableSeries, cutOff, poorContrasts } from './page_checks.mjs';

const { chromium } = createRequire(new URL('../../../host/report/web/package.json', import.meta.url))('playwright-core');

const PATIENCE = 120000;  // ms; a page is slow on a machine that compiles, or runs the other tests, at the same time
// ms for all that is asked of a page, some 20 s of computing. Now and then a browser stops answering for good, and the
// questions to the page have no limit of their own: a second browser is asked then. A page that hangs does so in both.
const ATTEMPT = 300000;

const problems = [];
export function expect(holds, message) {
  if (!holds) problems.push(message);
}

function parse(script, more) {
  const usage = message => {
    console.error(`${script}: ${message}\nusage: node ${script}.mjs FILE.html [--screenshot FILE.png] [--width PIXELS] [--pdf FILE.pdf] ${more}`.trimEnd());
    process.exit(2);
  };
  try {
    const { values: options, positionals: [file, ...rest] } = parseArgs({ allowPositionals: true, options: {
      screenshot: { type: 'string' }, width: { type: 'string', default: '1400' }, pdf: { type: 'string' } } });
    if (!file) usage('no file given');
    if (!existsSync(file)) usage(`${file} does not exist`);
    return { options, file, rest };
  } catch (error) {
    return usage(error.message);
  }
}

// Waits until `holds`(argument), a function that runs in the page, is true; false when it is not in all the time.
export async function becomes(page, holds, argument, timeout = PATIENCE) {
  return page.waitForFunction(holds, argument, { timeout, polling: 50 }).then(() => true, () => false);
}

// Names of a chart's traces, their points and the symbols of these where each has its own, as the chart library holds them.
// As one string: value by value, which is what a page's answer is sent as, takes longer than all else that is asked.
export async function traces(page, chart) {
  return JSON.parse(await page.evaluate(id => JSON.stringify((document.getElementById(id).data || []).map(trace => (
    { name: trace.name, x: Array.from(trace.x), y: Array.from(trace.y), symbols: Array.isArray(trace.marker?.symbol) ? trace.marker.symbol : [] }))), chart));
}

function pageData(page) {
  return page.evaluate(() => JSON.parse(document.getElementById('data').textContent));
}

// Two frames: what a change of the window started has been drawn.
const drawn = page => page.evaluate(() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done))));
const sized = page => becomes(page, () => [...document.querySelectorAll('.js-plotly-plot')].every(chart => Math.abs(chart._fullLayout.width - chart.clientWidth) < 2), null, 10000);

const NARROW = { width: 375, height: 800 }, PAPER = { width: 702, height: 1000 };  // A4 less its margins, pixels of CSS

// What holds for a report of any kind: the head, units at every axis, contrast and telling series apart in light and
// dark, everything whole on a narrow screen and on paper.
async function checkAnyPage(page, window) {
  const ask = async (where, question, argument) => {
    for (const answer of await page.evaluate(question, argument)) expect(false, `${where}: ${answer}`);
  };
  const sentence = await page.locator('.headline').innerText();
  expect(/^\S.{20,}[.]$/.test(sentence) && !/[.] [A-Z]/.test(sentence), `the head is not one sentence: '${sentence}'`);
  for (const term of ['Date', 'Machine', 'Source files', 'Version', 'Command line'])
    expect(await page.locator('.origin dt', { hasText: new RegExp(`^${term}$`) }).count() === 1, `the head does not say '${term}'`);
  expect(await page.locator('details.sheet-of-machine:not([open])').count() === 1, 'the machine sheet is not folded');
  await ask('axes', axesWithoutUnit);
  for (const scheme of ['light', 'dark']) {
    await page.emulateMedia({ colorScheme: scheme });
    await drawn(page);
    expect(await page.evaluate(() => document.documentElement.dataset.scheme) === scheme, `the page does not follow the system to ${scheme}`);
    await ask(scheme, poorContrasts);
    await ask(scheme, confusableSeries);
  }
  await page.emulateMedia({ colorScheme: 'light' });
  await ask('wide screen', cutOff, false);
  await page.setViewportSize(NARROW);
  expect(await sized(page), 'the charts do not follow a narrow window');
  await ask('narrow screen', cutOff, true);
  await page.setViewportSize(PAPER);
  await page.emulateMedia({ media: 'print', colorScheme: 'dark' });
  await page.evaluate(() => dispatchEvent(new Event('beforeprint')));
  await drawn(page);
  expect(await page.evaluate(() => document.documentElement.dataset.scheme) === 'light', 'a dark page is printed dark');
  expect(await page.locator('details.sheet-of-machine[open]').count() === 1, 'the machine sheet is folded on paper');
  await ask('paper', cutOff, false);
  await ask('paper', poorContrasts);
  await page.evaluate(() => dispatchEvent(new Event('afterprint')));
  await page.emulateMedia({ media: 'screen', colorScheme: 'light' });
  await page.setViewportSize(window);
  expect(await sized(page), 'the charts do not return to the window after printing');
}

// The file that a button of a chart saves.
async function saved(page, chart, words) {
  const [download] = await Promise.all([page.waitForEvent('download'), page.locator(`.tools[data-of="${chart}"] button`, { hasText: words }).click()]);
  return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
}

// What is below the first chart: cursors by mouse and keyboard, and the chart saved as picture and as table.
async function checkTools(page) {
  const chart = await page.evaluate(() => document.querySelector('.js-plotly-plot')?.id);  // an agreement may have none
  if (!chart) return;
  const cursors = page.locator(`.tools[data-of="${chart}"] button`, { hasText: 'Cursors' }), readout = page.locator(`.tools[data-of="${chart}"] + .readout`);
  expect(await readout.isHidden(), 'cursors are read out before they are chosen');
  await cursors.click();
  const changes = async (what, act) => {
    const before = await readout.innerText();
    await act();
    expect(await readout.innerText() !== before, `${what} moves no cursor of '${chart}'`);
  };
  await changes('a key', () => page.keyboard.press('Shift+ArrowRight'));
  await changes('a key after b', async () => { await page.keyboard.press('b'); await page.keyboard.press('Shift+ArrowLeft'); });
  const box = await page.locator(`#${chart} .nsewdrag`).first().boundingBox();
  // A click may fall where a cursor stands already; of three places that happens at one.
  const seen = new Set();
  for (const share of [0.05, 0.5, 0.95]) {
    await page.mouse.click(box.x + share * box.width, box.y + 0.5 * box.height);
    seen.add(await readout.innerText());
  }
  expect(seen.size > 1, `the mouse moves no cursor of '${chart}'`);
  const [a, b] = await page.evaluate(id => FIGURES.get(id).cursors.map(({ curve, point }) => { const trace = FIGURES.get(id).traces[curve]; return [trace.x[point], trace.y[point]]; }), chart);
  const told = (await readout.innerText()).match(/Δx (\S+) .*Δy (\S+)/)?.slice(1).map(value => Number(value.replace('−', '-'))) || [];
  for (const k of [0, 1]) expect(Math.abs(told[k] - (b[k] - a[k])) <= 1e-4 * Math.abs(b[k] - a[k]), `the cursors of '${chart}' differ by ${b[k] - a[k]} and are said to differ by ${told[k]}`);
  await page.keyboard.press('Escape');
  expect(await readout.isHidden(), 'Escape leaves the cursors');

  const picture = await saved(page, chart, 'PNG'), drawing = await saved(page, chart, 'SVG'), points = await saved(page, chart, 'CSV');
  expect(picture.bytes.subarray(1, 4).toString() === 'PNG' && picture.bytes.readUInt32BE(16) >= 1800, `${picture.name} is not a picture of at least 1800 pixels`);
  const lines = points.bytes.toString().split('\r\n').filter(Boolean), header = lines.find(line => !line.startsWith('#')), rows = lines.slice(lines.indexOf(header) + 1);
  expect(drawing.bytes.toString().startsWith('<svg') && drawing.bytes.toString().includes(await page.locator('h1').innerText()), `${drawing.name} does not have the page's title`);
  const names = await page.evaluate(id => FIGURES.get(id).traces.filter(readable).map(trace => trace.name), chart);
  expect(header.split(',').every(column => /\[[^\]]+\]"?$/.test(column)) && header.split(',').length > names.length - 1, `${points.name} has the header '${header}'`);
  expect(rows.length >= 2 && rows.every(row => row.split(',').length === header.split(',').length), `${points.name} has ${rows.length} rows, not all as long as the header`);
}

// What `work` resolves to, or undefined when that takes longer than `limit` ms.
async function within(limit, work) {
  let timer;
  const late = new Promise(done => { timer = setTimeout(done, limit); });
  return Promise.race([work, late]).finally(() => clearTimeout(timer));
}

// Opens the page of the command line, runs `checks`(page, the page's data, what else the command line says), and ends
// the process.
export async function openPage(script, more, checks) {
  const { options, file, rest } = parse(script, more);
  const address = pathToFileURL(resolve(file)).href;
  const open = async browser => {
    const window = { width: Number(options.width), height: 1000 };
    const page = await browser.newPage({ viewport: window, colorScheme: 'light' });
    page.setDefaultTimeout(PATIENCE);
    page.on('console', message => { if (['error', 'warning'].includes(message.type())) problems.push(`console: ${message.text()}`); });
    page.on('pageerror', error => problems.push(`script: ${error.message}`));
    page.on('request', request => {
      if (request.url() !== address && !/^(data|blob):/.test(request.url())) problems.push(`the page asks for ${request.url()}`);
    });
    await page.goto(address, { waitUntil: 'load' });
    await checkAnyPage(page, window);
    await checkTools(page);
    await checks(page, await pageData(page), rest);
    if (options.screenshot) await page.screenshot({ path: options.screenshot, fullPage: true });
    if (options.pdf) await page.pdf({ path: options.pdf, preferCSSPageSize: true, printBackground: true });
  };
  let late = `within ${ATTEMPT / 1000} s`;
  // What went wrong on the way; undefined where the browser did not answer. It may not close either then: the end of
  // this process ends it.
  const attempt = async () => {
    try {
      const browser = await chromium.launch({ executablePath: process.env.CHROMIUM || '/usr/bin/chromium-headless-shell', timeout: PATIENCE,
        args: ['--headless', '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
               '--disable-component-update', '--disable-sync', '--disable-dev-shm-usage'] });  // /dev/shm is small in containers
      await open(browser).finally(() => browser.close());
      return [];
    } catch (error) {
      if (error.name !== 'TimeoutError') return [error.message];
      late = error.message.split('\n')[0];
      return undefined;
    }
  };
  let errors = await within(ATTEMPT, attempt());
  if (!errors) {
    console.error(`${script}: ${file}: the browser does not answer (${late}); a second one is asked`);
    problems.length = 0;
    errors = await within(ATTEMPT, attempt()) || [`a second browser does not answer (${late})`];
  }
  problems.push(...errors);
  for (const problem of problems) console.error(`${script}: ${file}: ${problem}`);
  if (!problems.length) console.log(`${script}: ${file}: all holds`);
  process.exit(problems.length ? 1 : 0);
}
