#include "hal/modbus/power_stage.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace stiction::hal {
namespace {

constexpr double position_scale = 1e-8;  // m: 32 bits reach 21 m

// Bits of the registers "inputs" and "control".
template <class Owner>
struct Bit {
  bool Owner::*member;
  const char* text;
};
constexpr std::array<Bit<PowerStageState>, 5> input_bits{{
    {&PowerStageState::fault, "fault"},
    {&PowerStageState::limit_negative, "negative limit switch reached"},
    {&PowerStageState::limit_positive, "positive limit switch reached"},
    {&PowerStageState::home, "home switch reached"},
    {&PowerStageState::enabled, "power stage on"},
}};
constexpr std::array<Bit<PowerStageState>, 6> protection_bits{{
    {&PowerStageState::torque_off_a, "channel A of safe torque off open"},
    {&PowerStageState::torque_off_b, "channel B of safe torque off open"},
    {&PowerStageState::has_torque_off, "safe torque off is told"},
    {&PowerStageState::has_dc_link, "dc_link is measured"},
    {&PowerStageState::has_motor_temperature, "motor_temperature is measured"},
    {&PowerStageState::has_stage_temperature, "stage_temperature is measured"},
}};
constexpr std::array<Bit<PowerStageCommand>, 2> control_bits{{
    {&PowerStageCommand::enable, "power stage on"},
    {&PowerStageCommand::release_brake, "brake released"},
}};

template <class Owner, std::size_t n>
double bits_of(const Owner& owner, const std::array<Bit<Owner>, n>& bits) {
  unsigned word = 0;
  for (std::size_t i = 0; i < n; ++i) word |= (owner.*bits[i].member ? 1U : 0U) << i;
  return word;
}
template <class Owner, std::size_t n>
void set_bits(Owner& owner, const std::array<Bit<Owner>, n>& bits, double value) {
  const auto word = static_cast<unsigned>(value);
  for (std::size_t i = 0; i < n; ++i) owner.*bits[i].member = (word >> i & 1U) != 0;
}
template <class Owner, std::size_t n>
std::string text_of(const std::array<Bit<Owner>, n>& bits) {
  std::string text;
  for (std::size_t i = 0; i < n; ++i) text += (i == 0 ? "bit " : "; bit ") + std::to_string(i) + ": " + bits[i].text;
  return text;
}

// A register with how its value is got from what it belongs to, and put there.
template <class Owner>
struct Row {
  std::uint16_t address;
  RegisterType type;
  double scale;
  const char* name;
  const char* unit;
  std::string text;
  double (*get)(const Owner&);
  void (*set)(Owner&, double);
};

using enum RegisterType;

const std::array<Row<PowerStageState>, 11>& state_rows() {
  using S = PowerStageState;
  static const std::array<Row<S>, 11> rows{{
      {0, uint16, 1, "identification", "1", "21332 identifies a power stage for stiction",
       [](const S&) -> double { return power_stage_identification; }, [](S&, double) {}},
      {1, uint16, 1, "schema", "1", "version of these registers", [](const S&) -> double { return power_stage_schema; },
       [](S&, double) {}},
      {2, uint16, 1, "inputs", "1", text_of(input_bits), [](const S& s) { return bits_of(s, input_bits); },
       [](S& s, double v) { set_bits(s, input_bits, v); }},
      {3, uint16, 1, "cycle", "1", "counts the cycles of the slave", [](const S& s) -> double { return s.cycle; },
       [](S& s, double v) { s.cycle = static_cast<std::uint16_t>(v); }},
      {4, int32, position_scale, "position", "m", "measured position", [](const S& s) { return s.position; },
       [](S& s, double v) { s.position = v; }},
      {6, float32, 1, "velocity", "m/s", "measured velocity", [](const S& s) { return s.velocity; },
       [](S& s, double v) { s.velocity = v; }},
      {8, float32, 1, "current", "A", "amplitude of the force-producing current", [](const S& s) { return s.current; },
       [](S& s, double v) { s.current = v; }},
      {10, uint16, 1, "protection", "1", text_of(protection_bits),
       [](const S& s) { return bits_of(s, protection_bits); }, [](S& s, double v) { set_bits(s, protection_bits, v); }},
      {11, uint16, 0.1, "dc_link", "V", "voltage of the DC link", [](const S& s) { return s.dc_link; },
       [](S& s, double v) { s.dc_link = v; }},
      {12, int16, 0.1, "motor_temperature", "degC", "temperature of the motor",
       [](const S& s) { return s.motor_temperature; }, [](S& s, double v) { s.motor_temperature = v; }},
      {13, int16, 0.1, "stage_temperature", "degC", "temperature of the power stage",
       [](const S& s) { return s.stage_temperature; }, [](S& s, double v) { s.stage_temperature = v; }},
  }};
  return rows;
}

const std::array<Row<PowerStageCommand>, 4>& command_rows() {
  using C = PowerStageCommand;
  static const std::array<Row<C>, 4> rows{{
      {16, uint16, 1, "control", "1", text_of(control_bits), [](const C& c) { return bits_of(c, control_bits); },
       [](C& c, double v) { set_bits(c, control_bits, v); }},
      {17, uint16, 1, "master_cycle", "1",
       "counts the exchanges of the master; the stage stops when it no longer changes",
       [](const C& c) -> double { return c.cycle; }, [](C& c, double v) { c.cycle = static_cast<std::uint16_t>(v); }},
      {18, float32, 1, "velocity_command", "m/s", "followed by a stage with a velocity controller",
       [](const C& c) { return c.velocity; }, [](C& c, double v) { c.velocity = v; }},
      {20, float32, 1, "voltage_command", "V", "applied by a stage without one", [](const C& c) { return c.voltage; },
       [](C& c, double v) { c.voltage = v; }},
  }};
  return rows;
}

}  // namespace

const RegisterMap& power_stage_map() {
  static const RegisterMap map = [] {
    std::vector<Register> registers;
    const auto append = [&](const auto& rows, RegisterAccess access) {
      for (const auto& r : rows) {
        Register& made = registers.emplace_back();
        made.table = RegisterTable::holding;
        made.address = r.address;
        made.type = r.type;
        made.access = access;
        made.name = r.name;
        made.unit = r.unit;
        made.scale = r.scale;
        made.text = r.text;
      }
    };
    append(state_rows(), RegisterAccess::read);
    append(command_rows(), RegisterAccess::motion);
    return RegisterMap(std::move(registers));
  }();
  return map;
}

void put_power_stage_values(const PowerStageState& state, std::span<double> values) {
  std::size_t i = 0;
  for (const auto& row : state_rows()) values[i++] = row.get(state);
}

void apply(const RegisterWrite& write, PowerStageCommand& command) {
  const std::size_t first = state_rows().size();
  if (write.index >= first && write.index < first + command_rows().size())
    command_rows()[write.index - first].set(command, write.value);
}

void put_words(const PowerStageCommand& command, std::span<std::uint16_t, power_stage_written_words> words) {
  for (const auto& row : command_rows())
    put_words(row.type, row.get(command) / row.scale, words.subspan(row.address - power_stage_written));
}

PowerStageState state_in(std::span<const std::uint16_t, power_stage_read_words> words) {
  PowerStageState state;
  for (const auto& row : state_rows())
    row.set(state, number_in(row.type, words.subspan(row.address - power_stage_read)) * row.scale);
  return state;
}

}  // namespace stiction::hal
