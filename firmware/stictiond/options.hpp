// The options of `stictiond`.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

namespace stiction::drive {

struct DriveOptions {
  std::string machine, hal = "simulated", circle, trace, parameters, master, speed;
  std::vector<std::string> set, cam;
  std::optional<double> hold;  // s
  bool unpaced = false, budget = false, check_realtime = false, dbc = false, faults = false, modbus_registers = false;
  bool canopen_objects = false, eds = false;
  bool rest = false, udev = false;

  static constexpr double longest_hold = 31'536'000.0;  // s, a year

  // Empty for a time that an axis can be held for; else why `text` is none.
  static std::string hold_rejection(const std::string& text) {
    double seconds = 0.0;
    if (CLI::detail::lexical_cast(text, seconds) && seconds > 0.0 && seconds <= longest_hold) return {};
    return "found " + text + "; expected a number of seconds above 0 and at most 31536000, a year";
  }

  void add_to(CLI::App& program) {
    program.add_option("--machine", machine, "machine file, or the name of a shipped machine")->type_name("MACHINE");
    program.add_option("--hal", hal, "backend that connects power stages and encoders")
        ->check(CLI::IsMember({"simulated", "can", "gpio", "modbus"}))
        ->capture_default_str();
    program.add_option("--set", set, "override a key of the machine file; may be repeated")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
    program.add_option("--parameters", parameters, "folder in which parameters are stored on this machine")
        ->type_name("DIR");
    program.add_option("--circle", circle, "enable the axes, drive the circular test at this feed, stop and exit")
        ->type_name("\"16 m/min\"");
    program
        .add_option("--hold", hold,
                    "enable the axes, hold them for this many seconds, or follow the cam of --cam, stop and exit; "
                    "without --circle and --hold the "
                    "axes remain off until a client of [drive.can_server] or [drive.modbus_server] enables them")
        ->type_name("SECONDS")
        ->check(CLI::Validator(hold_rejection, ""));
    program
        .add_option(
            "--cam", cam,
            "table of an electronic cam, as `stiction cam table` makes it; may be repeated: clients ask for them "
            "by their number, from 1")
        ->type_name("TABLE")
        ->allow_extra_args(false);
    program
        .add_option("--master", master,
                    "what axes follow in the modes of cam and gear: virtual, an axis of the machine, or can:NODE, an "
                    "encoder on the bus of [drive.master_encoder]")
        ->type_name("MASTER");
    program.add_option("--speed", speed, "largest speed of the master, for which the tables of --cam are checked")
        ->type_name("\"130 rpm\"");
    program.add_flag("--unpaced", unpaced, "run the simulated machine as fast as possible, without deadlines");
    program.add_option("--trace", trace, "write every signal of every tick of the motion as a log")->type_name("FILE");
    program.add_flag("--budget", budget, "print the load of the buses and exit");
    program.add_flag("--check-realtime", check_realtime,
                     "check whether this computer is fit for the loop, print the result and exit");
    program.add_flag("--rest", rest, "put lines and PWM of a run that was killed to rest and exit");
    program.add_flag("--udev", udev,
                     "print the rules for udev that give the drive's group the chips of the machine and exit");
    program.add_flag("--faults", faults, "print the table of faults and exit");
    program.add_flag("--modbus-registers", modbus_registers, "print the Modbus registers as Markdown and exit");
    program.add_flag("--canopen-objects", canopen_objects, "print the objects of CANopen as Markdown and exit");
    program.add_flag("--eds", eds, "print the electronic data sheet of an axis on CANopen and exit");
    program.add_flag("--dbc", dbc, "print the frames of the CAN bus as a DBC file and exit");
  }
};

}  // namespace stiction::drive
