// Runs the page's own programme, taken out of a studio's page, and compares every value with the desk's
// (write_studio_values): profile, following error and load over three cycles on the stand, the project's functions of a
// million arguments, and the motion file.
// The drive's table and the files for controllers of other makers are those that the programme STICTION writes.
// usage: node studio_bits.mjs STUDIO.html MOTION MACHINE SPEED FOLDER STICTION
// Exit 0: all bits are the same; 1: a message says what differs; 2: usage.
import { execFileSync } from 'node:child_process';
import { existsSync, readFileSync, statSync } from 'node:fs';
import { basename } from 'node:path';

const CYCLES = 3, ARGUMENTS = 1000000, MOST_BYTES = 6e6;
const FUNCTIONS = ['sine', 'cosine', 'exponential', 'logarithm', 'square root', 'arc tangent', 'arc cosine'];
const [page, motion, machine, speedText, folder, stiction] = process.argv.slice(2);
if (!stiction) {
  console.error('usage: node studio_bits.mjs STUDIO.html MOTION MACHINE SPEED FOLDER STICTION');
  process.exit(2);
}
const speed = Number(speedText), problems = [], html = readFileSync(page, 'utf8');
const expect = (holds, message) => { if (!holds) problems.push(message); };

// The page's own loader, not a copy of it.
const loader = html.slice(html.lastIndexOf('// The compiled studio:'), html.indexOf('// Charts as SVG'));
const createEngine = new Function(`${loader}; return createEngine;`)();
const programme = html.match(/<script type="text\/plain" id="programme">([^<]*)</)[1];
const engine = await createEngine(Buffer.from(programme, 'base64'));

function compare(name, found, wanted) {
  if (found.length !== wanted.length) return expect(false, `${name}: ${found.length} values, the desk has ${wanted.length}`);
  const bits = values => new BigUint64Array(values.buffer, values.byteOffset, values.length), [a, b] = [bits(found), bits(wanted)];
  let differ = 0, first = -1;
  for (let i = 0; i < a.length; ++i) if (a[i] !== b[i]) { if (first < 0) first = i; ++differ; }
  expect(differ === 0, `${name}: ${differ} of ${found.length} values differ, the first is ${found[first]}, the desk has ${wanted[first]}`);
  if (!differ) console.log(`${name}: ${found.length} values, the same bits`);
}

function desk(name) {
  const bytes = readFileSync(`${folder}/${name}`);
  return new Float64Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
}

const loaded = file => `${basename(file)}\0${readFileSync(file, 'utf8')}`;
engine.call('load_motion', { text: loaded(motion) });
engine.call('load_machine', { text: loaded(machine) });
const { table } = engine.call('curves', { x: speed, at: 600 }), profile = new Float64Array(table.length / 7 * 5);
for (let row = 0; row * 7 < table.length; ++row) profile.set(table.subarray(7 * row, 7 * row + 5), 5 * row);
compare('profile', profile, desk('profile.bin'));
if (existsSync(`${folder}/follow.bin`)) compare('following error over three cycles', engine.run('follow', { x: speed, flag: CYCLES }).record, desk('follow.bin'));
compare('load over three cycles', engine.run('shaft', { x: speed, y: 1, flag: CYCLES }).record, desk('stand.bin'));
FUNCTIONS.forEach((name, k) => compare(name, engine.call('numbers', { at: ARGUMENTS, flag: k }).table, desk(`numbers-${k}.bin`)));
expect(engine.call('motion_text').text === readFileSync(`${folder}/motion.toml`, 'utf8'), 'the motion file of the page is not that of the desk');
const written = `${folder}/exported`;
for (const format of ['table', ...JSON.parse(engine.call('formats').text).map(({ name }) => name)]) {
  let wanted = null, found = null;
  try {
    execFileSync(stiction, format === 'table' ? ['cam', 'table', motion, '--out', written] : ['cam', 'export', motion, '--format', format, '-o', written], { stdio: 'pipe' });
    wanted = readFileSync(written);
  } catch { /* a format that does not hold this motion; the page must refuse it as well */ }
  try {
    found = Buffer.from(engine.call('exported', { text: format }).bytes);
  } catch { /* refused */ }
  expect(wanted === null ? found === null : found !== null && wanted.equals(found), `the page's export ${format} is not the command's`);
  if (wanted) console.log(`export ${format}: ${wanted.length} bytes, the same`);
}
// Each method makes the motion file of `stiction cam shape`; the page has no linear programme for the band-optimal one.
let shaped = 0, identical = 0;
execFileSync(stiction, ['cam', 'shape', motion, '--machine', machine, '--speed', `${speedText} rad/s`, '--out', `${folder}/shaped`], { stdio: 'pipe' });
for (const { name } of JSON.parse(engine.call('methods').text)) {
  const file = `${folder}/shaped/${name}.toml`;
  if (!existsSync(file) || name === 'band-optimal') continue;
  engine.call('shape', { text: name, x: speed });
  const same = engine.call('motion_text').text === readFileSync(file, 'utf8');
  expect(same, `the page's motion by the method ${name} is not the command's`);
  engine.call('undo');
  ++shaped;
  identical += same ? 1 : 0;
}
expect(shaped >= 5, `${shaped} methods were compared`);
console.log(`methods against residual vibration: ${identical} of ${shaped} the same motion files`);
const size = statSync(page).size;
expect(size <= MOST_BYTES, `the page has ${size} bytes`);
console.log(`page: ${(size / 1e6).toFixed(2)} MB`);
for (const problem of problems) console.error(`studio_bits: ${problem}`);
process.exit(problems.length ? 1 : 0);
