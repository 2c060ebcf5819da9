#include "firmware/machine/file/axis_coordinates.hpp"

#include <fmt/format.h>

#include <numbers>
#include <optional>

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

void check(const Document& document, const toml::table& table, const std::string& path, AxisKind kind,
           const TransmissionParameters& transmission) {
  const auto has = [&](const char* key) { return table.get(key) != nullptr; };
  const auto fail = [&](const toml::source_region& place, const char* key, const std::string& found,
                        const char* expected) { document.fail(place, join_key(path, key), found, expected); };
  if (kind == AxisKind::rotary) {
    for (const char* key : {"lead", "pulley_circumference"})
      if (has(key))
        fail(table.get(key)->source(), key, describe_node(*table.get(key)),
             "none on a rotary axis, whose transmission is its ratio alone");
  } else if (!transmission.lead && !transmission.pulley_circumference) {
    fail(table.source(), "lead", "no such key",
         "the lead of the screw, or pulley_circumference: how a rotary motor moves a linear axis");
  } else if (transmission.lead && transmission.pulley_circumference) {
    fail(table.get("pulley_circumference")->source(), "pulley_circumference",
         fmt::format("{} together with lead, {} (line {})", describe_node(*table.get("pulley_circumference")),
                     describe_node(*table.get("lead")), table.get("lead")->source().begin.line),
         "one of them");
  }
}

}  // namespace

AxisCoordinates coordinates_of(const Document& document, const toml::table& table, const std::string& path,
                               double radius) {
  const toml::node* kind_node = table.get("kind");
  const AxisKind kind =
      kind_node != nullptr && describe_node(*kind_node) == "\"rotary\"" ? AxisKind::rotary : AxisKind::linear;
  const Coordinate axis{kind, kind == AxisKind::rotary ? radius : 1.0};
  const toml::node* node = table.get("transmission");
  if (node == nullptr) return {axis, axis};
  const std::string key = join_key(path, "transmission");
  const TableReader reader(document, false);
  const toml::table& given = reader.as_table(*node, key, Table<TransmissionParameters>::text);
  const auto transmission = reader.read<TransmissionParameters>(given, key);
  check(document, given, key, kind, transmission);
  return {axis, {AxisKind::rotary, way_per_radian(transmission, radius) / transmission.ratio}};
}

void reduce(const Document& document, const toml::table& table, const std::string& path, AxisModel& axis,
            const AxisCoordinates& coordinates) {
  axis.coordinate = coordinates.axis;
  axis.motor_coordinate = coordinates.motor;
  axis.load_mass = axis.mass;
  if (const auto& transmission = axis.transmission) {
    const double motor = coordinates.motor.radius, screw = way_per_radian(*transmission, coordinates.axis.radius);
    axis.mass += transmission->motor_inertia / (motor * motor) + transmission->screw_inertia / (screw * screw);
  }
  if (const auto& counts = axis.encoder.counts) {
    const auto& place = axis.encoder.on == EncoderPlace::motor ? coordinates.motor : coordinates.axis;
    const toml::node& node = *table.at_path("encoder.counts").node();
    if (!place.rotary())
      document.fail(node.source(), join_key(path, "encoder.counts"), describe_node(node),
                    "increment in its place: what the encoder sits on does not turn");
    axis.encoder.increment = turn * place.radius / *counts;
  }
  if (axis.coordinate.rotary() && !axis.supervision.following_error)
    axis.supervision.following_error = usual_following_error * axis.coordinate.radius;
}

}  // namespace stiction::machine
