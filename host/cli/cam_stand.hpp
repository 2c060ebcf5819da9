// The part of `stiction simulate cam` that has the models of an elastic axis.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "host/cli/cam_options.hpp"
#include "host/cli/commands.hpp"

namespace stiction::host {

struct CamStandOptions {
  std::string model;  // a list; empty: not asked for
  bool verification = false;

  bool asked() const { return verification || !model.empty(); }
  void add_to(CLI::App& command);
};

// What the rest of the command says.
struct CamStandRun {
  const MachineOptions& machine;
  const MotionOptions& motion;
  const std::string& speed;
  const std::string& log;
  const std::string& out;
  int cycles;
  bool json;
};

// Runs the models of `options` with the rest of the command, `run`, as `invocation` has it.
void run_cam_stand(const CamStandOptions& options, const CamStandRun& run, const Invocation& invocation);

}  // namespace stiction::host
