// An axis in SI units, and what the drive's cascade is configured with: the start of a drive of one's own. It runs at
// the desk, at start-up, or, with GCC, while compiling:
//   constexpr stiction::AxisDesign design{.mass = 20.0, ...};
//   static_assert(design.validate().empty());
//   constinit stiction::Axis<stiction::FixedSignals> axis(design.configuration());
#pragma once

#include <cstdint>

#include "stiction/design/axis_configuration.hpp"
#include "stiction/design/axis_parameters.hpp"
#include "stiction/design/conversion.hpp"
#include "stiction/design/problems.hpp"
#include "stiction/drive/axis.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction {

struct AxisDesign {
  design::TimingParameters timing{};
  double mass = 0.0;          // kg, all that moves
  double max_velocity = 0.0;  // m/s
  design::MotorParameters motor{};
  design::InverterParameters inverter{};
  design::EncoderParameters encoder{};
  design::PositionControllerParameters position_controller{};
  design::PiParameters velocity_controller{};
  design::NotchParameters notch{};
  design::PiParameters current_controller{};
  design::FeedforwardParameters feedforward{};
  design::SupervisionParameters supervision{};

  // What is wrong with it; empty: configuration() holds all of it.
  constexpr design::Problems validate() const {
    design::Problems problems;
    check_timing(problems);
    check_values(problems);
    // What is computed of values without a sense would only repeat them.
    if (problems.empty()) design::configure_axis<FixedSignals>(*this, problems);
    return problems;
  }

  // Of a design that validates. Of any other: an empty one, whose limits are all zero, so that an axis gives no voltage
  // and stops with a fault at the first motion.
  constexpr AxisConfig<FixedSignals> configuration() const {
    design::Problems problems = validate();
    if (!problems.empty()) return {};
    return design::configure_axis<FixedSignals>(*this, problems);
  }

  // Fast ticks from one slow tick to the next; of a design that validates.
  constexpr std::uint32_t slow_ticks() const {
    return static_cast<std::uint32_t>(design::nearest(timing.slow_period / timing.fast_period));
  }

 private:
  static constexpr double longest_period = 0.1;  // s

  constexpr void check_timing(design::Problems& problems) const {
    const double fast = timing.fast_period, slow = timing.slow_period;
    const design::Quantity quantity{"timing.fast_period", "", "s"};
    if (!(fast > 0.0)) return problems.add({quantity, fast, "more than", 0.0, ""});
    if (!(fast <= longest_period)) return problems.add({quantity, fast, "at most", longest_period, ""});
    const double ticks = slow / fast;
    const bool whole =
        ticks > 0.5 && ticks < 1e6 && __builtin_fabs(ticks - static_cast<double>(design::nearest(ticks))) < 1e-6;
    if (!whole) problems.add({{"timing.slow_period", "", "s"}, slow, "a whole multiple of", fast, ", the fast_period"});
  }

  // The ranges of a machine file's keys.
  constexpr void check_values(design::Problems& problems) const {
    const auto positive = [&](double value, const design::Quantity& quantity) {
      if (!(value > 0.0)) problems.add({quantity, value, "more than", 0.0, ""});
    };
    const auto not_negative = [&](double value, const design::Quantity& quantity, double most) {
      if (!(value >= 0.0)) problems.add({quantity, value, "at least", 0.0, ""});
      if (value > most) problems.add({quantity, value, "at most", most, ""});
    };
    constexpr double any = 1e300;
    const bool force_source = motor.loop == CurrentLoop::none;
    const char* ampere = force_source ? "V" : "A";
    positive(mass, {"mass", "", "kg"});
    positive(max_velocity, {"max_velocity", "", "m/s"});
    positive(motor.force_constant, {"motor.force_constant", "", force_source ? "N/V" : "N/A"});
    positive(motor.count, {"motor.count", "", ""});
    if (design::has_phases(motor.loop)) positive(motor.pole_pair_pitch, {"motor.pole_pair_pitch", "", "m"});
    positive(inverter.voltage_limit, {"inverter.voltage_limit", "", "V"});
    if (!force_source) positive(inverter.current_limit, {"inverter.current_limit", "", "A"});
    positive(position_controller.gain, {"position_controller.gain", "", "1/s"});
    not_negative(position_controller.increment, {"position_controller.increment", "", "m"}, any);
    positive(velocity_controller.gain, {"velocity_controller.gain", "", force_source ? "V s/m" : "A s/m"});
    not_negative(velocity_controller.integral_time, {"velocity_controller.integral_time", "", "s"}, any);
    check_current_controller(problems);
    check_notch(problems);
    not_negative(feedforward.velocity, {"feedforward.velocity", "", ""}, 10.0);
    not_negative(feedforward.current, {"feedforward.current", "", ""}, 10.0);
    not_negative(supervision.following_error, {"supervision.following_error", "", "m"}, any);
    not_negative(supervision.over_current, {"supervision.over_current", "", ampere}, any);
    not_negative(supervision.over_speed, {"supervision.over_speed", "", "m/s"}, any);
  }

  constexpr void check_current_controller(design::Problems& problems) const {
    const design::Quantity gain{"current_controller.gain", "", "V/A"};
    if (motor.loop != CurrentLoop::none) {
      if (!(current_controller.gain > 0.0)) problems.add({gain, current_controller.gain, "more than", 0.0, ""});
      if (!(current_controller.integral_time >= 0.0))
        problems.add(
            {{"current_controller.integral_time", "", "s"}, current_controller.integral_time, "at least", 0.0, ""});
    } else if (current_controller.gain != 0.0) {
      problems.add({gain, current_controller.gain, "none,", 0.0, ", with a force source"});
    }
  }

  constexpr void check_notch(design::Problems& problems) const {
    if (notch.frequency == 0.0) return;
    const double nyquist = 0.5 / timing.fast_period;
    if (!(notch.frequency > 0.0 && notch.frequency < nyquist))
      problems.add({{"notch.frequency", "", "Hz"},
                    notch.frequency,
                    "more than 0 Hz and less than",
                    nyquist,
                    ", half of the fast loop's rate"});
    if (!(notch.numerator_damping >= 0.0))
      problems.add({{"notch.numerator_damping", "", ""}, notch.numerator_damping, "at least", 0.0, ""});
    if (!(notch.denominator_damping > 0.0))
      problems.add({{"notch.denominator_damping", "", ""}, notch.denominator_damping, "more than", 0.0, ""});
  }
};

}  // namespace stiction
