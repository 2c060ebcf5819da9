// The table of experiments other than the circle. A new one is a file beside this one and a row in experiments.cpp: the
// command line takes name and text from it.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/log/log.hpp"
#include "sim/experiment/experiment_result.hpp"

namespace stiction::host {

struct ExperimentInput {
  machine::Machine machine;              // with the experiment's overrides, and what needs_of() asks for
  std::vector<std::string> friction;     // the models to run, at least one; none without axes
  std::vector<double> feeds{};           // m/s, at least one; none where the experiment has no --feed
  std::vector<std::string> equations{};  // at least one; none where the experiment has no --equations
  std::optional<double> jerk{};          // m/s^3, to which set-points are limited; none: as the experiment has them
  // Takes the log of a run; `run` tells several runs of one model apart ("24 m/min") and is empty where there is one.
  // Empty: no logs are wanted.
  std::function<void(const std::string& run, Log)> keep_log = {};
};

// Forms of the feed drive's equations.
inline constexpr const char* equations_corrected = "corrected";
inline constexpr const char* equations_printed = "printed";

// What an experiment needs of the machine stands in machine_needs.cpp.
struct Experiment {
  const char* name;  // "impact"
  const char* text;  // for --help
  sim::ExperimentResult (*run)(const ExperimentInput&);
  bool keeps_logs = false;               // calls keep_log
  const char* feeds = nullptr;           // what --feed is unless it is given; null: the experiment has no --feed
  std::vector<std::string> equations{};  // what --equations chooses from, all unless it is given
  bool jerk = false;                     // whether its set-points can be limited: it has --jerk
  bool compensation = false;             // whether it shows what friction compensation does: it has --compensation
};

std::span<const Experiment> experiments();

// Runs it, and puts the expected figures of the machine file to its figures. Throws what the experiment throws, and
// MachineFileError for an expected value in a unit that is not the figure's.
sim::ExperimentResult run_experiment(const Experiment& experiment, const ExperimentInput& input);

// The experiments, firmware in fixed point where control takes part. Throw FaultTripped.
sim::ExperimentResult run_constant_velocity(const ExperimentInput& input);
sim::ExperimentResult run_impact(const ExperimentInput& input);
sim::ExperimentResult run_l_shape(const ExperimentInput& input);
sim::ExperimentResult run_presliding(const ExperimentInput& input);
sim::ExperimentResult run_friction_lag(const ExperimentInput& input);
sim::ExperimentResult run_break_away(const ExperimentInput& input);
sim::ExperimentResult run_stick_slip(const ExperimentInput& input);

// The feed drive's experiment, on a machine that has one; double precision, no firmware takes part.
sim::ExperimentResult run_feed_cutting(const ExperimentInput& input);

}  // namespace stiction::host
