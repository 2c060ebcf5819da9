// A batch driven along set-points in memory, with what of it is kept.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "host/batch/batch_run.hpp"

namespace stiction::host {

// A value a tick for all members, or a row of a value a member for each tick.
struct BatchSetPoints {
  std::span<const double> position;      // m
  std::span<const double> velocity;      // m/s, as many
  std::span<const double> acceleration;  // m/s^2, as many
  bool shared = false;                   // one for all members
};

// One signal to keep, and its name in Python and C: "x", "e".
struct BatchSignal {
  const char* name;
  const char* unit;
  Row row;
};

// All that can be kept.
std::span<const BatchSignal> batch_signals();

// Where a signal's values go: a row of a value a member for each kept tick.
struct BatchColumn {
  Row row;
  double* values;
};

// Ticks of `set_points` that are kept when each `every`-th is, the first among them.
std::size_t kept_ticks(std::size_t ticks, std::size_t every);

// Drives `run` along `set_points`, a tick for each, and writes into `columns`, which have room for kept_ticks() rows,
// the values of every `every`-th tick, at least 1. `progress` is told the ticks that are done every few thousand of
// them; what it throws leaves this function.
void record_batch(BatchRun& run, const BatchSetPoints& set_points, std::size_t every,
                  std::span<const BatchColumn> columns, const std::function<void(std::size_t)>& progress = {});

}  // namespace stiction::host
