// A table of steady states as an engineer notes them: speed and current, or force, of constant speeds. CSV with one
// header row, columns v[...] and i[A] or F[N] in any unit of their kind; lines "# key: value" before it, of which
// "# amperes: amplitude" (or peak, or rms) says how the currents were read.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/identify/motion.hpp"
#include "host/identify/sliding_curve.hpp"

namespace stiction::host {

struct SteadyTable {
  std::string source;
  std::vector<double> speed;       // m/s; negative for the other direction
  std::vector<double> current;     // A, as written; empty when the table has forces
  std::vector<double> force;       // N; empty when the table has currents
  std::optional<Amperes> amperes;  // when the table says it
};

// Whether a text is such a table: its header has no time.
bool is_steady_table(std::string_view text);

// Throws LogError.
SteadyTable parse_steady_table(std::string_view text, const std::string& name);

// "peak", "amplitude" or "rms"; nothing for any other text.
std::optional<Amperes> parse_amperes(std::string_view text);

// The rows as data for a sliding curve, each a block of its own. Throws LogError for currents of which neither the
// table nor `stated` says how they are to be read, for too few rows, and for forces of the wrong sign. `table`: as
// read; `axis`: of the machine, for its force constant.
SlidingData sliding_data(const SteadyTable& table, const machine::AxisModel& axis, std::optional<Amperes> stated);

}  // namespace stiction::host
