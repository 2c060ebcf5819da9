// A machine file from a data sheet: every conversion by hand here, in another way than the product's.
#include "host/sheet/machine_text.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/machine_file.hpp"

namespace stiction::host {
namespace {

// A ball-screw axis as sheets give it: mm a turn, kg cm^2, N m per rms ampere, V per 1000 rpm and Ohm between lines.
const SheetAnswers ball_screw{{"name", "Ball screw"},
                              {"axis", "Z"},
                              {"kind", "linear"},
                              {"transmission", "screw"},
                              {"load", "180 kg"},
                              {"travel", "600 mm"},
                              {"max-velocity", "30 m/min"},
                              {"max-acceleration", "5 m/s^2"},
                              {"lead", "10 mm"},
                              {"motor-inertia", "3.49 kg cm^2"},
                              {"screw-inertia", "5 kg cm^2"},
                              {"amperes", "rms"},
                              {"volts", "rms"},
                              {"between", "line"},
                              {"torque-constant", "1.49 N m/A"},
                              {"voltage-constant", "95.5 V/1000 rpm"},
                              {"resistance", "4.4 Ohm"},
                              {"inductance", "27 mH"},
                              {"pole-pairs", "4"},
                              {"supply", "560 V"},
                              {"current-limit", "11 A"},
                              {"encoder-on", "motor"},
                              {"counts", "65536"}};

machine::AxisModel axis_of(const SheetAnswers& answers) {
  return sim::parse_machine("sheet.toml", machine_text(answers, "a test")).axes.at(0);
}

TEST(MachineText, BallScrewHasAmplitudesOfOneWindingAtTheTable) {
  EXPECT_LE(ball_screw.size(), 25u);
  const auto axis = axis_of(ball_screw);
  const double turns_per_metre = 100.0, radians_per_metre = turns_per_metre * 2.0 * std::numbers::pi;
  const auto near = [](double value, double wanted) { EXPECT_NEAR(value, wanted, 1e-6 * wanted); };
  near(axis.mass, 180.0 + (3.49e-4 + 5e-4) * radians_per_metre * radians_per_metre);
  near(axis.load_mass, 180.0);
  // 1.49 N m at 1 A rms is 1.49 N m at an amplitude of 1.414 A.
  near(axis.motor.force_constant, 1.49 / std::sqrt(2.0) * radians_per_metre);
  near(axis.motor.phase_force_constant, 2.0 / 3.0 * 1.49 / std::sqrt(2.0) * radians_per_metre);
  // At 1 m/s the motor turns with 6000 rpm: 573 V rms between lines, an amplitude of 573 sqrt(2/3) of one winding.
  near(axis.motor.emf_constant, 6.0 * 95.5 * std::sqrt(2.0 / 3.0));
  near(axis.motor.phase_resistance, 2.2);
  near(axis.motor.phase_inductance - axis.motor.mutual_inductance, 13.5e-3);
  near(axis.motor.pole_pair_pitch, 2.5e-3);
  near(axis.inverter.current_limit, 11.0 * std::sqrt(2.0));
  near(axis.encoder.increment, 10e-3 / 65536.0);
}

// A sheet's two constants of one motor are one by energy: what is converted rightly agrees.
TEST(MachineText, TorqueAndVoltageConstantOfOneMotorAgree) {
  const auto axis = axis_of(ball_screw);
  EXPECT_NEAR(axis.motor.emf_constant / axis.motor.phase_force_constant, 1.0, 0.1);
}

TEST(MachineText, EstimatedFrictionIsMarked) {
  auto answers = ball_screw;
  answers["guide-coefficient"] = "0.004";
  answers["carriages"] = "4";
  answers["seal-drag"] = "6 N";
  answers["preload"] = "500 N";
  answers["drag-torque"] = "0.2 N m";
  const auto text = machine_text(answers, "a test");
  EXPECT_NE(text.find("ESTIMATE"), std::string::npos);
  const auto axis = sim::parse_machine("sheet.toml", text).axes.at(0);
  const double by_hand = 0.004 * (180.0 * 9.80665 + 4 * 500.0) + 4 * 6.0 + 0.2 * 2.0 * std::numbers::pi / 10e-3;
  EXPECT_NEAR(axis.friction.models.at("coulomb_viscous").at("coulomb").at(0), by_hand, 1e-6 * by_hand);
  answers["coulomb"] = "104.1 N";
  EXPECT_EQ(machine_text(answers, "a test").find("ESTIMATE: 0.004"), std::string::npos);
}

// Every kind that the questions offer becomes a file that the reader takes.
TEST(MachineText, EveryKindIsAMachine) {
  auto joint = ball_screw;
  joint["kind"] = "rotary";
  joint["transmission"] = "gear";
  joint["ratio"] = "355/113";
  joint["load"] = "2 kg m^2";
  joint["travel"] = "360 deg";
  joint["max-velocity"] = "6 rad/s";
  joint["max-acceleration"] = "40 rad/s^2";
  joint.erase("lead");
  const auto axis = axis_of(joint);
  ASSERT_TRUE(axis.coordinate.rotary());
  const double inertia = axis.coordinate.own("kg").from_linear(axis.mass);
  EXPECT_NEAR(inertia, 2.0 + 3.49e-4 * std::pow(355.0 / 113.0, 2), 1e-9);
  auto direct = joint;
  direct["transmission"] = "direct";
  EXPECT_NEAR(axis_of(direct).coordinate.own("kg").from_linear(axis_of(direct).mass), 2.0 + 3.49e-4, 1e-9);
  auto belt = ball_screw;
  belt["transmission"] = "belt";
  belt["pulley"] = "200 mm";
  EXPECT_NEAR(axis_of(belt).motor.pole_pair_pitch, 0.05, 1e-12);
  const SheetAnswers linear_motor{{"transmission", "direct"},
                                  {"load", "225 kg"},
                                  {"travel", "500 mm"},
                                  {"max-velocity", "80 m/min"},
                                  {"max-acceleration", "20 m/s^2"},
                                  {"amperes", "rms"},
                                  {"volts", "rms"},
                                  {"between", "phase"},
                                  {"force-constant", "133 N/A"},
                                  {"resistance", "1.8 Ohm"},
                                  {"inductance", "16.2 mH"},
                                  {"pole-pair-pitch", "72 mm"},
                                  {"supply", "600 V"},
                                  {"current-limit", "49.5 A"},
                                  {"increment", "1 nm"}};
  const auto motor = axis_of(linear_motor).motor;
  EXPECT_NEAR(motor.force_constant, 133.0 / std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(motor.emf_constant, motor.force_constant / 1.5, 1e-9);
}

TEST(SheetQuestions, RefuseWhatIsNoAnswer) {
  const auto objection = [](std::string_view name, const std::string& answer) {
    for (const auto& question : sheet_questions())
      if (question.name == name) return objection_to(question, answer, ball_screw);
    return std::string("no such question");
  };
  EXPECT_NE(objection("lead", "10").find("no unit"), std::string::npos);
  EXPECT_NE(objection("lead", "0 mm").find("more than 0"), std::string::npos);
  EXPECT_NE(objection("ratio", "1/0").find("355/113"), std::string::npos);
  EXPECT_NE(objection("pole-pairs", "2.5").find("whole number"), std::string::npos);
  EXPECT_NE(objection("amperes", "effective").find("rms or peak"), std::string::npos);
  EXPECT_EQ(objection("voltage-constant", "95.5 V/1000 rpm"), "");
  EXPECT_EQ(objection("voltage-constant", "0.91 V s/rad"), "");
}

}  // namespace
}  // namespace stiction::host
