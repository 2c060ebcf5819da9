// The bodies of toml++, compiled with the fuzzers' instrumentation; they take the place of those in its library.
#define TOML_IMPLEMENTATION
#include <toml++/toml.h>
