// The keys of a machine file's feed drive, [feed_drive]: as parameters.hpp for the axes.
#pragma once

#include <array>
#include <string_view>
#include <tuple>

#include "firmware/machine/file/parameter_tables.hpp"
#include "firmware/machine/model/feed_drive.hpp"

namespace stiction::machine {

template <>
struct Table<FeedMotor> : EmptyTable<FeedMotor> {
  static constexpr std::string_view text = "motor of the feed drive";
  static constexpr std::array<Parameter<FeedMotor>, 4> parameters{{
      {"torque_constant", "N m/A", positive(), &FeedMotor::torque_constant, {}, "torque and voltage constant C"},
      {"resistance", "Ohm", positive(), &FeedMotor::resistance, {}, "resistance of the armature circuit"},
      {"inductance", "H", positive(), &FeedMotor::inductance, {}, "inductance of the armature"},
      {"inertia", "kg m^2", positive(), &FeedMotor::inertia, {}, "inertia J of armature and screw"},
  }};
};

template <>
struct Table<FeedConverter> : EmptyTable<FeedConverter> {
  static constexpr std::string_view text = "power converter of the feed drive";
  static constexpr std::array<Parameter<FeedConverter>, 2> parameters{{
      {"gain", "1", positive(), &FeedConverter::gain, {}, "gain K_n, armature voltage per control voltage"},
      {"time_constant", "s", positive(), &FeedConverter::time_constant, {}, "lag tau"},
  }};
};

template <>
struct Table<FeedSpeedController> : EmptyTable<FeedSpeedController> {
  static constexpr std::string_view text = "PI speed controller of the feed drive";
  static constexpr std::array<Parameter<FeedSpeedController>, 3> parameters{{
      {"gain", "1", positive(), &FeedSpeedController::gain, {}, "gain K_pc"},
      {"integral_time",
       "s",
       positive(),
       &FeedSpeedController::integral_time,
       {},
       "time T_pc of T dx/dt = K e: the integral alone has the gain K/T"},
      {"feedback", "V s/rad", positive(), &FeedSpeedController::feedback, {}, "tachometer constant K_c"},
  }};
};

template <>
struct Table<FeedCurrentController> : EmptyTable<FeedCurrentController> {
  static constexpr std::string_view text = "PI current controller of the feed drive";
  static constexpr std::array<Parameter<FeedCurrentController>, 3> parameters{{
      {"gain", "1", positive(), &FeedCurrentController::gain, {}, "gain K_pm"},
      {"integral_time",
       "s",
       positive(),
       &FeedCurrentController::integral_time,
       {},
       "time T_pm of T dx/dt = K e: the integral alone has the gain K/T"},
      {"feedback", "V/A", positive(), &FeedCurrentController::feedback, {}, "current sensor's constant K_m"},
  }};
};

template <>
struct Table<FeedCarriage> : EmptyTable<FeedCarriage> {
  static constexpr std::string_view text = "sliding carriage of the feed drive";
  static constexpr std::array<Parameter<FeedCarriage>, 3> parameters{{
      {"mass", "kg", positive(), &FeedCarriage::mass, {}, "moving mass m"},
      {"stiffness", "N/m", positive(), &FeedCarriage::stiffness, {}, "stiffness C_c between motor and carriage"},
      {"damping_ratio",
       "1",
       {1e-3, 0.5},
       &FeedCarriage::damping_ratio,
       {},
       "damping ratio zeta of the carriage on that stiffness"},
  }};
};

template <>
struct Table<FeedFriction> : EmptyTable<FeedFriction> {
  static constexpr std::string_view text = "friction of the carriage: normal load times coefficient";
  static constexpr std::array<Parameter<FeedFriction>, 7> parameters{{
      {"normal_load", "N", positive(), &FeedFriction::normal_load, {}, "normal load on the guideways"},
      {"static_short",
       "1",
       positive(),
       &FeedFriction::static_short,
       {},
       "coefficient at the beginning of a standstill, at least sliding"},
      {"static_long",
       "1",
       positive(),
       &FeedFriction::static_long,
       {},
       "coefficient after a long standstill, at least static_short"},
      {"dwell_time",
       "s",
       positive(),
       &FeedFriction::dwell_time,
       {},
       "time constant of the growth from static_short to static_long"},
      {"sliding", "1", not_negative(), &FeedFriction::sliding, {}, "coefficient in motion"},
      {"stribeck_velocity", "m/s", not_negative(), &FeedFriction::stribeck_velocity, 0.0,
       "speed over which static_short falls to sliding; 0: at once"},
      {"viscous", "N s/m", not_negative(), &FeedFriction::viscous, 0.0, "viscous part"},
  }};
};

template <>
struct Table<FeedCutting> : EmptyTable<FeedCutting> {
  static constexpr std::string_view text = "cutting force against the feed";
  static constexpr std::array<Parameter<FeedCutting>, 3> parameters{{
      {"constant_force", "N", not_negative(), &FeedCutting::constant_force, 0.0,
       "part P_R that does not depend on feed"},
      {"coefficient", "N/m", not_negative(), &FeedCutting::coefficient, 0.0,
       "coefficient C_v0, force over feed per revolution"},
      {"spindle_speed", "rad/s", positive(), &FeedCutting::spindle_speed, {}, "speed of the spindle"},
  }};
};

template <>
struct Table<FeedTool> : EmptyTable<FeedTool> {
  static constexpr std::string_view text = "tool: force proportional to a power of the carriage's speed";
  static constexpr std::array<Parameter<FeedTool>, 10> parameters{{
      {"mass", "kg", positive(), &FeedTool::mass, {}, "mass m_p"},
      {"stiffness_x", "N/m", positive(), &FeedTool::stiffness_x, {}, "stiffness in X"},
      {"stiffness_z", "N/m", positive(), &FeedTool::stiffness_z, {}, "stiffness in Z, along the feed"},
      {"damping_ratio_x", "1", not_negative(0.999), &FeedTool::damping_ratio_x, {}, "damping ratio in X"},
      {"damping_ratio_z", "1", not_negative(0.999), &FeedTool::damping_ratio_z, {}, "damping ratio in Z"},
      {"reference_speed", "m/s", positive(), &FeedTool::reference_speed, {}, "speed at which the forces are given"},
      {"force_x", "N", not_negative(), &FeedTool::force_x, {}, "force in X at the reference speed"},
      {"force_z", "N", not_negative(), &FeedTool::force_z, {}, "force in Z at the reference speed"},
      {"exponent_x", "1", positive(2.0), &FeedTool::exponent_x, 0.55, "exponent of the speed in X"},
      {"exponent_z", "1", positive(2.0), &FeedTool::exponent_z, 0.75, "exponent of the speed in Z"},
  }};
};

template <>
struct Table<FeedDrive> : EmptyTable<FeedDrive> {
  static constexpr std::string_view text = "feed drive with screw, sliding carriage, cutting and tool";
  static constexpr std::array<Parameter<FeedDrive>, 1> parameters{{
      {"lead", "m", positive(), &FeedDrive::lead, {}, "lead h of the screw, travel per turn"},
  }};
  static constexpr std::tuple subtables{
      Subtable<FeedDrive, FeedMotor>{"motor", &FeedDrive::motor, Presence::required},
      Subtable<FeedDrive, FeedConverter>{"converter", &FeedDrive::converter, Presence::required},
      Subtable<FeedDrive, FeedSpeedController>{"speed_controller", &FeedDrive::speed_controller, Presence::required},
      Subtable<FeedDrive, FeedCurrentController>{"current_controller", &FeedDrive::current_controller,
                                                 Presence::required},
      Subtable<FeedDrive, FeedCarriage>{"carriage", &FeedDrive::carriage, Presence::required},
      Subtable<FeedDrive, FeedFriction>{"friction", &FeedDrive::friction, Presence::required},
      Subtable<FeedDrive, FeedCutting>{"cutting", &FeedDrive::cutting, Presence::required},
      Subtable<FeedDrive, FeedTool>{"tool", &FeedDrive::tool, Presence::required},
  };
};

}  // namespace stiction::machine
