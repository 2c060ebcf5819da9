// A machine file from a log: what the log tells is in it and marked, what it does not tell is not, and a sheet that
// says otherwise keeps its value.
#include "host/sheet/log_facts.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "host/sheet/machine_text.hpp"
#include "sim/machine_file.hpp"
#include "tests/support/moved_axis.hpp"

namespace stiction::host {
namespace {

using test::moved;
using test::MovedAxis;

struct Made {
  SheetAnswers answers;
  LogFacts facts;
  MarkedSheet marked;
  std::string text;
  machine::AxisModel axis;
};

// As the command does it, without a terminal: `given` by flags.
Made made_from(const std::vector<Log>& logs, const SheetAnswers& given) {
  Made made;
  made.facts = facts_of(logs, "");
  for (const auto& question : sheet_questions()) {
    const std::string name(question.name);
    if (!question.wanted(made.answers) || name == "load" || name == "coulomb" || name == "viscous") continue;
    if (given.contains(name))
      made.answers[name] = given.at(name);
    else
      take_from_logs(made.facts, question, made.answers);
  }
  auto known = made.answers;
  if (given.contains("load")) known["load"] = given.at("load");
  identify_facts(made.facts, known, logs);
  for (const auto& question : sheet_questions()) {
    const std::string name(question.name);
    if (name != "load" && name != "coulomb" && name != "viscous") continue;
    if (given.contains(name))
      made.answers[name] = given.at(name);
    else
      take_from_logs(made.facts, question, made.answers);
  }
  made.marked = marks_of(made.facts, made.answers, given);
  made.text = machine_text(made.answers, "a test", made.marked.marks);
  made.axis = sim::parse_machine("made.toml", made.text).axes.at(0);
  return made;
}

const SheetAnswers source_of_volts{{"motor", "force"}, {"force-constant", "35 N/V"}};

void expect_mark(const Made& made, const std::string& text) {
  EXPECT_NE(made.text.find(text), std::string::npos) << "no \"" << text << "\" in\n" << made.text;
}

TEST(LogFacts, AForceConstantIsAllThatALogNeeds) {
  const auto made = made_from({moved({.constant = 4.0, .volts = true})}, source_of_volts);
  EXPECT_FALSE(made.axis.coordinate.rotary());
  EXPECT_NEAR(made.axis.mass, 80.0, 0.01 * 80.0);
  const auto& friction = made.axis.friction.models.at("coulomb_viscous");
  EXPECT_NEAR(friction.at("coulomb")[0], 20.0, 0.02 * 20.0);
  EXPECT_NEAR(friction.at("viscous")[0], 150.0, 0.03 * 150.0);
  EXPECT_NEAR(made.axis.encoder.increment, 1e-6, 1e-12);
  EXPECT_NEAR(made.axis.max_velocity, 0.2, 1e-3);
  ASSERT_EQ(made.axis.effects.size(), 1u);
  EXPECT_NEAR(made.axis.effects[0].values.at("force")[0], -4.0, 0.2) << "the motor pushes with 4 N against it";
  EXPECT_FALSE(made.axis.cascaded());
  for (const char* mark : {"from the log moved.csv: 95 % from", "the smallest step of x", "not proven to be the",
                           "its stroke; the axis may have more", "its largest; the axis may be faster"})
    expect_mark(made, mark);
  EXPECT_TRUE(made.marked.contradictions.empty());
}

// The file is a fixed point: identified again with it the log says the same.
TEST(LogFacts, TheIntervalsHoldWhatTheAxisIs) {
  const auto made = made_from({moved({.volts = true})}, source_of_volts);
  for (const auto& [question, truth] : {std::pair{"load", 80.0}, {"coulomb", 20.0}, {"viscous", 150.0}}) {
    const auto& fact = made.facts.facts.at(question);
    EXPECT_LE(fact.low, truth + 0.01 * truth) << question;
    EXPECT_GE(fact.high, truth - 0.01 * truth) << question;
    EXPECT_LT(fact.low, fact.value);
    EXPECT_GT(fact.high, fact.value);
  }
}

TEST(LogFacts, AWeightThatTurnsIsGravity) {
  const MovedAxis joint{.rotary = true,
                        .mass = 5e-3,
                        .coulomb = 0.02,
                        .viscous = 0.01,
                        .moment = 0.4,
                        .per_unit = 0.1,
                        .increment = 2.0 * std::numbers::pi / 4096.0,
                        .speeds = {0.5, 1.0, 2.0, 4.0},
                        .stroke = 1.5,
                        .acceleration = 60.0,
                        .volts = true};
  const auto made = made_from({moved(joint)}, {{"motor", "force"}, {"torque-constant", "0.1 N m/V"}});
  ASSERT_TRUE(made.axis.coordinate.rotary());
  ASSERT_TRUE(made.axis.gravity.has_value());
  EXPECT_NEAR(made.axis.coordinate.own("N").from_linear(made.axis.gravity->force), 0.4, 0.02);
  EXPECT_NEAR(made.axis.coordinate.own("kg").from_linear(made.axis.mass), 5e-3, 0.05 * 5e-3);
  EXPECT_EQ(made.axis.encoder.counts, 4096.0);
  EXPECT_TRUE(made.axis.effects.empty());
}

TEST(LogFacts, WhatContradictsIsNamedAndTheSheetStays) {
  auto given = source_of_volts;
  given["load"] = "100 kg";
  given["coulomb"] = "20 N";
  given["travel"] = "50 mm";
  given["increment"] = "10 um";
  given["max-velocity"] = "1 m/s";
  const auto made = made_from({moved({.volts = true})}, given);
  EXPECT_NEAR(made.axis.mass, 100.0, 1e-9);
  EXPECT_NEAR(made.axis.travel, 0.05, 1e-12);
  EXPECT_NEAR(made.axis.encoder.increment, 1e-5, 1e-12);
  ASSERT_EQ(made.marked.contradictions.size(), 3u);
  EXPECT_TRUE(made.marked.contradictions[0].starts_with("mass of the load"));
  EXPECT_NE(made.marked.contradictions[0].find("the sheet's 100 kg and the 79."), std::string::npos)
      << made.marked.contradictions[0];
  expect_mark(made, "CONTRADICTION: travel from end to end: the sheet's 50 mm");
  expect_mark(made, "In addition to the sheet's value: 0.2 m/s from the log moved.csv");
}

TEST(LogFacts, WhatTheMotionDoesNotTellIsLeftOpenWithTheRecordThatWould) {
  // One slow speed: neither the mass nor the viscous friction makes a force that is seen.
  const auto made = made_from({moved({.speeds = {0.02}, .stroke = 0.1, .acceleration = 0.02, .volts = true})},
                              {{"motor", "force"}, {"force-constant", "35 N/V"}, {"load", "80 kg"}});
  EXPECT_FALSE(made.facts.facts.contains("load"));
  EXPECT_NE(made.facts.open.at("load").find("record"), std::string::npos) << made.facts.open.at("load");
  expect_mark(made, "Not determined by the log moved.csv");
  EXPECT_EQ(made.axis.mass, 80.0);
}

TEST(LogFacts, AmperesAreThoseOfTheLog) {
  const auto made =
      made_from({moved({})}, {{"motor", "force"}, {"force-constant", "49.497474683 N/A"}, {"amperes", "rms"}});
  EXPECT_NEAR(made.axis.motor.force_constant, 35.0, 1e-6);
  EXPECT_NEAR(made.axis.mass, 80.0, 0.8);
  try {
    made_from({moved({})}, source_of_volts);
    FAIL() << "volts without a voltage";
  } catch (const LogError& error) {
    EXPECT_NE(std::string(error.what()).find("found the current i alone and a motor's constant per volt; expected"),
              std::string::npos)
        << error.what();
  }
}

TEST(LogFacts, BehindATransmissionTheLoadIsWhatTheMotorIsNot) {
  // 10 mm a turn: 3.49e-4 kg m^2 of the motor are 137.8 kg.
  const double radians = 2.0 * std::numbers::pi / 10e-3, motor = 3.49e-4 * radians * radians;
  const auto made = made_from({moved({.mass = 80.0 + motor, .per_unit = 1.0 * radians, .increment = 10e-3 / 65536.0})},
                              {{"motor", "force"},
                               {"transmission", "screw"},
                               {"lead", "10 mm"},
                               {"motor-inertia", "3.49 kg cm^2"},
                               {"torque-constant", "1 N m/A"}});
  EXPECT_NEAR(made.axis.load_mass, 80.0, 2.0);
  EXPECT_NEAR(made.axis.mass, 80.0 + motor, 2.0);
  EXPECT_EQ(made.axis.encoder.counts, 65536.0) << made.facts.increment;
  EXPECT_EQ(made.axis.encoder.on, machine::EncoderPlace::motor);
}

TEST(LogFacts, LogsOfTwoKindsOrOfSeveralAxesAreRefused) {
  const auto message = [](const std::vector<Log>& logs, const std::string& axis) {
    try {
      facts_of(logs, axis);
      return std::string("accepted");
    } catch (const LogError& error) {
      return std::string(error.what());
    }
  };
  auto turned = moved({.rotary = true});
  EXPECT_NE(message({moved({}), turned}, "").find("found columns of a rotary axis; expected"), std::string::npos);
  auto two = moved({});
  two.axes[0].axis = "X";
  two.axes.push_back(two.axes[0]);
  two.axes[1].axis = "Y";
  EXPECT_NE(message({two}, "").find("found channels of 2 axes; expected --axis"), std::string::npos);
  EXPECT_EQ(message({two}, "Y"), "accepted");
}

}  // namespace
}  // namespace stiction::host
