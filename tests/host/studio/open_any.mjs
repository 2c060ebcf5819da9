// Writes the drive's table of a motion, its files for other controllers and the log of an axis that follows it, has
// `stiction cam open` make a studio of each, and takes the motion out of the page again: the commands read it, and its
// position is that of the motion before. Files that hold no motion are refused with the file's name and without a page.
// usage: node open_any.mjs STICTION MOTION EXAMPLES FOLDER
import { execFileSync } from 'node:child_process';
import { existsSync, mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';

const [stiction, motion, examples, folder] = process.argv.slice(2);
if (!folder) {
  console.error('usage: node open_any.mjs STICTION MOTION EXAMPLES FOLDER');
  process.exit(2);
}
const problems = [], expect = (holds, message) => { if (!holds) problems.push(message); };
const run = (...words) => execFileSync(stiction, words, { stdio: 'pipe' }).toString();
const refusal = (...words) => { try { run(...words); return null; } catch (error) { return error.stderr.toString(); } };
rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });

// Degrees, of 0.1 mm at a radius of half a metre; a log has its master once a tick, 0.05 degrees.
const TOLERANCE = 0.01;
// Position at every degree by the command's own table of points.
const positions = file => {
  const points = `${folder}/points.txt`;
  run('cam', 'export', file, '--format', 'csv', '--points', '361', '-o', points);
  return readFileSync(points, 'utf8').split(/\r?\n/).slice(1).filter(Boolean).map(line => Number(line.split(',')[1]));
};

const wanted = positions(motion);
function check(name, file, ...more) {
  const page = `${folder}/${name}.html`, again = `${folder}/${name}.again.toml`;
  run('cam', 'open', file, ...more, '--out', page);
  const data = JSON.parse(readFileSync(page, 'utf8').match(/<script type="application\/json" id="data">([^]*?)<\/script>/)[1]);
  writeFileSync(again, data.motion.text);
  const found = positions(again), offset = found[0] - wanted[0];
  const off = Math.max(...found.map((y, i) => Math.abs(y - offset - wanted[i])));
  expect(found.length === wanted.length && off <= TOLERANCE, `${name}: the motion is ${off} degrees off`);
  console.log(`${name}: within ${off.toExponential(1)} degrees`);
}

const table = `${folder}/motion.scam`, log = `${folder}/motion.csv`;
run('cam', 'table', motion, '--out', table);
check('table', table);
run('simulate', 'cam', '--machine', 'cam-stand', '--cam', motion, '--speed', '130 rpm', '--cycles', '2', '--log', log);
check('log', log);
for (const format of ['codesys-xy', 'xyva']) {
  const file = `${folder}/motion.${format}`;
  run('cam', 'export', motion, '--format', format, '-o', file);
  check(format, file);
}
check('motion', motion);
run('cam', 'open', `${examples}/step_cam.toml`, '--out', `${folder}/step.html`);
expect(existsSync(`${folder}/step.html`), 'a project of a step cam makes no studio');

const damaged = `${folder}/damaged.scam`, bytes = readFileSync(table);
bytes[bytes.length >> 1] ^= 1;
writeFileSync(damaged, bytes);
writeFileSync(`${folder}/noise`, Buffer.from(Array.from({ length: 3000 }, (_, i) => (i * 7919 + 31) % 251)));
for (const file of [damaged, `${folder}/noise`, `${folder}/missing`]) {
  const said = refusal('cam', 'open', file, '--out', `${folder}/refused.html`);
  expect(said !== null && said.includes(file.split('/').pop()) && !existsSync(`${folder}/refused.html`), `${file} is answered by '${said}'`);
}
for (const problem of problems) console.error(`open_any: ${problem}`);
process.exit(problems.length ? 1 : 0);
