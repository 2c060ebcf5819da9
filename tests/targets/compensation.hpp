// The friction compensation beside a recorded axis: fed with its set-points and its following error, without a way back
// to it. So an older recording's axis stays as it is, and every law of the compensation meets limits, jumps, reversals
// and a fault. The configuration is in whole numbers, as no target but the host has others.
#pragma once

#include <array>
#include <cstdint>

#include "stiction/drive/axis_signals.hpp"
#include "stiction/drive/friction_compensation.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::targets {

inline FrictionCompensationConfig<FixedSignals> compensation_config(CompensationKind kind) {
  using S = FixedSignals;
  FrictionCompensationConfig<S> c;
  c.kind = kind;
  c.set_point_delay = 10;
  c.lag_ticks = 6;
  c.lag_fraction = S::TickFraction::from_raw(100000000);
  // 2 to 400 um, 0.12 A each.
  for (int k = 0; k < static_cast<int>(c.friction.elements.size()); ++k) {
    c.friction.elements[static_cast<std::size_t>(k)].reach = S::Step::from_raw(1 << (21 + k));
    c.friction.elements[static_cast<std::size_t>(k)].stiffness = S::ContactStiffness::from_raw(503316 >> k);
  }
  c.friction.damping = S::ContactDamping::from_raw(52 << 20);
  for (std::int32_t k = 0; k < static_cast<std::int32_t>(c.friction.forward.size()); ++k) {
    c.friction.forward[static_cast<std::size_t>(k)] = S::Current::from_raw(k * k * 4000);
    c.friction.backward[static_cast<std::size_t>(k)] = S::Current::from_raw(k * k * 4400 - k * 9000);
  }
  c.friction.limit = S::Current::from_raw(6 << 20);
  c.pulse.amplitude = S::Velocity::from_raw(161061);  // 0.6 mm/s
  c.pulse.final_amplitude = S::Velocity::from_raw(53687);
  c.pulse.rise = S::PulseSlope::from_raw(100663);  // to 0.1 m/s^2
  c.pulse.fall = S::PulseSlope::from_raw(3355);    // to 3 m/s^2
  c.pulse.flat_until = S::Acceleration::from_raw(1 << 22);
  c.pulse.delay_ticks = 24;
  c.pulse.duration_ticks = 300;
  auto& l = c.learning;
  l.rate_gain = S::ContactStiffness::from_raw(76800000);
  l.error_gain = S::ContactStiffness::from_raw(1360000);
  l.dead_zone = S::Distance::from_raw(1288);
  l.error_limit = S::Distance::from_raw(214748);
  l.filter = S::FilterCoefficient::from_raw(16262000);
  l.filter_rest = S::FilterCoefficient::from_raw((1 << 28) - 16262000);
  l.gain = S::FilterCoefficient::from_raw(161061274);
  l.keep = S::FilterCoefficient::from_raw(155692564);
  l.smoothing = S::FilterCoefficient::from_raw(53687091);
  l.limit = S::Current::from_raw(1 << 19);
  l.credit_ticks = 58;
  l.tolerance = S::Distance::from_raw(4295);
  return c;
}

// Of one axis: the learning one, which works the feedforward too, and the pulse.
class CompensationBeside {
 public:
  void start(const Feedback<FixedSignals>& feedback) {
    learning_.start(feedback.position);
    pulse_.start(feedback.position);
  }
  void tick(const SetPoint<FixedSignals>& set, const AxisSignals<FixedSignals>& axis) {
    set_ = set;
    learning_.step(set_, signals_);
    learning_.observe(axis, signals_);
    FrictionCompensationSignals<FixedSignals> of_pulse;
    auto with_pulse = set;
    pulse_.step(with_pulse, of_pulse);
    signals_.pulse = of_pulse.pulse;
  }

  // Calls visit(name, word) for all that it shows of itself in a tick.
  template <class Visit>
  void each_word(Visit&& visit) const {
    for_each_signal(signals_,
                    [&](const char* name, auto, auto, auto value) { visit(name, std::int64_t{value.raw()}); });
    visit("compensated_position", std::int64_t{set_.position.raw()});
    visit("compensated_injection", std::int64_t{set_.injection.raw()});
    visit("learning_dropped", std::int64_t{signals_.dropped});
    std::uint64_t table = 0;  // of all its currents, modulo 2^64
    for (const auto& each : learning_.learned())
      for (const auto& current : each) table = 31 * table + static_cast<std::uint64_t>(current.raw());
    visit("learned_table", static_cast<std::int64_t>(table));
    visit("compensation_saturations", static_cast<std::int64_t>(learning_.saturations()));
  }

 private:
  using Compensation = FrictionCompensation<FixedSignals>;
  Compensation learning_{compensation_config(CompensationKind::learning)};
  Compensation pulse_{compensation_config(CompensationKind::pulse)};
  FrictionCompensationSignals<FixedSignals> signals_;
  SetPoint<FixedSignals> set_;
};

}  // namespace stiction::targets
