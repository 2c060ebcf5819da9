// The options of `stictiond`.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

namespace stiction::drive {

struct DriveOptions {
  std::string machine, hal = "simulated", circle, trace, parameters;
  std::vector<std::string> set;
  std::optional<double> hold;  // s
  bool unpaced = false, budget = false, check_realtime = false, dbc = false, faults = false, modbus_registers = false;

  void add_to(CLI::App& program) {
    program.add_option("--machine", machine, "machine file, or the name of a shipped machine")->type_name("MACHINE");
    program.add_option("--hal", hal, "how the drive reaches its power stages and encoders")
        ->check(CLI::IsMember({"simulated", "can", "gpio", "modbus"}))
        ->capture_default_str();
    program.add_option("--set", set, "another value for a key of the machine file; may be repeated")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
    program.add_option("--parameters", parameters, "folder of the parameters that were stored on this machine")
        ->type_name("DIR");
    program.add_option("--circle", circle, "enable the axes, drive the circle test at this feed, stop and end")
        ->type_name("\"16 m/min\"");
    program
        .add_option("--hold", hold,
                    "enable the axes, hold them for so many seconds, stop and end; without --circle and --hold the "
                    "axes stay off until [drive.can_server] or [drive.modbus_server] is asked to move them")
        ->type_name("SECONDS")
        ->check(CLI::PositiveNumber);
    program.add_flag("--unpaced", unpaced, "the simulated machine in its own time, as fast as it goes: no deadlines");
    program.add_option("--trace", trace, "write every signal of every tick of the motion as a log")->type_name("FILE");
    program.add_flag("--budget", budget, "print what the bus has to carry, and end");
    program.add_flag("--check-realtime", check_realtime, "print whether this machine is fit for the loop, and end");
    program.add_flag("--faults", faults, "print the table of faults, and end");
    program.add_flag("--modbus-registers", modbus_registers, "print the Modbus registers as Markdown, and end");
    program.add_flag("--dbc", dbc, "print the frames of the CAN bus as a DBC file, and end");
  }
};

}  // namespace stiction::drive
