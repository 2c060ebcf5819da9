// The commands of `stiction`: each adds itself to the program and runs when it was named.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace stiction::host {

// What every command knows of its call.
struct Invocation {
  std::string command_line;  // as typed, quoted for a shell
  std::string version;
  std::string command{};  // that was called, "simulate circle"
};

// Without a known subcommand, `command` throws UsageError with what was found and what it knows.
void expect_subcommand(CLI::App& command, const std::string& kind);
// Throws that UsageError. `kind`: what its commands are called, "experiment".
[[noreturn]] void refuse_unknown_command(const CLI::App& command, const std::string& kind);

void add_simulate(CLI::App& program, const Invocation& invocation);
// The experiments of the table, below `stiction simulate`.
void add_experiments(CLI::App& simulate, const Invocation& invocation);
// The set-points of a log, below `stiction simulate`.
void add_replay(CLI::App& simulate, const Invocation& invocation);
// Records of one axis, below `stiction simulate`.
void add_commissioning(CLI::App& simulate, const Invocation& invocation);
// A motion through the simulated axis, below `stiction simulate`.
void add_cam_run(CLI::App& simulate, const Invocation& invocation);
void add_compare(CLI::App& program, const Invocation& invocation);
void add_machine(CLI::App& program, const Invocation& invocation);
// A machine file from data sheets, below `stiction machine`.
void add_machine_new(CLI::App& machine, const Invocation& invocation);
void add_identify(CLI::App& program, const Invocation& invocation);
void add_diagnose(CLI::App& program, const Invocation& invocation);
void add_tune_friction(CLI::App& program, const Invocation& invocation);
// Less residual vibration of a cam from its records.
void add_tune_cam(CLI::App& program, const Invocation& invocation);
// Lift laws, motion files and tables of electronic cams.
void add_cam(CLI::App& program, const Invocation& invocation);
// Laws compared for one stroke, formats of other makers, and the page of a motion, below `stiction cam`.
void add_cam_rank(CLI::App& cam);
void add_cam_exchange(CLI::App& cam);
void add_cam_design(CLI::App& cam, const Invocation& invocation);
// Methods against residual vibration, below `stiction cam`.
void add_cam_shape(CLI::App& cam, const Invocation& invocation);
// Step cams from a project, below `stiction cam`.
void add_cam_step(CLI::App& cam, const Invocation& invocation);
// Scripts for the shells, made from the commands that `program` has when it runs.
void add_completion(CLI::App& program);
// Many runs over a grid or a sample.
void add_sweep(CLI::App& program, const Invocation& invocation);
// Records of many axes over months.
void add_fleet(CLI::App& program, const Invocation& invocation);
void add_convert(CLI::App& program);
void add_inspect(CLI::App& program);

}  // namespace stiction::host
