/* A circle of the machine that ships as mcfv5050ln: its document, and the largest following error of its X axis.
 *
 *   cc -std=c11 circle.c -lstiction -lm -o circle && ./circle "16 m/min" */
#include <math.h>
#include <stdio.h>
#include <stiction.h>

int main(int argc, char** argv) {
  char feed[64];
  snprintf(feed, sizeof feed, "feed=%s", argc > 1 ? argv[1] : "16 m/min");
  const char* const texts[] = {"friction=lugre", feed};
  const stiction_options options = {.options = texts, .option_count = 2, .keep_logs = 1};

  stiction_machine* machine = stiction_open_machine("mcfv5050ln", NULL, 0);
  stiction_result* circle = machine == NULL ? NULL : stiction_run("simulate circle", machine, &options);
  if (circle == NULL) {
    fprintf(stderr, "%s\n", stiction_error());
    stiction_close_machine(machine);
    return 1;
  }
  const stiction_log* log = stiction_result_log(circle, 0);
  const double* set = stiction_column(log, "X.x_set");
  const double* x = stiction_column(log, "X.x");
  double largest = 0.0;
  for (size_t k = 0; k < stiction_log_samples(log); ++k) largest = fmax(largest, fabs(set[k] - x[k]));
  printf("%s\nlargest following error of X: %.3f mm\n", stiction_document(circle), 1e3 * largest);
  stiction_close_result(circle);
  stiction_close_machine(machine);
  return 0;
}
