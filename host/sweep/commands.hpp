// The table of commands that a sweep can run: each row of a sweep is one call, in this process, with the figures that
// the command itself would print. A new one is a row in commands.cpp and a function.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/sweep/rows.hpp"
#include "sim/experiment/experiment_result.hpp"

namespace stiction::host {

// A number that a run gives.
struct SweepFigure {
  std::string name;  // "peak_error_X"
  std::string unit;  // as it is shown, "um"; empty: a plain number
  double value = 0.0;

  // The name of its column: "peak_error_X[um]".
  std::string column() const { return unit.empty() ? name : name + "[" + unit + "]"; }
};

struct SweepCommand {
  std::string name;        // as typed after `stiction`
  std::string experiment;  // whose overrides the machine file may have
  std::vector<std::string_view> options{};
  std::vector<std::string_view> flags{};     // options without a value
  std::vector<std::string_view> required{};  // of the options
  bool logs = false;                         // needs them
  std::string log_option{};                  // before a log, "--from"; empty: logs are arguments of their own
  // Runs `row`. Throws what the command's own functions throw. Called from several threads at once.
  std::vector<SweepFigure> (*run)(const SweepCommand& command, const SweepRow& row) = nullptr;
};

std::span<const SweepCommand> sweep_commands();

// The command that `spec` names, whose options, logs and their names are those that it knows. Throws
// machine::MachineFileError "FILE: KEY: found ...; expected ...".
const SweepCommand& command_of(const SweepSpec& spec);

// The figures of `result` without the names of friction models, of which a row has one.
std::vector<SweepFigure> sweep_figures(const sim::ExperimentResult& result);

// The functions of the table: they run `row` of `command`.
std::vector<SweepFigure> sweep_circle(const SweepCommand& command, const SweepRow& row);
std::vector<SweepFigure> sweep_experiment(const SweepCommand& command, const SweepRow& row);
std::vector<SweepFigure> sweep_tuning(const SweepCommand& command, const SweepRow& row);
std::vector<SweepFigure> sweep_identification(const SweepCommand& command, const SweepRow& row);
std::vector<SweepFigure> sweep_diagnosis(const SweepCommand& command, const SweepRow& row);

}  // namespace stiction::host
