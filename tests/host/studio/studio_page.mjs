// A studio's page in a browser, for the tests that work in it: no request leaves, and the console is silent.
// The browser is $CHROMIUM, else /usr/bin/chromium-headless-shell.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

const { chromium } = createRequire(new URL('../../../host/report/web/package.json', import.meta.url))('playwright-core');
export const PATIENCE = 120000;
const CONTROLS = new Set(['button', 'spinbutton', 'slider', 'combobox', 'searchbox', 'textbox', 'radio', 'checkbox', 'link', 'listbox', 'dialog']);

export const problems = [];
export const expect = (holds, message) => { if (!holds) problems.push(message); };
export const becomes = (page, holds, argument) => page.waitForFunction(holds, argument, { timeout: PATIENCE, polling: 30 }).then(() => true, () => false);

export const launch = () => chromium.launch({ executablePath: process.env.CHROMIUM || '/usr/bin/chromium-headless-shell', timeout: PATIENCE,
  args: ['--headless', '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync', '--disable-dev-shm-usage'] });

export async function open(browser, name, { before, window = { width: 1280, height: 1000 } } = {}) {
  const address = pathToFileURL(resolve(name)).href, page = await browser.newPage({ viewport: window, colorScheme: 'light', acceptDownloads: true });
  page.setDefaultTimeout(PATIENCE);
  page.on('console', message => { if (['error', 'warning'].includes(message.type())) problems.push(`console: ${message.text()}`); });
  page.on('pageerror', error => problems.push(`script: ${error.message}`));
  page.on('request', request => { if (request.url() !== address && !/^(data|blob):/.test(request.url())) problems.push(`the page asks for ${request.url()}`); });
  if (before) await page.addInitScript(before);
  await page.goto(address, { waitUntil: 'load' });
  return page;
}

export async function saved(page, act) {
  const [download] = await Promise.all([page.waitForEvent('download'), act()]);
  return { path: await download.path(), bytes: readFileSync(await download.path()), name: download.suggestedFilename() };
}

// By the browser's own tree for screen readers: `least` controls, all with a name.
export async function checkNames(page, least) {
  const session = await page.context().newCDPSession(page), { nodes } = await session.send('Accessibility.getFullAXTree');
  const controls = nodes.filter(node => !node.ignored && CONTROLS.has(node.role?.value)), nameless = controls.filter(node => !node.name?.value?.trim());
  console.log(`controls: ${controls.length}, with a name: ${controls.length - nameless.length}`);
  expect(controls.length > least && nameless.length === 0, `${nameless.length} of ${controls.length} controls have no name: ${nameless.slice(0, 5).map(node => node.role.value).join(', ')}`);
}

// The keys of the keyboard and nothing else.
export function keyboardOf(page) {
  const reach = async selector => {
    for (let k = 0; k < 400; ++k) {
      if (await page.evaluate(selector => document.activeElement?.matches(selector), selector)) return;
      await page.keyboard.press('Tab');
    }
    expect(false, `the key Tab does not reach ${selector}`);
  };
  const press = async selector => { await reach(selector); await page.keyboard.press('Enter'); };
  const type = async (selector, text) => {
    await reach(selector);
    await page.keyboard.press('Control+a');
    await page.keyboard.type(text);
    await page.keyboard.press('Enter');
  };
  const law = async words => {
    await press('#law');
    await becomes(page, () => document.getElementById('laws').open);
    await page.keyboard.type(words);
    await page.keyboard.press('Tab');
    await page.keyboard.press('Tab');
    await page.keyboard.press('Enter');
    await becomes(page, () => !document.getElementById('laws').open);
  };
  return { reach, press, type, law };
}
