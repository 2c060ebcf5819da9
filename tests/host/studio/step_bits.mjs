// Runs the page's own programme, taken out of a studio's page, on projects of step cams, and compares every file for the
// shop with those that `stiction cam step` writes: drawings, tables, project, motion and figures, byte for byte. Projects
// are the given one, and those that steps of editing make of it.
// usage: node step_bits.mjs STUDIO.html PROJECT MOTION FOLDER STICTION
// Exit 0: all bytes are the same; 1: a message says what differs; 2: usage.
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { basename } from 'node:path';

const [page, project, motion, folder, stiction] = process.argv.slice(2);
if (!stiction) {
  console.error('usage: node step_bits.mjs STUDIO.html PROJECT MOTION FOLDER STICTION');
  process.exit(2);
}
const problems = [], html = readFileSync(page, 'utf8'), decoder = new TextDecoder();
const expect = (holds, message) => { if (!holds) problems.push(message); };
// The page's own loader, not a copy of it.
const loader = html.slice(html.lastIndexOf('// The compiled studio:'), html.indexOf('// Charts as SVG'));
const createEngine = new Function(`${loader}; return createEngine;`)();
const engine = await createEngine(Buffer.from(html.match(/<script type="text\/plain" id="programme">([^<]*)</)[1], 'base64'));
const { version } = JSON.parse(html.match(/<script type="application\/json" id="data">([^]*?)<\/script>/)[1]);

function pageFiles() {
  const { bytes, table } = engine.call('step_files', { text: `stiction ${version}` }), files = new Map();
  for (let k = 0, begin = 0; k < table.length; k += 2) {
    const name = decoder.decode(bytes.subarray(begin, begin + table[k]));
    files.set(name, Buffer.from(bytes.subarray(begin + table[k], begin + table[k] + table[k + 1])));
    begin += table[k] + table[k + 1];
  }
  return files;
}

// `project` and the motion beside it by the command, against what the page makes now.
function compare(name, file) {
  const shop = `${folder}/${name}`;
  execFileSync(stiction, ['cam', 'step', file, '--out', shop], { stdio: 'pipe' });
  const made = pageFiles(), names = readdirSync(shop).filter(each => each !== 'report.html' && !each.startsWith('.')).sort();
  expect(names.join() === [...made.keys()].sort().join(), `${name}: the page has ${[...made.keys()].join(', ')}, the command ${names.join(', ')}`);
  let same = 0, bytes = 0;
  for (const each of names) {
    const wanted = readFileSync(`${shop}/${each}`), found = made.get(each);
    expect(found?.equals(wanted), `${name}: the page's ${each} is not the command's`);
    same += found?.equals(wanted) ? 1 : 0;
    bytes += wanted.length;
  }
  console.log(`${name}: ${same} of ${names.length} files with ${bytes} bytes, the same`);
}

rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });
const load = () => {
  engine.call('load_motion', { text: `${basename(motion)}\0${readFileSync(motion, 'utf8')}` });
  engine.call('load_step', { text: `${basename(project)}\0${readFileSync(project, 'utf8')}` });
};
load();
compare('given', project);

// What is edited is saved, and the command makes the same of what was saved.
const number = (name, value) => engine.call('step_number', { text: name, x: value, flag: 1 });
const choice = (name, value) => engine.call('step_choice', { text: `${name}\0${value}` });
const relief = (what, arc, value, alone) => engine.call('relief', { text: what, at: arc, x: value, flag: alone ? 2 : 0 });
const edits = {
  relieved: () => { relief('depth', 0, 6e-5, false); relief('blend', 1, 0.0527, true); relief('depth', 3, 3.1e-5, true); choice('relief.law', 'polynomial_4_5_6_7'); },
  different: () => { number('mechanism.arm', 47.3); number('mechanism.roller_radius', 11.7); number('load.torque', 3); number('load.speed', 217); number('relief.lead_in', 0); number('steps', 2880); number('wheel_radius', 9); },
  rigid: () => { engine.call('step_number', { text: 'load.preload', flag: 0 }); engine.call('step_number', { text: 'load.stiffness', flag: 0 }); engine.call('step_number', { text: 'load.largest_pressure', flag: 0 }); },
  moved: () => { number('wheel_radius', 10); engine.call('edit', { text: 'law\0sloping_sine', at: 1 }); },
};
for (const [name, edit] of Object.entries(edits)) {
  load();
  edit();
  const { problem } = JSON.parse(engine.call('step_state').text), source = `${folder}/${name}-source`;
  if (problem) { expect(false, `${name}: ${problem}`); continue; }
  mkdirSync(source);
  writeFileSync(`${source}/${basename(project)}`, engine.call('step_text').text);
  writeFileSync(`${source}/${basename(motion)}`, engine.call('motion_text').text);
  compare(name, `${source}/${basename(project)}`);
}
for (const problem of problems) console.error(`step_bits: ${problem}`);
process.exit(problems.length ? 1 : 0);
