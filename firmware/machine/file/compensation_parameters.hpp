// The keys of [axis.NAME.friction_compensation].
#pragma once

#include <array>
#include <tuple>

#include "firmware/machine/file/parameter_tables.hpp"
#include "firmware/machine/model/machine.hpp"

namespace stiction::machine {

inline constexpr std::array<Choice<CompensationKind>, 4> compensation_kinds{{
    {"off", CompensationKind::off, "none; set-points are delayed if a different axis has one"},
    {"pulse", CompensationKind::pulse, "speed pulse at reversals"},
    {"friction", CompensationKind::friction, "current from presliding and sliding curve"},
    {"learning", CompensationKind::learning, "the same, and a current learned from the errors of earlier laps"},
}};

template <>
struct Table<PulseCompensationParameters> : EmptyTable<PulseCompensationParameters> {
  static constexpr std::string_view text = "speed pulse at reversals, its amplitude over the acceleration there";
  static constexpr std::array<Parameter<PulseCompensationParameters>, 7> parameters{{
      {"amplitude",
       "m/s",
       not_negative(),
       &PulseCompensationParameters::amplitude,
       {},
       "amplitude from rise_until to flat_until"},
      {"final_amplitude", "m/s", not_negative(), &PulseCompensationParameters::final_amplitude, 0.0,
       "amplitude from fall_until on; at most amplitude"},
      {"rise_until",
       "m/s^2",
       positive(),
       &PulseCompensationParameters::rise_until,
       {},
       "a1: up to it the amplitude rises from 0"},
      {"flat_until",
       "m/s^2",
       positive(),
       &PulseCompensationParameters::flat_until,
       {},
       "a2: from it on the amplitude falls"},
      {"fall_until",
       "m/s^2",
       positive(),
       &PulseCompensationParameters::fall_until,
       {},
       "a3: up to it the amplitude falls"},
      {"delay", "s", not_negative(), &PulseCompensationParameters::delay, 0.0,
       "from the reversal of the newest set-point to the pulse"},
      {"duration", "s", positive(10.0), &PulseCompensationParameters::duration, {}, "length of the pulse"},
  }};
};

template <>
struct Table<FrictionFeedforwardParameters> : EmptyTable<FrictionFeedforwardParameters> {
  static constexpr std::string_view text = "current against friction, by distance and by speed";
  static constexpr std::array<Parameter<FrictionFeedforwardParameters>, 7> parameters{{
      {"look_ahead",
       "s",
       not_negative(0.1),
       &FrictionFeedforwardParameters::look_ahead,
       {},
       "time by which the current comes before the set-point; at most timing.set_point_delay"},
      {"distance",
       "m",
       positive(1.9e-3),
       &FrictionFeedforwardParameters::distance,
       {},
       "displacement after a reversal at which each presliding element slips again, increasing; at most 8"},
      {"level",
       "A",
       not_negative(),
       &FrictionFeedforwardParameters::level,
       {},
       "current of each element; their sum is the Coulomb level",
       "V"},
      {"contact_damping", "s", not_negative(0.05), &FrictionFeedforwardParameters::contact_damping, 0.0,
       "weight of the rate of the presliding current, as a time"},
      {"speed",
       "m/s",
       positive(),
       &FrictionFeedforwardParameters::speed,
       {},
       "speeds of the sliding curve, increasing"},
      {"forward",
       "A",
       any_value(),
       &FrictionFeedforwardParameters::forward,
       {},
       "current beyond the Coulomb level at each speed, in the positive direction",
       "V"},
      {"backward",
       "A",
       any_value(),
       &FrictionFeedforwardParameters::backward,
       {},
       "the same in the negative direction",
       "V"},
  }};
};

template <>
struct Table<QuadrantLearningParameters> : EmptyTable<QuadrantLearningParameters> {
  static constexpr std::string_view text = "learning from the errors of earlier laps";
  static constexpr std::array<Parameter<QuadrantLearningParameters>, 7> parameters{{
      {"gain",
       "1",
       {0.0, 1.0},
       &QuadrantLearningParameters::gain,
       0.6,
       "share of the missing current that is learned in a lap"},
      {"forgetting",
       "1",
       {0.0, 1.0},
       &QuadrantLearningParameters::forgetting,
       0.02,
       "share that is forgotten in a lap"},
      {"smoothing",
       "1",
       {0.0, 0.33},
       &QuadrantLearningParameters::smoothing,
       0.2,
       "share that is taken from each neighbour"},
      {"limit",
       "A",
       not_negative(),
       &QuadrantLearningParameters::limit,
       {},
       "largest current that can be learned",
       "V"},
      {"dead_zone", "m", not_negative(1e-5), &QuadrantLearningParameters::dead_zone, 0.1e-6,
       "error from which nothing is learned"},
      {"filter",
       "s",
       {1e-4, 0.01},
       &QuadrantLearningParameters::filter,
       1e-3,
       "time constant of the lowpass for the missing current"},
      {"lead",
       "s",
       not_negative(0.012),
       &QuadrantLearningParameters::lead,
       {},
       "time from a force to its error; left out: mass / (velocity gain * force constant) - filter"},
  }};
};

template <>
struct Table<LearnedTable> : EmptyTable<LearnedTable> {
  static constexpr std::string_view text = "table that the drive has learned on this machine";
  static constexpr std::array<TextParameter<LearnedTable>, 2> texts{{
      {"machine", &LearnedTable::machine, "name of the machine that learned it"},
      {"axis", &LearnedTable::axis, "name of its axis"},
  }};
  static constexpr std::array<Parameter<LearnedTable>, 2> parameters{{
      {"forward",
       "A",
       any_value(),
       &LearnedTable::forward,
       {},
       "current after a reversal into the positive direction, 23 values at 0, 0.95 um and then twice an octave",
       "V"},
      {"backward", "A", any_value(), &LearnedTable::backward, {}, "the same into the negative direction", "V"},
  }};
};

template <>
struct Table<FrictionCompensationParameters> : EmptyTable<FrictionCompensationParameters> {
  static constexpr std::string_view text = "compensation of friction in the drive";
  static constexpr std::tuple choices{ChoiceParameter<FrictionCompensationParameters, CompensationKind>{
      "use", &FrictionCompensationParameters::use, compensation_kinds, CompensationKind::off,
      "the compensation that acts"}};
  static constexpr std::tuple subtables{
      Subtable<FrictionCompensationParameters, std::optional<PulseCompensationParameters>>{
          "pulse", &FrictionCompensationParameters::pulse, Presence::optional},
      Subtable<FrictionCompensationParameters, std::optional<FrictionFeedforwardParameters>>{
          "friction", &FrictionCompensationParameters::friction, Presence::optional},
      Subtable<FrictionCompensationParameters, std::optional<QuadrantLearningParameters>>{
          "learning", &FrictionCompensationParameters::learning, Presence::optional},
      Subtable<FrictionCompensationParameters, std::optional<LearnedTable>>{
          "learned", &FrictionCompensationParameters::learned, Presence::optional},
  };
};

}  // namespace stiction::machine
