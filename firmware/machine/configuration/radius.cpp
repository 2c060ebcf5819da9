#include "firmware/machine/configuration/radius.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
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

std::vector<design::Problem> problems_on(const AxisDesign& design, int exponent) {
  design::Problems problems;
  design::configure_axis<FixedSignals>(on_radius(design, std::ldexp(1.0, exponent)), problems);
  return std::vector<design::Problem>(problems.begin(), problems.end());
}

// What leaves its format in one direction, and from the lowest to the highest exponent at which it does.
struct Refusal {
  design::Problem problem;  // at the highest
  int lowest, highest;

  bool is(const design::Problem& other) const {
    const auto text = [](const char* t) { return std::string_view(t); };
    return text(problem.quantity.key) == other.quantity.key && text(problem.quantity.what) == other.quantity.what &&
           text(problem.expected) == other.expected;
  }
  bool asks_for_less() const { return highest == largest_exponent; }
  bool asks_for_more() const { return lowest == smallest_exponent; }
};

RadiusBound bound(const Refusal& refusal, int exponent) {
  return {refusal.problem.quantity.key, refusal.problem.quantity.what, std::ldexp(1.0, exponent)};
}

}  // namespace

RadiusChoice choose_radius(const Timing& timing, const AxisModel& axis) {
  const AxisDesign design = design_of(timing, axis);
  std::vector<Refusal> refusals;
  for (int exponent = largest_exponent; exponent >= smallest_exponent; --exponent) {
    const auto problems = problems_on(design, exponent);
    if (problems.empty()) return {std::ldexp(1.0, exponent), {}, {}, {}};
    for (const auto& problem : problems) {
      const auto known =
          std::find_if(refusals.begin(), refusals.end(), [&](const Refusal& r) { return r.is(problem); });
      if (known == refusals.end())
        refusals.push_back({problem, exponent, exponent});
      else
        known->lowest = exponent;
    }
  }
  // The tightest on either side.
  RadiusChoice none;
  const Refusal *less = nullptr, *more = nullptr;
  for (const auto& refusal : refusals) {
    if (refusal.asks_for_less() && refusal.asks_for_more())
      none.never.push_back({refusal.problem.quantity.key, refusal.problem.quantity.what, {}});
    else if (refusal.asks_for_less() && (less == nullptr || refusal.lowest < less->lowest))
      less = &refusal;
    else if (refusal.asks_for_more() && (more == nullptr || refusal.highest > more->highest))
      more = &refusal;
  }
  if (less != nullptr && more != nullptr && less->lowest <= more->highest + 1) {
    none.at_most = bound(*less, less->lowest - 1);
    none.at_least = bound(*more, more->highest + 1);
  }
  return none;
}

}  // namespace stiction::machine
