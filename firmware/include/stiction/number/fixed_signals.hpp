// The firmware's signal types: which quantity has which fixed-point format, and the integer operations that depend on
// it. The control laws are written over such a policy; the same laws in double precision use another one, which lives
// with the simulation so that no floating point enters these headers.
#pragma once

#include <bit>
#include <cstdint>

#include "stiction/number/fixed.hpp"
#include "stiction/number/octave.hpp"
#include "stiction/number/reciprocal.hpp"
#include "stiction/number/trigonometry.hpp"

namespace stiction {

struct FixedSignals {
  static constexpr const char* name = "fixed";
  template <class T>
  using Each = T;  // of this one axis

  // Signals. Range and resolution in SI units.
  using Position = Wide<40, std::uint64_t{1} << 61>;  // +-2097 km, 0.9 pm
  using Distance = Fixed<32>;                         // +-0.5 m, 0.23 nm: position errors
  using Step = Fixed<40>;                             // +-1.95 mm, 0.9 pm: motion between two samples
  using Velocity = Fixed<28>;                         // +-8 m/s, 3.7 nm/s
  using Acceleration = Fixed<22>;                     // +-512 m/s^2, 0.24 um/s^2
  using Current = Fixed<20>;                          // +-2048 A, 0.95 uA
  using Voltage = Fixed<18>;                          // +-8192 V, 3.8 uV
  using Count = Fixed<0>;                             // whole increments
  using Angle = Turn;
  using Sine = stiction::Sine;
  using Rate = stiction::Rate;               // 1/s
  using Ticks = Fixed<28>;                   // of the fast period, below 8
  using TickFraction = Coefficient<28, 28>;  // 0 .. 1
  using Seconds = Fixed<36>;                 // below 31 ms

  // Gains.
  using PositionGain = Coefficient<20>;                       // +-1024 1/s
  using VelocityWeight = Coefficient<24>;                     // +-64
  using IncrementInverse = Coefficient<0>;                    // 1/m, increments from 1 nm
  using Increment = Coefficient<44>;                          // below 61 um
  using VelocityGain = Coefficient<16>;                       // A s/m, +-16384
  using VelocityIntegralGain = Coefficient<16>;               // A s/m per tick
  using VelocityIntegral = Wide<44, std::uint64_t{1} << 62>;  // +-262144 A
  using VelocityTracking = Coefficient<24>;                   // of the excess per tick, +-64
  using CurrentGain = Coefficient<18>;                        // V/A, +-4096
  using CurrentIntegralGain = Coefficient<18>;                // V/A per tick
  using CurrentIntegral = Wide<38, std::uint64_t{1} << 62>;   // V
  using CurrentTracking = Coefficient<20>;                    // of the excess per tick
  using AccelerationGain = Coefficient<24>;                   // A s^2/m, +-64
  using CurrentSum = Fixed<19>;                               // +-4096 A, of three phases
  using FilterCoefficient = Coefficient<28, 29>;              // +-2
  using FilterResidue = Fixed<48>;                            // of half a bit of current
  using PitchInverse = Coefficient<20>;                       // 1/m, pitches from 1 mm
  using ContactStiffness = Coefficient<3, 28>;                // A/m, +-3.3e7: eight of them share a sum
  using ContactSum = Wide<43, std::uint64_t{1} << 62>;        // A
  using ContactDamping = Coefficient<20>;                     // ticks, below 1024
  using PulseSlope = Coefficient<24>;                         // s, of a speed over acceleration, +-64

  // Time.
  static constexpr Rate rate(std::int64_t interval_ns) { return rate_of_interval(interval_ns); }
  // `inverse_period` is 2^45 / period in ns; results beyond the format are clamped.
  using PeriodInverse = Coefficient<45>;
  static constexpr Ticks ticks(std::int64_t duration_ns, PeriodInverse inverse_period) {
    SaturationCounter none;
    return narrow<Ticks>(Fixed<0>::from_raw(clamp_to_word(duration_ns)) * inverse_period, none);
  }
  struct Split {
    int whole;
    TickFraction fraction;
  };
  // Whole ticks, 0 .. highest, and the fraction beyond them; delays outside 0 .. highest + 1 read the ends.
  static constexpr Split split(Ticks delay, int highest) {
    const std::int32_t one = std::int32_t{1} << TickFraction::fraction_bits;
    const std::int32_t bounded = delay.raw() < 0 ? 0 : delay.raw();
    int whole = bounded >> TickFraction::fraction_bits;
    whole = whole > highest ? highest : whole;
    const std::int32_t rest = bounded - whole * one;
    return {whole, TickFraction::from_bounded_raw(rest > one ? one : rest)};
  }
  static constexpr Seconds seconds(std::int64_t duration_ns) {
    constexpr auto per_ns = Coefficient<50>::from_raw(1125900);  // 1e-9 s
    SaturationCounter none;
    return narrow<Seconds>(Fixed<0>::from_raw(clamp_to_word(duration_ns)) * per_ns, none);
  }

  // 1 - fraction.
  static constexpr TickFraction complement(TickFraction fraction) {
    return TickFraction::from_bounded_raw((std::int32_t{1} << TickFraction::fraction_bits) - fraction.raw());
  }

  // Place of a speed, not negative, in a table over speed: two nodes an octave from 0.24 mm/s on.
  static constexpr int lowest_speed_bit = 16;
  static constexpr std::size_t speed_nodes = octave_nodes<lowest_speed_bit>;
  struct Place {
    std::size_t node;
    TickFraction fraction;
  };
  static constexpr Place speed_place(Velocity speed) {
    return place(octave_place<lowest_speed_bit>(static_cast<std::uint32_t>(speed.raw())));
  }

  // A step held within half of the format, and the sum of such a one and a deflection within that half, which no sum
  // leaves: eight elements add without a test.
  static constexpr Step bounded_step(Step dx) {
    constexpr std::int32_t most = (std::int32_t{1} << 30) - 1;
    const std::int32_t below = dx.raw() > most ? most : dx.raw();
    return Step::from_raw(below < -most ? -most : below);
  }
  static constexpr Step add_steps(Step deflection, Step dx) { return Step::from_raw(deflection.raw() + dx.raw()); }

  // The way since a reversal, which stays at the format's end, 1.95 mm; its place in a table with two nodes an octave
  // from 0.95 um on; and how much of what was before the reversal is left: 1 at the reversal, 0 from 30.5 um on.
  static constexpr int lowest_travel_bit = 20;
  static constexpr std::size_t travel_nodes = octave_nodes<lowest_travel_bit> - 1;
  static constexpr Step add_travel(Step travel, Step dx) {
    SaturationCounter meant;
    return saturated_sum(travel, dx < Step{} ? opposite(dx) : dx, meant);
  }
  static constexpr bool far_travelled(Step travel) { return travel.raw() == INT32_MAX; }
  static constexpr Place travel_place(Step travel) {
    return place(octave_place<lowest_travel_bit>(static_cast<std::uint32_t>(travel.raw())));
  }
  static constexpr TickFraction blend(Step travel) {
    constexpr std::int32_t end = std::int32_t{1} << 25;
    return TickFraction::from_bounded_raw(travel.raw() < end ? (end - travel.raw()) << 3 : 0);
  }

  // Octave of an acceleration's magnitude from 2^-6 m/s^2 on, 0 .. highest.
  static constexpr int acceleration_octave(Acceleration a, int highest) {
    const auto magnitude = static_cast<std::uint32_t>(a < Acceleration{} ? opposite(a).raw() : a.raw());
    const int octave = 31 - std::countl_zero(magnitude | 1u) - (Acceleration::fraction_bits - 6);
    return octave < 0 ? 0 : (octave > highest ? highest : octave);
  }
  // value > 5/4 reference + tolerance
  static constexpr bool has_grown(Distance value, Distance reference, Distance tolerance) {
    return value.raw() - tolerance.raw() > reference.raw() + (reference.raw() >> 2);
  }

  // What rounding `exact` to `rounded` left. The lower word holds it, as it is below half a bit of the output; where
  // the output saturated there is no remainder worth keeping, and the word bounds what stands in its place.
  template <class Exact>
  static constexpr FilterResidue filter_residue(Exact exact, Current rounded) {
    static_assert(Exact::fraction_bits == FilterResidue::fraction_bits);
    constexpr int shift = Exact::fraction_bits - Current::fraction_bits;
    return FilterResidue::from_raw(static_cast<std::int32_t>(static_cast<std::uint32_t>(exact.raw()) -
                                                             (static_cast<std::uint32_t>(rounded.raw()) << shift)));
  }

  // Electrical angle of a position; whole turns wrap away in unsigned arithmetic.
  static constexpr Angle angle(Position position, PitchInverse inverse_pitch) {
    const auto coarse = static_cast<std::uint64_t>(position.raw() >> 8);  // 32 fraction bits, 0.23 nm
    return Turn{
        static_cast<std::uint32_t>((coarse * static_cast<std::uint64_t>(std::int64_t{inverse_pitch.raw()})) >> 20)};
  }
  static constexpr Angle turned(Angle angle, Turn by) { return Turn{angle.raw + by.raw}; }
  static constexpr Sine sine(Angle angle) { return stiction::sine(angle); }
  static constexpr Angle third_of_turn_after(Angle angle) { return Turn{angle.raw + 0x55555555u}; }
  static constexpr Coefficient<30> two_thirds() { return Coefficient<30>::from_raw(715827883); }

 private:
  static constexpr Place place(OctavePlace found) {
    static_assert(TickFraction::fraction_bits == octave_fraction_bits);
    return {static_cast<std::size_t>(found.node), TickFraction::from_bounded_raw(found.fraction)};
  }
  static constexpr std::int32_t clamp_to_word(std::int64_t value) {
    const auto word = static_cast<std::int32_t>(value);
    if (word == value) [[likely]]
      return word;
    return value < 0 ? INT32_MIN : INT32_MAX;
  }
};

}  // namespace stiction
