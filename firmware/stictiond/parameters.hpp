// The parameters of a drive that an engineer may set without its machine file: the numeric keys of every axis'
// controllers, notch, feedforward, supervision and of what [drive] says of the axis, each as parameters.hpp and
// drive_parameters.hpp of firmware/machine/file describe it.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/machine/file/parameter_tables.hpp"
#include "firmware/machine/model/drive_setup.hpp"
#include "firmware/machine/model/machine.hpp"
#include "firmware/stictiond/parameter_store.hpp"

namespace stiction::drive {

struct DriveParameter {
  std::string key;  // of the machine file, "axis.X.position_controller.gain"
  std::string unit;
  std::string text;
  machine::Range range;
  bool whole = false;           // a whole number
  std::optional<double> value;  // none: left out
};

// Of every axis in the order of the machine; every axis has the same ones.
std::vector<DriveParameter> drive_parameters(const machine::Machine& machine, const machine::DriveSetup& setup);

// Which way a limit becomes tighter.
enum class Tightens { down, up };
struct LimitParameter {
  std::string_view key;  // as it ends, behind the axis
  Tightens tightens;
};
// What protects the machine: over a bus these values are only made tighter than they are.
inline constexpr std::array<LimitParameter, 15> limit_parameters{{
    {"supervision.following_error", Tightens::down},
    {"supervision.over_current", Tightens::down},
    {"supervision.over_speed", Tightens::down},
    {"quick_stop_deceleration", Tightens::up},
    {"slow_down_deceleration", Tightens::up},
    {"brake_time", Tightens::up},
    {"frozen_distance", Tightens::down},
    {"encoder_jump", Tightens::down},
    {"current_sum", Tightens::down},
    {"runaway_current", Tightens::down},
    {"following_error_timeout", Tightens::down},
    {"max_motor_speed", Tightens::down},
    {"torque_slope", Tightens::down},
    {"negative_end", Tightens::up},
    {"positive_end", Tightens::down},
}};

// Why a client may not give `parameter` the value; empty: it may. `parameter`: with the value that is in force.
std::string rejection_of(const DriveParameter& parameter, double value);

// The set as assignments of ReadOptions::set, so that the machine file's reader checks range and sense of each. Throws
// std::runtime_error for another machine's set and for keys that are none of the parameters. `set`: as read from the
// store; `machine_id`: of the machine that is started; `parameters`: those it has.
std::vector<std::string> assignments_of(const ParameterSet& set, const std::string& machine_id,
                                        const std::vector<DriveParameter>& parameters);

}  // namespace stiction::drive
