#include "firmware/stictiond/modbus_registers.hpp"

#include <fmt/format.h>

#include <limits>

#include "firmware/machine/file/description.hpp"
#include "firmware/stictiond/modbus_cam_rows.hpp"
#include "firmware/stictiond/modbus_rows.hpp"

namespace stiction::drive {
namespace {

using hal::Register;
using hal::RegisterAccess;
using hal::RegisterTable;
using hal::RegisterType;
using enum RegisterType;

// Axis by axis, with room to grow; a parameter takes two registers.
constexpr std::uint16_t first_axis = 100, axis_stride = axis_registers;
constexpr std::uint16_t first_parameters = 1000, parameters_stride = parameter_registers;
constexpr double store_password = 0x5354;

double number_of(Fault fault) { return static_cast<double>(fault); }

using Drive = PublishedState;
constexpr std::array<StateRow<Drive>, 10> drive_rows{{
    {3, uint16, 1, "fault", "1", "number of the fault of programme or bus; 0: none",
     [](const Drive& s) { return number_of(s.fault); }},
    {4, uint32, 1, "seconds", "s", "time since the loop began", [](const Drive& s) -> double { return s.seconds; }},
    {6, uint32, 1, "missed_deadlines", "1", "ticks that began later than a period",
     [](const Drive& s) -> double { return s.missed_deadlines; }},
    {8, float32, 1, "largest_lateness", "s", "largest delay of the beginning of a tick",
     [](const Drive& s) { return s.largest_lateness; }},
    {10, float32, 1, "largest_work", "s", "longest duration of a tick", [](const Drive& s) { return s.largest_work; }},
    {12, uint32, 1, "trace_rows", "1", "rows of the trace that were recorded",
     [](const Drive& s) -> double { return s.trace_rows; }},
    {14, uint32, 1, "trace_lost", "1", "rows of the trace that were lost",
     [](const Drive& s) -> double { return s.trace_lost; }},
    {16, uint32, 1, "commissioning_time", "s", "time for which parameters may still be written; 0: they are refused",
     [](const Drive& s) -> double { return s.commissioning_seconds; }},
    {18, uint16, 1, "store_result", "1",
     "how the last request to store ended; 0: none, 1: stored, 2: under way, 3: the set would refuse a start, 4: the "
     "disk did not take it",
     [](const Drive& s) { return static_cast<double>(s.store_result); }},
    {19, uint16, 1, "client", "1", "number of the connection over which this is read",
     [](const Drive& s) -> double { return s.client; }},
}};

using Axis = PublishedAxis;
constexpr std::array<StateRow<Axis>, 28> axis_rows_alone{{
    {0, uint16, 1, "statusword", "1", "CiA 402, 6041h", [](const Axis& a) -> double { return a.statusword; }},
    {1, int16, 1, "mode", "1", "mode of operation shown, 6061h", [](const Axis& a) -> double { return a.mode; }},
    {2, uint16, 1, "fault", "1", "number of the axis' fault; 0: none",
     [](const Axis& a) { return number_of(a.fault); }},
    {3, uint16, 1, "inputs", "1", "bit 0: negative limit switch; bit 1: positive; bit 2: home switch",
     [](const Axis& a) -> double {
       return (a.limit_negative ? 1 : 0) + (a.limit_positive ? 2 : 0) + (a.home ? 4 : 0);
     }},
    {4, int32, position_scale, "position", "m", "measured", [](const Axis& a) { return a.position; }},
    {6, int32, position_scale, "set_position", "m", "set", [](const Axis& a) { return a.set_position; }},
    {8, float32, 1, "velocity", "m/s", "measured", [](const Axis& a) { return a.velocity; }},
    {10, float32, 1, "current", "A", "amplitude of the force-producing current",
     [](const Axis& a) { return a.current; }},
    {12, float32, 1, "following_error", "m", "set position minus measured",
     [](const Axis& a) { return a.following_error; }},
    {14, float32, 1, "peak_following_error", "m", "largest of the trace",
     [](const Axis& a) { return a.peak_following_error; }},
    {16, float32, 1, "peak_current", "A", "largest of the trace", [](const Axis& a) { return a.peak_current; }},
    {18, float32, 1, "rms_current", "A", "of the trace", [](const Axis& a) { return a.rms_current; }},
    {20, uint16, 1, "error_code", "1", "603Fh, of the axis' fault; 0: none",
     [](const Axis& a) -> double { return error_code_of(a.fault); }},
    {21, uint16, 1, "owner", "1", "who commands the axis; 0: none, 1: CAN, 2: Modbus",
     [](const Axis& a) { return static_cast<double>(a.owner); }},
    {22, uint16, 1, "owner_token", "1", "changes with each change of the owner",
     [](const Axis& a) -> double { return a.owner_token; }},
    {23, uint16, 1, "held_by", "1", "whose stop holds the axis; numbers of owner",
     [](const Axis& a) { return static_cast<double>(a.held_by); }},
    {24, uint16, 1, "refusal", "1",
     "why the last target was refused; 0: it was not, 1: no number, 2: beyond an end, 3: the zero is not known",
     [](const Axis& a) { return static_cast<double>(a.refusal); }},
    {25, int16, 1e-3, "torque", "1", "6077h, of the current limit", [](const Axis& a) { return a.torque; }},
    {26, uint32, 1, "supported_modes", "1", "6502h", [](const Axis&) -> double { return supported_mode_bits(); }},
    {28, uint16, 1, "owner_client", "1",
     "client of the connection that commands the axis; 0: none, 65535: it has ended, and the next one that commands "
     "the "
     "axis takes its place",
     [](const Axis& a) -> double { return a.owner_client; }},
    // Of motor and power stage: 60 to 79 are theirs.
    {60, uint16, 1, "commutation", "1",
     "whether the electrical angle is known; 0: not yet, 1: it is tested, 2: it is known",
     [](const Axis& a) -> double { return a.commutation; }},
    {61, int16, 0.01, "commutation_offset", "deg", "electrical angle at the encoder's zero, in force",
     [](const Axis& a) { return a.commutation_offset; }},
    {62, uint16, 1e-3, "motor_load", "1", "state of the motor's thermal model; fault 82 at 1.025",
     [](const Axis& a) { return a.motor_load; }},
    {63, uint16, 1e-3, "stage_load", "1", "state of the power stage's thermal model, of its hottest phase; fault 83",
     [](const Axis& a) { return a.stage_load; }},
    {64, float32, 1, "dc_link", "V", "voltage of the DC link, where it is watched",
     [](const Axis& a) { return a.dc_link; }},
    {66, int16, 0.1, "motor_temperature", "degC", "temperature of the motor, where it is watched",
     [](const Axis& a) { return a.motor_temperature; }},
    {67, int16, 0.1, "stage_temperature", "degC", "temperature of the power stage, where it is watched",
     [](const Axis& a) { return a.stage_temperature; }},
    {68, uint16, 1, "torque_off", "1", "safe torque off; bit 0: channel A is open, bit 1: channel B",
     [](const Axis& a) -> double { return (a.torque_off_a ? 1 : 0) + (a.torque_off_b ? 2 : 0); }},
}};
constexpr auto axis_rows = joined(axis_rows_alone, cam_registers::state_rows);

void to_velocity(const machine::AxisModel& axis, Register& r) { up_to(axis.max_velocity, r); }
// To both sides.
void to_speed(const machine::AxisModel& axis, Register& r) {
  r.low = -axis.max_velocity;
  r.high = axis.max_velocity;
}
void to_torque(const machine::AxisModel&, Register& r) {
  r.low = -1.0;
  r.high = 1.0;
}
void to_max_torque(const machine::AxisModel&, Register& r) { up_to(1.0, r); }
void to_acceleration(const machine::AxisModel& axis, Register& r) { up_to(axis.max_acceleration, r); }
// Set-points of every tick do not come over this bus; what can be asked for is what a drive does by itself. A target
// beyond the travel is refused by the axis, as it may be relative: bit 11 of the statusword.
using What = MotionWrite::What;
constexpr std::array<MotionRow, 9> motion_rows_alone{{
    {0, uint16, 1, "controlword", "1", "CiA 402, 6040h; reads as the last accepted value", What::controlword,
     [](const Axis& a) -> double { return a.controlword; }},
    {1,
     int16,
     1,
     "mode_of_operation",
     "1",
     "6060h; 1: profile position, 3: profile velocity, 6: homing, 8: cyclic position, 10: cyclic torque; with --master "
     "-1: cam, -2: gear",
     What::mode,
     [](const Axis& a) -> double { return a.mode; },
     {1, 3, 6, 8, 10, -1, -2}},
    {2, int32, position_scale, "target_position", "m",
     "607Ah; accepted when bit 4 of the controlword rises; bit 5: at once, bit 6: relative", What::target,
     [](const Axis& a) { return a.target; }},
    {4,
     uint32,
     1e-6,
     "profile_velocity",
     "m/s",
     "6081h; initial value and maximum: max_velocity",
     What::velocity,
     [](const Axis& a) { return a.profile_velocity; },
     {},
     to_velocity},
    {6,
     uint32,
     1e-3,
     "profile_acceleration",
     "m/s^2",
     "6083h; initial value and maximum: max_acceleration",
     What::acceleration,
     [](const Axis& a) { return a.profile_acceleration; },
     {},
     to_acceleration},
    {8,
     uint32,
     1e-3,
     "profile_deceleration",
     "m/s^2",
     "6084h; initial value and maximum: max_acceleration",
     What::deceleration,
     [](const Axis& a) { return a.profile_deceleration; },
     {},
     to_acceleration},
    {10,
     int32,
     1e-6,
     "target_velocity",
     "m/s",
     "60FFh, of profile velocity",
     What::target_velocity,
     [](const Axis& a) { return a.target_velocity; },
     {},
     to_speed},
    {12,
     int16,
     1e-3,
     "target_torque",
     "1",
     "6071h, of cyclic torque, in parts of the current limit",
     What::target_torque,
     [](const Axis& a) { return a.target_torque; },
     {},
     to_torque},
    {13,
     uint16,
     1e-3,
     "max_torque",
     "1",
     "6072h, of every mode, in parts of the current limit; initial value and maximum: 1",
     What::max_torque,
     [](const Axis& a) { return a.max_torque; },
     {},
     to_max_torque},
}};
constexpr auto motion_rows = joined(motion_rows_alone, cam_registers::motion_rows);
static_assert(motion_rows.size() == MotionWrite::kinds);

template <class Row>
Register made(const Row& row, RegisterTable table, RegisterAccess access, unsigned start, const std::string& prefix) {
  Register r;
  r.table = table;
  r.address = static_cast<std::uint16_t>(start + row.offset);
  r.type = row.type;
  r.access = access;
  r.name = prefix + row.name;
  r.unit = row.unit;
  r.scale = row.scale;
  r.text = row.text;
  if constexpr (requires { row.choices; })
    if (row.choices != decltype(row.choices){}) r.choices.assign(row.choices.begin(), row.choices.end());
  return r;
}

Register constant(std::uint16_t address, const char* name, const char* text) {
  Register r;
  r.address = address;
  r.name = name;
  r.unit = "1";
  r.text = text;
  return r;
}

Register parameter_register(const DriveParameter& parameter, unsigned address) {
  Register r;
  r.table = RegisterTable::holding;
  r.address = static_cast<std::uint16_t>(address);
  r.type = float32;
  r.access = RegisterAccess::write;
  r.name = parameter.key;
  r.unit = parameter.unit;
  const std::string range = machine::describe_range(parameter.range, parameter.unit);
  r.text = parameter.text + (range.empty() ? "" : "; a value " + range);
  r.low = parameter.range.low;
  r.high = parameter.range.high;
  r.low_open = parameter.range.low_open;
  return r;
}

// The order of put_values().
std::vector<Register> all_registers(const machine::Machine& machine, const std::vector<DriveParameter>& parameters) {
  std::vector<Register> registers{
      constant(0, "identification", "21316 identifies a stiction drive"),
      constant(1, "schema", "version of these registers"),
      constant(2, "axes", "number of axes"),
  };
  for (const auto& row : drive_rows) registers.push_back(made(row, RegisterTable::input, RegisterAccess::read, 0, ""));
  const auto of_each_axis = [&](const auto& rows, RegisterTable table, RegisterAccess access) {
    unsigned start = first_axis;
    for (const machine::AxisModel& axis : machine.axes) {
      for (const auto& row : rows) {
        registers.push_back(made(row, table, access, start, axis.name + "."));
        if constexpr (requires { row.limit; })
          if (row.limit != nullptr) row.limit(axis, registers.back());
      }
      start += axis_stride;
    }
  };
  of_each_axis(axis_rows, RegisterTable::input, RegisterAccess::read);
  Register store = constant(0, "store_parameters", "the value 21332 stores the written parameters for the next start");
  store.table = RegisterTable::holding;
  store.access = RegisterAccess::write;
  store.low = store.high = store_password;
  registers.push_back(store);
  of_each_axis(motion_rows, RegisterTable::holding, RegisterAccess::motion);
  const std::size_t per_axis = machine.axes.empty() ? 0 : parameters.size() / machine.axes.size();
  if (2 * per_axis > parameters_stride) throw std::invalid_argument("more parameters than registers of an axis");
  for (std::size_t i = 0; i < parameters.size(); ++i)
    registers.push_back(parameter_register(
        parameters[i],
        static_cast<unsigned>(first_parameters + parameters_stride * (i / per_axis) + 2 * (i % per_axis))));
  return registers;
}

std::size_t checked_axis_count(const machine::Machine& machine) {
  if (machine.axes.size() > most_published_axes)
    throw std::invalid_argument(
        fmt::format("Modbus: found {} axes; expected at most {}", machine.axes.size(), most_published_axes));
  return machine.axes.size();
}

// Registers before those of the motion.
std::size_t count_before_motion(std::size_t axes) { return 3 + drive_rows.size() + axes * axis_rows.size() + 1; }

}  // namespace

ModbusRegisters::ModbusRegisters(const machine::Machine& machine, const machine::DriveSetup& setup,
                                 const std::optional<ParameterSet>& begun)
    : machine_id_(machine.id),
      axis_count_(checked_axis_count(machine)),
      parameters_(drive_parameters(machine, setup)),
      map_(all_registers(machine, parameters_)),
      first_parameter_(count_before_motion(axis_count_) + axis_count_ * motion_rows.size()),
      written_{machine.id, {}} {
  for (const auto& p : parameters_) values_.push_back(p.value.value_or(std::numeric_limits<double>::quiet_NaN()));
  if (begun) set_written(*begun);
}

void ModbusRegisters::put_values(const PublishedState& state, std::span<double> values) const {
  std::size_t i = 0;
  values[i++] = modbus_identification;
  values[i++] = modbus_schema;
  values[i++] = static_cast<double>(axis_count_);
  for (const auto& row : drive_rows) values[i++] = row.value(state);
  for (std::size_t axis = 0; axis < axis_count_; ++axis)
    for (const auto& row : axis_rows) values[i++] = row.value(state.axes[axis]);
  values[i++] = 0.0;  // the command to store
  for (std::size_t axis = 0; axis < axis_count_; ++axis)
    for (const auto& row : motion_rows) values[i++] = row.value(state.axes[axis]);
  const std::lock_guard lock(mutex_);
  for (const double value : values_) values[i++] = value;
}

DriveWrite ModbusRegisters::meaning_of(const hal::RegisterWrite& write) const {
  if (write.index >= first_parameter_)
    return ParameterWrite{parameters_.at(write.index - first_parameter_).key, write.value};
  const std::size_t before = count_before_motion(axis_count_);
  if (write.index < before) return StoreParameters{};
  const std::size_t motion = write.index - before;
  return MotionWrite{motion / motion_rows.size(), motion_rows[motion % motion_rows.size()].what, write.value};
}

void ModbusRegisters::remember(const ParameterWrite& write) {
  const std::lock_guard lock(mutex_);
  for (std::size_t i = 0; i < parameters_.size(); ++i)
    if (parameters_[i].key == write.key) values_[i] = write.value;
  written_.values[write.key] = write.value;
}

ParameterSet ModbusRegisters::written() const {
  const std::lock_guard lock(mutex_);
  return written_;
}

void ModbusRegisters::set_written(const ParameterSet& set) {
  const std::lock_guard lock(mutex_);
  written_ = set;
  for (std::size_t i = 0; i < parameters_.size(); ++i)
    if (const auto found = set.values.find(parameters_[i].key); found != set.values.end()) values_[i] = found->second;
}

std::string ModbusRegisters::rejection_of(const ParameterWrite& write) const {
  for (const auto& parameter : parameters_)
    if (parameter.key == write.key) return drive::rejection_of(parameter, write.value);
  return {};
}

void ModbusRegisters::take_back(const std::optional<ParameterSet>& set) {
  {
    const std::lock_guard lock(mutex_);
    written_ = {machine_id_, {}};
    for (std::size_t i = 0; i < parameters_.size(); ++i)
      values_[i] = parameters_[i].value.value_or(std::numeric_limits<double>::quiet_NaN());
  }
  if (set) set_written(*set);
}

}  // namespace stiction::drive
