#include "host/identify/own_identification.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "host/log/own_units.hpp"
#include "sim/effects/effects.hpp"

namespace stiction::host {
namespace {

// Units that names of quantities end with, the longest ending first.
struct Ending {
  std::string_view suffix, unit;
};
constexpr std::array endings{
    Ending{"_N_s_per_m", "N s/m"},
    Ending{"_m_per_s2", "m/s^2"},
    Ending{"_N_per_m", "N/m"},
    Ending{"_m_per_s", "m/s"},
    Ending{"_kg", "kg"},
    Ending{"_N", "N"},
    Ending{"_m", "m"},
};

const Ending* ending_of(std::string_view name) {
  const auto found =
      std::find_if(endings.begin(), endings.end(), [&](const Ending& e) { return name.ends_with(e.suffix); });
  return found == endings.end() ? nullptr : &*found;
}

constexpr machine::Coordinate any_rotary{machine::AxisKind::rotary, 1.0};

// Whether the name is that of a rotary axis' quantity already: "coulomb_N_m".
bool is_own(std::string_view name) {
  return std::any_of(endings.begin(), endings.end(), [&](const Ending& e) {
    return e.unit != any_rotary.own(e.unit).unit && name.ends_with(sim::unit_suffix(any_rotary.own(e.unit).unit));
  });
}

// What to record of a joint where a feed axis is told lengths.
constexpr std::array<std::pair<std::string_view, std::string_view>, 5> records_of_joints{{
    {"constant speeds from a few mm/s", "constant speeds from a hundredth of the highest"},
    {"moves with accelerations of 1 m/s^2 and more", "moves with a tenth of the highest acceleration and more"},
    {"amplitudes, 5 to 200 um", "amplitudes, from ten increments of the encoder on"},
    {"below 10 mm/s", "below a hundredth of the highest"},
    {"at 1 mm/s and below", "at the lowest speeds"},
}};

std::string for_joints(std::string text) {
  for (const auto& [length, angle] : records_of_joints)
    if (const auto at = text.find(length); at != std::string::npos) text.replace(at, length.size(), angle);
  return text;
}

class Converter {
 public:
  explicit Converter(const machine::AxisModel& axis) : coordinate_(axis.coordinate) {}

  double operator()(double value, std::string_view unit) const { return coordinate_.own(unit).from_linear(value); }
  double named(double value, const std::string& name) const {
    const auto* ending = ending_of(name);
    return ending == nullptr ? value : (*this)(value, ending->unit);
  }
  void all(std::vector<double>& values, std::string_view unit) const {
    for (double& value : values) value = (*this)(value, unit);
  }
  // A force at 1 m/s that goes with a power of the speed is one at 1 rad/s.
  double at_own_speed(double force, double exponent) const {
    return (*this)(force, "N") * std::pow(coordinate_.radius, exponent);
  }

 private:
  machine::Coordinate coordinate_;
};

void convert(SlidingCurve& curve, const Converter& own) {
  const auto exponent = std::find_if(curve.parameters.begin(), curve.parameters.end(),
                                     [](const auto& p) { return p.name == "exponent"; });
  const double power = exponent == curve.parameters.end() ? 0.0 : exponent->value;
  for (auto& p : curve.parameters) {
    const bool of_speed = p.name == "force_at_1_m_per_s_N";
    const auto convert_one = [&](double& v) { v = of_speed ? own.at_own_speed(v, power) : own.named(v, p.name); };
    convert_one(p.value);
    std::for_each(p.replicates.begin(), p.replicates.end(), convert_one);
    p.name = own_name(p.name);
  }
  for (auto& e : curve.errors) e.held_out = own(e.held_out, "N");
  for (auto& p : curve.points) {
    p.speed = own(p.speed, "m/s");
    for (double* force : {&p.force, &p.low, &p.high}) *force = own(*force, "N");
  }
  for (auto& p : curve.measured) {
    p.speed = own(p.speed, "m/s");
    for (double* force : {&p.force, &p.standard_error}) *force = own(*force, "N");
  }
}

void convert(Band& band, const Converter& own) {
  constexpr std::array<std::string_view, 5> units{"kg", "N s/m", "N", "N", "N"};
  for (auto& trial : band.trials) {
    for (std::size_t c = 0; c < units.size(); ++c)
      for (auto* values : {&trial.value, &trial.error}) (*values)[c] = own((*values)[c], units[c]);
    trial.friction = own(trial.friction, "N");
    trial.speed_noise = own(trial.speed_noise, "m/s");
    trial.acceleration_noise = own(trial.acceleration_noise, "m/s^2");
  }
  band.position_noise = own(band.position_noise, "m");
}

}  // namespace

std::vector<Log> linear_logs(std::vector<Log> logs, const machine::AxisModel& axis) {
  for (auto& log : logs)
    for (auto& channels : log.axes) {
      if (channels.axis != axis.name && !channels.axis.empty()) continue;
      require_same_kind(log, channels, axis);
      channels = as_linear(std::move(channels), axis.coordinate);
    }
  return logs;
}

std::vector<Log> linear_logs(std::vector<Log> logs, const std::vector<machine::AxisModel>& axes) {
  for (const auto& axis : axes) logs = linear_logs(std::move(logs), axis);
  return logs;
}

std::string own_name(const std::string& name) {
  if (name == "mass_kg") return "inertia_kg_m2";
  if (name == "force_at_1_m_per_s_N") return "torque_at_1_rad_per_s_N_m";
  const auto* ending = ending_of(name);
  if (ending == nullptr || is_own(name)) return name;
  auto stem = name.substr(0, name.size() - ending->suffix.size());
  for (const auto& [force, torque] : {std::pair<std::string_view, std::string_view>{"_force", "_torque"}})
    if (stem.ends_with(force)) stem = stem.substr(0, stem.size() - force.size()) + std::string(torque);
  return stem + sim::unit_suffix(any_rotary.own(ending->unit).unit);
}

Identification in_own_units(Identification result, const machine::AxisModel& axis) {
  if (!axis.coordinate.rotary()) return result;
  const Converter own(axis);
  result.rotary = true;
  for (auto& p : result.parameters) {
    for (double* value : {&p.value, &p.ci95.low, &p.ci95.high}) *value = own.named(*value, p.name);
    p.name = own_name(p.name);
    p.how = for_joints(p.how);
  }
  for (auto& n : result.not_determined) {
    n.name = own_name(n.name);
    n.record = for_joints(n.record);
  }
  const auto maybe = [&](std::optional<double>& value, std::string_view unit) {
    if (value) value = own(*value, unit);
  };
  maybe(result.initial.coulomb, "N");
  maybe(result.initial.viscous, "N s/m");
  maybe(result.initial.mass, "kg");
  if (result.curve) convert(*result.curve, own);
  if (result.band) convert(*result.band, own);
  for (auto& element : result.elements) {
    element.stiffness = own(element.stiffness, "N/m");
    element.level = own(element.level, "N");
  }
  if (result.held_out)
    for (double* force : {&result.held_out->fit, &result.held_out->plain}) *force = own(*force, "N");
  for (double* force : {&result.force_rms, &result.residual_rms}) *force = own(*force, "N");
  for (auto& log : result.residuals) {
    own.all(log.speed, "m/s");
    own.all(log.residual, "N");
  }
  return result;
}

}  // namespace stiction::host
