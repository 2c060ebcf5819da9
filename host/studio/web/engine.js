// The compiled studio: calls with a text and numbers, answers with a text and tables of doubles. wasm/exports.cpp is the
// other side.
'use strict';

// In the order of Call in wasm/exports.cpp.
const CALLS = ['load_motion', 'load_machine', 'edit', 'undo', 'redo', 'motion_text', 'state', 'laws', 'law_curve', 'curves',
               'harmonics', 'follow', 'shaft', 'numbers', 'formats', 'exported', 'methods', 'shape',
               'choose_cam', 'load_step', 'new_step', 'step_text', 'step_number', 'step_choice', 'relief', 'step_state', 'step_figures', 'step_profiles', 'step_contacts',
               'step_turn', 'step_files'];
const RUN_FIGURES = ['peakError', 'meanError', 'peakEffort', 'rmsEffort', 'motorError', 'dwell', 'dwellArea'];

// What the C library asks of a system: there is no environment and nothing to write to.
function emptySystem(memory) {
  return {
    environ_sizes_get(count, size) {
      const view = new DataView(memory().buffer);
      view.setUint32(count, 0, true);
      view.setUint32(size, 0, true);
      return 0;
    },
    environ_get: () => 0,
    fd_close: () => 0,
    fd_seek: () => 0,
    fd_write: () => 0,
    proc_exit(status) { throw new Error(`the studio's programme ended with ${status}`); },
  };
}

// Throws where the browser has no WebAssembly or refuses it.
async function createEngine(bytes) {
  let exports = null;
  const { instance } = await WebAssembly.instantiate(bytes, { wasi_snapshot_preview1: emptySystem(() => exports.memory) });
  exports = instance.exports;
  exports._initialize();
  const encoder = new TextEncoder(), decoder = new TextDecoder();
  const doubles = (place, size) => new Float64Array(exports.memory.buffer.slice(place, place + 8 * size));

  // `text`: one text, or two with a zero between them. Throws an Error with what was found and expected.
  function call(name, { text = '', at = 0, x = 0, y = 0, flag = 0 } = {}) {
    const given = encoder.encode(text), place = exports.studio_input(given.length);
    new Uint8Array(exports.memory.buffer, place, given.length).set(given);
    const status = exports.studio_call(CALLS.indexOf(name), at, x, y, flag);
    const bytes = new Uint8Array(exports.memory.buffer.slice(exports.studio_text(), exports.studio_text() + exports.studio_text_size())), answer = decoder.decode(bytes);
    if (status !== 0) throw new Error(answer);
    return { text: answer, bytes, table: doubles(exports.studio_table(), exports.studio_table_size()), record: doubles(exports.studio_record(), exports.studio_record_size()) };
  }

  // The ticks of a run in columns, its record, and its figures, null where it has none.
  function run(name, options) {
    const { table, record } = call(name, options), end = table.length - RUN_FIGURES.length;
    const figures = Object.fromEntries(RUN_FIGURES.map((figure, k) => [figure, table[end + k] < 0 ? null : table[end + k]]));
    return { ticks: table.subarray(0, end), record, figures };
  }

  return { call, run };
}
