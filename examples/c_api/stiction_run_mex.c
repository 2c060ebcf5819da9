/* stiction for Octave and MATLAB:
 *
 *   [document, signals, units] = stiction_run_mex(command, machine, options, logs)
 *
 *   command   "simulate circle", "diagnose", ...
 *   machine   a machine that ships, by name, or a file
 *   options   a cell array of texts "feed=16 m/min"; may be left out
 *   logs      a cell array of paths, of commands that read logs; may be left out
 *   document  the document of the command as JSON text (jsondecode reads it)
 *   signals   of a simulation the columns of its first run, a struct with X_x for X.x; values in SI units
 *   units     their units, by the same names
 *
 * Built by `mkoctfile --mex stiction_run_mex.c -lstiction` or `mex stiction_run_mex.c -lstiction`. */
#include <mex.h>
#include <stdlib.h>
#include <stiction.h>
#include <string.h>

enum { most_texts = 64 };

/* The texts of a cell array; they live until Octave frees them after the call. */
static size_t texts_of(const mxArray* cells, const char** texts, const char* what) {
  if (!mxIsCell(cells)) mexErrMsgIdAndTxt("stiction:input", "%s: expected a cell array of texts", what);
  const size_t count = mxGetNumberOfElements(cells);
  if (count > most_texts)
    mexErrMsgIdAndTxt("stiction:input", "%s: found %d texts; expected at most %d", what, (int)count, (int)most_texts);
  for (size_t k = 0; k < count; ++k) {
    const mxArray* cell = mxGetCell(cells, k);
    if (cell == NULL || !mxIsChar(cell)) mexErrMsgIdAndTxt("stiction:input", "%s: expected texts alone", what);
    texts[k] = mxArrayToString(cell);
  }
  return count;
}

static char* text_of(const mxArray* array, const char* what) {
  if (!mxIsChar(array)) mexErrMsgIdAndTxt("stiction:input", "%s: expected a text", what);
  return mxArrayToString(array);
}

static void signals_of(const stiction_log* log, mxArray** signals, mxArray** units) {
  *signals = mxCreateStructMatrix(1, 1, 0, NULL);
  *units = mxCreateStructMatrix(1, 1, 0, NULL);
  for (size_t k = 0; log != NULL && k < stiction_log_columns(log); ++k) {
    char name[64];
    strncpy(name, stiction_column_name(log, k), sizeof name - 1);
    name[sizeof name - 1] = '\0';
    for (char* at = name; *at != '\0'; ++at)
      if (*at == '.' || *at == '-') *at = '_';
    mxArray* column = mxCreateDoubleMatrix(stiction_log_samples(log), 1, mxREAL);
    memcpy(mxGetPr(column), stiction_column(log, stiction_column_name(log, k)),
           stiction_log_samples(log) * sizeof(double));
    mxAddField(*signals, name);
    mxSetField(*signals, 0, name, column);
    mxAddField(*units, name);
    mxSetField(*units, 0, name, mxCreateString(stiction_column_unit(log, k)));
  }
}

void mexFunction(int outputs, mxArray* output[], int inputs, const mxArray* input[]) {
  const char *texts[most_texts], *logs[most_texts];
  if (inputs < 2 || inputs > 4)
    mexErrMsgIdAndTxt("stiction:input", "found %d arguments; expected command, machine, options, logs", inputs);
  const char* command = text_of(input[0], "command");
  const char* name = text_of(input[1], "machine");
  stiction_options options = {.options = texts, .logs = logs, .keep_logs = outputs > 1};
  if (inputs > 2) options.option_count = texts_of(input[2], texts, "options");
  if (inputs > 3) options.log_count = texts_of(input[3], logs, "logs");

  stiction_machine* machine = stiction_open_machine(name, NULL, 0);
  stiction_result* result = machine == NULL ? NULL : stiction_run(command, machine, &options);
  stiction_close_machine(machine);
  if (result == NULL) mexErrMsgIdAndTxt("stiction:failed", "%s", stiction_error());
  output[0] = mxCreateString(stiction_document(result));
  if (outputs > 1) {
    mxArray* units = NULL;
    signals_of(stiction_result_log(result, 0), &output[1], &units);
    if (outputs > 2)
      output[2] = units;
    else
      mxDestroyArray(units);
  }
  stiction_close_result(result);
}
