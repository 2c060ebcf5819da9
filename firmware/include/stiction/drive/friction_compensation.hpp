// Stands between the source of set-points and an axis: holds the set-points back by some ticks and works out from the
// newest one what will rub when the axis comes there, early enough for the force to arrive in time. What it adds enters
// the axis as test signals do, into the set current; a speed pulse enters the set speed. An axis without it pays
// nothing.
#pragma once

#include <array>
#include <cstdint>

#include "stiction/control/compensation_kind.hpp"
#include "stiction/control/delay_line.hpp"
#include "stiction/control/friction_feedforward.hpp"
#include "stiction/control/quadrant_learning.hpp"
#include "stiction/control/reversal_pulse.hpp"
#include "stiction/drive/axis_signals.hpp"
#include "stiction/drive/exchange.hpp"
#include "stiction/number/choice.hpp"
#include "stiction/number/fixed.hpp"

namespace stiction {

template <class S>
struct FrictionCompensationConfig {
  static constexpr std::uint32_t buffer_ticks = compensation_buffer_ticks;

  CompensationKind kind = CompensationKind::off;
  std::uint32_t set_point_delay = 0;  // ticks, below buffer_ticks; the same for all axes of a path
  // Ticks by which the current waits for the set-points: their delay less the look-ahead. At most buffer_ticks - 2.
  Each<S, std::uint32_t> lag_ticks{};
  typename S::TickFraction lag_fraction{};
  typename ReversalPulse<S>::Config pulse{};
  typename FrictionFeedforward<S>::Config friction{};
  typename QuadrantLearning<S>::Config learning{};
};

// What it added in a tick, as it enters the axis but for `friction`, whose terms are those of the newest set-point.
template <class S>
struct FrictionCompensationSignals {
  typename FrictionFeedforward<S>::Terms friction{};
  typename S::Current learned{};
  typename S::Current missing{};
  typename S::Current current{};
  typename S::Velocity pulse{};
  Each<S, bool> dropped{};
};

// The one list of the signals above, as for_each_signal() of an axis.
template <class S, class Visit>
constexpr void for_each_signal(const FrictionCompensationSignals<S>& s, Visit&& visit) {
  visit("i_contact", "A", "current against presliding, of the newest set-point", s.friction.contact);
  visit("i_contact_damping", "A", "current against the contact's damping, of the newest set-point", s.friction.damping);
  visit("i_sliding", "A", "current of the sliding curve beyond the Coulomb level, of the newest set-point",
        s.friction.sliding);
  visit("i_learned", "A", "current learned from earlier laps, of the newest set-point", s.learned);
  visit("i_missing", "A", "current that the following error says is missing", s.missing);
  visit("i_compensation", "A", "current that the friction compensation adds", s.current);
  visit("v_pulse", "m/s", "speed that the friction compensation adds", s.pulse);
}

template <class S>
class FrictionCompensation {
 public:
  using Config = FrictionCompensationConfig<S>;
  using Signals = FrictionCompensationSignals<S>;

  explicit constexpr FrictionCompensation(const Config& config) : config_(config) {}

  constexpr const Config& config() const { return config_; }
  constexpr std::uint64_t saturations() const { return saturations_.count; }

  // At rest at the measured position. Call before the first tick, with the axis' own start.
  constexpr void start(typename S::Position x) {
    set_points_.fill({x, {}, {}});
    current_.fill({});
    pulse_ = ReversalPulse<S>::start(config_.pulse);
    friction_ = {};
    learning_ = QuadrantLearning<S>::start(config_.learning);
    newest_ = x;
  }

  // Takes the newest set-point and puts the one for the axis in its place. A test signal and the mark of a set-point
  // that is not valid are not held back.
  constexpr void step(SetPoint<S>& set, Signals& terms) {
    const Motion newest{set.position, set.velocity, set.acceleration};
    set_points_.push(newest);
    const Motion& late = set_points_.at(config_.set_point_delay);
    set.position = late.position;
    set.velocity = late.velocity;
    set.acceleration = late.acceleration;
    switch (config_.kind) {
      case CompensationKind::off:
        break;
      case CompensationKind::pulse:
        terms.pulse = ReversalPulse<S>::step(config_.pulse, pulse_, newest.velocity, newest.acceleration, saturations_);
        set.velocity = saturated_sum(set.velocity, terms.pulse, saturations_);
        break;
      case CompensationKind::friction:
        add(set, oppose_friction(step_to(newest.position), newest.velocity, terms), terms);
        break;
      case CompensationKind::learning: {
        const auto dx = step_to(newest.position);
        terms.learned = QuadrantLearning<S>::play(config_.learning, learning_, dx, newest.velocity, newest.acceleration,
                                                  saturations_);
        add(set, saturated_sum(oppose_friction(dx, newest.velocity, terms), terms.learned, saturations_), terms);
        break;
      }
    }
  }

  // After the axis' tick: what its error teaches.
  constexpr void observe(const AxisSignals<S>& axis, Signals& terms) {
    if (config_.kind != CompensationKind::learning) return;
    QuadrantLearning<S>::learn(config_.learning, learning_, axis.e, saturations_);
    terms.missing = learning_.missing;
    terms.dropped = learning_.dropped;
  }

  // What was learned so far, to be kept for the next start.
  constexpr const typename QuadrantLearning<S>::Tables& learned() const { return learning_.tables; }
  constexpr Each<S, bool> dropped() const { return learning_.dropped; }

 private:
  struct Motion {
    typename S::Position position{};
    typename S::Velocity velocity{};
    typename S::Acceleration acceleration{};
  };

  constexpr typename S::Step step_to(typename S::Position x) {
    const auto dx = narrow<typename S::Step>(x - newest_, saturations_);
    newest_ = x;
    return dx;
  }
  constexpr typename S::Current oppose_friction(typename S::Step dx, typename S::Velocity v, Signals& terms) {
    terms.friction = FrictionFeedforward<S>::step(config_.friction, friction_, dx, v, saturations_);
    return terms.friction.sum;
  }
  constexpr void add(SetPoint<S>& set, typename S::Current newest, Signals& terms) {
    current_.push(newest);
    terms.current = read_between<S>(current_, config_.lag_ticks, config_.lag_fraction);
    if (!set.by_current) set.injection = saturated_sum(set.injection, terms.current, saturations_);
  }

  Config config_;
  DelayLine<Motion, Config::buffer_ticks> set_points_{};
  typename S::Position newest_{};
  DelayLine<typename S::Current, Config::buffer_ticks> current_{};
  typename ReversalPulse<S>::State pulse_{};
  typename FrictionFeedforward<S>::State friction_{};
  typename QuadrantLearning<S>::State learning_{};
  SaturationCounter saturations_{};
};

}  // namespace stiction
