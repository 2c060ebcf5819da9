#include "firmware/machine/configuration/radius.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "stiction/design/axis_configuration.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::machine {
namespace {

constexpr int largest_exponent = 20, smallest_exponent = -30;

// The design of an axis whose radian was 1 m long, with one of `radius`.
AxisDesign on_radius(AxisDesign design, double radius) {
  design.mass /= radius * radius;
  design.max_velocity *= radius;
  design.motor.force_constant /= radius;
  design.motor.pole_pair_pitch *= radius;
  design.position_controller.increment *= radius;
  design.velocity_controller.gain /= radius;
  design.supervision.following_error *= radius;
  design.supervision.over_speed *= radius;
  return design;
}

// A key, and in which direction its value leaves its format.
using Refusal = std::pair<std::string, std::string>;

std::vector<Refusal> refusals_on(const AxisDesign& design, double radius) {
  design::Problems problems;
  design::configure_axis<FixedSignals>(on_radius(design, radius), problems);
  std::vector<Refusal> refusals;
  for (const design::Problem& problem : problems) refusals.emplace_back(problem.quantity.key, problem.expected);
  return refusals;
}

bool contains(const std::vector<Refusal>& refusals, const Refusal& refusal) {
  return std::find(refusals.begin(), refusals.end(), refusal) != refusals.end();
}

}  // namespace

RadiusChoice choose_radius(const Timing& timing, const AxisModel& axis) {
  const AxisDesign design = design_of(timing, axis);
  const auto largest = refusals_on(design, std::ldexp(1.0, largest_exponent));
  auto before = largest;
  for (int exponent = largest_exponent; exponent >= smallest_exponent; --exponent) {
    const double radius = std::ldexp(1.0, exponent);
    const auto refusals = refusals_on(design, radius);
    if (refusals.empty()) return {radius, {}};
    // What asks for a larger radius, beside what still asks for a smaller one, or did so at twice this radius.
    const auto larger =
        std::find_if(refusals.begin(), refusals.end(), [&](const Refusal& r) { return !contains(largest, r); });
    if (larger != refusals.end()) {
      const auto smaller =
          std::find_if(refusals.begin(), refusals.end(), [&](const Refusal& r) { return contains(largest, r); });
      const Refusal& other = smaller != refusals.end() ? *smaller : before.front();
      return {{}, fmt::format("{} and {}", other.first, larger->first)};
    }
    before = refusals;
  }
  return {{}, before.front().first};
}

}  // namespace stiction::machine
