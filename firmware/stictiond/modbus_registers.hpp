// What the drive publishes over Modbus and takes from there: its registers made from the parameters' descriptions, the
// state that the loop hands over, and what a client's write means. docs/modbus_registers.md is printed from here.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "firmware/machine/file/machine_file.hpp"
#include "firmware/stictiond/parameters.hpp"
#include "hal/modbus/register_map.hpp"
#include "stiction/drive/remote_axis.hpp"

namespace stiction::drive {

inline constexpr std::uint16_t modbus_identification = 0x5344;  // "SD"
inline constexpr std::uint16_t modbus_schema = 5;               // of the registers; changes with any address
inline constexpr std::size_t most_published_axes = 8;
// From the registers of an axis to those of the next one: of state and commands, and of parameters.
inline constexpr std::uint16_t axis_registers = 100, parameter_registers = 200;

// Of the modes of cam and gear.
struct PublishedCam {
  // Bits: busy, active, in sync, waiting, command aborted, the master is known; the second cam busy, in sync.
  std::uint16_t state = 0;
  CamRefusal refusal = CamRefusal::none;
  std::uint16_t followed = 0, second = 0;  // tables
  std::uint32_t ends = 0;                  // of cycles, that were passed
  double master_phase = 0.0;               // cycles, 0 to 1
  std::int32_t master_cycles = 0;
  double master_speed = 0.0;  // cycles/s
  // What was asked for last.
  std::uint16_t table = 1, trigger = 0, approach = 0, options = 0;
  double time = 0.0, distance = 0.0, at = 0.0;                                  // s, cycles
  double master_offset = 0.0, slave_offset = 0.0, slave_scale = 1.0;            // cycles, m
  double gear_way = 0.0, phase = 0.0;                                           // m, cycles
  double tolerance = 0.0, tolerance_speed = 0.0, tolerance_acceleration = 0.0;  // m, m/s, m/s^2
  double leave_speed = 0.0, superposed = 0.0, leave_position = 0.0;             // m/s, m, m
  std::int32_t numerator = 1;
  std::uint16_t denominator = 1;
};

// Of the tuner of a cam, on the axis that has one.
struct PublishedCamTuning {
  std::uint16_t state = 0, refusal = 12, steps = 0;  // numbers of cam_tuner.hpp and cam_tuning.hpp
  double quality = 0.0, before = 0.0;                // m, times cycles
  double frequency = 0.0;                            // Hz
};

struct PublishedAxis {
  std::uint16_t statusword = 0;  // CiA 402, 6041h
  std::int16_t mode = 0;         // 6061h
  Fault fault = Fault::none;
  bool limit_negative = false, limit_positive = false, home = false;
  double position = 0.0;         // m
  double set_position = 0.0;     // m
  double velocity = 0.0;         // m/s
  double current = 0.0;          // A, amplitude that makes the force
  double following_error = 0.0;  // m
  // Of the trace since it began.
  double peak_following_error = 0.0;  // m
  double peak_current = 0.0;          // A
  double rms_current = 0.0;           // A
  // Who commands it.
  CommandSource owner = CommandSource::none, held_by = CommandSource::none;
  std::uint16_t owner_token = 0;
  std::uint16_t owner_client = 0;  // of Modbus
  Refusal refusal = Refusal::none;
  // What was asked for last, by whomever.
  std::uint16_t controlword = 0;
  double target = 0.0;                                            // m
  double profile_velocity = 0.0, target_velocity = 0.0;           // m/s
  double torque = 0.0, target_torque = 0.0, max_torque = 0.0;     // of the current limit
  double profile_acceleration = 0.0, profile_deceleration = 0.0;  // m/s^2
  // Of motor and power stage.
  int commutation = 0;                        // 0: the electrical angle is not known, 1: it is tested, 2: it is known
  double commutation_offset = 0.0;            // degrees, electrical, at the encoder's zero, in force
  double motor_load = 0.0, stage_load = 0.0;  // of the thermal models; 1: what the continuous current leads to
  double dc_link = 0.0;                       // V
  double motor_temperature = 0.0, stage_temperature = 0.0;  // degrees Celsius
  bool torque_off_a = false, torque_off_b = false;          // open channels
  PublishedCam cam{};
  PublishedCamTuning cam_tuning{};
};

// How the last request to store ended.
enum class StoreResult : std::uint8_t { none, stored, under_way, rejected, not_written };

// What the loop hands over, as often as it likes, through hal::Snapshot<PublishedState>.
struct PublishedState {
  std::uint32_t seconds = 0;  // that the loop has run
  Fault fault = Fault::none;  // of the programme or the bus
  std::uint32_t missed_deadlines = 0;
  double largest_lateness = 0.0;            // s, of a tick's begin
  double largest_work = 0.0;                // s, of a tick
  std::uint32_t trace_rows = 0;             // recorded
  std::uint32_t trace_lost = 0;             // not recorded, because the trace was full
  std::uint32_t commissioning_seconds = 0;  // that clients may write parameters
  StoreResult store_result = StoreResult::none;
  std::uint16_t client = 0;  // number of the connection that asks
  std::array<PublishedAxis, most_published_axes> axes{};
};

// What a client wrote.
struct MotionWrite {
  enum class What : std::uint8_t {
    controlword,
    mode,
    target,
    velocity,
    acceleration,
    deceleration,
    target_velocity,
    target_torque,
    max_torque,
    // Of a cam; its command last, as what it needs may come in the same request.
    cam_table,
    cam_trigger,
    cam_approach,
    cam_options,
    cam_time,
    cam_distance,
    cam_at,
    cam_master_offset,
    cam_slave_offset,
    cam_slave_scale,
    gear_numerator,
    gear_denominator,
    gear_way,
    cam_phase,
    cam_tolerance,
    cam_tolerance_speed,
    cam_tolerance_acceleration,
    cam_leave_speed,
    cam_superposed,
    cam_leave_position,
    master_speed,
    cam_tuning_command,
    cam_command
  };
  static constexpr std::size_t kinds = 32;
  std::size_t axis = 0;
  What what = What::controlword;
  double value = 0.0;     // SI units; torques as shares of the current limit
  bool of_other = false;  // a stop of a client that the axis does not belong to (modbus_clients.hpp)
};
struct ParameterWrite {
  std::string key;
  double value = 0.0;  // SI units
};
struct StoreParameters {};  // the written parameters are to be kept, for the next start

using DriveWrite = std::variant<MotionWrite, ParameterWrite, StoreParameters>;

class ModbusRegisters {
 public:
  // Throws std::invalid_argument for more axes than most_published_axes.
  // `machine`, `setup`: as configured; `begun`: parameters that were stored before, to begin with.
  ModbusRegisters(const machine::Machine& machine, const machine::DriveSetup& setup,
                  const std::optional<ParameterSet>& begun = {});

  const hal::RegisterMap& map() const { return map_; }
  // One value a register: the state's and the parameters', those that were written included. From the server's thread.
  void put_values(const PublishedState& state, std::span<double> values) const;

  // The meaning of a client's write to one of the map's registers that are for writing. Allocates for a parameter.
  DriveWrite meaning_of(const hal::RegisterWrite& write) const;
  // Why a client may not write it; empty: it may.
  std::string rejection_of(const ParameterWrite& write) const;
  // A parameter that was written: shown from now on.
  void remember(const ParameterWrite& write);
  // All parameters that were written, or came from the store.
  ParameterSet written() const;
  // Begins with the stored set.
  void set_written(const ParameterSet& set);
  // Forgets what was written since the last set: of `set`, or of the machine file alone.
  void take_back(const std::optional<ParameterSet>& set);

 private:
  std::string machine_id_;
  std::size_t axis_count_;
  std::vector<DriveParameter> parameters_;
  hal::RegisterMap map_;
  std::size_t first_parameter_ = 0;  // its register
  mutable std::mutex mutex_;         // of what follows: written in one thread, shown in the server's
  ParameterSet written_;
  std::vector<double> values_;
};

// Builds everything that a start builds of a set; throws what refuses it.
using SetCheck = std::function<void(const ParameterSet&)>;

// The registers of a machine with one axis as a page of Markdown.
std::string modbus_register_page();

}  // namespace stiction::drive
