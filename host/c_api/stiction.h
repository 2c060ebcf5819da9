/* stiction from C, and from whatever calls C: MATLAB, LabVIEW, Octave, Julia, C#.
 *
 * Functions that return a pointer return NULL, and those that return an int a number other than 0, when they fail;
 * stiction_error() then says what was found and what was expected. Texts are UTF-8 and end with 0. What a function
 * whose name has "open", "run" or "read" returns is closed by the caller with the function of its kind; all other
 * pointers belong to the object that they were asked of and are good until it is closed. Different threads may use
 * different objects. Values are in SI units. Link with -lstiction. */
#ifndef STICTION_H
#define STICTION_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct stiction_machine stiction_machine;
typedef struct stiction_result stiction_result;
typedef struct stiction_log stiction_log;

/* "0.1.0 (commit b8ff57e)". */
const char* stiction_version(void);

/* Of the last call in this thread that failed; empty before one. */
const char* stiction_error(void);

/* The machine that ships under `name`, or that of the file `name`; `set`: `assignments` texts "KEY=VALUE", as
 * `stiction --set` takes them. */
stiction_machine* stiction_open_machine(const char* name, const char* const* set, size_t assignments);
void stiction_close_machine(stiction_machine* machine);

/* Identifier, number of axes, and the name of axis `axis`, counted from 0; NULL beyond the last. */
const char* stiction_machine_id(const stiction_machine* machine);
size_t stiction_axes(const stiction_machine* machine);
const char* stiction_axis_name(const stiction_machine* machine, size_t axis);

/* Told what is being done; a number other than 0 ends the run. `user`: as given to stiction_run(). May be called from
 * another thread than the one that runs. */
typedef int (*stiction_progress)(const char* what, void* user);

/* What a command of `stiction` takes beside a machine. Zero is a good value of every member. */
typedef struct stiction_options {
  const char* const*
      options; /* `option_count` texts "feed=16 m/min", as the command's --feed; of a flag "refine=true" */
  size_t option_count;
  const char* const* logs; /* `log_count` paths, of a command that reads logs */
  size_t log_count;
  int keep_logs; /* not 0: a simulation keeps its runs as logs */
  stiction_progress progress;
  void* user;
} stiction_options;

/* Runs `command` ("simulate circle", "identify", "diagnose", "tune-friction", ...) on `machine`. `options` may be
 * NULL. */
stiction_result* stiction_run(const char* command, const stiction_machine* machine, const stiction_options* options);
void stiction_close_result(stiction_result* result);

/* The document that the command prints with --json. */
const char* stiction_document(const stiction_result* result);

/* The logs that were kept, in the order of the runs; NULL beyond the last. They belong to the result. */
size_t stiction_result_logs(const stiction_result* result);
const stiction_log* stiction_result_log(const stiction_result* result, size_t log);

/* The log of a file in any of the formats that the commands read. `columns`: names and units of a table without header,
 * "t[ms],x[mm],i[mA]"; NULL: it has one. A record with gaps is refused. */
stiction_log* stiction_read_log(const char* file, const char* columns);
void stiction_close_log(stiction_log* log);

/* Samples of each column, columns, and name ("X.x") and unit ("m") of column `column`, counted from 0; NULL beyond the
 * last. */
size_t stiction_log_samples(const stiction_log* log);
size_t stiction_log_columns(const stiction_log* log);
const char* stiction_column_name(const stiction_log* log, size_t column);
const char* stiction_column_unit(const stiction_log* log, size_t column);

/* The values of the column `name`, stiction_log_samples() of them, not copied; NAN where a file has none. NULL, with a
 * text in stiction_error(), when there is no such column. */
const double* stiction_column(const stiction_log* log, const char* name);

#ifdef __cplusplus
}
#endif

#endif
