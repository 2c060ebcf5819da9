// A slow power stage or remote inputs as a Modbus slave: its registers, for the client that drives it (client.hpp) and
// for a program that plays one over ModbusServer. One axis a slave. One exchange of function 23 writes the command and
// reads the state.
#pragma once

#include <cstdint>
#include <span>

#include "hal/modbus/register_map.hpp"

namespace stiction::hal {

inline constexpr std::uint16_t power_stage_identification = 0x5354;  // "ST"
// Since 2 it tells of its DC link, temperatures and safe torque off; a stage of before has none of them.
inline constexpr std::uint16_t power_stage_schema = 2, oldest_power_stage_schema = 1;
// Holding registers of an exchange, from the first on.
inline constexpr std::uint16_t power_stage_read = 0, power_stage_read_words = 14;
constexpr std::uint16_t words_of_schema(std::uint16_t schema) { return schema == 1 ? 10 : power_stage_read_words; }
inline constexpr std::uint16_t power_stage_written = 16, power_stage_written_words = 6;

struct PowerStageState {
  bool fault = false;
  bool limit_negative = false, limit_positive = false, home = false;
  bool enabled = false;
  std::uint16_t cycle = 0;                          // counts the slave's cycles: the same number again is an old state
  double position = 0.0;                            // m
  double velocity = 0.0;                            // m/s
  double current = 0.0;                             // A, amplitude that makes the force
  bool torque_off_a = false, torque_off_b = false;  // channels of safe torque off that are open
  bool has_torque_off = false, has_dc_link = false, has_motor_temperature = false, has_stage_temperature = false;
  double dc_link = 0.0;                                     // V
  double motor_temperature = 0.0, stage_temperature = 0.0;  // degrees Celsius
};

struct PowerStageCommand {
  bool enable = false;
  bool release_brake = false;
  std::uint16_t cycle = 0;  // counts the master's exchanges: the slave stops where it stands still
  double velocity = 0.0;    // m/s; a stage with a velocity controller follows it
  double voltage = 0.0;     // V; one without applies it
};

// In the order of power_stage_map().registers().
const RegisterMap& power_stage_map();
void put_power_stage_values(const PowerStageState& state, std::span<double> values);
// What a client wrote becomes part of the command.
void apply(const RegisterWrite& write, PowerStageCommand& command);

// The words of an exchange. Of an older schema's state those that it lacks are zero.
void put_words(const PowerStageCommand& command, std::span<std::uint16_t, power_stage_written_words> words);
PowerStageState state_in(std::span<const std::uint16_t, power_stage_read_words> words);

}  // namespace stiction::hal
