/* The C API from a program in C11. usage: c_api_test FOLDER     FOLDER: for a log and a document */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <stiction.h>
#include <string.h>

static int failures = 0;

static void expect(int holds, const char* what) {
  if (holds) return;
  fprintf(stderr, "does not hold: %s (stiction_error: \"%s\")\n", what, stiction_error());
  ++failures;
}

static void expect_error(const void* result, const char* words) {
  expect(result == NULL, "a call that must fail returns NULL");
  if (strstr(stiction_error(), words) == NULL) {
    fprintf(stderr, "found \"%s\"; expected \"%s\" in it\n", stiction_error(), words);
    ++failures;
  }
}

static int count(const char* what, void* user) {
  (void)what;
  ++*(int*)user;
  return 0;
}

static int refuse(const char* what, void* user) {
  (void)what;
  (void)user;
  return 1;
}

/* Writes the columns of X as a log, and returns the largest deviation of x from x_set, m. */
static double write_log(const stiction_log* log, const char* path) {
  static const char* const names[] = {"t", "X.x_set", "X.x", "X.i"};
  const double* columns[4];
  const size_t samples = stiction_log_samples(log);
  double largest = 0.0;
  FILE* file = fopen(path, "w");
  if (file == NULL) return NAN;
  fprintf(file, "t[s],X.x_set[m],X.x[m],X.i[A]\n");
  for (int k = 0; k < 4; ++k) columns[k] = stiction_column(log, names[k]);
  for (size_t k = 0; k < samples; ++k) {
    fprintf(file, "%.17g,%.17g,%.17g,%.17g\n", columns[0][k], columns[1][k], columns[2][k], columns[3][k]);
    largest = fmax(largest, fabs(columns[1][k] - columns[2][k]));
  }
  fclose(file);
  return largest;
}

static void refuses_bad_input(const stiction_machine* machine) {
  const char* const option[] = {"fed=16 m/min"};
  const char* const no_value[] = {"feed"};
  const char* const set[] = {"axis.X.mass=-3 kg"};
  stiction_options options = {0};
  expect_error(stiction_open_machine("mcfv5050l", NULL, 0), "did you mean \"mcfv5050ln\"?");
  expect_error(stiction_open_machine(NULL, NULL, 0), "name: found NULL; expected a text");
  expect_error(stiction_open_machine("mcfv5050ln", set, 1), "axis.X.mass");
  expect_error(stiction_open_machine("mcfv5050ln", NULL, 1), "set: found NULL; expected 1 texts");
  expect_error(stiction_run("simulate circel", machine, NULL), "did you mean 'simulate circle'?");
  expect_error(stiction_run("simulate circle", NULL, NULL), "machine: found NULL");
  expect_error(stiction_run("diagnose", machine, NULL), "found no log; expected at least one");
  options.option_count = 1;
  options.options = option;
  expect_error(stiction_run("simulate circle", machine, &options), "did you mean 'feed'?");
  options.options = no_value;
  expect_error(stiction_run("simulate circle", machine, &options), "options: found 'feed'; expected NAME=VALUE");
  expect_error(stiction_read_log("nowhere.csv", NULL), "nowhere.csv");
}

int main(int argc, char** argv) {
  const char* const set[] = {"axis.X.mass=240 kg"};
  const char* const circle[] = {"friction=lugre", "feed=16 m/min"};
  const char* const axis[] = {"axis=X"};
  char path[4096];
  const char* const logs[] = {path};
  stiction_options options = {0};
  int reports = 0;
  if (argc != 2) return 2;
  snprintf(path, sizeof path, "%s/circle.csv", argv[1]);

  stiction_machine* machine = stiction_open_machine("mcfv5050ln", set, 1);
  if (machine == NULL) {
    fprintf(stderr, "%s\n", stiction_error());
    return 1;
  }
  expect(strcmp(stiction_machine_id(machine), "mcfv5050ln") == 0, "the machine has its name");
  expect(stiction_axes(machine) == 2 && strcmp(stiction_axis_name(machine, 1), "Y") == 0, "its second axis is Y");
  expect(stiction_axis_name(machine, 2) == NULL, "there is no third axis");
  refuses_bad_input(machine);

  options.options = circle;
  options.option_count = 2;
  options.keep_logs = 1;
  options.progress = refuse;
  expect_error(stiction_run("simulate circle", machine, &options), "ended by its progress function");
  options.progress = count;
  options.user = &reports;
  stiction_result* result = stiction_run("simulate circle", machine, &options);
  if (result == NULL) {
    fprintf(stderr, "%s\n", stiction_error());
    return 1;
  }
  expect(reports > 0, "progress is told");
  expect(strstr(stiction_document(result), "\"stiction.circle/1\"") != NULL, "the document has its schema");
  expect(stiction_result_logs(result) == 1 && stiction_result_log(result, 1) == NULL, "one run was kept");
  const stiction_log* kept = stiction_result_log(result, 0);
  expect(strcmp(stiction_column_name(kept, 0), "t") == 0 && strcmp(stiction_column_unit(kept, 0), "s") == 0,
         "the first column is the time in s");
  expect(stiction_column_name(kept, stiction_log_columns(kept)) == NULL, "there is no column beyond the last");
  expect_error(stiction_column(kept, "X.y"), "found no column 'X.y'; expected one of t, X.x_set");
  const double error = write_log(kept, path);
  printf("largest following error of X: %.1f um\n", error * 1e6);
  expect(error > 1e-7 && error < 1e-2, "the axis follows its set-points, and not without error");

  stiction_log* read = stiction_read_log(path, NULL);
  expect(read != NULL && stiction_log_samples(read) == stiction_log_samples(kept), "the log is read as it was written");
  expect(read != NULL && memcmp(stiction_column(read, "X.x"), stiction_column(kept, "X.x"),
                                stiction_log_samples(kept) * sizeof(double)) == 0,
         "to the bit");
  stiction_close_log(read);
  stiction_close_result(result);

  options = (stiction_options){.options = axis, .option_count = 1, .logs = logs, .log_count = 1};
  result = stiction_run("diagnose", machine, &options);
  if (result == NULL) {
    fprintf(stderr, "%s\n", stiction_error());
    return 1;
  }
  snprintf(path, sizeof path, "%s/verdict.json", argv[1]);
  FILE* file = fopen(path, "w");
  if (file == NULL) return 1;
  fprintf(file, "%s\n", stiction_document(result));
  fclose(file);
  stiction_close_result(result);
  stiction_close_machine(machine);
  return failures == 0 ? 0 : 1;
}
