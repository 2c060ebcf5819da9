// Works on a step cam in the studio as a designer does. By keyboard alone, from an empty studio: a motion that steps, a new
// project, its numbers, relief of both cams, and the files for the shop, which must be those that `stiction cam step`
// writes of the saved project and motion. Then a studio of a project by mouse: the cam turned by wheel, drag and play, the
// charts linked to the drawing, relief dragged, tracks, cams, files that are refused.
// usage: node open_step_cam.mjs STEP.html EMPTY.html STICTION PROJECT FOLDER [--screenshots FOLDER]
import { execFileSync, spawnSync } from 'node:child_process';
import { mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

import { cutOff, poorContrasts } from '../report/page_checks.mjs';
import { becomes, checkNames, expect, keyboardOf, launch, open, problems, saved } from './studio_page.mjs';

const [file, empty, stiction, project, folder, option, screenshots] = process.argv.slice(2);
if (!folder || (option && option !== '--screenshots')) {
  console.error('usage: node open_step_cam.mjs STEP.html EMPTY.html STICTION PROJECT FOLDER [--screenshots FOLDER]');
  process.exit(2);
}
const degree = 180 / Math.PI, WINDOW = { width: 1280, height: 3000 };
const message = page => page.evaluate(() => ({ text: document.getElementById('message').textContent, bad: document.getElementById('message').className === 'bad' }));
const relief = page => page.evaluate(() => stepCam.made.arcs.map(({ depth, blend, alone }) => ({ depth, blend, alone })));
const projectText = page => page.evaluate(() => engine.call('step_text').text);
const settled = page => page.evaluate(() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done))));

// The entries of an archive without compression.
function unzipped(bytes) {
  const files = new Map();
  for (let at = 0; bytes.readUInt32LE(at) === 0x04034b50;) {
    const size = bytes.readUInt32LE(at + 18), named = bytes.readUInt16LE(at + 26), begin = at + 30 + named;
    files.set(bytes.subarray(at + 30, begin).toString(), bytes.subarray(begin, begin + size));
    at = begin + size;
  }
  return files;
}

async function designByKeyboard(browser) {
  const page = await open(browser, empty);
  // Whoever goes on behind what failed waits for keys that nothing answers.
  const holds = condition => { if (!condition) throw new Error(`by keyboard: ${problems.pop() || 'the design ended'}`); };
  expect(await becomes(page, () => engine && state), 'the empty studio does not begin');
  const { reach, press, type, law } = keyboardOf(page), begun = problems.length;
  await type('#values [data-field="Endless, modulo"]', '90');
  await press('#insert');
  await press('#insert');
  await press('#segments [data-segment="1"]');
  await law('modified sine');
  await type('#values [data-field="Ends at"]', '270');
  await type('#values [data-field="Stroke"]', '90');
  await press('#step-new');
  expect(await becomes(page, () => stepCam?.made), `the new step cam cannot be made: ${await page.evaluate(() => stepCam?.problem)}`);
  holds(problems.length === begun);
  await press('#step-groups [data-group="Load"] summary');
  await type('#step-groups [data-field="load.stiffness"]', '100');
  await type('#step-groups [data-field="load.preload"]', '10');
  await press('#step-groups [data-group="Wheel and files"] summary');
  await type('#step-groups [data-field="wheel_radius"]', '12');
  await press('#step-groups [data-group="Relief"] summary');
  await type('#step-groups [data-field="relief.lead_in"]', '4');
  const arcs = (await relief(page)).length;
  expect(arcs === 4, `the new step cam has ${arcs} arcs without needed contacts, expected 4`);
  holds(problems.length === begun);
  for (const kind of [true, false]) {
    const k = await page.evaluate(kind => stepCam.made.arcs.findIndex(arc => arc.valley === kind), kind);
    await reach(`[data-arc="${k}"]`);
    holds(problems.length === begun);
    for (let times = 0; times < 10; ++times) await page.keyboard.press('ArrowUp');
  }
  for (const { depth, blend } of await relief(page)) expect(Math.abs(depth - 1e-4) < 1e-12 && Math.abs(blend * degree - 4) < 1e-9, `by keyboard an arc is lowered by ${1e3 * depth} mm with blends of ${blend * degree}°`);
  await reach('#step-file');
  expect(await becomes(page, () => document.getElementById('step-file').options.length > 8), 'the files for the shop are not listed');
  const archive = await saved(page, () => press('#step-export')), made = unzipped(archive.bytes);
  const motion = await saved(page, () => page.keyboard.press('Control+s')), step = await saved(page, () => press('#step-save'));
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(folder, { recursive: true });
  writeFileSync(`${folder}/${motion.name}`, motion.bytes);
  writeFileSync(`${folder}/${step.name}`, step.bytes);
  execFileSync(stiction, ['cam', 'step', `${folder}/${step.name}`, '--out', `${folder}/shop`], { stdio: 'pipe' });
  compareFolder(made, `${folder}/shop`);
  expect(made.get(step.name)?.equals(step.bytes) && made.get(motion.name)?.equals(motion.bytes), 'the saved project and motion are not those of the archive');
  console.log(`by keyboard alone: both cams relieved, ${made.size} files exported, equal to the command's`);
  await page.close();
}

// All but the page, which the command alone writes.
function compareFolder(made, shop) {
  const names = readdirSync(shop).filter(name => name !== 'report.html' && !name.startsWith('.')).sort();
  expect(names.join() === [...made.keys()].sort().join(), `the page exports ${[...made.keys()].join(', ')}, the command ${names.join(', ')}`);
  for (const name of names) expect(made.get(name)?.equals(readFileSync(`${shop}/${name}`)), `the page's ${name} is not the command's`);
}

async function checkTurning(page) {
  await page.locator('#mechanism').waitFor({ state: 'visible' });
  const angle = () => page.evaluate(() => angle), box = await page.locator('#mechanism').boundingBox();
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 0.5 * box.height);
  await page.mouse.wheel(0, 100);
  expect(await becomes(page, () => angle === 1), `the wheel turns the cam to ${await angle()}°, expected 1`);
  const centre = await page.evaluate(() => { const place = new DOMPoint(0, 0).matrixTransform(document.getElementById('mechanism').getScreenCTM()); return [place.x, place.y]; });
  await page.mouse.move(centre[0] + 60, centre[1]);
  await page.mouse.down();
  await page.mouse.move(centre[0], centre[1] + 60, { steps: 6 });
  await page.mouse.up();
  expect(Math.abs(await angle() - 91) < 1.5, `a quarter of a turn by the pointer brings the cam to ${await angle()}°, expected 91`);
  const rows = await page.locator('#contacts tbody tr').count(), shown = await page.evaluate(() => stepCam.contacts[indexOfAngle()].length);
  expect(rows === shown && rows >= 2, `${rows} contacts are listed, ${shown} are there`);
  const chart = await page.locator('#turn-chart-0').boundingBox();
  await page.mouse.click(chart.x + 0.6 * chart.width, chart.y + 0.5 * chart.height);
  expect(await angle() > 180 && await angle() < 260, `a click into a chart turns the cam to ${await angle()}°`);
  const lines = await page.evaluate(() => [...document.querySelectorAll('#turn-charts .cursor')].map(line => line.getAttribute('d').slice(0, 8)));
  expect(lines.length === 4 && new Set(lines).size === 1, `the charts have the lines ${lines.join(' ')}`);
  expect(await page.locator('#turning').getAttribute('transform') === `rotate(${await angle()})`, 'the drawing is not at the angle of the charts');
  await page.locator('#turn-charts select').nth(3).selectOption('input');
  expect(await page.locator('#turn-chart-3').getAttribute('aria-label').then(label => /Torque of the cam shaft/.test(label)), 'a different chart is not drawn');
  const before = await angle();
  await page.locator('#turn').click();
  expect(await becomes(page, before => Math.abs(angle - before) > 1, before), 'the cam does not turn by itself');
  await page.locator('#turn').click();
}

async function checkRelief(page) {
  const before = await projectText(page), old = await relief(page), knob = await page.locator('#relief-0 [data-arc="0"] .knob').boundingBox();
  const drag = async (scope, lift) => {
    await page.locator('#relief-scope').selectOption(scope);
    // An undo is drawn a moment later: the handle is where it was until then.
    const shown = () => page.locator('#relief-0 [data-arc="0"]').getAttribute('aria-valuenow');
    expect(await becomes(page, depth => Number(document.querySelector('#relief-0 [data-arc="0"]').getAttribute('aria-valuenow')) === depth, 1e3 * old[0].depth), `the handle is at ${await shown()} mm; expected ${1e3 * old[0].depth}`);
    const at = await page.locator('#relief-0 [data-arc="0"] .knob').boundingBox(), x = at.x + at.width / 2, y = at.y + at.height / 2;
    await page.mouse.move(x, y);
    await page.mouse.down();
    for (let k = 1; k <= 5; ++k) { await page.mouse.move(x, y + lift * k / 5); await settled(page); }
    await page.mouse.up();
  };
  expect(knob !== null, 'an arc has no handle');
  await drag('kind', 30);
  const all = await relief(page), kind = await page.evaluate(() => stepCam.made.arcs.map(arc => arc.valley === stepCam.made.arcs[0].valley));
  expect(all.every(({ depth }, k) => kind[k] ? depth < old[k].depth && depth === all[0].depth : depth === old[k].depth), `dragged down, the depths are ${all.map(arc => 1e3 * arc.depth).join(', ')} mm`);
  await page.keyboard.press('Control+z');
  expect(await projectText(page) === before, 'a drag of the relief is not one step to undo');
  await drag('alone', 20);
  const one = await relief(page);
  expect(one[0].alone && one[0].depth < old[0].depth && one.slice(1).every(({ depth }, k) => depth === old[k + 1].depth), 'a drag of one arc alone changes others');
  await page.keyboard.press('Control+z');
  await page.locator('#relief-scope').selectOption('kind');
  const depth = page.locator('#arcs input').first();
  await depth.fill('40');
  await depth.press('Enter');
  const said = await message(page);
  expect(said.bad && /expected less/.test(said.text), `a relief of 40 mm is answered by '${said.text}'`);
  expect(await projectText(page) === before, 'a refused relief changes the project');
  await page.locator('#arcs input').first().fill('0.05');
  await page.locator('#arcs input').first().press('Enter');
  expect(Math.abs((await relief(page))[0].depth - 0.05e-3) < 1e-15, `a depth of 0.05 mm that is typed is taken as ${1e3 * (await relief(page))[0].depth} mm: ${(await message(page)).text}`);
  await page.keyboard.press('Control+z');
}

async function checkMotionBehind(page) {
  // The motion is the lift: what cannot be built is said, and undo brings the drawing back.
  await page.locator('#segments [data-segment="1"]').click();
  await page.locator('#values [data-field="Stroke"]').fill('80');
  await page.locator('#values [data-field="Stroke"]').press('Enter');
  expect(await becomes(page, () => /whole number/.test(document.getElementById('step-problem').textContent)), `a step of 80° with 4 rollers is answered by '${await page.locator('#step-problem').textContent()}'`);
  expect(await page.locator('#step-made').isHidden(), 'a step cam that cannot be built is drawn');
  await page.locator('#undo').click();
  expect(await becomes(page, () => stepCam?.made && !document.getElementById('step-made').hidden), 'undo does not bring back the step cam');
}

async function checkTracksAndCams(page) {
  await page.locator('#add-track').click();
  await page.locator('#add-track').click();
  await page.locator('#tracks [data-field="track 1"]').fill('gripper');
  await page.locator('#tracks [data-field="track 1"]').press('Enter');
  await page.locator('#tracks [data-field="track 1 on 0"]').fill('350');
  await page.locator('#tracks [data-field="track 1 on 0"]').press('Enter');
  await page.locator('#tracks [data-field="track 1 off_compensation"]').fill('-3');
  await page.locator('#tracks [data-field="track 1 off_compensation"]').press('Enter');
  const tracks = await page.evaluate(() => state.tracks);
  expect(tracks.length === 2 && tracks[1].name === 'gripper' && Math.abs(tracks[1].windows[0][0] * degree - 350) < 1e-9 && tracks[1].off === -0.003, `the tracks are ${JSON.stringify(tracks)}`);
  await page.locator('#tracks [data-field="track 1 hysteresis"]').fill('-1');
  await page.locator('#tracks [data-field="track 1 hysteresis"]').press('Enter');
  expect((await message(page)).bad && (await page.evaluate(() => state.tracks[1].hysteresis)) === 0, 'a negative hysteresis is taken');
  for (let k = 0; k < 5; ++k) await page.keyboard.press('Control+z');
  const text = await page.evaluate(() => engine.call('motion_text').text), second = text.replace('[cam.carousel]', '[cam.second]').replaceAll('cam.carousel.', 'cam.second.');
  const two = text + second.slice(second.indexOf('[cam.second]'));
  await page.locator('#file').setInputFiles({ name: 'two.toml', mimeType: 'text/plain', buffer: Buffer.from(two) });
  expect(await becomes(page, () => state.cams.length === 2), 'a file of two cams does not open');
  // The list of cams appears with the file, some frames later on a busy computer.
  await page.locator('#cam').waitFor({ state: 'visible' });
  await page.locator('#cam').selectOption({ label: 'second' });
  expect(await page.evaluate(() => state.name) === 'second', 'the second cam is not edited');
  await page.locator('#add-track').click();
  const both = await page.evaluate(() => engine.call('motion_text').text);
  expect(both.includes('[[cam.second.track]]') && !both.includes('[[cam.carousel.track]]') && both.includes('[cam.carousel]'), 'editing one cam of a file loses or changes the other one');
  for (let k = 0; k < 3; ++k) await page.keyboard.press('Control+z');
  expect(await page.evaluate(() => engine.call('motion_text').text) === text, 'undo does not bring back the file of one cam');
}

async function checkFiles(page) {
  const before = await projectText(page), given = readFileSync(project, 'utf8');
  const step = await saved(page, () => page.locator('#step-save').click());
  await page.locator('#file').setInputFiles({ name: step.name, mimeType: 'text/plain', buffer: step.bytes });
  expect(await becomes(page, name => document.getElementById('message').textContent === `${name} is open.`, step.name) && await projectText(page) === before, 'a saved project does not open as it was');
  const refused = async (name, content, words) => {
    await page.locator('#file').setInputFiles({ name, mimeType: 'text/plain', buffer: Buffer.from(content) });
    expect(await becomes(page, words => document.getElementById('message').className === 'bad' && document.getElementById('message').textContent.includes(words), words), `${name} is answered by '${(await message(page)).text}', expected '${words}'`);
    expect(await projectText(page) === before, `${name} changes the project`);
  };
  await refused('newer.toml', given.replace('step-cam/1', 'step-cam/2'), 'expected "stiction.step-cam/1"');
  await refused('cut.toml', given.slice(0, given.indexOf('poisson')), 'cut.toml');
  await refused('spring.toml', given.slice(0, given.indexOf('[relief]')).replace(/^(preload|stiffness).*$/mg, '') + '[spring]\nrate = "1 N m/rad"\npreload = "1 N m"\n', 'single cam with a spring');
}

// The report of a motion with a machine and a step cam: a page by itself, whose commands run on the files that it shows;
// that of the step cam writes its figures.
async function checkReport(browser, page) {
  const machine = fileURLToPath(new URL('../../../firmware/machine/shipped/cam-stand.toml', import.meta.url));
  await page.locator('#file').setInputFiles(machine);
  expect(await becomes(page, () => state.machine && document.querySelectorAll('#figures td.number').length > 3), 'the machine does not run the motion of the step cam');
  const written = await saved(page, () => page.locator('#report').click()), place = `${folder}/report`;
  mkdirSync(place, { recursive: true });
  writeFileSync(`${place}/report.html`, written.bytes);
  const report = await open(browser, `${place}/report.html`);
  if (screenshots) await report.screenshot({ path: `${screenshots}/step-report.png`, fullPage: true });
  expect(await report.locator('figure svg:not([role="img"])').count() === 0, 'a picture of the report has no name for a screen reader');
  expect(await report.locator('[tabindex], script').count() === 0, 'the report has something to be moved');
  const { charts, commands, files, rows } = await report.evaluate(() => ({ charts: document.querySelectorAll('figure svg .curve').length, commands: [...document.querySelectorAll('code')].map(each => each.textContent),
    files: [...document.querySelectorAll('pre')].map(each => [each.previousElementSibling.textContent, each.textContent]), rows: [...document.querySelectorAll('tbody tr')].map(row => [...row.children].map(cell => cell.textContent)) }));
  expect(charts >= 7 + 1 + 8 + 2, `the report has ${charts} curves`);
  for (const problem of await report.evaluate(poorContrasts)) expect(false, `report: ${problem}`);
  for (const problem of await report.evaluate(cutOff, false)) expect(false, `report: ${problem}`);
  await report.close();
  for (const [name, text] of files) writeFileSync(`${place}/${name}`, text);
  const kinds = ['cam design', 'cam check', 'simulate cam', 'cam step'];
  for (const kind of kinds) {
    const command = commands.find(each => each.startsWith(`stiction ${kind} `)) || `echo no command ${kind}; false #`;
    const run = spawnSync('bash', ['-c', command.replace(/^stiction/, '"$STICTION"')], { cwd: place, env: { ...process.env, STICTION: stiction }, encoding: 'utf8' });
    // What the motion breaks is said by the status of `cam check`.
    expect(run.status === 0 || (kind === 'cam check' && run.status === 1), `the report's '${command}' ends with ${run.status}: ${run.stdout} ${run.stderr}`);
    if (kind !== 'cam step') continue;
    const figures = rows.filter(([text]) => /^(largest (contact|Hertz|torque of the c|load)|highest|worst|exactly)/.test(text)).map(([text, value]) => [text, value.replaceAll('−', '-')]);
    const wanted = readFileSync(`${place}/shop/report.html`, 'utf8'), missing = figures.filter(([text, value]) => !wanted.includes(text) || !wanted.includes(value));
    expect(figures.length >= 7 && missing.length === 0, `of ${figures.length} figures of the report those of '${command}' lack ${missing.join('; ')}`);
    console.log(`report: ${commands.length} commands, ${charts} curves`);
  }
}

async function checkLooks(page) {
  for (const scheme of ['light', 'dark']) {
    await page.emulateMedia({ colorScheme: scheme });
    await becomes(page, scheme => document.documentElement.dataset.scheme === scheme, scheme);
    for (const problem of await page.evaluate(poorContrasts)) expect(false, `${scheme}: ${problem}`);
    if (screenshots) await page.screenshot({ path: `${screenshots}/step-${scheme}.png`, fullPage: true });
  }
  await page.emulateMedia({ colorScheme: 'light' });
  await page.setViewportSize({ width: 400, height: 800 });
  await settled(page);
  for (const problem of await page.evaluate(cutOff, true)) expect(false, `narrow screen: ${problem}`);
  if (screenshots) await page.screenshot({ path: `${screenshots}/step-narrow.png`, fullPage: true });
  await page.setViewportSize(WINDOW);
}

const browser = await launch();
try {
  // As high as the page, so that everything is in reach of the pointer.
  const page = await open(browser, file, { window: WINDOW });
  if (await becomes(page, () => stepCam?.made && document.querySelectorAll('#step-figures td.number').length > 5)) {
    await checkTurning(page);
    await checkRelief(page);
    await checkNames(page, 30);
    await checkLooks(page);
    await checkFiles(page);
    await checkMotionBehind(page);
    await checkReport(browser, page);
    await checkTracksAndCams(page);
  } else expect(false, 'the step cam shows no figures');
  await designByKeyboard(browser);
} catch (error) {
  problems.push(error.message);
}
await browser.close();
for (const problem of problems) console.error(`open_step_cam: ${problem}`);
if (!problems.length) console.log('open_step_cam: all holds');
process.exit(problems.length ? 1 : 0);
