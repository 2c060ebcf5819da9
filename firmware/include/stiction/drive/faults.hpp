// The faults of a drive: what is watched, by whom, how fast it is seen and what follows. One table; numbers are stable,
// they appear in logs and on buses. "Limiting" is not a fault. Conventions: shared practice of CiA 402 drives (a fault
// is latched, the reaction runs to its end, a reset is taken only when the cause has gone).
#pragma once

#include <array>
#include <cstdint>

namespace stiction {

enum class Fault : std::uint8_t {
  none = 0,
  // Seen by the axis itself (axis.hpp).
  following_error = 1,
  over_current = 2,
  over_speed = 3,
  position_lost = 4,
  drive_input = 5,
  set_point = 6,
  limit_cycle = 7,
  // Seen by the supervision around it (supervision.hpp).
  encoder_frozen = 16,
  encoder_jump = 17,
  current_offset = 18,
  runaway = 19,
  limit_switch = 20,
  limit_switch_stuck = 21,
  homing = 22,
  // Seen by the backend on its bus (hal/).
  frames_lost = 32,
  frames_disturbed = 33,
  bus_off = 34,
  bus_overload = 35,
  encoder_signal = 36,
  // Seen by the drive's programme and by who watches it (firmware/stictiond).
  missed_deadline = 48,
  clock_jump = 49,
  parameters_damaged = 50,
  watchdog_starved = 51,
  set_points_lost = 52,
  commander_lost = 53,
  // Of an axis that follows a master (cam_mode.hpp).
  master_lost = 64,
  master_too_fast = 65,
  synchronisation_lost = 66,
  cam_table = 67,
  // Of the motor and its power stage: commutation_search.hpp, protection.hpp, brake_test.hpp.
  commutation_not_found = 80,
  commutation_offset = 81,
  motor_overload = 82,
  stage_overload = 83,
  dc_link_high = 84,
  dc_link_low = 85,
  motor_temperature = 86,
  stage_temperature = 87,
  temperature_sensor = 88,
  torque_off_in_motion = 89,
  torque_off_channels = 90,
  brake_slips = 91,
};

enum class Detector : std::uint8_t { axis, supervision, backend, programme, protection };

enum class Reaction : std::uint8_t {
  disable,       // the power stage is off in the same tick
  quick_stop,    // controlled stop with the quick-stop deceleration, then off; a second fault on the way disables
  refuse_start,  // nothing is enabled
};

struct FaultDescription {
  Fault fault;
  const char* name;
  const char* condition;
  int detection_ticks;       // of the fast loop, from the first violating sample; 0: depends on the signal
  std::uint16_t error_code;  // 603Fh, and of an emergency message: IEC 61800-7-201 and CiA 301
  Detector detector = Detector::axis;
  Reaction reaction = Reaction::disable;
  bool loses_reference = false;  // the encoder may have lost its place: what counts from homing on is not to be used
};

// Reset of all: a fault reset, taken only when the cause has gone, then a new start of the axis.
inline constexpr std::array<FaultDescription, 41> fault_table{{
    {Fault::following_error, "following error",
     "|x_set - x| above supervision.following_error for longer than drive.axis.NAME.following_error_timeout; above "
     "twice of it, or where a force above runaway_current meets an acceleration the other way that does not abate, the "
     "power is off in the same tick",
     1, 0x8611, Detector::axis, Reaction::quick_stop},
    {Fault::over_current, "over-current", "|i| above supervision.over_current", 1, 0x2310},
    {Fault::over_speed, "over-speed", "|v| above supervision.over_speed", 1, 0x8400},
    {Fault::position_lost, "position lost", "no valid encoder position in three ticks in a row", 3, 0x7305,
     Detector::axis, Reaction::disable, true},
    {Fault::drive_input, "drive fault input", "the power stage or the encoder reports a fault", 1, 0x5400,
     Detector::axis, Reaction::disable, true},
    {Fault::set_point, "set-point",
     "a set-point that is not a number or exceeds the number format; from a bus: beyond the travel, max_velocity or "
     "max_acceleration",
     1, 0x8612, Detector::axis, Reaction::quick_stop},
    {Fault::limit_cycle, "limit cycle",
     "current or voltage goes from one limit to the other more than 12 times in 125 ms", 0, 0x8a00},
    {Fault::encoder_frozen, "encoder frozen",
     "new samples repeat exactly the same position while the set-point moved by frozen_distance", 0, 0x7305,
     Detector::supervision, Reaction::disable, true},
    {Fault::encoder_jump, "encoder jump",
     "the position differs by more than encoder_jump from the one that the speed predicts", 1, 0x7305,
     Detector::supervision, Reaction::disable, true},
    {Fault::current_offset, "current sensor offset",
     "|i_A + i_B + i_C|, or one phase current without power, is above current_sum for 16 ticks in a row", 16, 0x7200,
     Detector::supervision},
    {Fault::runaway, "runaway",
     "the speed rises within 16 ticks against a force above runaway_current, by more than half of the change that this "
     "force would cause",
     16, 0x7302, Detector::supervision},
    {Fault::limit_switch, "limit switch", "a limit switch is reached while the axis moves towards it", 1, 0xff14,
     Detector::supervision, Reaction::quick_stop},
    {Fault::limit_switch_stuck, "limit switch stuck",
     "both limit switches are active at once, one is active far inside its end, or none is active beyond it", 1, 0xff15,
     Detector::supervision, Reaction::quick_stop},
    {Fault::homing, "homing", "the switch or index was not found within the travel or the time", 0, 0xff16,
     Detector::supervision, Reaction::quick_stop},
    {Fault::frames_lost, "frames lost", "no valid frame of a node in three ticks in a row", 3, 0x8100,
     Detector::backend, Reaction::disable, true},
    {Fault::frames_disturbed, "frames disturbed",
     "more than 10 frames were late, duplicated, out of order, stale or damaged within a second", 1, 0x8100,
     Detector::backend, Reaction::quick_stop},
    {Fault::bus_off, "bus off", "the CAN controller left the bus", 1, 0x8140, Detector::backend, Reaction::disable,
     true},
    {Fault::bus_overload, "bus overload", "more than 16 frames with an unknown identifier arrived within 16 ticks", 16,
     0x8110, Detector::backend, Reaction::quick_stop},
    {Fault::encoder_signal, "encoder signal",
     "quadrature edges came faster than quadrature_rate, an edge was lost, or both tracks changed at once", 1, 0x7305,
     Detector::backend, Reaction::disable, true},
    {Fault::missed_deadline, "missed deadline", "two ticks in a row began later than a period", 2, 0xff30,
     Detector::programme, Reaction::quick_stop},
    {Fault::clock_jump, "clock jump",
     "the clock went back, or advanced by more than 100 ms between two ticks, or the computer was suspended", 1, 0xff31,
     Detector::programme},
    {Fault::parameters_damaged, "parameters damaged", "version, length or checksum of the parameter file is wrong", 0,
     0x6320, Detector::programme, Reaction::refuse_start},
    {Fault::watchdog_starved, "watchdog starved", "the loop made no progress within the watchdog time", 0, 0x6010,
     Detector::programme},
    {Fault::set_points_lost, "set-points lost", "no new set-point arrived from the bus in three cycles in a row", 0,
     0x8700, Detector::programme, Reaction::quick_stop},
    {Fault::commander_lost, "commander lost",
     "no command or heartbeat of the axis' owner came within commander_timeout while the axis had power", 0, 0x8130,
     Detector::programme, Reaction::quick_stop},
    {Fault::master_lost, "master lost", "no valid position of the master of an axis that follows it", 1, 0xff40,
     Detector::programme, Reaction::quick_stop},
    {Fault::master_too_fast, "master too fast",
     "the master exceeds the speed of --speed, or the acceleration that belongs to it, while an axis follows it", 1,
     0xff41, Detector::programme, Reaction::quick_stop},
    {Fault::synchronisation_lost, "synchronisation lost",
     "the master of an axis that follows it is not where its speed leads: it jumped", 1, 0xff42, Detector::programme,
     Reaction::quick_stop},
    {Fault::cam_table, "cam table",
     "a table of --cam is damaged, is for a different kind of axis or cycle, asks for more than the axis keeps, or its "
     "position, speed or acceleration jumps: the programme says so and ends with exit status 2",
     0, 0x6320, Detector::programme, Reaction::refuse_start},
    {Fault::commutation_not_found, "commutation not found",
     "the test at the enabling moved the axis too little with all of test_current or by more than test_way, or the "
     "Hall "
     "signals show no sector",
     0, 0x7122, Detector::protection},
    {Fault::commutation_offset, "commutation offset",
     "the stored offset, or the one in force, differs by more than commutation.tolerance from what test, Hall signals "
     "or "
     "index mark show",
     0, 0x7122, Detector::protection},
    {Fault::motor_overload, "motor overload",
     "I2t: the motor's thermal model is 2.5 % above the state to which protection.motor_current leads", 1, 0x2350,
     Detector::protection, Reaction::quick_stop},
    {Fault::stage_overload, "power stage overload",
     "I2t: the thermal model of a phase of the power stage is 2.5 % above the state to which protection.stage_current "
     "leads",
     1, 0x2350, Detector::protection, Reaction::quick_stop},
    {Fault::dc_link_high, "DC link over-voltage", "the DC link is above protection.dc_link_high", 1, 0x3210,
     Detector::protection},
    {Fault::dc_link_low, "DC link under-voltage", "the DC link is below protection.dc_link_low for 16 ticks in a row",
     16, 0x3220, Detector::protection, Reaction::quick_stop},
    {Fault::motor_temperature, "motor temperature",
     "the motor is hotter than protection.motor_temperature for 16 ticks in a row", 16, 0x4310, Detector::protection,
     Reaction::quick_stop},
    {Fault::stage_temperature, "power stage temperature",
     "the power stage is hotter than protection.stage_temperature for 16 ticks in a row", 16, 0x4210,
     Detector::protection, Reaction::quick_stop},
    {Fault::temperature_sensor, "temperature sensor",
     "a temperature that is watched is below -55 or above 300 degrees Celsius for 16 ticks in a row, as of a broken "
     "wire",
     16, 0xff58, Detector::protection, Reaction::quick_stop},
    {Fault::torque_off_in_motion, "safe torque off under power", "a channel of safe torque off opened under power", 1,
     0xff59, Detector::protection},
    {Fault::torque_off_channels, "safe torque off channels",
     "the channels of safe torque off differ for 3200 ticks in a row, 200 ms at 62.5 µs", 3200, 0xff5a,
     Detector::protection},
    {Fault::brake_slips, "brake slips",
     "under brake_test.current the closed brake lets the axis go by more than brake_test.way", 1, 0xff5b,
     Detector::protection},
}};

constexpr const FaultDescription* description_of(Fault fault) {
  for (const auto& row : fault_table)
    if (row.fault == fault) return &row;
  return nullptr;
}

// 603Fh; 0: no fault.
constexpr std::uint16_t error_code_of(Fault fault) {
  const auto* row = description_of(fault);
  return row == nullptr ? 0 : row->error_code;
}

// Whether the encoder may have lost its place.
constexpr bool loses_reference(Fault fault) {
  const auto* row = description_of(fault);
  return row != nullptr && row->loses_reference;
}

constexpr const char* name_of(Fault fault) {
  const auto* row = description_of(fault);
  return row == nullptr ? "none" : row->name;
}

// Which limits held an output back in a tick.
struct Limiting {
  bool velocity = false;
  bool current = false;
  bool voltage = false;
};

}  // namespace stiction
