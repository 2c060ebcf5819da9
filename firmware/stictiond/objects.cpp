#include "firmware/stictiond/objects.hpp"

#include <algorithm>
#include <array>

#include "firmware/machine/configuration/conversion.hpp"
#include "firmware/stictiond/modbus_registers.hpp"
#include "hal/can/identifiers.hpp"

namespace stiction::drive {
namespace {

using enum ObjectType;
using Unit = ObjectUnit;
using Source = ObjectSource;
constexpr auto fixed = ObjectAccess::constant, ro = ObjectAccess::read, rw = ObjectAccess::write;
using hal::can::base_of, hal::can::CobId;

constexpr std::array<ObjectTypeRow, 7> types{{
    {"INTEGER8", 1, 0x0002, -128.0, 127.0},
    {"INTEGER16", 2, 0x0003, -32768.0, 32767.0},
    {"INTEGER32", 4, 0x0004, -2147483648.0, 2147483647.0},
    {"UNSIGNED8", 1, 0x0005, 0.0, 255.0},
    {"UNSIGNED16", 2, 0x0006, 0.0, 65535.0},
    {"UNSIGNED32", 4, 0x0007, 0.0, 4294967295.0},
    {"VISIBLE_STRING", 0, 0x0009, 0.0, 0.0},
}};

constexpr Object number(std::uint16_t index, std::uint8_t sub, ObjectType type, const char* name, double value) {
  return {index, sub, type, fixed, name, Unit::none, Source::number, "", value};
}
constexpr Object number_of_subs(std::uint16_t index, double subs) {
  return number(index, 0, unsigned8, "Highest sub-index supported", subs);
}
constexpr Object cob_id(std::uint16_t index, std::uint8_t sub, const char* name, CobId use) {
  return {index, sub, unsigned32, ro, name, Unit::none, Source::node_id, "", static_cast<double>(base_of(use))};
}
constexpr Object setup(std::uint16_t index, ObjectType type, const char* name,
                       double (*value)(const DriveConfiguration&, std::size_t), const char* key) {
  return {index, 0, type, ro, name, Unit::none, Source::setup, key, 0.0, value};
}
constexpr Object setup(std::uint16_t index, std::uint8_t sub, ObjectType type, const char* name,
                       double (*value)(const DriveConfiguration&, std::size_t), const char* key) {
  return {index, sub, type, ro, name, Unit::none, Source::setup, key, 0.0, value};
}
constexpr Object cam(std::uint8_t sub, ObjectType type, const char* name, const char* command, Unit unit = Unit::none) {
  return {0x2400, sub, type, rw, name, unit, Source::command, command};
}
constexpr Object error(std::uint8_t sub) { return {0x1003, sub, unsigned32, ro, "Standard error field"}; }

using C = DriveConfiguration;
double reaction_of(const C& c, std::size_t axis) { return c.setup.axes.at(c.names.at(axis)).stops.commander_lost; }

constexpr auto table = std::to_array<Object>({
    number(0x1000, 0, unsigned32, "Device type", 0x0002'0192),
    {0x1001, 0, unsigned8, ro, "Error register"},
    {0x1003, 0, unsigned8, rw, "Number of errors"},
    error(1),
    error(2),
    error(3),
    error(4),
    error(5),
    error(6),
    error(7),
    error(8),
    {0x1008, 0, text, fixed, "Manufacturer device name", Unit::none, Source::text, "stiction"},
    {0x1009, 0, text, fixed, "Manufacturer hardware version", Unit::none, Source::text, "machine"},
    {0x100a, 0, text, fixed, "Manufacturer software version", Unit::none, Source::text, "version"},
    number_of_subs(0x1010, 1),
    {0x1010, 1, unsigned32, rw, "Save all parameters"},
    cob_id(0x1014, 0, "COB-ID EMCY", CobId::emergency),
    number_of_subs(0x1016, 1),
    {0x1016, 1, unsigned32, rw, "Consumer heartbeat time"},
    {0x1017, 0, unsigned16, rw, "Producer heartbeat time", Unit::none},
    number_of_subs(0x1018, 4),
    number(0x1018, 1, unsigned32, "Vendor-ID", 0),
    number(0x1018, 2, unsigned32, "Product code", modbus_identification),
    number(0x1018, 3, unsigned32, "Revision number", 1),
    number(0x1018, 4, unsigned32, "Serial number", 0),
    number_of_subs(0x1200, 2),
    cob_id(0x1200, 1, "COB-ID client to server", CobId::sdo_request),
    cob_id(0x1200, 2, "COB-ID server to client", CobId::sdo_answer),
    number(0x1f80, 0, unsigned32, "NMT startup", 0),
    // Of motor and power stage: 2300h to 23FFh are theirs.
    number_of_subs(0x2300, 3),
    setup(
        0x2300, 1, unsigned8, "Method",
        [](const C& c, std::size_t axis) -> double {
          return static_cast<double>(c.drives.at(axis).commutation.method);
        },
        "commutation.method"),
    {0x2300, 2, unsigned16, ro, "State", Unit::none, Source::state, "commutation"},
    {0x2300, 3, integer16, ro, "Offset", Unit::hundredth, Source::state, "commutation_offset"},
    number_of_subs(0x2301, 2),
    {0x2301, 1, unsigned16, ro, "Motor", Unit::thousandth, Source::state, "motor_load"},
    {0x2301, 2, unsigned16, ro, "Power stage", Unit::thousandth, Source::state, "stage_load"},
    number_of_subs(0x2302, 2),
    {0x2302, 1, integer16, ro, "Motor", Unit::tenth, Source::state, "motor_temperature"},
    {0x2302, 2, integer16, ro, "Power stage", Unit::tenth, Source::state, "stage_temperature"},
    {0x2303, 0, unsigned16, ro, "DC link voltage", Unit::tenth, Source::state, "dc_link"},
    {0x2304, 0, unsigned16, ro, "Safe torque off", Unit::none, Source::state, "torque_off"},
    number_of_subs(0x2400, 17),
    cam(1, unsigned16, "Cam table", "cam_table"),
    cam(2, unsigned16, "Cam trigger", "cam_trigger"),
    cam(3, unsigned16, "Cam approach", "cam_approach"),
    cam(4, unsigned16, "Cam options", "cam_options"),
    cam(5, unsigned32, "Cam time", "cam_time", Unit::millionth),
    cam(6, unsigned32, "Cam distance", "cam_distance", Unit::millionth),
    cam(7, integer32, "Cam trigger position", "cam_at", Unit::millionth),
    cam(8, integer32, "Cam master offset", "cam_master_offset", Unit::millionth),
    cam(9, integer32, "Cam slave offset", "cam_slave_offset", Unit::position),
    cam(10, integer32, "Cam slave scale", "cam_slave_scale", Unit::millionth),
    cam(11, integer32, "Cam phase", "cam_phase", Unit::millionth),
    cam(12, unsigned32, "Cam tolerance of position", "cam_tolerance", Unit::position),
    cam(13, unsigned32, "Cam tolerance of speed", "cam_tolerance_speed", Unit::millionth),
    cam(14, unsigned32, "Cam tolerance of acceleration", "cam_tolerance_acceleration", Unit::thousandth),
    cam(15, integer32, "Cam leave speed", "cam_leave_speed", Unit::millionth),
    cam(16, integer32, "Cam superposed displacement", "cam_superposed", Unit::position),
    cam(17, integer32, "Cam leave position", "cam_leave_position", Unit::position),
    number_of_subs(0x2401, 3),
    {0x2401, 1, integer32, rw, "Gear numerator", Unit::none, Source::command, "gear_numerator"},
    {0x2401, 2, unsigned16, rw, "Gear denominator", Unit::none, Source::command, "gear_denominator"},
    {0x2401, 3, integer32, rw, "Gear way", Unit::position, Source::command, "gear_way"},
    {0x2402, 0, unsigned16, rw, "Cam command", Unit::none, Source::command, "cam_command"},
    number_of_subs(0x2403, 5),
    {0x2403, 1, unsigned16, ro, "Cam state", Unit::none, Source::state, "cam_state"},
    {0x2403, 2, unsigned16, ro, "Cam refusal", Unit::none, Source::state, "cam_refusal"},
    {0x2403, 3, unsigned16, ro, "Cam table followed", Unit::none, Source::state, "cam_followed"},
    {0x2403, 4, unsigned32, ro, "Cam ends of profile", Unit::none, Source::state, "cam_ends"},
    {0x2403, 5, unsigned16, ro, "Second cam table followed", Unit::none, Source::state, "cam_second"},
    number_of_subs(0x2404, 4),
    {0x2404, 1, integer32, rw, "Master set speed", Unit::millionth, Source::command, "master_speed"},
    {0x2404, 2, integer32, ro, "Master speed", Unit::millionth, Source::state, "master_velocity"},
    {0x2404, 3, unsigned32, ro, "Master phase", Unit::millionth, Source::state, "master_phase"},
    {0x2404, 4, integer32, ro, "Master cycles", Unit::none, Source::state, "master_cycles"},
    {0x2410, 0, unsigned16, rw, "Cam tuning command", Unit::none, Source::command, "cam_tuning_command"},
    number_of_subs(0x2411, 6),
    {0x2411, 1, unsigned16, ro, "Cam tuning state", Unit::none, Source::state, "cam_tuning_state"},
    {0x2411, 2, unsigned16, ro, "Cam tuning refusal", Unit::none, Source::state, "cam_tuning_refusal"},
    {0x2411, 3, unsigned32, ro, "Cam tuning quality number", Unit::billionth, Source::state, "cam_tuning_quality"},
    {0x2411, 4, unsigned32, ro, "Cam tuning quality number before", Unit::billionth, Source::state,
     "cam_tuning_before"},
    {0x2411, 5, unsigned32, ro, "Cam tuning frequency", Unit::thousandth, Source::state, "cam_tuning_frequency"},
    {0x2411, 6, unsigned16, ro, "Cam tuning tables", Unit::none, Source::state, "cam_tuning_tables"},
    setup(0x6007, integer16, "Abort connection option code", reaction_of, "stops.commander_lost"),
    {0x603f, 0, unsigned16, ro, "Error code", Unit::none, Source::state, "error_code"},
    {0x6040, 0, unsigned16, rw, "Controlword", Unit::none, Source::command, "controlword"},
    {0x6041, 0, unsigned16, ro, "Statusword", Unit::none, Source::state, "statusword"},
    setup(
        0x605a, integer16, "Quick stop option code",
        [](const C& c, std::size_t axis) -> double { return c.drives.at(axis).stops.quick_stop; }, "stops.quick_stop"),
    setup(
        0x605b, integer16, "Shutdown option code",
        [](const C& c, std::size_t axis) -> double { return c.drives.at(axis).stops.shutdown; }, "stops.shutdown"),
    setup(
        0x605c, integer16, "Disable operation option code",
        [](const C& c, std::size_t axis) -> double { return c.drives.at(axis).stops.disable_operation; },
        "stops.disable_operation"),
    setup(
        0x605d, integer16, "Halt option code",
        [](const C& c, std::size_t axis) -> double { return c.drives.at(axis).stops.halt; }, "stops.halt"),
    setup(
        0x605e, integer16, "Fault reaction option code",
        [](const C& c, std::size_t axis) -> double { return c.drives.at(axis).stops.fault_reaction; },
        "stops.fault_reaction"),
    {0x6060, 0, integer8, rw, "Modes of operation", Unit::none, Source::command, "mode_of_operation"},
    {0x6061, 0, integer8, ro, "Modes of operation display", Unit::none, Source::state, "mode"},
    {0x6062, 0, integer32, ro, "Position demand value", Unit::position, Source::state, "set_position"},
    {0x6063, 0, integer32, ro, "Position actual internal value", Unit::position, Source::state, "position"},
    {0x6064, 0, integer32, ro, "Position actual value", Unit::position, Source::state, "position"},
    {0x6065, 0, unsigned32, rw, "Following error window", Unit::position, Source::parameter,
     "axis.AXIS.supervision.following_error", 0.0,
     [](const C& c, std::size_t axis) { return machine::to_si(c.drives.at(axis).following_error); }},
    {0x6066, 0, unsigned16, rw, "Following error time out", Unit::millisecond, Source::parameter,
     "drive.axis.AXIS.following_error_timeout"},
    {0x6067, 0, unsigned32, rw, "Position window", Unit::position, Source::parameter, "drive.axis.AXIS.target_window"},
    number(0x6068, 0, unsigned16, "Position window time", 0),
    {0x606c, 0, integer32, ro, "Velocity actual value", Unit::speed, Source::state, "velocity"},
    {0x6071, 0, integer16, rw, "Target torque", Unit::torque, Source::command, "target_torque"},
    {0x6072, 0, unsigned16, rw, "Max torque", Unit::torque, Source::command, "max_torque"},
    {0x6077, 0, integer16, ro, "Torque actual value", Unit::torque, Source::state, "torque"},
    {0x607a, 0, integer32, rw, "Target position", Unit::position, Source::command, "target_position"},
    {0x607c, 0, integer32, rw, "Home offset", Unit::position, Source::parameter, "drive.axis.AXIS.homing.offset"},
    number_of_subs(0x607d, 2),
    {0x607d, 1, integer32, rw, "Min position limit", Unit::position, Source::parameter, "drive.axis.AXIS.negative_end"},
    {0x607d, 2, integer32, rw, "Max position limit", Unit::position, Source::parameter, "drive.axis.AXIS.positive_end"},
    {0x6081, 0, unsigned32, rw, "Profile velocity", Unit::speed, Source::command, "profile_velocity"},
    {0x6083, 0, unsigned32, rw, "Profile acceleration", Unit::acceleration, Source::command, "profile_acceleration"},
    {0x6084, 0, unsigned32, rw, "Profile deceleration", Unit::acceleration, Source::command, "profile_deceleration"},
    {0x6085, 0, unsigned32, rw, "Quick stop deceleration", Unit::acceleration, Source::parameter,
     "drive.axis.AXIS.quick_stop_deceleration"},
    setup(
        0x6098, integer8, "Homing method",
        [](const C& c, std::size_t axis) -> double { return static_cast<double>(c.drives.at(axis).homing.method); },
        "homing.method"),
    number_of_subs(0x6099, 2),
    {0x6099, 1, unsigned32, rw, "Speed during search for switch", Unit::speed, Source::parameter,
     "drive.axis.AXIS.homing.search_speed"},
    {0x6099, 2, unsigned32, rw, "Speed during search for zero", Unit::speed, Source::parameter,
     "drive.axis.AXIS.homing.creep_speed"},
    {0x609a, 0, unsigned32, ro, "Homing acceleration", Unit::acceleration, Source::parameter,
     "drive.axis.AXIS.quick_stop_deceleration"},
    {0x60f4, 0, integer32, ro, "Following error actual value", Unit::position, Source::state, "following_error"},
    {0x60ff, 0, integer32, rw, "Target velocity", Unit::speed, Source::command, "target_velocity"},
    {0x6502, 0, unsigned32, ro, "Supported drive modes", Unit::none, Source::state, "supported_modes"},
});

struct RecordName {
  std::uint16_t index;
  const char* name;
};
constexpr std::array<RecordName, 15> record_names{{{0x2300, "Commutation"},
                                                   {0x2301, "Thermal load"},
                                                   {0x2302, "Temperature"},
                                                   {0x1003, "Pre-defined error field"},
                                                   {0x1010, "Store parameters"},
                                                   {0x1016, "Consumer heartbeat time"},
                                                   {0x1018, "Identity object"},
                                                   {0x1200, "SDO server parameter"},
                                                   {0x2400, "Cam request"},
                                                   {0x2401, "Gear"},
                                                   {0x2403, "Cam status"},
                                                   {0x2404, "Master of cam and gear"},
                                                   {0x2411, "Cam tuning"},
                                                   {0x607d, "Software position limit"},
                                                   {0x6099, "Homing speeds"}}};

constexpr bool is_sorted() {
  for (std::size_t i = 1; i < table.size(); ++i) {
    const auto &a = table[i - 1], &b = table[i];
    if (a.index > b.index || (a.index == b.index && a.sub + 1 != b.sub)) return false;
    if (a.index != b.index && b.sub != 0) return false;
  }
  return true;
}
static_assert(is_sorted());

}  // namespace

const ObjectTypeRow& row_of(ObjectType type) { return types[static_cast<std::size_t>(type)]; }

double value_of(ObjectUnit unit, double increment) {
  switch (unit) {
    case Unit::position:
      return increment;
    case Unit::speed:
    case Unit::acceleration:
      return 1000.0 * increment;
    case Unit::torque:
    case Unit::millisecond:
    case Unit::thousandth:
      return 1e-3;
    case Unit::tenth:
      return 0.1;
    case Unit::hundredth:
      return 0.01;
    case Unit::millionth:
      return 1e-6;
    case Unit::billionth:
      return 1e-9;
    default:
      return 1.0;
  }
}

std::span<const Object> object_table() { return table; }

const Object* object_at(std::uint16_t index, std::uint8_t sub) {
  const auto found = std::find_if(table.begin(), table.end(),
                                  [&](const Object& object) { return object.index == index && object.sub == sub; });
  return found == table.end() ? nullptr : &*found;
}

bool has_index(std::uint16_t index) { return object_at(index, 0) != nullptr; }

const char* record_name(std::uint16_t index) {
  for (const auto& row : record_names)
    if (row.index == index) return row.name;
  return nullptr;
}

std::string source_name(const Object& object, const std::string& axis) {
  std::string name = object.of;
  if (object.source == Source::state || object.source == Source::command) return axis + "." + name;
  if (object.source == Source::setup) return "drive.axis." + axis + "." + name;
  constexpr std::string_view placeholder = "AXIS";
  if (const auto at = name.find(placeholder); at != std::string::npos) name.replace(at, placeholder.size(), axis);
  return name;
}

}  // namespace stiction::drive
