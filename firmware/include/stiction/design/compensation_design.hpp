// What an axis does against friction, in SI units, and the configuration of FrictionCompensation that it becomes.
#pragma once

#include <span>

#include "stiction/control/compensation_kind.hpp"
#include "stiction/design/axis_design.hpp"
#include "stiction/design/compensation_configuration.hpp"
#include "stiction/design/compensation_parameters.hpp"
#include "stiction/design/conversion.hpp"
#include "stiction/design/problems.hpp"
#include "stiction/drive/friction_compensation.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction {

struct CompensationDesign {
  CompensationKind kind = CompensationKind::off;
  double set_point_delay = 0.0;  // s, by which the axis follows its set-points late; the same for all axes of a path
  design::PulseCompensationParameters pulse{};
  design::FrictionFeedforwardParameters friction{};
  design::QuadrantLearningParameters learning{};

  // What is wrong with it on this axis, whose own design must validate; empty: configuration() holds all of it.
  constexpr design::Problems validate(const AxisDesign& axis) const {
    design::Problems problems;
    check_delay(axis, problems);
    const bool learns = kind == CompensationKind::learning;
    if (kind == CompensationKind::pulse || pulse.duration > 0.0) check_pulse(axis, problems);
    if (kind == CompensationKind::friction || learns || friction.given()) check_friction(axis, problems);
    if (learns || learning.filter > 0.0) check_learning(axis, problems);
    if (problems.empty()) design::configure_compensation<FixedSignals>(axis, *this, problems);
    return problems;
  }

  // Of a design that validates; of any other one a stage that does nothing.
  constexpr FrictionCompensationConfig<FixedSignals> configuration(const AxisDesign& axis) const {
    design::Problems problems = validate(axis);
    if (!problems.empty()) return {};
    return design::configure_compensation<FixedSignals>(axis, *this, problems);
  }

 private:
  static constexpr double longest_pulse = 10.0;       // s
  static constexpr double longest_distance = 1.9e-3;  // m: half of it is the deflection of an element, S::bounded_step
  using Quantity = design::Quantity;

  constexpr void check_delay(const AxisDesign& axis, design::Problems& problems) const {
    const double fast = axis.timing.fast_period, ticks = set_point_delay / fast;
    const double most = compensation_buffer_ticks - 1;
    const Quantity quantity{"timing.set_point_delay", "", "s"};
    if (!(ticks >= 0.0 && ticks < most + 0.5))
      return problems.add({quantity, set_point_delay, "0 s to", most * fast, ", 15 fast periods"});
    if (__builtin_fabs(ticks - static_cast<double>(design::nearest(ticks))) > 1e-6)
      problems.add({quantity, set_point_delay, "a whole multiple of", fast, ", the fast_period"});
  }

  constexpr void check_pulse(const AxisDesign& axis, design::Problems& problems) const {
    const auto more = [&](double value, double than, const Quantity& quantity, const char* reason) {
      if (!(value > than)) problems.add({quantity, value, "more than", than, reason});
    };
    const Quantity amplitude{"friction_compensation.pulse.amplitude", "", "m/s"};
    if (!(pulse.amplitude >= 0.0 && pulse.amplitude <= axis.max_velocity))
      problems.add({amplitude, pulse.amplitude, "0 m/s to", axis.max_velocity, ", the axis' max_velocity"});
    if (!(pulse.final_amplitude >= 0.0 && pulse.final_amplitude <= pulse.amplitude))
      problems.add({{"friction_compensation.pulse.final_amplitude", "", "m/s"},
                    pulse.final_amplitude,
                    "0 m/s to",
                    pulse.amplitude,
                    ", the amplitude"});
    more(pulse.rise_until, 0.0, {"friction_compensation.pulse.rise_until", "", "m/s^2"}, "");
    more(pulse.flat_until, pulse.rise_until, {"friction_compensation.pulse.flat_until", "", "m/s^2"}, ", rise_until");
    more(pulse.fall_until, pulse.flat_until, {"friction_compensation.pulse.fall_until", "", "m/s^2"}, ", flat_until");
    if (!(pulse.duration > 0.0 && pulse.duration <= longest_pulse))
      problems.add({{"friction_compensation.pulse.duration", "", "s"},
                    pulse.duration,
                    "more than 0 s and at most",
                    longest_pulse,
                    ""});
    if (!(pulse.delay >= 0.0 && pulse.delay <= longest_pulse))
      problems.add({{"friction_compensation.pulse.delay", "", "s"}, pulse.delay, "0 s to", longest_pulse, ""});
  }

  constexpr void check_friction(const AxisDesign& axis, design::Problems& problems) const {
    const auto& f = friction;
    const auto count = [](std::span<const double> list) { return static_cast<double>(list.size()); };
    const auto as_many = [&](std::span<const double> list, std::span<const double> other, const Quantity& quantity,
                             const char* expected) {
      if (list.size() != other.size()) problems.add({quantity, count(list), expected, count(other), ""});
    };
    if (!(f.look_ahead >= 0.0 && f.look_ahead <= set_point_delay + 1e-12))
      problems.add({{"friction_compensation.friction.look_ahead", "", "s"},
                    f.look_ahead,
                    "0 s to",
                    set_point_delay,
                    ", the set_point_delay"});
    if (f.distance.size() > compensation_element_count)
      problems.add({{"friction_compensation.friction.distance", "number of values", ""},
                    count(f.distance),
                    "at most",
                    compensation_element_count,
                    ", as many elements as the drive has"});
    as_many(f.level, f.distance, {"friction_compensation.friction.level", "number of values", ""},
            "as many as there are distances,");
    as_many(f.forward, f.speed, {"friction_compensation.friction.forward", "number of values", ""},
            "as many as there are speeds,");
    as_many(f.backward, f.speed, {"friction_compensation.friction.backward", "number of values", ""},
            "as many as there are speeds,");
    for (const double distance : f.distance)
      if (distance > longest_distance)
        problems.add({{"friction_compensation.friction.distance", "", "m"}, distance, "at most", longest_distance, ""});
    check_rising(f.distance, {"friction_compensation.friction.distance", "", "m"}, problems);
    check_rising(f.speed, {"friction_compensation.friction.speed", "", "m/s"}, problems);
    double coulomb = 0.0;
    for (const double level : f.level) coulomb += level < 0.0 ? -level : level;
    const double most = design::largest_current(axis.motor, axis.inverter);
    if (!(coulomb <= most))
      problems.add({{"friction_compensation.friction.level", "sum", axis.motor.loop == CurrentLoop::none ? "V" : "A"},
                    coulomb,
                    "at most",
                    most,
                    ", the limit of the axis"});
  }

  static constexpr void check_rising(std::span<const double> list, const Quantity& quantity,
                                     design::Problems& problems) {
    double before = 0.0;
    for (const double value : list) {
      if (!(value > before)) problems.add({quantity, value, "increasing values, more than", before, ""});
      before = value;
    }
  }

  constexpr void check_learning(const AxisDesign& axis, design::Problems& problems) const {
    const auto within = [&](double value, double least, double most, const Quantity& quantity, const char* words) {
      if (!(value >= least && value <= most)) problems.add({quantity, value, words, most, ""});
    };
    const double most = design::largest_current(axis.motor, axis.inverter);
    within(learning.filter, 1e-4, 0.01, {"friction_compensation.learning.filter", "", "s"}, "0.0001 s to");
    within(learning.gain, 0.0, 1.0, {"friction_compensation.learning.gain", "", ""}, "0 to");
    within(learning.forgetting, 0.0, 1.0, {"friction_compensation.learning.forgetting", "", ""}, "0 to");
    within(learning.forgetting + 2.0 * learning.smoothing, learning.forgetting, 1.0,
           {"friction_compensation.learning.smoothing", "forgetting + 2 smoothing", ""}, "at most");
    within(learning.limit, 0.0, most, {"friction_compensation.learning.limit", "", "A"}, "0 A to");
    within(learning.dead_zone, 0.0, 1e-5, {"friction_compensation.learning.dead_zone", "", "m"}, "0 m to");
    if (!(learning.lead <= 0.012))
      problems.add({{"friction_compensation.learning.lead", "", "s"}, learning.lead, "at most", 0.012, ""});
  }
};

}  // namespace stiction
