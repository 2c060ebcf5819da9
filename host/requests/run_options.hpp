// What is run, from the texts of a request: a command line, Python, C.
#pragma once

#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/simulate/circle_plan.hpp"
#include "host/simulate/experiments.hpp"
#include "sim/experiment/circle_result.hpp"

namespace stiction::host {

// "a,b" or "a, b": the parts without blanks around them.
std::vector<std::string> split_list(const std::string& text);

// Names of friction models: empty: what the machine file uses, each axis its own (friction_choice.hpp); "all": all that
// every axis has parameters for; or a list of them. Throws UsageError.
std::vector<std::string> friction_models(const std::string& text, const machine::Machine& machine);

// Feeds in m/s from "16 m/min" or a list of such quantities, the value of `option`. Throws UsageError.
std::vector<double> feeds(const std::string& text, const std::string& option = "--feed");

// "cw", "ccw" or "both"; "both" begins with counter-clockwise. Throws UsageError.
std::vector<sim::Direction> directions(const std::string& text);

// The options of a circle as typed; empty: as the machine or the source has them.
struct CircleTexts {
  std::string friction{}, feed{}, direction = "ccw", radius{}, signals = "fixed";
};

// The circles of `machine` that `texts` ask for. Throws UsageError.
CirclePlan circle_plan(machine::Machine machine, const CircleTexts& texts);

// The options of an experiment as typed; empty: all that it makes sense for.
struct ExperimentTexts {
  std::string friction{}, feed{}, equations{}, jerk{};
};

// What `experiment` runs on `machine`, as `texts` ask for. Throws UsageError.
ExperimentInput experiment_input(const Experiment& experiment, machine::Machine machine, const ExperimentTexts& texts);

}  // namespace stiction::host
