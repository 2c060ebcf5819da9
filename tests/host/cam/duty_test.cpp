// Torque, power and limits of a cam on an axis against closed forms, and the ranking of laws.
#include "host/cam/duty.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "firmware/machine/file/machine_file.hpp"
#include "host/cam/design.hpp"
#include "host/cam/rank.hpp"
#include "sim/machine_file.hpp"

namespace stiction::host {
namespace {

constexpr double pi = std::numbers::pi;

sim::cam::Motion rise_and_back(const std::string& law, double stroke) {
  sim::cam::Cam cam{.name = "a"};
  cam.segments = {{.length = pi, .stroke = stroke, .law = law}, {.length = pi, .stroke = -stroke, .law = law}};
  return sim::cam::compose(cam);
}

AxisLoad bare_load() {
  AxisLoad load;
  load.axis = "A";
  load.load = 0.02;
  load.rotor = 0.003;
  return load;
}

// M_D = I w^2 y'' and M_H = I w^2 y' y'' of a sloping sine with stroke h in b: h 2 pi / b^2 and h^2 (3 sqrt 3 pi / 2) /
// b^3.
TEST(CamDuty, TorquesAreThoseOfClosedForms) {
  const double h = 0.7, w = 21.0;
  const Duty duty = duty_of(rise_and_back("sloping_sine", h), bare_load(), w);
  const double peak = h * 2 * pi / (pi * pi);
  EXPECT_NEAR(std::fabs(duty.effort.load.value), 0.02 * w * w * peak, 1e-9 * 0.02 * w * w * peak);
  const double product = h * h * 1.5 * std::sqrt(3.0) * pi / (pi * pi * pi);
  EXPECT_NEAR(std::fabs(duty.effort.cam.value), 0.02 * w * w * product, 1e-9 * 0.02 * w * w * product);
  EXPECT_NEAR(duty.effort.cam_power, 0.02 * w * w * w * product, 1e-9 * 0.02 * w * w * w * product);
  // The motor's own rotor adds to the load.
  EXPECT_NEAR(std::fabs(duty.effort.motor.value), 0.023 * w * w * peak, 1e-9 * 0.023 * w * w * peak);
  // Without friction what is given is taken back.
  EXPECT_NEAR(duty.effort.energy, 0.0, 1e-9);
  // The rms of a sine is its peak over the square root of 2.
  EXPECT_NEAR(duty.effort.motor_rms, 0.023 * w * w * peak / std::sqrt(2.0), 1e-9 * 0.023 * w * w * peak);
}

TEST(CamDuty, FrictionAndWeightAddToTheMotorAlone) {
  AxisLoad load = bare_load();
  load.coulomb = 0.5;
  load.viscous = 0.1;
  const double h = 0.7, w = 3.0;
  const Duty duty = duty_of(rise_and_back("sloping_sine", h), load, w);
  // Of a cycle: 2 h of way against Coulomb friction, and viscous w times the integral of y'^2, 3/2 h^2/b each way.
  EXPECT_NEAR(duty.effort.energy, 0.5 * 2 * h + 0.1 * w * 2 * 1.5 * h * h / pi, 1e-9);
  load.weight = 2.0;
  load.kind = sim::cam::Coordinate::linear;
  EXPECT_NEAR(load.effort(0.3, 0.0, 0.0), 2.0, 1e-15);
  load.kind = sim::cam::Coordinate::rotary;
  EXPECT_NEAR(load.effort(0.3, 0.0, 0.0), 2.0 * std::sin(0.3), 1e-15);
}

// The statement of the source, "a classic cam needs less torque", holds while the slave's speed over the master's is
// below 1 and not above.
TEST(CamDuty, AClassicCamNeedsLessTorqueOnlyWhereTheSlaveIsSlower) {
  const auto torques = [](double stroke) {
    return duty_of(rise_and_back("sloping_sine", stroke), bare_load(), 5.0).effort;
  };
  const auto small = torques(0.5), large = torques(4.0);
  EXPECT_LT(std::fabs(small.cam.value), std::fabs(small.load.value));
  EXPECT_GT(std::fabs(large.cam.value), std::fabs(large.load.value));
}

TEST(CamDuty, LimitsSayWhereTheyBreakAndTheHighestSpeedThatKeepsThem) {
  AxisLoad load = bare_load();
  load.travel = 1.0;
  load.max_speed = 2.0;
  load.max_acceleration = 30.0;
  load.largest_effort = 0.4;
  const double h = 0.7;
  const auto motion = rise_and_back("sloping_sine", h);
  const double v = 2 * h / pi, a = h * 2 * pi / (pi * pi);
  const Duty duty = duty_of(motion, load, 10.0);
  ASSERT_EQ(duty.limits.size(), 4u);
  EXPECT_FALSE(duty.limits[0].broken());
  EXPECT_TRUE(duty.limits[1].broken());
  EXPECT_NEAR(duty.limits[1].place, pi / 2, 1e-9);
  EXPECT_NEAR(duty.limits[1].highest_speed, 2.0 / v, 1e-9);
  EXPECT_NEAR(duty.limits[2].highest_speed, std::sqrt(30.0 / a), 1e-9);
  EXPECT_NEAR(duty.limits[3].highest_speed, std::sqrt(0.4 / (0.023 * a)), 1e-6);
  EXPECT_TRUE(duty.broken());
  EXPECT_FALSE(duty_of(motion, load, duty.highest_speed() * 0.999).broken());
  EXPECT_TRUE(duty_of(motion, load, duty.highest_speed() * 1.001).broken());
  load.travel = 0.6;
  EXPECT_EQ(duty_of(motion, load, 1.0).highest_speed(), 0.0);
}

TEST(CamDuty, LoadsOfShippedMachinesAreInTheirOwnUnits) {
  const auto joint = sim::read_machine(machine::find_machine("servo-joint"));
  const AxisLoad load = load_of(joint.axes.at(0));
  EXPECT_EQ(load.kind, sim::cam::Coordinate::rotary);
  EXPECT_NEAR(load.load, 0.4533, 1e-12);
  EXPECT_NEAR(load.rotor, 8e-5 * 50 * 50, 1e-12);
  EXPECT_NEAR(load.travel, 1.5 * pi, 1e-12);
  EXPECT_NEAR(load.max_speed, 3.5, 1e-12);
  EXPECT_NEAR(load.coulomb, 2.2, 1e-12);
  EXPECT_NEAR(load.weight, 11.77, 1e-12);
}

TEST(CamRank, MarksTheParetoFrontAndRecommendsALawOfIt) {
  AxisLoad load = bare_load();
  load.frequency = 12.0;
  RankTask task{.stroke = 1.5, .rise = pi, .master_speed = 4 * pi};
  const auto band = usual_band(load, task.rise / task.master_speed);
  task.lowest = band.lowest;
  task.highest = band.highest;
  EXPECT_NEAR(band.lowest, 9.6, 1e-12);
  const auto ranking = rank_laws(task, load);
  EXPECT_GT(ranking.laws.size(), 30u);
  ASSERT_TRUE(ranking.recommended);
  EXPECT_TRUE(ranking.laws[*ranking.recommended].front);
  EXPECT_FALSE(ranking.laws[*ranking.recommended].jumps);
  for (const auto& a : ranking.laws)
    for (const auto& b : ranking.laws)
      if (b.front) {
        EXPECT_FALSE(a.speed < b.speed * 0.999 && a.acceleration < b.acceleration * 0.999 &&
                     a.effort < b.effort * 0.999 && a.residual < b.residual * 0.999);
      }
  for (std::size_t k = 1; k < ranking.laws.size(); ++k)
    EXPECT_LE(ranking.laws[k - 1].residual, ranking.laws[k].residual);
}

TEST(CamRank, ComparesTheLawsOfAllTasksAtOnce) {
  RankTask task{.stroke = 1.5, .rise = pi, .master_speed = 4 * pi, .lowest = 5.0, .highest = 20.0, .task = "all"};
  const auto ranking = rank_laws(task, bare_load());
  EXPECT_EQ(ranking.laws.size(), 84u);  // without the two whose coefficients are the user's
  ASSERT_TRUE(ranking.recommended);
  const auto& best = *ranking.laws[*ranking.recommended].law;
  EXPECT_EQ(task_of(best), "R-R");
  EXPECT_EQ(best.kind, sim::cam::LawKind::rise);
  // The way back of sin^2 takes as long as the rise: its peak speed is that of half a harmonic each way.
  for (const auto& row : ranking.laws)
    if (row.law->number == 73) {
      EXPECT_NEAR(row.speed, 1.5 * pi / 2 / pi * 4 * pi, 1e-9);
    }
}

TEST(CamRank, RecommendsNoneWhereEachBreaksALimit) {
  AxisLoad load = bare_load();
  load.max_speed = 0.1;
  const auto ranking = rank_laws({1.5, pi, 4 * pi, 5.0, 20.0, "R-R"}, load);
  EXPECT_FALSE(ranking.recommended);
  EXPECT_NE(ranking.reason.find("each breaks a limit"), std::string::npos);
}

// The half sum of the squares of the lines is the mean square (Parseval); of a sine, half the square of its peak.
TEST(CamDesign, HarmonicsHoldTheMeanSquareOfTheAcceleration) {
  const double h = 0.7, peak = h * 2 / pi;
  const auto amplitudes = acceleration_harmonics(rise_and_back("sloping_sine", h), 400);
  double sum = 0.0;
  for (const double a : amplitudes) sum += 0.5 * a * a;
  EXPECT_NEAR(sum, 0.5 * peak * peak, 1e-4 * peak * peak);
}

TEST(CamDesign, ShowsCurvesTorqueSpectrumAndResidual) {
  CamDesign design{rise_and_back("modified_sine", 0.7), {}, bare_load(), {}};
  design.load.frequency = 9.0;
  design.duty = duty_of(design.motion, design.load, 10.0);
  const auto result = design_result(design);
  ASSERT_EQ(result.charts.size(), 8u);
  EXPECT_EQ(result.charts.back().distances.size(), 1u);  // the machine's own frequency
  for (const auto& chart : result.charts)
    for (const auto& series : chart.series) EXPECT_EQ(series.x.size(), series.y.size());
  // The amplitude at the mark is that of the unit law.
  const double r = 9.0 * pi / 10.0;
  const auto& law = *sim::cam::find_law("modified_sine");
  const double wanted = 0.7 * sim::cam::residual_amplitude(sim::cam::unit_curve(law), r) * 180.0 / pi;
  EXPECT_NEAR(result.charts.back().distances[0].to, wanted, 1e-9);
}

}  // namespace
}  // namespace stiction::host
