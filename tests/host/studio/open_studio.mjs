// Opens a studio's page in a browser and works in it as a designer does: drags, moves handles by keyboard, chooses a law,
// undoes, breaks a rule, saves, opens, and drops damaged files; then an empty studio by keyboard alone, and one in a
// browser without WebAssembly. No request leaves, the console is silent, every control has a name in the browser's own
// tree for screen readers, and texts have the contrast of WCAG 2.1 AA in light and dark.
// usage: node open_studio.mjs STUDIO.html EMPTY.html FOLDER REWRITE [--screenshots FOLDER]
// FOLDER and REWRITE: of write_studio_values. The browser is $CHROMIUM, else /usr/bin/chromium-headless-shell.
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';

import { cutOff, poorContrasts } from '../report/page_checks.mjs';
import { becomes, checkNames, expect, keyboardOf, launch, open, problems, saved } from './studio_page.mjs';

const [file, empty, folder, rewrite, option, screenshots] = process.argv.slice(2);
if (!rewrite || (option && option !== '--screenshots')) {
  console.error('usage: node open_studio.mjs STUDIO.html EMPTY.html FOLDER REWRITE [--screenshots FOLDER]');
  process.exit(2);
}
const CYCLES = 3;

const motionText = page => page.evaluate(() => engine.call('motion_text').text);
const stateOf = page => page.evaluate(() => state);
const message = page => page.evaluate(() => ({ text: document.getElementById('message').textContent, bad: document.getElementById('message').className === 'bad' }));

// A motion file of the page is what the commands write of it.
async function checkSaved(page, act) {
  const found = await saved(page, act), wanted = execFileSync(rewrite, ['--rewrite', found.path]);
  expect(found.bytes.equals(wanted), `the saved ${found.name} is not what the commands write of it`);
  return found;
}

async function checkBits(page, speed) {
  for (const [name, call, options] of [['stand.bin', 'shaft', { x: speed, y: 1, flag: CYCLES }]]) {
    const wanted = readFileSync(`${folder}/${name}`);
    const found = Buffer.from(await page.evaluate(([call, options]) => {
      const bytes = new Uint8Array(engine.run(call, options).record.buffer);
      let text = '';
      for (let i = 0; i < bytes.length; i += 8192) text += String.fromCharCode(...bytes.subarray(i, i + 8192));
      return btoa(text);
    }, [call, options]), 'base64');
    expect(found.equals(wanted), `${name}: the browser's ${found.length / 8} values are not the desk's ${wanted.length / 8}`);
  }
}

async function checkDrag(page) {
  const before = await motionText(page), { undo: steps, segments: [{ stroke }] } = await stateOf(page);
  const knob = await page.locator('#chart-0 [data-handle="0"] .knob').boundingBox(), x = knob.x + knob.width / 2, y = knob.y + knob.height / 2;
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let k = 1; k <= 8; ++k) await page.mouse.move(x - 10 * k, y + 5 * k);
  await page.evaluate(() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done))));
  await page.mouse.up();
  const dragged = await stateOf(page), after = await page.locator('#chart-0 [data-handle="0"] .knob').boundingBox();
  expect(Math.abs(after.x - knob.x + 80) < 3, `the handle went from ${knob.x} to ${after.x}, dragged by -80`);
  expect(dragged.segments[0].stroke < 0.99 * stroke, 'a handle that is dragged down does not lower the position');
  expect(dragged.undo === steps + 1, `a drag is ${dragged.undo - steps} steps to undo`);
  expect(dragged.segments.length === 2 && dragged.segments[1].stroke === 0, 'a drag of the level ends the rest behind it');
  // What others do on the machine adds to most drawings, and to the quickest least.
  const drawn = await page.evaluate(() => Array.from({ length: 20 }, () => { refresh(); return times.curves; }).sort((a, b) => a - b));
  console.log(`drag: curves after ${drawn[0].toFixed(1)} ms at the quickest, ${drawn[10].toFixed(1)} ms in the median of 20 drawings`);
  const moved = await motionText(page);
  expect(moved !== before, 'a drag does not change the motion');
  await page.keyboard.press('Control+z');
  expect(await motionText(page) === before, 'undo does not bring back the motion before the drag');
  await page.keyboard.press('Control+y');
  expect(await motionText(page) === moved, 'redo does not bring back the drag');
  await page.keyboard.press('Control+z');
}

async function checkKeyboard(page) {
  const before = (await stateOf(page)).segments[0];
  await page.locator('#chart-0 [data-handle="0"]').focus();
  for (const key of ['ArrowRight', 'ArrowRight', 'Shift+ArrowLeft', 'ArrowUp']) await page.keyboard.press(key);
  const after = (await stateOf(page)).segments[0], degree = 180 / Math.PI;
  expect(Math.abs((after.length - before.length) * degree - 1.9) < 1e-9, `the arrows move the boundary by ${(after.length - before.length) * degree}°, expected 1.9`);
  expect(Math.abs((after.stroke - before.stroke) * degree - 1) < 1e-9, `the arrows move the position by ${(after.stroke - before.stroke) * degree}°, expected 1`);
  expect(await page.evaluate(() => document.activeElement?.dataset?.handle === '0'), 'a handle loses the focus when it is moved');
  const text = await page.locator('#chart-0 [data-handle="0"]').getAttribute('aria-valuetext');
  expect(text === '181.9°, 31°', `a handle is read as '${text}'`);
  for (let k = 0; k < 4; ++k) await page.keyboard.press('Control+z');
  const back = (await stateOf(page)).segments[0];
  expect(back.length === before.length && back.stroke === before.stroke, 'four undone steps do not bring back the motion');
}

async function chooseLaw(page, words) {
  await page.locator('#law').focus();
  await page.keyboard.press('Enter');
  await becomes(page, () => document.getElementById('laws').open);
  await page.keyboard.type(words);
  await page.keyboard.press('Tab');
  await page.keyboard.press('Tab');
  await page.keyboard.press('Enter');
  await becomes(page, () => !document.getElementById('laws').open);
}

async function checkLaws(page) {
  await chooseLaw(page, 'sloping sine');
  expect((await stateOf(page)).segments[0].law === 'sloping_sine', `the law is ${(await stateOf(page)).segments[0].law} after choosing the sloping sine`);
  const lambda = page.locator('#values input[data-field="λ"]');
  await lambda.fill('0.4');
  await lambda.press('Enter');
  expect((await stateOf(page)).segments[0].values.lambda === 0.4, 'λ is not taken');
  await lambda.fill('7');
  await lambda.press('Enter');
  const said = await message(page);
  expect(said.bad && /expected/.test(said.text), `λ = 7 is answered by '${said.text}'`);
  expect((await stateOf(page)).segments[0].values.lambda === 0.4, 'a refused λ changes the motion');
}

async function checkRules(page) {
  const speed = page.locator('#speed');
  await speed.fill('900');
  await speed.press('Enter');
  const rules = await page.locator('#rules li.broken').allInnerTexts();
  expect(rules.some(rule => /^✕\s*speed/.test(rule) && /allows/.test(rule)), `beyond the limits the rules say '${rules.join('; ')}'`);
  expect(await page.locator('#chart-1 .broken').count() > 0, 'a broken limit of the speed is not marked in its chart');
  expect(await page.locator('#chart-1 .level').count() > 0, 'the limit of the speed is not drawn');
  expect(await becomes(page, () => /does not run|\d/.test(document.getElementById('figures').tBodies[0].innerText)), 'beyond the limits the machine says nothing');
  await speed.fill('130');
  await speed.press('Enter');
  expect(await page.locator('#rules li.broken').count() === 0, 'the rules stay broken at the speed before');
}

async function checkSweep(page) {
  await page.locator('#sweep').click();
  expect(await becomes(page, () => document.querySelectorAll('#chart-6 .curve').length === 1 && (document.querySelector('#chart-6 .curve').getAttribute('d').match(/[ML]/g) || []).length === 21), 'the sweep of the speed does not draw its 21 speeds');
}

async function checkShaping(page) {
  const before = await motionText(page), residual = () => page.evaluate(() => shownRun.run.figures.dwell), shaken = await residual();
  await page.locator('#method').selectOption('zvd');
  await page.locator('#shape').click();
  expect(await motionText(page) !== before, 'a method of shaping does not change the motion');
  expect(await becomes(page, shaken => shownRun?.run.figures.dwell < 0.1 * shaken, shaken), `ZVD leaves ${await residual()} of ${shaken}`);
  expect(await page.locator('#chart-5 .before').count() === 1, 'the run before shaping is not drawn');
  await page.keyboard.press('Control+z');
  expect(await motionText(page) === before, 'undo does not bring back the motion before shaping');
  await page.locator('#keep').click();
}

async function checkFiles(page) {
  const file = await checkSaved(page, () => page.keyboard.press('Control+s')), before = await motionText(page);
  await page.locator('#remove').click();
  await page.locator('#file').setInputFiles({ name: 'kept.toml', mimeType: 'text/plain', buffer: file.bytes });
  expect(await becomes(page, text => engine.call('motion_text').text === text, before), 'a saved motion does not open as it was');
  const refused = async (name, content, words) => {
    await page.locator('#file').setInputFiles({ name, mimeType: 'text/plain', buffer: Buffer.from(content) });
    expect(await becomes(page, words => document.getElementById('message').className === 'bad' && document.getElementById('message').textContent.includes(words), words), `${name} is answered by '${(await message(page)).text}', expected '${words}'`);
    expect(await motionText(page) === before, `${name} changes the motion`);
  };
  await refused('newer.toml', file.bytes.toString().replace('stiction.cam/1', 'stiction.cam/2'), 'expected "stiction.cam/1"');
  await refused('cut.toml', file.bytes.subarray(0, file.bytes.length / 2), 'cut.toml');
  await refused('noise.toml', Buffer.from(Array.from({ length: 4000 }, (_, i) => (i * 7919 + 31) % 256)), 'noise.toml');
  await refused('unit.toml', file.bytes.toString().replace('deg', 'furlong'), 'furlong');
  await refused('machine.toml', 'schema = "stiction.machine/1"\nname = "none"\n', 'machine.toml');
  const table = await saved(page, () => page.locator('#points').click()), report = await saved(page, () => page.locator('#report').click());
  expect(table.bytes.toString().split('\r\n').filter(line => /^[\d.,eE+-]+$/.test(line)).length > 500, `${table.name} has no table of the curves`);
  expect(/stiction simulate cam --machine cam-stand/.test(report.bytes.toString()) && /residual over the dwell/.test(report.bytes.toString()), `${report.name} lacks the machine or its command`);
}

async function checkLooks(page) {
  for (const scheme of ['light', 'dark']) {
    await page.emulateMedia({ colorScheme: scheme });
    await becomes(page, scheme => document.documentElement.dataset.scheme === scheme, scheme);
    for (const problem of await page.evaluate(poorContrasts)) expect(false, `${scheme}: ${problem}`);
    if (screenshots) await page.screenshot({ path: `${screenshots}/studio-${scheme}.png`, fullPage: true });
  }
  await page.emulateMedia({ colorScheme: 'light' });
  await page.setViewportSize({ width: 390, height: 800 });
  await page.evaluate(() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done))));
  for (const problem of await page.evaluate(cutOff, true)) expect(false, `narrow screen: ${problem}`);
  if (screenshots) await page.screenshot({ path: `${screenshots}/studio-narrow.png`, fullPage: true });
  await page.setViewportSize({ width: 1280, height: 1000 });
}

// From an empty studio to a rise, a rest and a return, with the keys of the keyboard and nothing else.
async function designByKeyboard(browser) {
  const page = await open(browser, empty);
  expect(await becomes(page, () => engine && state), 'the empty studio does not begin');
  const { reach, press, type, law } = keyboardOf(page);
  await press('#insert');
  await press('#insert');
  await law('modified sine');
  await press('#segments [data-segment="2"]');
  await law('sloping sine');
  await press('#segments [data-segment="0"]');
  await type('#values [data-field="Stroke"]', '40');
  await reach('#chart-0 [data-handle="0"]');
  for (let k = 0; k < 10; ++k) await page.keyboard.press('ArrowRight');
  const { segments } = await stateOf(page), degree = 180 / Math.PI;
  const found = segments.map(segment => `${segment.law} ${(segment.length * degree).toFixed(6)} ${(segment.stroke * degree).toFixed(6)}`).join(', ');
  expect(found === 'modified_sine 100.000000 40.000000, linear 80.000000 0.000000, sloping_sine 180.000000 -40.000000', `by keyboard the motion is ${found}`);
  expect(await page.locator('#rules li.broken').count() === 0, 'the motion by keyboard breaks rules');
  await checkSaved(page, () => page.keyboard.press('Control+s'));
  await page.close();
}

async function checkWithoutWebAssembly(browser) {
  const page = await open(browser, file, { before: () => { delete globalThis.WebAssembly; } });
  expect(await becomes(page, () => !document.getElementById('still').hidden), 'without WebAssembly the page says nothing');
  expect(await page.locator('#still').getByText('does not run WebAssembly').isVisible() && await page.locator('#still svg path').count() > 0, 'without WebAssembly the page does not show what was computed');
  expect(await page.locator('#studio').isHidden(), 'without WebAssembly the page shows an editor');
  await page.close();
}

const browser = await launch();
try {
  const page = await open(browser, file);
  if (await becomes(page, () => document.querySelectorAll('#figures td.number').length > 3)) {
    const speed = (await page.evaluate(() => masterSpeed));
    await checkBits(page, speed);
    await checkDrag(page);
    await checkKeyboard(page);
    await checkLaws(page);
    await checkRules(page);
    await checkSweep(page);
    await checkShaping(page);
    await checkNames(page, 30);
    await checkLooks(page);
    await checkFiles(page);
    console.log(`machine, two cycles: ${(await page.evaluate(() => { drawMachine(); return times.machine; })).toFixed(0)} ms`);
  } else expect(false, 'the machine shows no figures');
  await designByKeyboard(browser);
  await checkWithoutWebAssembly(browser);
} catch (error) {
  problems.push(error.message);
}
await browser.close();
for (const problem of problems) console.error(`open_studio: ${problem}`);
if (!problems.length) console.log('open_studio: all holds');
process.exit(problems.length ? 1 : 0);
