#include "host/identify/determined.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace stiction::host {
namespace {

// How wide half of a 95 % interval may be for the parameter to be called determined. A parameter counts as identifiable
// when the bound of Cramer and Rao on its standard error is a tenth of its value (of the Coulomb friction for a
// constant force): half of the interval of a perfect fit is then a fifth. What a real one finds may be as wide as the
// value itself, as long as its sign is certain: a wide interval tells more than none.
enum class Scale {
  value,     // a share of the parameter's own value
  coulomb,   // a share of the friction's level, in newtons: without a load that it rises with the Coulomb friction
  rise,      // a share of the coefficient that would make all of that level
  at_speed,  // a share of the value, or a tenth of the Coulomb friction at the machine's highest speed
  absolute,
};
struct Criterion {
  const char* name;
  Scale scale;
  double widest;
  const char* how;
  const char* record;
};

constexpr const char* record_reversals =
    "slow reversals of several small amplitudes, 5 to 200 um, a few periods of each at 1 to 2 Hz";
constexpr std::array<Criterion, 14> criteria{{
    {"mass_kg", Scale::value, 1.0, "force over acceleration", record_accelerations},
    // Where friction rises with a load, the rows tell the level better than either of its parts.
    {"coulomb_N", Scale::coulomb, 1.0, "friction level in sliding, extrapolated to standstill", record_speeds},
    {"viscous_N_s_per_m", Scale::at_speed, 1.0, "slope of the friction over speed", record_speeds},
    {"constant_force_N", Scale::coulomb, 0.6,
     "half the difference of both directions; includes gravity, current offset, and Coulomb friction that differs "
     "between the directions",
     record_speeds},
    // A weight is the axis' own, however little it rubs; a constant force beside friction is an offset of it.
    {"gravity_moment_N", Scale::value, 1.0,
     "force over the sine of the angle from the rest below, less the counterweight", record_angles},
    {"load_coefficient", Scale::rise, 1.0, "rise of the friction with the moment of the weight, over that moment",
     record_angles},
    {"coulomb_positive_N", Scale::value, 0.3, "includes the constant force, which no log of one axis can separate",
     record_speeds},
    {"coulomb_negative_N", Scale::value, 0.3, "includes the constant force, which no log of one axis can separate",
     record_speeds},
    {"viscous_positive_N_s_per_m", Scale::at_speed, 0.5, "slope of the friction over speed in +x", record_speeds},
    {"viscous_negative_N_s_per_m", Scale::at_speed, 0.5, "slope of the friction over speed in -x", record_speeds},
    {"stiffness_N_per_m", Scale::value, 0.5, "initial slope of the contact after a reversal", record_reversals},
    {"damping_ratio", Scale::absolute, 0.05, "force of the contact's deflection rate", record_reversals},
    {"static_ratio", Scale::absolute, 0.05, "friction at 1 mm/s and below against the sliding level",
     "four constant speeds and more below 10 mm/s, each both ways"},
    {"stribeck_velocity_m_per_s", Scale::value, 0.5, "speed over which the friction falls",
     "four constant speeds and more below 10 mm/s, each both ways"},
}};

const Criterion* criterion_of(std::string_view name) {
  const auto found = std::find_if(criteria.begin(), criteria.end(), [&](const auto& c) { return c.name == name; });
  return found == criteria.end() ? nullptr : &*found;
}

// What no friction model gets right, as a share of the Coulomb level. A parameter whose whole force in the data is less
// than that is read off the model's errors, however narrow its interval: the dither of a position controller's
// quantizer turned 500 N s/m into 3100 +- 100 in reversals of 5 to 40 um, and into 2200 +- 400 in some of up to 200 um.
constexpr double model_error = 0.05;

double floor_of(std::string_view name, const Scales& scales) {
  if (name == "mass_kg") return model_error * scales.coulomb / scales.data_acceleration;
  if (name.starts_with("viscous")) return model_error * scales.coulomb / scales.data_speed;
  return 0.0;
}

double allowed(const Criterion& c, double value, const Scales& scales) {
  switch (c.scale) {
    case Scale::value:
      return c.widest * std::abs(value);
    case Scale::coulomb:
      return c.widest * scales.coulomb;
    case Scale::rise:
      return c.widest * scales.whole_rise;
    case Scale::at_speed:
      return std::max(c.widest * std::abs(value), 0.1 * scales.coulomb / scales.highest_speed);
    case Scale::absolute:
      return c.widest;
  }
  return 0.0;
}

constexpr std::size_t least_blocks_of_scatter = 6;  // fewer do not say how much they scatter

// What the motion must be able to show over the model's errors.
double visible(std::string_view name, double value, const Scales& scales) {
  if (name == "mass_kg") return 0.2 * std::abs(value);
  return std::max(0.5 * std::abs(value), 0.1 * scales.coulomb / scales.highest_speed);
}

bool is_positive(std::string_view name) {
  return name == "mass_kg" || name == "coulomb_N" || name == "viscous_N_s_per_m" || name == "stiffness_N_per_m";
}

// Below 1 a ratio means that friction does not fall with speed, which a machine file writes as 1.
void bound_static_ratio(Identification& result) {
  for (auto& p : result.parameters) {
    if (p.name != "static_ratio") continue;
    const auto bounded = [](double ratio) { return std::max(ratio, 1.0); };
    p = {p.name, bounded(p.value), {bounded(p.ci95.low), bounded(p.ci95.high)}, p.how};
  }
}

}  // namespace

void judge(Identification& result, const FittedParameter& fitted, const Scales& scales, std::size_t blocks,
           const std::string& how) {
  const auto* criterion = criterion_of(fitted.name);
  const auto interval = fitted.interval();
  const double half = 0.5 * (interval.high - interval.low);
  const char* record = criterion != nullptr ? criterion->record : record_speeds;
  if (blocks < least_blocks_of_scatter) {
    result.not_determined.push_back(
        {fitted.name,
         fmt::format("the data have {} independent blocks, fewer than {}", blocks, least_blocks_of_scatter), record});
    return;
  }
  if (criterion != nullptr && floor_of(fitted.name, scales) > visible(fitted.name, fitted.value, scales)) {
    const auto own = [&](double value, const char* unit) { return scales.coordinate.own(unit).from_linear(value); };
    const bool rotary = scales.coordinate.rotary();
    result.not_determined.push_back({fitted.name,
                                     fmt::format("the motion is too slow for it: at most {:.3g} {} and {:.3g} {}",
                                                 own(scales.data_speed, "m/s") * 1e3, rotary ? "mrad/s" : "mm/s",
                                                 own(scales.data_acceleration, "m/s^2"), rotary ? "rad/s^2" : "m/s^2"),
                                     record});
    return;
  }
  if (is_positive(fitted.name) && fitted.value <= 0.0) {
    result.not_determined.push_back(
        {fitted.name,
         fmt::format("the fit gives the negative value {:.3g}, 95 % from {:.3g} to {:.3g}, which no machine has: check "
                     "sign, scale and time of force and position",
                     fitted.value, interval.low, interval.high),
         record});
    return;
  }
  if (criterion != nullptr && !(half <= allowed(*criterion, fitted.value, scales))) {
    result.not_determined.push_back({fitted.name,
                                     fmt::format("the 95 % interval {:.3g} to {:.3g} around {:.3g} is too wide",
                                                 interval.low, interval.high, fitted.value),
                                     record});
    return;
  }
  std::string text = criterion != nullptr ? criterion->how : "shape of the sliding curve";
  if (!how.empty()) text += "; " + how;
  result.parameters.push_back({fitted.name, fitted.value, interval, text});
}

void judge_contact(Identification& result, const FrictionFit& fit, const Scales& scales) {
  for (const char* name : {"stiffness_N_per_m", "damping_ratio", "static_ratio", "stribeck_velocity_m_per_s"}) {
    const auto* fitted = fit.find(name);
    if (fitted == nullptr) continue;
    const bool damping = std::string_view(name) == "damping_ratio";
    if (damping && result.find("stiffness_N_per_m") == nullptr)
      result.not_determined.push_back({name, "the ratio needs the contact stiffness", record_reversals});
    else
      judge(result, *fitted, scales, fit.blocks.size(), "");
  }
  if (fit.find("stribeck_velocity_m_per_s") == nullptr)
    result.not_determined.push_back({"stribeck_velocity_m_per_s", "the friction does not fall with speed",
                                     criterion_of("stribeck_velocity_m_per_s")->record});
  bound_static_ratio(result);
}

void name_contact(Identification& result, const char* why) {
  for (const char* name : {"stiffness_N_per_m", "damping_ratio", "static_ratio", "stribeck_velocity_m_per_s"})
    result.not_determined.push_back({name, why, criterion_of(name)->record});
}

}  // namespace stiction::host
