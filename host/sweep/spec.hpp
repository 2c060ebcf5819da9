// The specification of a sweep ("stiction.sweep-spec/1", docs/sweep.md): a command, machines, logs, keys with lists,
// grids or distributions, and the figures to collect.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/sweep/samples.hpp"

namespace stiction::host {

enum class Distribution { uniform, log_uniform, normal };

// What varies from row to row: values of a list or a range, or draws from a distribution.
struct SweptKey {
  enum class Kind {
    machine,  // the machine of the row
    log,      // the log of the row
    option,   // an option of the command, "feed"
    set,      // a key of the machine file, "axis.X.mass"
  };
  Kind kind = Kind::set;
  std::string name;  // "axis.X.mass"; "machine" and "log" of those
  std::string unit;  // of its numbers; empty: plain numbers, or texts
  bool numeric = true;
  bool relative = false;            // the numbers are factors of what the machine file has
  std::vector<std::string> values;  // of a list or a range, as --set and options take them; empty: drawn
  std::vector<double> numbers;      // of a list or a range of numbers, in `unit`
  // Where it is drawn: from `low` to `high`, or with mean `low` and standard deviation `high`.
  std::optional<Distribution> drawn;
  double low = 0.0, high = 0.0;
  bool design = false;  // of a search for the best worst case: is chosen, not given (results.hpp)

  bool varies() const { return drawn.has_value() || values.size() > 1; }
  // The name of its column in the result: "axis.X.mass[kg]", "axis.X.mass[relative]".
  std::string column() const;
};

struct SweepSpec {
  std::string file;  // as messages name it
  std::string text;  // its content
  std::string name;  // of the sweep
  std::string command;
  std::vector<SweptKey> keys;        // machine first, log, options, keys of the machine
  std::vector<std::string> figures;  // to collect, without units; empty: all
  SampleMethod method = SampleMethod::latin_hypercube;
  std::uint64_t samples = 1;  // draws; 1 where nothing is drawn
  std::uint64_t seed = 1;
  std::vector<std::string> pareto;  // two figures, or none
  std::string worst;                // whose largest value is the worst case; empty: the first figure
  std::string robust;               // whose worst case is made smallest over the design keys; empty: no search

  // Product of the lists' lengths and the draws; at most 2^62, where longer ones end.
  std::uint64_t rows() const;
};

inline constexpr const char* sweep_spec_schema = "stiction.sweep-spec/1";

// The specification in `text`, checked but for what only the machine files know; `file` as messages name it. Throws
// machine::MachineFileError.
SweepSpec parse_sweep_spec(const std::string& file, const std::string& text);

// The file of a specification named on the command line: a path, or the name of a shipped sweep, looked up in
// $STICTION_SWEEPS (folders separated by ':') and in ../share/stiction/sweeps of the program. Throws
// machine::MachineFileError with the sweeps found.
std::filesystem::path find_sweep(const std::string& name_or_path);

// Names of the shipped sweeps, sorted.
std::vector<std::string> shipped_sweeps();

}  // namespace stiction::host
