// Effects in a machine file: read, refused with a reason, written.
#include <gtest/gtest.h>

#include <string>

#include "firmware/machine/file/extended_machine.hpp"
#include "firmware/machine/file/reference_page.hpp"
#include "sim/effects/effects.hpp"
#include "sim/machine_file.hpp"
#include "tests/firmware/machine/machine_text.hpp"

namespace stiction::machine::test {
namespace {

// The message of reading the small machine with one effect, whose table begins in line 29.
std::string error_of_effect(const std::string& lines) {
  return error_of(small_machine + "[[axis.B.effect]]\n" + lines);
}

Effect effect(const std::string& name, KeyedValues values) { return {name, std::move(values)}; }

TEST(EffectsFile, IsReadInTheFilesOrderWithUnitsListsAndDefaults) {
  const Machine machine = read_text(small_machine + R"([[axis.B.effect]]
name = "force_ripple"
pitch = "72 mm"
cosine = ["3.1 N", "-500 mN"]
sine = ["0.4 N", "0 N"]
[[axis.B.effect]]
name = "time_skew"
delay = "0.25 ms"
[[axis.B.effect]]
name = "force_ripple"
pitch = "2.5 mm"
cosine = ["1 N"]
sine = ["1 N"]
)");
  const auto& effects = machine.axes[0].effects;
  ASSERT_EQ(effects.size(), 3u);
  EXPECT_EQ(effects[0].name, "force_ripple");
  EXPECT_EQ(effects[0].values.at("pitch"), std::vector{0.072});
  EXPECT_EQ(effects[0].values.at("cosine"), (std::vector{3.1, -0.5}));
  EXPECT_EQ(effects[0].values.at("sine"), (std::vector{0.4, 0.0}));
  EXPECT_EQ(effects[1].values.at("delay"), std::vector{0.25e-3});
  EXPECT_EQ(effects[1].values.at("loop_delay"), std::vector{0.0});
  EXPECT_EQ(effects[2].values.at("pitch"), std::vector{0.0025});
}

TEST(EffectsFile, AFileWithoutEffectsHasNone) { EXPECT_TRUE(read_text(small_machine).axes[0].effects.empty()); }

TEST(EffectsFile, AnUnknownNameListsTheNamesAndTheNearest) {
  const std::string message = error_of_effect("name = \"force_riple\"\n");
  EXPECT_TRUE(
      message.starts_with("FILE:30: axis.B.effect[0].name: found \"force_riple\"; expected an effect: "
                          "\"mass_mismatch\", \"coulomb_mismatch\", "))
      << message;
  EXPECT_NE(message.find("\"backlash\", "), std::string::npos);
  EXPECT_NE(message.find("\"transmission_error\" or \"force_map\"; did you mean \"force_ripple\"?"), std::string::npos);
  EXPECT_TRUE(error_of_effect("width = \"2 um\"\n")
                  .starts_with("FILE:29: axis.B.effect[0].name: found no such key; expected a text"));
  EXPECT_TRUE(error_of_effect("name = 3\n").starts_with("FILE:30: axis.B.effect[0].name: found 3; expected a text"));
}

TEST(EffectsFile, WrongKeysAndValuesNameTheirPlace) {
  EXPECT_EQ(
      error_of_effect("name = \"backlash\"\nwidht = \"2 um\"\n"),
      "FILE:31: axis.B.effect[0].widht: found an unknown key; expected one of name, width, mass_ratio, frequency; did "
      "you mean \"width\"?");
  EXPECT_EQ(
      error_of_effect("name = \"viscous_nonlinear\"\nforce = \"2 N\"\n"),
      "FILE:29: axis.B.effect[0].velocity: found no such key; expected a value greater than 0 m/s (speed at which "
      "63 % of it is reached)");
  EXPECT_EQ(error_of_effect("name = \"backlash\"\nwidth = \"2 N\"\n"),
            "FILE:31: axis.B.effect[0].width: found \"2 N\" (dimension m kg s^-2, not m); expected a value of at least "
            "0 m (play, from contact to contact)");
  EXPECT_EQ(error_of_effect("name = \"backlash\"\nwidth = \"-2 um\"\n"),
            "FILE:31: axis.B.effect[0].width: found \"-2 um\"; expected a value of at least 0 m (play, from contact to "
            "contact)");
  EXPECT_EQ(error_of_effect("name = \"backlash\"\nwidth = [\"2 um\"]\n"),
            "FILE:31: axis.B.effect[0].width: found a list; expected a value of at least 0 m (play, from contact to "
            "contact)");
  EXPECT_EQ(
      error_of_effect("name = \"constant_force\"\nforce = 3\n"),
      "FILE:31: axis.B.effect[0].force: found 3 (no unit); expected a value in N (force on the carriage, positive "
      "in +x)");
  EXPECT_EQ(error_of_effect("name = \"time_skew\"\n"),
            "FILE:29: axis.B.effect[0]: found no key but its name; expected time_skew with its values: delay, "
            "loop_delay");
}

TEST(EffectsFile, ListsAreChecked) {
  const std::string ripple = "name = \"force_ripple\"\npitch = \"1 mm\"\n";
  EXPECT_TRUE(error_of_effect(ripple + "cosine = \"1 N\"\nsine = [\"1 N\"]\n")
                  .starts_with("FILE:32: axis.B.effect[0].cosine: found \"1 N\"; expected a list of values in N"));
  EXPECT_TRUE(error_of_effect(ripple + "cosine = [\"1 N\", \"1 m\"]\nsine = [\"1 N\"]\n")
                  .starts_with("FILE:32: axis.B.effect[0].cosine[1]: found \"1 m\" (dimension m, not m kg s^-2)"));
  EXPECT_EQ(error_of_effect(ripple + "cosine = [\"1 N\", \"1 N\"]\nsine = [\"1 N\"]\n"),
            "FILE:29: axis.B.effect[0]: found force_ripple with a list of 1 as sine; expected a list of 2, as many as "
            "cosine has");
  EXPECT_EQ(error_of(small_machine + "[axis.B.effect]\nname = \"backlash\"\n"),
            "FILE:29: axis.B.effect: found a table; expected tables [[axis.B.effect]]");
}

TEST(EffectsFile, WhatCannotBeTogetherIsRefused) {
  const std::string play = "[[axis.B.effect]]\nname = \"backlash\"\nwidth = \"1 um\"\n";
  EXPECT_EQ(error_of(small_machine + play + play),
            "FILE:32: axis.B.effect[1]: found backlash with it twice on one axis; expected it once");
  // 1e6 N/m over 10 um is half of the 20 N of Coulomb friction.
  EXPECT_EQ(error_of_effect("name = \"presliding_hysteresis\"\nstiffness = \"1e6 N/m\"\ndistance = \"10 um\"\n"),
            "FILE:29: axis.B.effect[0]: found presliding_hysteresis with stiffness times distance of 10 N with a "
            "Coulomb friction of 20 N; expected a product of 0.9 to 1000 times Coulomb friction");
}

// What the plant's shaft refuses is refused where the file is read, with the line.
TEST(EffectsFile, WhatNeedsAShaftOrIsOneIsRefusedWhereTheAxisDoesNotFit) {
  const std::string expected =
      "with an axis without transmission.stiffness; expected one with an elastic shaft between motor and load";
  EXPECT_EQ(error_of_effect("name = \"transmission_error\"\nper = 1\norder = 1\ncosine = \"1 um\"\nsine = \"1 um\"\n"),
            "FILE:29: axis.B.effect[0]: found transmission_error " + expected);
  EXPECT_EQ(error_of_effect("name = \"shaft_stiffness\"\nstiffness = \"1e7 N/m\"\n"),
            "FILE:29: axis.B.effect[0]: found shaft_stiffness " + expected);
}

// Beside a shaft the mode is a part of the load that hangs on the rest of it.
TEST(EffectsFile, ASecondModeBesideAShaftIsBehindTheLoad) {
  const auto stand = shipped_machine().parent_path() / "cam-stand.toml";
  const auto with_mode = [&](double motor_measured) {
    const std::vector<AxisEffects> mode{{"L",
                                         {effect("structural_resonance", {{"frequency", {60.0}},
                                                                          {"damping_ratio", {0.1}},
                                                                          {"mass_ratio", {0.5}},
                                                                          {"motor_measured", {motor_measured}}})}}};
    return sim::parse_machine("e.toml", sim::extended_machine(stand, {}, mode, {}));
  };
  EXPECT_EQ(with_mode(1.0).axes[0].effects.size(), 1u);
  try {
    with_mode(0.0);
    FAIL() << "accepted";
  } catch (const MachineFileError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("found structural_resonance with motor_measured = 0 on an axis with "
                        "transmission.stiffness; expected motor_measured = 1"),
              std::string::npos)
        << error.what();
  }
}

TEST(EffectsFile, TheReferencePageShowsEveryKey) {
  const std::string page = sim::reference_page();
  for (const sim::EffectId kind : sim::all_effects()) {
    const std::size_t at = page.find("effect " + kind.name() + ": ");
    ASSERT_NE(at, std::string::npos) << kind.name();
    const std::string section = page.substr(at, page.find("\n## ", at) - at);
    for (const ValueKey& key : kind->keys)
      EXPECT_NE(section.find("| `" + std::string(key.key) + "` | "), std::string::npos) << kind.name() << key.key;
  }
}

TEST(Effects, HaveTheNamesKeysAndSuffixesOfTheVocabulary) {
  std::string all;
  for (const sim::EffectId kind : sim::all_effects()) {
    all += kind.name() + ":";
    for (const ValueKey& key : kind->keys)
      all += " " + std::string(key.key) + sim::unit_suffix(key.unit) + (key.list ? "[]" : "");
    all += '\n';
  }
  EXPECT_EQ(all,
            "mass_mismatch: mass_kg\n"
            "coulomb_mismatch: coulomb_N\n"
            "viscous_mismatch: viscous_N_s_per_m\n"
            "viscous_nonlinear: force_N velocity_m_per_s\n"
            "stribeck: break_away_N velocity_m_per_s\n"
            "friction_asymmetry: coulomb_N viscous_N_s_per_m\n"
            "presliding_hysteresis: stiffness_N_per_m distance_m share\n"
            "friction_lag: time_s\n"
            "position_dependent_friction: position_m[] force_N[]\n"
            "thermal_drift: change_N time_constant_s elapsed_s\n"
            "load_dependent_friction: coefficient\n"
            "constant_force: force_N\n"
            "position_spring: stiffness_N_per_m neutral_m\n"
            "force_ripple: pitch_m cosine_N[] sine_N[]\n"
            "force_constant_ripple: pitch_m cosine[] sine[]\n"
            "force_constant_mismatch: force_constant_N_per_A\n"
            "force_saturation: current_A\n"
            "backlash: width_m mass_ratio frequency_Hz\n"
            "structural_resonance: frequency_Hz damping_ratio mass_ratio motor_measured\n"
            "encoder_subdivision_error: period_m cosine_m[] sine_m[]\n"
            "time_skew: delay_s loop_delay_s\n"
            "cross_axis_coupling: mass_kg\n"
            "periodic_disturbance: frequency_Hz cosine_N sine_N\n"
            "controller_gain_mismatch: position_gain_per_s velocity_gain_A_s_per_m velocity_integral_time_s "
            "current_gain_V_per_A current_integral_time_s\n"
            "master_delay: delay_s\n"
            "shaft_stiffness: stiffness_N_per_m\n"
            "transmission_error: per order cosine_m sine_m\n"
            "force_map: position_m[] velocity_m_per_s[] force_N[]\n");
  EXPECT_EQ(sim::unit_suffix("1"), "");
  EXPECT_EQ(sim::unit_suffix("1/s"), "_per_s");
  EXPECT_EQ(sim::unit_suffix("m/s^2"), "_m_per_s2");
}

TEST(Effects, ConfuseBothWaysAndNameAnExperiment) {
  for (const sim::EffectId kind : sim::all_effects())
    for (const sim::Confusion& confusion : sim::confusions_of(kind)) {
      EXPECT_NE(confusion.other, kind);
      EXPECT_FALSE(confusion.separate_by.empty());
      const auto back = sim::confusions_of(confusion.other);
      EXPECT_TRUE(std::any_of(back.begin(), back.end(), [&](const sim::Confusion& each) { return each.other == kind; }))
          << kind.name() << " " << confusion.other.name();
    }
  EXPECT_EQ(sim::confusions_of(*sim::find_effect("constant_force")).at(0).other,
            *sim::find_effect("friction_asymmetry"));
  EXPECT_FALSE(sim::find_effect("gravity"));
}

const std::vector<AxisEffects> additions{
    {"B",
     {effect("force_ripple", {{"pitch", {0.072}}, {"cosine", {3.125}}, {"sine", {-0.5}}}),
      effect("friction_asymmetry", {{"coulomb", {1.5}}}), effect("backlash", {{"width", {2.5e-6}}})}}};

void expect_additions(const std::vector<Effect>& effects) {
  ASSERT_EQ(effects.size(), 3u);
  EXPECT_EQ(effects[0].values, additions[0].effects[0].values);
  EXPECT_EQ(effects[1].values.at("coulomb"), std::vector{1.5});
  EXPECT_EQ(effects[1].values.at("viscous"), std::vector{0.0});
  EXPECT_EQ(effects[2].values.at("width"), std::vector{2.5e-6});
  EXPECT_EQ(effects[2].values.at("mass_ratio"), std::vector{0.0});
}

TEST(ExtendedMachine, KeepsTheTextAndReadsBackWithTheEffects) {
  const std::string text = small_machine + "# what a user wrote";
  const MachineFileOnDisk file(text);
  const std::vector<std::string> comment{"extended"};
  const std::string extended = sim::extended_machine(file.path(), {}, additions, comment);
  EXPECT_TRUE(extended.starts_with("# extended\n" + text + "\n")) << extended;
  expect_additions(sim::parse_machine("extended.toml", extended).axes[0].effects);
}

TEST(ExtendedMachine, ContinuesTheEffectsOfTheFileWhicheverWayTheyAreWritten) {
  for (const std::string before : {"[[axis.B.effect]]\nname = \"constant_force\"\nforce = \"1 N\"\n",
                                   "[axis.B]\neffect = [{ name = \"constant_force\", force = \"1 N\" }]\n"}) {
    const bool in_one_line = before.starts_with("[axis");
    const std::string text = in_one_line ? replaced(small_machine, "[axis.B]\n", before) : small_machine + before;
    const MachineFileOnDisk file(text);
    const Machine machine = sim::parse_machine("e.toml", sim::extended_machine(file.path(), {}, additions, {}));
    ASSERT_EQ(machine.axes[0].effects.size(), 4u);
    EXPECT_EQ(machine.axes[0].effects[0].values.at("force"), std::vector{1.0});
    expect_additions({machine.axes[0].effects.begin() + 1, machine.axes[0].effects.end()});
  }
}

TEST(ExtendedMachine, ReplacesWhatAnAxisHasOnlyOnceAndTakesAssignments) {
  const MachineFileOnDisk file(small_machine + "[[axis.B.effect]]\nname = \"backlash\"\nwidth = \"9 um\"\n");
  expect_additions(sim::parse_machine("e.toml", sim::extended_machine(file.path(), {}, additions, {})).axes[0].effects);
  const std::vector<std::string> set{"axis.B.mass=100 kg"};
  const Machine machine = sim::parse_machine("e.toml", sim::extended_machine(file.path(), set, additions, {}));
  EXPECT_EQ(machine.axes[0].mass, 100.0);
  expect_additions(machine.axes[0].effects);
}

TEST(ExtendedMachine, AddingNothingLeavesTheText) {
  const MachineFileOnDisk file(small_machine);
  EXPECT_EQ(sim::extended_machine(file.path(), {}, {}, {}), small_machine);
}

TEST(ExtendedMachine, RefusesUnknownAxesAndEffects) {
  const MachineFileOnDisk file(small_machine);
  const std::vector<AxisEffects> elsewhere{{"Q", {effect("backlash", {{"width", {1e-6}}})}}};
  EXPECT_THROW(sim::extended_machine(file.path(), {}, elsewhere, {}), MachineFileError);
  const std::vector<AxisEffects> unknown{{"B", {effect("gravity", {{"force", {1.0}}})}}};
  EXPECT_THROW(sim::extended_machine(file.path(), {}, unknown, {}), sim::EffectError);
  const std::vector<AxisEffects> negative{{"B", {effect("backlash", {{"width", {-1e-6}}})}}};
  EXPECT_THROW(sim::extended_machine(file.path(), {}, negative, {}), sim::EffectError);
  const std::vector<AxisEffects> missing{{"B", {effect("backlash", {})}}};
  EXPECT_THROW(sim::extended_machine(file.path(), {}, missing, {}), sim::EffectError);
  const std::vector<AxisEffects> two{{"B", {effect("backlash", {{"width", {1e-6, 2e-6}}})}}};
  EXPECT_THROW(sim::extended_machine(file.path(), {}, two, {}), sim::EffectError);
  const std::vector<AxisEffects> stranger{{"B", {effect("backlash", {{"width", {1e-6}}, {"force", {1.0}}})}}};
  EXPECT_THROW(sim::extended_machine(file.path(), {}, stranger, {}), sim::EffectError);
}

TEST(ExtendedMachine, WritesOnlyTheOptionalKeysThatAreGivenAndVoltsForAForceSource) {
  const std::string text = sim::effect_table("X", effect("controller_gain_mismatch", {{"velocity_gain", {3.0}}}), true);
  EXPECT_NE(text.find("velocity_gain = \"3 V s/m\""), std::string::npos) << text;
  EXPECT_EQ(text.find("position_gain"), std::string::npos) << text;
}

TEST(ExtendedMachine, TheShippedMachinesTakeEveryEffectButThoseOfAShaft) {
  for (const sim::EffectId kind : sim::all_effects()) {
    Effect one{kind.name(), {}};
    for (const ValueKey& key : kind->keys)
      one.values[std::string(key.key)] = {key.unit == "N/m" ? 1e7 : key.key == "share" ? 0.5 : 1e-3};
    const std::vector<AxisEffects> every{{"X", {one}}, {"Y", {one}}};
    if (kind.name() == "shaft_stiffness" || kind.name() == "transmission_error") {
      // The motors of this table move their axes directly.
      EXPECT_THROW(sim::parse_machine("e.toml", sim::extended_machine(shipped_machine(), {}, every, {})),
                   MachineFileError);
      continue;
    }
    const Machine machine = sim::parse_machine("e.toml", sim::extended_machine(shipped_machine(), {}, every, {}));
    for (const AxisModel& axis : machine.axes) EXPECT_EQ(axis.effects.at(0).values, one.values) << kind.name();
  }
}

// The shipped table has experiments on a bench with 400 N of Coulomb friction, beside which this contact cannot be.
TEST(ExtendedMachine, AnEffectNeedNotFitTheMachineOfAnExperimentThatDoesNotRun) {
  const std::vector<AxisEffects> contact{
      {"X", {effect("presliding_hysteresis", {{"stiffness", {7e5}}, {"distance", {300e-6}}})}}};
  const auto text = sim::extended_machine(shipped_machine(), {}, contact, {});
  EXPECT_EQ(sim::parse_machine("e.toml", text).axes[0].effects.size(), 1u);
  EXPECT_THROW(sim::parse_machine("e.toml", text, {"presliding", {}}), MachineFileError);
}

}  // namespace
}  // namespace stiction::machine::test
