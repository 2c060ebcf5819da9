#include "firmware/machine/file/axis_coordinates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>

#include "firmware/machine/file/units.hpp"

namespace stiction::machine {
namespace {

constexpr double usual_following_error = 0.1;  // rad; a linear axis' is the drive's own
constexpr double turn = 2.0 * std::numbers::pi;

// Way (m) of the axis in a radian of what its screw, pulley or output shaft turns.
double way_per_radian(const TransmissionParameters& transmission, double radius) {
  if (transmission.lead) return *transmission.lead / turn;
  if (transmission.pulley_circumference) return *transmission.pulley_circumference / turn;
  return radius;
}

// Of a rotary axis; before its transmission is read, in whose units there are no lengths.
void refuse_lengths(const Document& document, const toml::table& table, const std::string& path) {
  for (const char* key : {"lead", "pulley_circumference", "screw_inertia"})
    if (const toml::node* node = table.get(key))
      document.attempt([&] {
        document.fail(node->source(), join_key(path, key), describe_node(*node),
                      "none on a rotary axis, whose transmission is its ratio alone, without a screw");
      });
}

void check(const Document& document, const toml::table& table, const std::string& path, AxisKind kind,
           const TransmissionParameters& transmission) {
  const auto fail = [&](const toml::source_region& place, const char* key, const std::string& found,
                        const char* expected) { document.fail(place, join_key(path, key), found, expected); };
  if (kind == AxisKind::rotary) return;
  if (!transmission.lead && !transmission.pulley_circumference) {
    const toml::node* screw = table.get("screw_inertia");
    const auto together = screw == nullptr ? std::string()
                                           : fmt::format(" together with screw_inertia, {} (line {})",
                                                         describe_node(*screw), screw->source().begin.line);
    fail(table.source(), "lead", "no such key" + together,
         "the lead of the screw, or pulley_circumference: how a rotary motor moves a linear axis");
  } else if (transmission.lead && transmission.pulley_circumference) {
    fail(table.get("pulley_circumference")->source(), "pulley_circumference",
         fmt::format("{} together with lead, {} (line {})", describe_node(*table.get("pulley_circumference")),
                     describe_node(*table.get("lead")), table.get("lead")->source().begin.line),
         "one of them");
  }
}

// Whether the text of a node is a quantity of this dimension; not for what is no node.
bool names_unit(const toml::node* node, std::string_view unit) {
  if (node == nullptr || !node->is_string()) return false;
  try {
    parse_quantity(node->as_string()->get(), unit);
    return true;
  } catch (const UnitError&) {
    return false;
  }
}

// The increment that counts make of what an encoder sits on.
template <class Encoder>
void count(const Document& document, const toml::table& table, const std::string& path, const char* name,
           const AxisCoordinates& coordinates, Encoder& encoder) {
  if (!encoder.counts) return;
  const auto& place = encoder.on == EncoderPlace::motor ? coordinates.motor : coordinates.axis;
  const std::string key = fmt::format("{}.counts", name);
  const toml::node& node = *table.at_path(key).node();
  if (!place.rotary())
    document.fail(node.source(), join_key(path, key), describe_node(node),
                  "increment in its place: what the encoder sits on does not turn");
  encoder.increment = turn * place.radius / *encoder.counts;
}

constexpr double standard_gravity = 9.80665;  // m/s^2

void balance(AxisModel& axis) {
  if (!axis.gravity || !axis.gravity->counterweight_mass) return;
  const double mass = *axis.gravity->counterweight_mass;
  axis.mass += mass;
  if (!axis.gravity->counterweight) axis.gravity->counterweight = mass * standard_gravity;
}

// The damping of the mode in which motor and load move against each other.
void damp(AxisModel& axis) {
  if (!axis.elastic() || !axis.transmission->damping_ratio) return;
  const double load = axis.mass - axis.motor_mass, reduced = load * axis.motor_mass / axis.mass;
  axis.transmission->damping =
      2.0 * *axis.transmission->damping_ratio * std::sqrt(*axis.transmission->stiffness * reduced);
}

void limit(const toml::table& table, AxisModel& axis) {
  auto& inverter = axis.inverter;
  if (table.get("inverter") == nullptr) inverter.voltage_limit = inverter.current_limit = unlimited;
  if (axis.motor.model == MotorModel::force && axis.motor.amperes)
    inverter.voltage_limit = std::min(inverter.current_limit, unlimited);
}

}  // namespace

AxisCoordinates coordinates_of(const Document& document, const toml::table& table, const std::string& path,
                               double radius) {
  const toml::node* kind_node = table.get("kind");
  const AxisKind kind =
      kind_node != nullptr && describe_node(*kind_node) == "\"rotary\"" ? AxisKind::rotary : AxisKind::linear;
  const Coordinate axis{kind, kind == AxisKind::rotary ? radius : 1.0};
  const toml::node* node = table.get("transmission");
  const bool in_volts = names_unit(table.at_path("controller.gain").node(), axis.own("V/m").unit);
  if (node == nullptr) return {axis, axis, in_volts};
  const std::string key = join_key(path, "transmission");
  const TableReader reader(document, false, nullptr, {axis, axis});
  const toml::table& given = reader.as_table(*node, key, Table<TransmissionParameters>::text);
  if (axis.rotary()) refuse_lengths(document, given, key);
  const auto transmission = reader.read<TransmissionParameters>(given, key);
  document.attempt([&] { check(document, given, key, kind, transmission); });
  return {axis, {AxisKind::rotary, way_per_radian(transmission, radius) / transmission.ratio}, in_volts};
}

bool driven_by_amperes(const toml::table& axis) {
  const auto is = [&](const char* key, const char* unit) { return names_unit(axis.at_path(key).node(), unit); };
  return is("motor.force_constant", "N/A") || is("motor.torque_constant", "N m/A");
}

void reduce(const Document& document, const toml::table& table, const std::string& path, AxisModel& axis,
            const AxisCoordinates& coordinates) {
  axis.coordinate = coordinates.axis;
  axis.motor_coordinate = coordinates.motor;
  axis.load_mass = axis.mass;
  if (const auto& transmission = axis.transmission) {
    const double motor = coordinates.motor.radius, screw = way_per_radian(*transmission, coordinates.axis.radius);
    axis.motor_mass = transmission->motor_inertia / (motor * motor) + transmission->screw_inertia / (screw * screw);
    axis.mass += axis.motor_mass;
  }
  if (axis.motor.model == MotorModel::synchronous && axis.motor.phase_force_constant == 0.0)
    axis.motor.phase_force_constant = axis.motor.force_constant / 1.5;
  if (axis.modulo) axis.travel = *axis.modulo;
  balance(axis);
  damp(axis);
  limit(table, axis);
  count(document, table, path, "encoder", coordinates, axis.encoder);
  if (axis.velocity_encoder) count(document, table, path, "velocity_encoder", coordinates, *axis.velocity_encoder);
  if (axis.second_encoder) count(document, table, path, "second_encoder", coordinates, *axis.second_encoder);
  if (axis.coordinate.rotary() && !axis.supervision.following_error)
    axis.supervision.following_error = usual_following_error * axis.coordinate.radius;
}

}  // namespace stiction::machine
