// The control laws' signal types for many axes at once: in each lane of a batch the law of DoubleSignals, to the bit.
// What the kind of an axis decides (its current loop, whether it has a notch) is the same in all lanes; what its
// signals decide is decided lane by lane.
#pragma once

#include <array>
#include <cstdint>
#include <numbers>

#include "firmware/machine/batch/batch.hpp"
#include "firmware/machine/batch/lanes.hpp"
#include "firmware/machine/configuration/double_signals.hpp"
#include "stiction/control/limit.hpp"
#include "stiction/control/quadrant_learning.hpp"
#include "stiction/control/reversal_pulse.hpp"
#include "stiction/drive/faults.hpp"
#include "stiction/number/choice.hpp"
#include "stiction/number/octave.hpp"

namespace stiction::machine {

// A batch that holds whole numbers: narrowing to it rounds by the firmware's rule.
template <class Isa>
struct WholeBatch {
  Batch<Isa> value;
  STICTION_INLINE friend Batch<Isa> operator*(WholeBatch a, Batch<Isa> b) { return a.value * b; }
};

template <class Isa>
struct BatchFault {
  Batch<Isa> code{};

  STICTION_INLINE BatchFault() {}
  STICTION_INLINE BatchFault(Fault all) : code(static_cast<int>(all)) {}
  STICTION_INLINE Fault lane(std::size_t k) const { return static_cast<Fault>(static_cast<int>(code.lane(k))); }
  STICTION_INLINE friend BatchMask<Isa> operator==(BatchFault a, BatchFault b) { return a.code == b.code; }
  // In the lanes of `m` the variable `to` becomes `value`.
  STICTION_INLINE friend void assign(BatchMask<Isa> m, BatchFault& to, BatchFault value) {
    assign(m, to.code, value.code);
  }
};

template <class Isa>
struct BatchLimiting {
  BatchMask<Isa> velocity, current, voltage;
};

// A time in ns, or a whole number: of each lane.
template <class Isa, class T>
struct LaneType {
  using type = Batch<Isa>;
};
template <class Isa>
struct LaneType<Isa, bool> {
  using type = BatchMask<Isa>;
};
template <class Isa>
struct LaneType<Isa, Fault> {
  using type = BatchFault<Isa>;
};
template <class Isa>
struct LaneType<Isa, Limiting> {
  using type = BatchLimiting<Isa>;
};

template <class Isa>
STICTION_INLINE Batch<Isa> operator+(Batch<Isa> a, NoResidue) {
  return a;
}
// Half of a whole number, towards minus infinity.
template <class Isa>
STICTION_INLINE Batch<Isa> operator>>(Batch<Isa> a, int) {
  return floored(a * 0.5);
}

template <class Out, class Isa>
requires std::same_as<Out, Batch<Isa>> STICTION_INLINE Out narrow(Batch<Isa> x, SaturationCounter&) { return x; }
template <class Out, class Isa>
requires std::same_as<Out, WholeBatch<Isa>> STICTION_INLINE Out narrow(Batch<Isa> x, SaturationCounter&) {
  return {rounded(x)};
}
template <class Out, class Isa>
STICTION_INLINE Batch<Isa> round_to(Batch<Isa> x) {
  return x;
}
template <class Out, class Isa>
STICTION_INLINE Batch<Isa> cut(Batch<Isa> x) {
  return x;
}
template <class Isa>
STICTION_INLINE Batch<Isa> opposite(Batch<Isa> x) {
  return -x;
}
template <class Isa>
STICTION_INLINE Batch<Isa> negative(Batch<Isa> x) {
  return -x;
}
// `a` + `b`; nothing saturates, and the SaturationCounter stays.
template <class Isa>
STICTION_INLINE Batch<Isa> saturated_sum(Batch<Isa> a, Batch<Isa> b, SaturationCounter&) {
  return a + b;
}
// `a` - `b`, likewise with its SaturationCounter.
template <class Isa>
STICTION_INLINE Batch<Isa> saturated_difference(Batch<Isa> a, Batch<Isa> b, SaturationCounter&) {
  return a - b;
}
template <class Isa>
STICTION_INLINE BatchMask<Isa> exceeds(Batch<Isa> x, Batch<Isa> bound) {
  return absolute(x) > bound;
}

// In each lane that of a row of its own.
// `rows`: a ring; `newest`: its last row; `ticks`: rows before it, in each lane.
template <class Isa, std::size_t Length>
STICTION_INLINE Batch<Isa> from_rows(const std::array<Batch<Isa>, Length>& rows, std::uint32_t newest,
                                     Batch<Isa> ticks) {
  Batch<Isa> found;
  for (std::size_t k = 0; k < Batch<Isa>::lanes; ++k)
    found.set_lane(k, rows[(newest - static_cast<std::uint32_t>(ticks.lane(k))) & (Length - 1)].lane(k));
  return found;
}
template <class Isa, std::size_t Length>
STICTION_INLINE Batch<Isa> from_places(const std::array<Batch<Isa>, Length>& rows, Batch<Isa> place) {
  const double first = place.lane(0);
  if (all(place == Batch<Isa>(first))) [[likely]]
    return rows[static_cast<std::size_t>(first)];
  Batch<Isa> found;
  for (std::size_t k = 0; k < Batch<Isa>::lanes; ++k)
    found.set_lane(k, rows[static_cast<std::size_t>(place.lane(k))].lane(k));
  return found;
}

template <class Isa>
struct BatchSignals {
  static constexpr const char* name = Isa::name;
  template <class T>
  using Each = typename LaneType<Isa, T>::type;
  using Number = Batch<Isa>;
  using Mask = BatchMask<Isa>;

  using Position = Number;
  using Distance = Number;
  using Step = Number;
  using Velocity = Number;
  using Acceleration = Number;
  using Current = Number;
  using Voltage = Number;
  using Count = WholeBatch<Isa>;
  using Angle = Number;  // rad
  using Sine = Number;
  using Rate = Number;
  using Ticks = Number;
  using TickFraction = Number;
  using Seconds = Number;

  using PositionGain = Number;
  using VelocityWeight = Number;
  using IncrementInverse = Number;
  using Increment = Number;
  using VelocityGain = Number;
  using VelocityIntegralGain = Number;
  using VelocityIntegral = Number;
  using VelocityTracking = Number;
  using CurrentGain = Number;
  using CurrentIntegralGain = Number;
  using CurrentIntegral = Number;
  using CurrentTracking = Number;
  using AccelerationGain = Number;
  using CurrentSum = Number;
  using FilterCoefficient = Number;
  using FilterResidue = NoResidue;
  using PitchInverse = Number;
  using PeriodInverse = Number;
  using ContactStiffness = Number;
  using ContactSum = Number;
  using ContactDamping = Number;
  using PulseSlope = Number;

  STICTION_INLINE static Rate rate(Number interval_ns) { return 1e9 / interval_ns; }
  STICTION_INLINE static Ticks ticks(Number duration_ns, PeriodInverse inverse_period) {
    return duration_ns * inverse_period;
  }
  STICTION_INLINE static Seconds seconds(Number duration_ns) { return duration_ns * 1e-9; }

  struct Split {
    Number whole;
    TickFraction fraction;
  };
  STICTION_INLINE static Split split(Ticks delay, int highest) {
    const Number positive = select(delay > 0.0, delay, Number());
    const Number bounded = select(positive < highest + 1.0, positive, Number(highest + 1.0));
    const Number cut_off = truncated(bounded), whole = select(cut_off < highest, cut_off, Number(highest));
    return {whole, bounded - whole};
  }

  static constexpr std::size_t speed_nodes = DoubleSignals::speed_nodes;
  struct Place {
    Number node;
    TickFraction fraction;
  };
  STICTION_INLINE static Place speed_place(Velocity speed) { return place(speed, 0x1p-12, speed_nodes); }

  // The values of a table before and behind a place: of `first` where the condition holds, else of `second`.
  struct Entries {
    Number below, above;
  };
  // `condition`: the lanes that read `first`, the others `second`; `node`: of the place, in each lane.
  template <std::size_t Length>
  STICTION_INLINE static Entries entries(Mask condition, const std::array<Number, Length>& first,
                                         const std::array<Number, Length>& second, Number node) {
    Entries found;
    const unsigned in_first = condition.bits();
    for (std::size_t k = 0; k < Number::lanes; ++k) {
      const auto& table = (in_first >> k & 1U) != 0 ? first : second;
      const auto at = static_cast<std::size_t>(node.lane(k));
      found.below.set_lane(k, table[at].lane(k));
      found.above.set_lane(k, table[at + 1].lane(k));
    }
    return found;
  }

  STICTION_INLINE static Step bounded_step(Step dx) { return dx; }
  STICTION_INLINE static Step add_steps(Step deflection, Step dx) { return deflection + dx; }
  static constexpr std::size_t travel_nodes = DoubleSignals::travel_nodes;

  STICTION_INLINE static TickFraction complement(TickFraction fraction) { return 1.0 - fraction; }
  STICTION_INLINE static FilterResidue filter_residue(Number, Number) { return {}; }

  STICTION_INLINE static Angle angle(Position position, PitchInverse inverse_pitch) {
    return 2.0 * std::numbers::pi * position * inverse_pitch;
  }
  STICTION_INLINE static Angle turned(Angle angle, Turn by) {
    return angle + 2.0 * std::numbers::pi * 0x1p-32 * by.raw;
  }
  STICTION_INLINE static Sine sine(Angle angle) {
    std::array<double, Number::lanes> values;
    angle.store(values.data());
    lanes::sines(values.data(), Number::lanes);
    return Number::load(values.data());
  }
  STICTION_INLINE static Angle third_of_turn_after(Angle angle) { return angle + 2.0 * std::numbers::pi / 3.0; }
  STICTION_INLINE static Number two_thirds() { return 2.0 / 3.0; }

 private:
  STICTION_INLINE static Place place(Number magnitude, double first, std::size_t nodes) {
    const Number ratio = magnitude / first, mantissa = mantissa_of(ratio);
    const Mask upper = mantissa >= 1.5;
    const Number node = 1.0 + 2.0 * exponent_of(ratio) + select(upper, Number(1.0), Number());
    const Number fraction = 2.0 * (mantissa - select(upper, Number(1.5), Number(1.0)));
    const Mask below = magnitude < first, beyond = node + 1.0 >= static_cast<double>(nodes);
    return {select(below, Number(), select(beyond, Number(static_cast<double>(nodes - 2)), node)),
            select(below, ratio, select(beyond, Number(1.0), fraction))};
  }
};

}  // namespace stiction::machine

namespace stiction {

template <class Isa>
struct Limited<machine::Batch<Isa>> {
  machine::Batch<Isa> value;
  machine::Batch<Isa> side;  // -1, 0 or 1

  STICTION_INLINE machine::BatchMask<Isa> limiting() const { return side != 0.0; }
};

template <class Isa>
STICTION_INLINE Limited<machine::Batch<Isa>> limit(machine::Batch<Isa> value, machine::Batch<Isa> bound) {
  using Number = machine::Batch<Isa>;
  const auto outside = exceeds(value, bound), above = value > 0.0;
  return {select(outside, select(above, bound, -bound), value),
          select(outside, select(above, Number(1.0), Number(-1.0)), Number())};
}
template <class Isa>
STICTION_INLINE Limited<machine::Batch<Isa>> limit_sum(machine::Batch<Isa> sum, machine::Batch<Isa> bound) {
  return limit(sum, bound);
}
template <class Isa>
STICTION_INLINE machine::Batch<Isa> clamped(machine::Batch<Isa> value, machine::Batch<Isa> bound) {
  const auto low = -bound, below = select(value > bound, bound, value);
  return select(below < low, low, below);
}

// Decisions and a small table in each lane: the law of doubles, lane by lane.
template <class Isa>
struct QuadrantLearning<machine::BatchSignals<Isa>> {
  using Number = machine::Batch<Isa>;
  using Lane = machine::lanes::Learning;
  static constexpr std::size_t lanes = Number::lanes;
  using Tables = std::array<Lane::State, lanes>;  // which have them

  struct Config {
    std::array<Lane::Config, lanes> lane{};
  };
  struct State {
    std::array<Lane::State, lanes> tables{};
    Number missing{};
    machine::BatchMask<Isa> dropped{};
  };

  STICTION_INLINE static State start(const Config& config) {
    State state;
    machine::lanes::start(config.lane.data(), state.tables.data(), lanes);
    return state;
  }
  // `config`, `state`: of all lanes; `dx`: m; `v`: m/s; `a`: m/s^2; the SaturationCounter stays.
  STICTION_INLINE static Number play(const Config& config, State& state, Number dx, Number v, Number a,
                                     SaturationCounter&) {
    double in[3][lanes], out[lanes];
    dx.store(in[0]);
    v.store(in[1]);
    a.store(in[2]);
    machine::lanes::play(config.lane.data(), state.tables.data(), in[0], in[1], in[2], out, lanes);
    return Number::load(out);
  }
  // `config`, `state`: of all lanes; `e`: m; the SaturationCounter stays.
  STICTION_INLINE static void learn(const Config& config, State& state, Number e, SaturationCounter&) {
    double in[lanes], missing[lanes], dropped[lanes];
    e.store(in);
    machine::lanes::learn(config.lane.data(), state.tables.data(), in, missing, dropped, lanes);
    state.missing = Number::load(missing);
    state.dropped = Number::load(dropped) != 0.0;
  }
};

template <class Isa>
struct ReversalPulse<machine::BatchSignals<Isa>> {
  using Number = machine::Batch<Isa>;
  using Lane = machine::lanes::Pulse;
  static constexpr std::size_t lanes = Number::lanes;

  struct Config {
    std::array<Lane::Config, lanes> lane{};
  };
  struct State {
    std::array<Lane::State, lanes> lane{};
  };

  STICTION_INLINE static State start(const Config& config) {
    State state;
    machine::lanes::start(config.lane.data(), state.lane.data(), lanes);
    return state;
  }
  // `config`, `state`: of all lanes; `v`: m/s; `a`: m/s^2; the SaturationCounter stays.
  STICTION_INLINE static Number step(const Config& config, State& state, Number v, Number a, SaturationCounter&) {
    double in[2][lanes], out[lanes];
    v.store(in[0]);
    a.store(in[1]);
    machine::lanes::step(config.lane.data(), state.lane.data(), in[0], in[1], out, lanes);
    return Number::load(out);
  }
};

}  // namespace stiction
