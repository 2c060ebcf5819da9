// Keys of a machine file about a motor and its power stage, for the drive (motor_setup.hpp).
#pragma once

#include <array>
#include <tuple>

#include "firmware/machine/file/parameter_tables.hpp"
#include "firmware/machine/model/motor_setup.hpp"

namespace stiction::machine {

inline constexpr std::array<Choice<CommutationSource>, 4> commutation_sources{{
    {"encoder-zero", CommutationSource::encoder_zero, "the zero of the encoder is that of the motor"},
    {"stored", CommutationSource::stored, "offset, of an absolute encoder"},
    {"test", CommutationSource::test, "a bounded test with current at the first enabling after a start"},
    {"hall", CommutationSource::hall, "three Hall signals"},
}};
inline constexpr std::array<Choice<bool>, 2> commutation_checks{{
    {"test", true, "the bounded test at the first enabling must agree with it"},
    {"none", false, "it is trusted"},
}};

template <>
struct Table<CommutationSetup> : EmptyTable<CommutationSetup> {
  static constexpr std::string_view text = "how the electrical angle of a three-phase motor is known";
  static constexpr std::tuple choices{
      ChoiceParameter<CommutationSetup, CommutationSource>{"method", &CommutationSetup::method, commutation_sources,
                                                           CommutationSource::encoder_zero,
                                                           "where the angle comes from"},
      ChoiceParameter<CommutationSetup, bool>{"check", &CommutationSetup::checked, commutation_checks, true,
                                              "how a stored offset is checked before the axis moves"}};
  static constexpr std::array<Parameter<CommutationSetup>, 6> parameters{{
      {"offset", "rad", any_value(), &CommutationSetup::offset, 0.0,
       "electrical angle at the encoder's zero; of Hall signals where A rises"},
      {"tolerance", "rad", positive(1.0), &CommutationSetup::tolerance, 0.2617993877991,
       "electrical angle by which offset, test, Hall signals and index may differ"},
      {"index_offset",
       "rad",
       any_value(),
       &CommutationSetup::index_offset,
       {},
       "electrical angle at the index mark, which makes the offset exact; left out: the mark is not used"},
      {"test_current",
       "A",
       positive(),
       &CommutationSetup::test_current,
       {},
       "largest current of the test; left out: half of the current limit"},
      {"test_response",
       "m",
       positive(),
       &CommutationSetup::test_response,
       {},
       "amplitude of the vibration with which the test is content; left out: a 4000th of the pole pair pitch, at least "
       "4 increments"},
      {"test_way",
       "m",
       positive(),
       &CommutationSetup::test_way,
       {},
       "largest displacement in the test; left out: a fiftieth of the pole pair pitch, at least 16 times "
       "test_response"},
  }};
};

template <>
struct Table<BrakeTestSetup> : EmptyTable<BrakeTestSetup> {
  static constexpr std::string_view text = "test of the closed brake at each enabling";
  static constexpr std::array<Parameter<BrakeTestSetup>, 3> parameters{{
      {"current", "A", not_negative(), &BrakeTestSetup::current, 0.0, "current that pushes against it; 0: no test"},
      {"way", "m", positive(), &BrakeTestSetup::way, 100e-6, "displacement by which it may yield"},
      {"time",
       "s",
       {1e-3, 10.0},
       &BrakeTestSetup::time,
       0.1,
       "time in which the current comes, is held, and goes, each"},
  }};
};

inline constexpr std::array<Choice<bool>, 2> torque_off_wirings{{
    {"none", false, "it is not wired"},
    {"two-channels", true, "both of its channels are inputs of the drive"},
}};

template <>
struct Table<ProtectionSetup> : EmptyTable<ProtectionSetup> {
  static constexpr std::string_view text = "limits of motor and power stage; a limit that is left out is not watched";
  static constexpr std::tuple choices{ChoiceParameter<ProtectionSetup, bool>{
      "torque_off", &ProtectionSetup::torque_off, torque_off_wirings, false, "safe torque off as an input"}};
  static constexpr std::array<Parameter<ProtectionSetup>, 8> parameters{{
      {"motor_current",
       "A",
       positive(),
       &ProtectionSetup::motor_current,
       {},
       "continuous current of the motor, amplitude, for its thermal model"},
      {"motor_time_constant",
       "s",
       {1e-1, 1e5},
       &ProtectionSetup::motor_time_constant,
       600.0,
       "time constant of the motor's thermal model"},
      {"stage_current",
       "A",
       positive(),
       &ProtectionSetup::stage_current,
       {},
       "continuous current of the power stage, amplitude; at standstill a phase may carry less"},
      {"stage_time_constant",
       "s",
       {1e-1, 1e5},
       &ProtectionSetup::stage_time_constant,
       10.0,
       "time constant of the power stage's thermal model"},
      {"dc_link_high", "V", positive(), &ProtectionSetup::dc_link_high, {}, "DC link above which the power goes"},
      {"dc_link_low", "V", positive(), &ProtectionSetup::dc_link_low, {}, "DC link below which the axis stops"},
      {"motor_temperature",
       "K",
       positive(),
       &ProtectionSetup::motor_temperature,
       {},
       "largest temperature of the motor"},
      {"stage_temperature",
       "K",
       positive(),
       &ProtectionSetup::stage_temperature,
       {},
       "largest temperature of the power stage"},
  }};
};

}  // namespace stiction::machine
