// What the scripts that open a report in a browser have in common: their command line, the browser, what they ask of
// any page (nothing is loaded from outside, the console is silent, nothing sticks out sideways), and the verdict.
// usage: node SCRIPT.mjs FILE.html [--screenshot FILE.png] [--width PIXELS] [--pdf FILE.pdf] [MORE...]
// The browser is $CHROMIUM, else /usr/bin/chromium. Exit 0: all holds; 1: a message says what does not; 2: usage.
import { existsSync } from 'node:fs';
import { createRequire } from 'node:module';
import { resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { parseArgs } from 'node:util';

const { chromium } = createRequire(new URL('../../../host/report/web/package.json', import.meta.url))('playwright-core');

const PATIENCE = 120000;  // ms; a page is slow on a machine that compiles, or runs the other tests, at the same time

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

// Names of a chart's traces and their points, as the chart library holds them.
export function traces(page, chart) {
  return page.evaluate(id => (document.getElementById(id).data || []).map(trace => ({ name: trace.name, x: Array.from(trace.x), y: Array.from(trace.y) })), chart);
}

function pageData(page) {
  return page.evaluate(() => JSON.parse(document.getElementById('data').textContent));
}

async function checkAnyPage(page) {
  expect((await page.locator('.headline').innerText()).length > 10, 'the page has no headline');
  const wide = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
  expect(wide <= 0, `the page is ${wide} pixels wider than the window`);
}

// Opens the page of the command line, runs `checks`(page, the page's data, what else the command line says), and ends
// the process.
export async function openPage(script, more, checks) {
  const { options, file, rest } = parse(script, more);
  const address = pathToFileURL(resolve(file)).href;
  const open = async browser => {
    const page = await browser.newPage({ viewport: { width: Number(options.width), height: 1000 } });
    page.setDefaultTimeout(PATIENCE);
    page.on('console', message => { if (['error', 'warning'].includes(message.type())) problems.push(`console: ${message.text()}`); });
    page.on('pageerror', error => problems.push(`script: ${error.message}`));
    page.on('request', request => {
      if (request.url() !== address && !/^(data|blob):/.test(request.url())) problems.push(`the page asks for ${request.url()}`);
    });
    await page.goto(address, { waitUntil: 'load' });
    await checkAnyPage(page);
    await checks(page, await pageData(page), rest);
    if (options.screenshot) await page.screenshot({ path: options.screenshot, fullPage: true });
    if (options.pdf) await page.pdf({ path: options.pdf, preferCSSPageSize: true, printBackground: true });
  };
  try {
    const browser = await chromium.launch({ executablePath: process.env.CHROMIUM || '/usr/bin/chromium', timeout: PATIENCE,
      args: ['--headless', '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
             '--disable-component-update', '--disable-sync', '--disable-dev-shm-usage'] });  // /dev/shm is small in containers
    await open(browser).finally(() => browser.close());
  } catch (error) {
    problems.push(error.message);
  }
  for (const problem of problems) console.error(`${script}: ${file}: ${problem}`);
  if (!problems.length) console.log(`${script}: ${file}: all holds`);
  process.exit(problems.length ? 1 : 0);
}
