// The keys under [drive] of a machine file, each described once; as parameters.hpp for the rest.
#pragma once

#include <array>
#include <limits>
#include <tuple>

#include "firmware/machine/file/cam_parameters.hpp"
#include "firmware/machine/file/motor_setup_parameters.hpp"
#include "firmware/machine/file/parameter_tables.hpp"
#include "firmware/machine/model/drive_setup.hpp"

namespace stiction::machine {

template <>
struct Table<CanSetup> : EmptyTable<CanSetup> {
  static constexpr std::string_view text = "CAN bus with the power stages and encoders";
  static constexpr std::array<TextParameter<CanSetup>, 1> texts{
      {{"interface", &CanSetup::interface, "name of the network interface, such as can0"}}};
  static constexpr std::array<Parameter<CanSetup>, 2> parameters{{
      {"bit_rate", "bit/s", {1e4, 1e6}, &CanSetup::bit_rate, 1e6, "bit rate of arbitration"},
      {"data_bit_rate",
       "bit/s",
       {1e5, 8e6},
       &CanSetup::data_bit_rate,
       {},
       "bit rate of the data of CAN FD frames; left out: classical frames"},
  }};
};

inline constexpr std::array<Choice<bool>, 2> motion_permissions{{
    {"refused", false, "commands that move an axis are refused"},
    {"allowed", true, "they are accepted"},
}};

inline constexpr std::array<Choice<bool>, 2> server_syncs{{
    {"sent", false, "by the drive: the controller answers it"},
    {"followed", true, "by the controller each period: the drive's clock follows it"},
}};

inline constexpr std::array<Choice<ServerFrames>, 3> server_frames{{
    {"positions", ServerFrames::positions,
     "controlwords and targets, statuswords and positions: half of the bus's load"},
    {"all", ServerFrames::all, "in addition offsets of velocity and torque, velocities and following errors"},
    {"torques", ServerFrames::torques, "in addition actual torques"},
}};

template <>
struct Table<CanServerSetup> : EmptyTable<CanServerSetup> {
  static constexpr std::string_view text = "CAN bus on which a motion controller gives the axes their set-points";
  static constexpr std::array<TextParameter<CanServerSetup>, 1> texts{
      {{"interface", &CanServerSetup::interface, "name of the network interface; may be that of [drive.can]"}}};
  static constexpr std::array<Parameter<CanServerSetup>, 6> parameters{{
      {"bit_rate", "bit/s", {1e4, 1e6}, &CanServerSetup::bit_rate, 1e6, "bit rate of arbitration"},
      {"data_bit_rate",
       "bit/s",
       {1e5, 8e6},
       &CanServerSetup::data_bit_rate,
       {},
       "bit rate of the data of CAN FD frames; left out: classical frames"},
      {"period",
       "s",
       {100e-6, 20e-3},
       &CanServerSetup::period,
       {},
       "time from one set-point to the next, whole slow periods; left out: the slow period"},
      {"position_increment",
       "m",
       {1e-12, 1e-6},
       &CanServerSetup::position_increment,
       1e-9,
       "a unit of target and actual position; a unit of velocity is 1000 of them a second"},
      {"commander_timeout", "s", not_negative(60.0), &CanServerSetup::commander_timeout, 0.5,
       "time without a frame for an axis, or a heartbeat, after which the controller that commands it is lost; 0: it "
       "is "
       "not watched"},
      {"heartbeat_node",
       "1",
       {0, 127},
       &CanServerSetup::heartbeat_node,
       0.0,
       "node of the controller, whose heartbeats at 700h + node count for all axes; 0: its frames alone count"},
  }};
  static constexpr std::tuple choices{
      ChoiceParameter<CanServerSetup, bool>{"sync", &CanServerSetup::sync_followed, server_syncs, false,
                                            "sender of SYNC, 80h, which gives the clock"},
      ChoiceParameter<CanServerSetup, ServerFrames>{"frames", &CanServerSetup::frames, server_frames, ServerFrames::all,
                                                    "frames that are exchanged in each period in addition to SYNC"},
      ChoiceParameter<CanServerSetup, bool>{"motion", &CanServerSetup::motion_allowed, motion_permissions, false,
                                            "controlwords and set-points that a motion controller sends"}};
};

inline constexpr std::array<Choice<InputBias>, 4> input_biases{{
    {"as-is", InputBias::as_is, "as the board's firmware left it"},
    {"pull-up", InputBias::pull_up, "to the supply"},
    {"pull-down", InputBias::pull_down, "to ground"},
    {"none", InputBias::none, "off"},
}};

template <>
struct Table<GpioSetup> : EmptyTable<GpioSetup> {
  static constexpr std::string_view text = "lines of a gpiochip and the kernel's PWM class";
  static constexpr std::array<TextParameter<GpioSetup>, 2> texts{{
      {"chip", &GpioSetup::chip, "name or path of the gpiochip"},
      {"pwm_chip", &GpioSetup::pwm_chip, "folder of the PWM class, such as /sys/class/pwm/pwmchip0"},
  }};
  static constexpr std::tuple choices{ChoiceParameter<GpioSetup, InputBias>{
      "bias", &GpioSetup::bias, input_biases, InputBias::as_is, "resistor inside the chip at every input"}};
  static constexpr std::array<Parameter<GpioSetup>, 4> parameters{{
      {"watchdog", "1", line_numbers, &GpioSetup::watchdog, -1.0,
       "line of the pulse for a watchdog outside of the computer, by its number; -1: not wired"},
      {"watchdog_period",
       "s",
       {62.5e-6, 1.0},
       &GpioSetup::watchdog_period,
       10e-3,
       "time from one edge of that pulse to the next, as long as the loop goes on"},
      {"pwm_period", "s", {1e-6, 1e-2}, &GpioSetup::pwm_period, 62.5e-6, "period of the PWM"},
      {"dc_link", "V", not_negative(1500.0), &GpioSetup::dc_link, 0.0,
       "voltage between the rails of the half bridges behind the PWM; 0: none"},
  }};
};

template <>
struct Table<ModbusClientSetup> : EmptyTable<ModbusClientSetup> {
  static constexpr std::string_view text = "a slow power stage or remote inputs and outputs over Modbus";
  static constexpr std::array<TextParameter<ModbusClientSetup>, 1> texts{
      {{"device", &ModbusClientSetup::device, "a serial device for RTU, or HOST:PORT for TCP"}}};
  static constexpr std::array<Parameter<ModbusClientSetup>, 3> parameters{{
      {"baud_rate", "1", {1200, 1000000}, &ModbusClientSetup::baud_rate, 115200.0, "bits a second of RTU, 8E1"},
      {"unit", "1", {1, 247}, &ModbusClientSetup::unit, 1.0, "address of the slave"},
      {"period", "s", {1e-3, 10.0}, &ModbusClientSetup::period, 10e-3, "time from one exchange to the next"},
  }};
};

template <>
struct Table<ModbusServerSetup> : EmptyTable<ModbusServerSetup> {
  static constexpr std::string_view text = "data that the drive publishes to a PLC or an operator panel over Modbus";
  static constexpr std::array<TextParameter<ModbusServerSetup>, 1> texts{
      {{"address", &ModbusServerSetup::address, "HOST:PORT to listen on, or a serial device for RTU"}}};
  static constexpr std::array<Parameter<ModbusServerSetup>, 4> parameters{{
      {"baud_rate", "1", {1200, 1000000}, &ModbusServerSetup::baud_rate, 115200.0, "bits a second of RTU, 8E1"},
      {"unit", "1", {1, 247}, &ModbusServerSetup::unit, 1.0, "address of the drive on RTU"},
      {"commander_timeout", "s", not_negative(60.0), &ModbusServerSetup::commander_timeout, 1.0,
       "time without a write to a register that moves an axis, after which the client that commands it is lost; 0: it "
       "is not watched"},
      {"commissioning_time", "s", not_negative(86400.0), &ModbusServerSetup::commissioning_time, 900.0,
       "time for which SIGUSR1 lets clients write parameters; 0: never"},
  }};
  static constexpr std::tuple choices{ChoiceParameter<ModbusServerSetup, bool>{
      "motion", &ModbusServerSetup::motion_allowed, motion_permissions, false, "commands that move an axis"}};
};

template <>
struct Table<RealTimeSetup> : EmptyTable<RealTimeSetup> {
  static constexpr std::string_view text = "how the loop is run";
  static constexpr std::array<Parameter<RealTimeSetup>, 2> parameters{{
      {"priority", "1", {0, 98}, &RealTimeSetup::priority, 80.0, "priority of SCHED_FIFO; 0: no real time"},
      {"cpu", "1", {-1, 1023}, &RealTimeSetup::cpu, -1.0, "processor of the loop; -1: any"},
  }};
};

inline constexpr std::array<Choice<HomingMethod>, 8> homing_methods{{
    {"none", HomingMethod::none, "the encoder is absolute"},
    {"here", HomingMethod::here, "the present position (CiA 402 method 35)"},
    {"limit-negative", HomingMethod::limit_negative, "the negative limit switch (17)"},
    {"limit-positive", HomingMethod::limit_positive, "the positive limit switch (18)"},
    {"home-positive", HomingMethod::home_positive, "the home switch, searched for in +x (19)"},
    {"home-negative", HomingMethod::home_negative, "the home switch, searched for in -x (21)"},
    {"index-negative", HomingMethod::index_negative, "the next index in -x (33)"},
    {"index-positive", HomingMethod::index_positive, "the next index in +x (34)"},
}};

template <>
struct Table<HomingSetup> : EmptyTable<HomingSetup> {
  static constexpr std::string_view text = "how the axis finds its zero";
  static constexpr std::tuple choices{ChoiceParameter<HomingSetup, HomingMethod>{
      "method", &HomingSetup::method, homing_methods, HomingMethod::none, "mark that it searches for"}};
  static constexpr std::array<Parameter<HomingSetup>, 3> parameters{{
      {"search_speed", "m/s", positive(1.0), &HomingSetup::search_speed, 0.02, "speed towards the switch"},
      {"creep_speed", "m/s", positive(0.1), &HomingSetup::creep_speed, 0.002, "speed off the switch or to the index"},
      {"offset", "m", any_value(), &HomingSetup::offset, 0.0, "position of the mark"},
  }};
};

// As many as stop_option_table has; the test of the table holds both together.
inline constexpr std::array<Choice<std::int8_t>, 5> quick_stop_codes{{
    {"off", 0, "power off at once, the axis coasts (code 0)"},
    {"slow-down", 1, "slow_down_deceleration, then power off (1)"},
    {"quick-stop", 2, "quick_stop_deceleration, then power off (2)"},
    {"slow-down-held", 5, "slow_down_deceleration, then held under power (5)"},
    {"quick-stop-held", 6, "quick_stop_deceleration, then held under power (6)"},
}};
inline constexpr std::array<Choice<std::int8_t>, 2> disable_codes{{
    {"off", 0, "power off at once, the axis coasts (code 0)"},
    {"slow-down", 1, "slow_down_deceleration, then power off (1)"},
}};
inline constexpr std::array<Choice<std::int8_t>, 2> halt_codes{{
    {"slow-down", 1, "slow_down_deceleration; a profile its own deceleration (code 1)"},
    {"quick-stop", 2, "quick_stop_deceleration (2)"},
}};
inline constexpr std::array<Choice<std::int8_t>, 3> fault_reaction_codes{{
    {"off", 0, "power off at once, the axis coasts (code 0)"},
    {"slow-down", 1, "slow_down_deceleration, then power off (1)"},
    {"quick-stop", 2, "quick_stop_deceleration, then power off (2)"},
}};

inline constexpr std::array<Choice<std::int8_t>, 4> commander_lost_codes{{
    {"none", 0, "nothing, the axis goes on (code 0)"},
    {"fault", 1, "fault 53, a controlled stop; a reset is needed afterwards (1)"},
    {"off", 2, "power off at once, the axis coasts (2)"},
    {"quick-stop", 3, "a quick stop, without a fault (3)"},
}};

template <>
struct Table<StopSetup> : EmptyTable<StopSetup> {
  static constexpr std::string_view text = "how the axis stops: option codes of CiA 402";
  static constexpr std::tuple choices{
      ChoiceParameter<StopSetup, std::int8_t>{"quick_stop", &StopSetup::quick_stop, quick_stop_codes, 2,
                                              "605Ah, by bit 2 of the controlword or a fault of a different axis"},
      ChoiceParameter<StopSetup, std::int8_t>{"shutdown", &StopSetup::shutdown, disable_codes, 1,
                                              "605Bh, from operation enabled to ready to switch on"},
      ChoiceParameter<StopSetup, std::int8_t>{"disable_operation", &StopSetup::disable_operation, disable_codes, 1,
                                              "605Ch, from operation enabled to switched on"},
      ChoiceParameter<StopSetup, std::int8_t>{"halt", &StopSetup::halt, halt_codes, 1,
                                              "605Dh, by bit 8 of the controlword"},
      ChoiceParameter<StopSetup, std::int8_t>{"fault_reaction", &StopSetup::fault_reaction, fault_reaction_codes, 2,
                                              "605Eh, of a fault that ends in a controlled stop"},
      ChoiceParameter<StopSetup, std::int8_t>{"commander_lost", &StopSetup::commander_lost, commander_lost_codes, 1,
                                              "6007h, when nothing more is heard of who commands the axis"}};
};

inline constexpr std::array<Choice<ActiveLevel>, 2> active_levels{{
    {"high", ActiveLevel::high, "the line is high while the signal is active"},
    {"low", ActiveLevel::low, "low, as of an opening contact to the supply; a broken wire is active too"},
}};
inline constexpr auto active_level = [](std::string_view key, ActiveLevel LineSetup::*member, std::string_view text) {
  return ChoiceParameter<LineSetup, ActiveLevel>{key, member, active_levels, ActiveLevel::high, text};
};

template <>
struct Table<LineSetup> : EmptyTable<LineSetup> {
  static constexpr std::string_view text = "lines of the gpiochip by their number; -1: not wired";
  static constexpr std::tuple choices{
      active_level("enable_active", &LineSetup::enable_active, "level of enable that turns the power stage on"),
      active_level("brake_active", &LineSetup::brake_active, "level of brake that releases it"),
      active_level("fault_active", &LineSetup::fault_active, "level of fault that reports one"),
      active_level("limit_active", &LineSetup::limit_active, "level of both limit switches when they are reached"),
      active_level("home_active", &LineSetup::home_active, "level of the home switch when it is reached"),
      active_level("index_active", &LineSetup::index_active, "level of the index mark"),
      active_level("torque_off_active", &LineSetup::torque_off_active,
                   "level of both channels of safe torque off when they are open"),
      active_level("hall_active", &LineSetup::hall_active, "level of the Hall signals when they are true"),
  };
  static constexpr std::array<Parameter<LineSetup>, 18> parameters{{
      {"enable", "1", line_numbers, &LineSetup::enable, -1.0, "power stage on"},
      {"brake", "1", line_numbers, &LineSetup::brake, -1.0, "brake released"},
      {"fault", "1", line_numbers, &LineSetup::fault, -1.0, "fault of the power stage"},
      {"limit_negative", "1", line_numbers, &LineSetup::limit_negative, -1.0, "limit switch at the negative end"},
      {"limit_positive", "1", line_numbers, &LineSetup::limit_positive, -1.0, "limit switch at the positive end"},
      {"home", "1", line_numbers, &LineSetup::home, -1.0, "home switch"},
      {"index", "1", line_numbers, &LineSetup::index, -1.0, "index mark of the encoder"},
      {"torque_off_a", "1", line_numbers, &LineSetup::torque_off_a, -1.0, "safe torque off, channel A open"},
      {"torque_off_b", "1", line_numbers, &LineSetup::torque_off_b, -1.0, "safe torque off, channel B open"},
      {"hall_a", "1", line_numbers, &LineSetup::hall_a, -1.0, "Hall signal A of the motor"},
      {"hall_b", "1", line_numbers, &LineSetup::hall_b, -1.0, "Hall signal B of the motor"},
      {"hall_c", "1", line_numbers, &LineSetup::hall_c, -1.0, "Hall signal C of the motor"},
      {"quadrature_a", "1", line_numbers, &LineSetup::quadrature_a, -1.0, "track A of the encoder"},
      {"quadrature_b", "1", line_numbers, &LineSetup::quadrature_b, -1.0, "track B of the encoder"},
      {"quadrature_increment", "m", not_negative(1e-3), &LineSetup::quadrature_increment, 0.0,
       "distance from one edge of the tracks to the next; 0: the increment of the encoder"},
      {"quadrature_rate", "1/s", positive(1e6), &LineSetup::quadrature_rate, 10e3,
       "edges per second of both tracks that the kernel of this machine processes in a measurement; more are a fault"},
      {"quadrature_settle", "s", not_negative(1e-2), &LineSetup::quadrature_settle, 50e-6,
       "time by which an edge may come late out of its interrupt; the position is so old"},
      {"pwm_channel", "1", line_numbers, &LineSetup::pwm_channel, -1.0, "PWM channel of the first phase"},
  }};
};

template <>
struct Table<DriveAxisSetup> : EmptyTable<DriveAxisSetup> {
  static constexpr std::string_view text = "one axis as the drive's programme runs it";
  static constexpr std::array<Parameter<DriveAxisSetup>, 16> parameters{{
      {"node", "1", {0, 127}, &DriveAxisSetup::node, 0.0, "node of its power stage and encoder on the bus; 0: none"},
      {"server_node",
       "1",
       {0, 127},
       &DriveAxisSetup::server_node,
       0.0,
       "node of the axis on the bus of [drive.can_server]; 0: none"},
      {"quick_stop_deceleration", "m/s^2", positive(500.0), &DriveAxisSetup::quick_stop_deceleration, 10.0,
       "deceleration of a controlled stop"},
      {"slow_down_deceleration",
       "m/s^2",
       positive(500.0),
       &DriveAxisSetup::slow_down_deceleration,
       {},
       "deceleration of a stop by the slow-down ramp, at most that of a controlled stop; left out: the same"},
      {"brake_time", "s", not_negative(10.0), &DriveAxisSetup::brake_time, 0.0,
       "time that the brake takes to open or to close"},
      {"frozen_distance", "m", positive(0.1), &DriveAxisSetup::frozen_distance, 100e-6,
       "displacement of the set-point within which the encoder must show a different position"},
      {"encoder_jump",
       "m",
       positive(0.1),
       &DriveAxisSetup::encoder_jump,
       {},
       "deviation of a position from the one that the speed predicts; left out: twice the displacement in the square "
       "of a "
       "fast period at the acceleration of the motor's largest force, at least 0.005 mm"},
      {"current_sum",
       "A",
       positive(),
       &DriveAxisSetup::current_sum,
       {},
       "sum of the phase currents that means an offset; left out: a twentieth of the current limit"},
      {"runaway_current",
       "A",
       positive(),
       &DriveAxisSetup::runaway_current,
       {},
       "current from which speed must follow force; left out: a fifth of the current limit"},
      {"following_error_timeout", "s", not_negative(1.0), &DriveAxisSetup::following_error_timeout, 0.0,
       "6066h: time for which supervision.following_error (6065h) may be exceeded before a controlled stop; above "
       "twice "
       "of it the power goes at once"},
      {"max_motor_speed",
       "m/s",
       positive(),
       &DriveAxisSetup::max_motor_speed,
       {},
       "6080h: speed within which the axis is held in cyclic synchronous torque, at most max_velocity; left out: "
       "max_velocity"},
      {"torque_slope",
       "A/s",
       positive(),
       &DriveAxisSetup::torque_slope,
       {},
       "6087h: change of the set current in cyclic synchronous torque; left out: the current limit in 10 ms"},
      {"target_window", "m", positive(1e-2), &DriveAxisSetup::target_window, 10e-6,
       "distance from a profile's target at which it is reached"},
      {"profile_jerk_time", "s", not_negative(1.0), &DriveAxisSetup::profile_jerk_time, 16e-3,
       "time in which a profile's acceleration comes and goes; taken as a power of two of ticks, at most 1024"},
      {"negative_end", "m", any_value(), &DriveAxisSetup::negative_end, {}, "end of the travel; left out: -travel/2"},
      {"positive_end", "m", any_value(), &DriveAxisSetup::positive_end, {}, "end of the travel; left out: travel/2"},
  }};
  static constexpr std::tuple subtables{
      Subtable<DriveAxisSetup, HomingSetup>{"homing", &DriveAxisSetup::homing, Presence::optional},
      Subtable<DriveAxisSetup, StopSetup>{"stops", &DriveAxisSetup::stops, Presence::optional},
      Subtable<DriveAxisSetup, LineSetup>{"line", &DriveAxisSetup::line, Presence::optional},
      Subtable<DriveAxisSetup, CommutationSetup>{"commutation", &DriveAxisSetup::commutation, Presence::optional},
      Subtable<DriveAxisSetup, BrakeTestSetup>{"brake_test", &DriveAxisSetup::brake_test, Presence::optional},
      Subtable<DriveAxisSetup, ProtectionSetup>{"protection", &DriveAxisSetup::protection, Presence::optional},
      Subtable<DriveAxisSetup, CamAxisSetup>{"cam", &DriveAxisSetup::cam, Presence::optional}};
};

template <>
struct Table<DriveSetup> : EmptyTable<DriveSetup> {
  static constexpr std::string_view text = "settings of the drive programme in addition to the machine";
  static constexpr std::tuple subtables{
      Subtable<DriveSetup, std::optional<CanSetup>>{"can", &DriveSetup::can, Presence::optional},
      Subtable<DriveSetup, std::optional<CanServerSetup>>{"can_server", &DriveSetup::can_server, Presence::optional},
      Subtable<DriveSetup, std::optional<MasterEncoderSetup>>{"master_encoder", &DriveSetup::master_encoder,
                                                              Presence::optional},
      Subtable<DriveSetup, std::optional<GpioSetup>>{"gpio", &DriveSetup::gpio, Presence::optional},
      Subtable<DriveSetup, std::optional<ModbusClientSetup>>{"modbus_client", &DriveSetup::modbus_client,
                                                             Presence::optional},
      Subtable<DriveSetup, std::optional<ModbusServerSetup>>{"modbus_server", &DriveSetup::modbus_server,
                                                             Presence::optional},
      Subtable<DriveSetup, CamSwitchSetup>{"cam_switch", &DriveSetup::cam_switch, Presence::optional},
      Subtable<DriveSetup, std::optional<CamTuningSetup>>{"cam_tuning", &DriveSetup::cam_tuning, Presence::optional},
      Subtable<DriveSetup, RealTimeSetup>{"real_time", &DriveSetup::real_time, Presence::optional}};
};

}  // namespace stiction::machine
