// A single cam with a spring: forces and the speed of lift-off against closed forms, and against an arm that is free.
#include <gtest/gtest.h>

#include <cmath>

#include "host/cam/step/spring_cam.hpp"
#include "tests/host/cam/step/step_case.hpp"
#include "tests/support/figure.hpp"

namespace stiction::host::step {
namespace {

// An arm that swings by `stroke`, deg, and back within a turn; by one harmonic the way is h/2 (1 - cos psi).
StepProject spring_case(double stroke = 20.0, double dwell = 30.0) {
  StepProject project;
  project.mechanism = {0.12, 0.08, 0.012, 0.012, 1, 0.0, dwell * degree, false, 0.02};
  project.cam = sim::cam::Cam{.name = "swing"};
  project.cam->segments = {{.length = 0.5 * turn, .stroke = stroke * degree, .law = "harmonic"},
                           {.length = 0.5 * turn, .stroke = -stroke * degree, .law = "harmonic"}};
  project.load.inertia = 0.01;
  project.load.speed = 10.0 * std::numbers::pi;
  project.load.cam = project.load.roller = {210e9, 0.3};
  project.spring = ReturnSpring{20.0, 6.0};
  return project;
}

// At the top I w^2 h / 2 takes all that the spring has there: w^2 = 2 (T0 + k h) / (I h).
TEST(SpringCam, LiftsOffAtTheSpeedOfTheClosedForm) {
  double worst = 0.0;
  for (const double rate : {0.0, 20.0, 200.0})
    for (const double preload : {1.0, 6.0}) {
      StepProject project = spring_case();
      project.spring = ReturnSpring{rate, preload};
      const SpringCam made = synthesize_spring_cam(project);
      const double h = 20.0 * degree, speed = std::sqrt(2.0 * (preload + rate * h) / (0.01 * h));
      EXPECT_NEAR(made.lift_off_speed / speed, 1.0, 1e-9) << rate << " " << preload;
      EXPECT_NEAR(made.lift_off_psi, 0.5 * turn, 1e-9);
      worst = std::max(worst, std::fabs(made.lift_off_speed / speed - 1.0));
    }
  test::figure("spring cam: speed of lift-off over its closed form, less 1", fmt::format("{:.1g} (bound 1e-9)", worst));
}

// Below that speed every contact is pressed, above it one is not; and the work of the shaft over a turn is none.
TEST(SpringCam, HasAPressedContactUpToLiftOffAndNoWorkOverATurn) {
  StepProject project = spring_case();
  project.cam->segments = {{.length = 60.0 * degree},
                           {.length = 120.0 * degree, .stroke = 20.0 * degree, .law = "modified_sine"},
                           {.length = 60.0 * degree},
                           {.length = 120.0 * degree, .stroke = -20.0 * degree, .law = "modified_sine"}};
  const double speed = synthesize_spring_cam(project).lift_off_speed;
  const auto least = [&](double at) {
    project.load.speed = at;
    const SpringCam made = synthesize_spring_cam(project);
    double force = infinity, work = 0.0, size = 0.0;
    for (const auto& contact : made.contacts) {
      force = std::min(force, contact.force);
      work += contact.input_torque, size += std::fabs(contact.input_torque);
    }
    EXPECT_LE(std::fabs(work), 1e-6 * size);
    return std::pair(force, made.notes.size());
  };
  EXPECT_GT(least(0.999 * speed).first, 0.0);
  EXPECT_EQ(least(0.999 * speed).second, 0u);
  EXPECT_LT(least(1.001 * speed).first, 0.0);
  EXPECT_EQ(least(1.001 * speed).second, 1u);
}

// The force by virtual work: the torque of the shaft times the cam's speed is the power of arm and spring. The pressure
// is that of Hertz for the force and the curvature of the profile, which three of its points have.
TEST(SpringCam, ForcesDoTheWorkOfArmAndSpring) {
  StepProject project = spring_case();
  project.load.torque = 0.7;
  project.load.largest_pressure = 900e6;
  const SpringCam made = synthesize_spring_cam(project);
  const double w = project.load.speed, h = 20.0 * degree;
  for (const auto& contact : made.contacts) {
    const double way = 0.5 * h * (1.0 - std::cos(contact.psi)), rate = 0.5 * h * std::sin(contact.psi);
    const double bend = 0.5 * h * std::cos(contact.psi);
    const double against = std::fabs(rate) < 1e-9 ? 0.0 : std::copysign(0.7, rate);
    EXPECT_NEAR(contact.input_torque, (0.01 * w * w * bend + 6.0 + 20.0 * way + against) * rate, 1e-9);
  }
  StepProject faster = project;
  faster.load.speed = made.speed_for_pressure;
  double peak = 0.0;
  for (const auto& contact : synthesize_spring_cam(faster).contacts) peak = std::max(peak, contact.pressure);
  EXPECT_NEAR(peak / 900e6, 1.0, 1e-9);
}

TEST(SpringCam, RefusesWhatASpringCannotHold) {
  const auto problem = [](const StepProject& project) -> std::string {
    try {
      synthesize_spring_cam(project);
    } catch (const sim::cam::CamError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(problem(spring_case()), "");
  StepProject on = spring_case();
  on.cam->segments.pop_back();
  on.cam->segments.push_back({.length = 0.5 * turn});
  on.cam->modulo = 20.0 * degree;
  EXPECT_NE(problem(on).find("expected one that returns"), std::string::npos) << problem(on);
  StepProject two = spring_case();
  two.mechanism.rollers = 2;
  EXPECT_NE(problem(two).find("found 2 rollers"), std::string::npos);
  // On the line between the axes the cam cannot push the arm aside.
  EXPECT_NE(problem(spring_case(20.0, 0.2)).find("pressure angle"), std::string::npos)
      << problem(spring_case(20.0, 0.2));
  StepProject wheel = spring_case();
  wheel.mechanism.hub_radius = 0.055;
  EXPECT_NE(problem(wheel).find("the hub has"), std::string::npos) << problem(wheel);
}

}  // namespace
}  // namespace stiction::host::step
