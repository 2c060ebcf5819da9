// The two simplified models of Dostrasil 2014 against each other, against closed forms and against the figures of an
// independent prototype (docs/residual_vibration.md).
#include "sim/cam/stand/response.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "firmware/machine/file/machine_file.hpp"
#include "sim/cam/laws.hpp"
#include "sim/cam/motion_file.hpp"
#include "sim/cam/stand/dwell.hpp"
#include "sim/machine_file.hpp"
#include "tests/sim/cam/stand/study.hpp"
#include "tests/support/figure.hpp"

namespace stiction::sim::cam {
namespace {

using std::numbers::pi;

TEST(StandModel, PrintedDenominatorIsLagrangesAndPrintedNumeratorIsAGearOff) {
  const auto printed = printed_transfer_function(table_2()), ours = transfer_function(study_drive());
  // Both up to a common factor, 33^2.
  const double factor = ours.denominator[4] / printed.denominator[4];
  for (std::size_t k = 0; k < 5; ++k)
    EXPECT_NEAR(ours.denominator[k] / (factor * printed.denominator[k]), 1.0, 1e-14) << k;
  // From the motor's set-point, u = p Pi: a gear that the printed one lacks.
  for (const double f : {0.0, 3.0, 14.5, 30.0, 200.0}) {
    const std::complex<double> s(0.0, 2.0 * pi * f);
    EXPECT_NEAR(std::abs(ours.at(s) / 33.0 / printed.at(s) * 33.0 - 1.0), 0.0, 1e-13) << f;
  }
  EXPECT_NEAR(std::abs(printed.at(0.0) - 1.0), 0.0, 1e-15) << "the motor's lift would need 1/33";
}

TEST(StandModel, PolesAndZerosAreThoseOfTheTestRig) {
  const auto g = transfer_function(study_drive());
  const auto poles = g.poles();
  ASSERT_EQ(poles.size(), 4u);
  EXPECT_NEAR(std::abs(poles[0]) / (2 * pi), 14.481, 5e-4);
  EXPECT_NEAR(Mode{poles[0]}.damping_ratio(), 0.01367, 5e-6);
  EXPECT_NEAR(std::abs(poles[2]) / (2 * pi), 26.748, 5e-4);
  EXPECT_NEAR(Mode{poles[2]}.damping_ratio(), 0.6482, 5e-5);
  const auto zeros = g.zeros();
  ASSERT_EQ(zeros.size(), 2u);
  EXPECT_NEAR(zeros[0].real(), -129.18, 5e-3);
  EXPECT_NEAR(zeros[1].real(), -3652.7, 5e-2);
  EXPECT_NEAR(study_drive().clamped_frequency() / (2 * pi), 14.500, 5e-4);
}

TEST(StandModel, ShippedMachineIsTheStandOfTable2) {
  const auto machine = sim::read_machine(machine::find_machine("cam-stand"));
  const auto found = elastic_drive_of(machine.axes.front()), wanted = study_drive();
  // The file has nine digits and more.
  EXPECT_NEAR(found.load_inertia / wanted.load_inertia, 1.0, 1e-12);
  EXPECT_NEAR(found.rotor_inertia / wanted.rotor_inertia, 1.0, 1e-11);
  EXPECT_NEAR(found.shaft_stiffness / wanted.shaft_stiffness, 1.0, 1e-12);
  EXPECT_NEAR(found.shaft_damping / wanted.shaft_damping, 1.0, 1e-12);
  EXPECT_NEAR(found.drive_stiffness / wanted.drive_stiffness, 1.0, 1e-8);
  EXPECT_NEAR(found.drive_damping / wanted.drive_damping, 1.0, 1e-9);
}

TEST(StandModel, OtherAxesAreRefused) {
  const auto refused = [](const char* name) {
    const auto machine = sim::read_machine(machine::find_machine(name));
    try {
      elastic_drive_of(machine.axes.front());
    } catch (const StandError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(refused("servo-joint").find("found no transmission.stiffness; expected it"), std::string::npos);
}

double largest_distance(const std::vector<LoadState>& a, const std::vector<LoadState>& b) {
  double largest = 0.0;
  EXPECT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) {
    EXPECT_NEAR(a[k].master, b[k].master, 1e-12 * (1.0 + a[k].master));
    largest = std::max(largest, std::fabs(a[k].position - b[k].position));
  }
  return largest;
}

// A law of every kind, with and without jumps of the acceleration, and the motions that ship.
TEST(StandModel, TransferFunctionAndLagrangeAgreeOnAnyMotion) {
  double worst = 0.0;
  for (const char* law : {"parabola", "cubic", "simple_sine", "sloping_sine", "modified_sine", "modified_trapezoid",
                          "polynomial_3_4_5", "polynomial_7_13", "exponential_1"}) {
    ASSERT_NE(find_law(law), nullptr) << law;
    const auto motion = indexing(law, 30.0, 120.0);
    const ResponseSettings settings{.master_speed = 130.0 * turns_a_minute, .cycles = 2};
    const double off = largest_distance(transfer_response(study_drive(), motion, settings),
                                        lagrange_response(study_drive(), motion, settings)) /
                       (30.0 * degree);
    EXPECT_LE(off, 1e-7) << law;
    worst = std::max(worst, off);
  }
  const std::filesystem::path examples = std::filesystem::path(STICTION_SOURCE_DIR) / "examples";
  for (const char* file : {"indexing.toml"})
    for (const Cam& cam : read_motion_file(examples / "cams" / file)) {
      const auto motion = compose(cam);
      const ResponseSettings settings{.master_speed = 60.0 * turns_a_minute, .cycles = 1};
      double stroke = 0.0;
      for (const Segment& segment : cam.segments) stroke = std::max(stroke, std::fabs(segment.stroke));
      const double off = largest_distance(transfer_response(study_drive(), motion, settings),
                                          lagrange_response(study_drive(), motion, settings)) /
                         stroke;
      EXPECT_LE(off, 1e-7) << cam.name;
      worst = std::max(worst, off);
    }
  test::figure("cam stand: transfer function against Lagrange's equations, worst",
               fmt::format("{:.2g} of the stroke", worst));
}

// 68.18 degrees in 90 at 47/min, by a parabola (Dostrasil 2014, 5.4).
TEST(StandModel, VerificationCaseIsThatOfThePrototype) {
  const auto motion = indexing("parabola", 68.18, 90.0);
  const double speed = 47.0 * turns_a_minute;
  for (const bool lagrange : {false, true}) {
    const ResponseSettings settings{.master_speed = speed, .step = 0.05e-3};
    const auto states = lagrange ? lagrange_response(study_drive(), motion, settings)
                                 : transfer_response(study_drive(), motion, settings);
    const auto largest = [&](auto&& value) {
      return *std::max_element(states.begin(), states.end(),
                               [&](const auto& a, const auto& b) { return value(a) < value(b); });
    };
    const auto top = largest([](const LoadState& s) { return s.position; });
    EXPECT_NEAR(top.position / degree, 69.0698, 0.001 * 69.0698);
    EXPECT_NEAR(top.master / degree, 93.79, 0.05);
    EXPECT_NEAR(dwell_figures(states, motion, *longest_dwell(motion)).peak_to_peak / degree, 1.7484, 0.0017);
    EXPECT_NEAR(largest([](const LoadState& s) { return s.speed; }).speed / degree, 456.95, 0.457);
    EXPECT_NEAR(largest([](const LoadState& s) { return -s.speed; }).speed / degree, -79.68, 0.08);
    const auto up = largest([](const LoadState& s) { return s.acceleration; });
    const auto down = largest([](const LoadState& s) { return -s.acceleration; });
    EXPECT_NEAR(up.acceleration / degree, 7114.8, 7.1);
    EXPECT_NEAR(up.master / degree, 103.45, 0.05);
    EXPECT_NEAR(down.acceleration / degree, -10304.5, 10.3);
    EXPECT_NEAR(down.master / degree, 56.18, 0.05);
    constexpr double places[] = {30, 45, 60, 90, 100}, lifts[] = {14.3833, 33.6062, 53.7782, 68.5044, 67.8260};
    for (std::size_t k = 0; k < 5; ++k) {
      const auto behind = std::find_if(states.begin(), states.end(),
                                       [&](const LoadState& s) { return s.master >= places[k] * degree - 1e-9; });
      // Between two states, the speed takes it there.
      const double late = (behind->master - places[k] * degree) / speed;
      EXPECT_NEAR((behind->position - behind->speed * late) / degree, lifts[k], 5e-4) << places[k];
    }
  }
}

TEST(StandModel, ParabolaLeavesWhatThePrototypeFound) {
  const auto figures = [](double rise, int cycles) {
    const auto motion = indexing("parabola", 30.0, rise);
    const auto states = transfer_response(study_drive(), motion,
                                          {.master_speed = 130.0 * turns_a_minute, .cycles = cycles, .step = 0.1e-3});
    return dwell_figures(states, motion, *longest_dwell(motion));
  };
  EXPECT_NEAR(figures(180.0, 1).peak_to_peak / degree, 1.645, 0.005 * 1.645);
  EXPECT_NEAR(figures(180.0, 1).quality / (degree * degree), 84.5, 0.005 * 84.5);
  EXPECT_NEAR(figures(120.0, 1).peak_to_peak / degree, 0.649, 0.005 * 0.649);
  EXPECT_NEAR(figures(120.0, 1).quality / (degree * degree), 43.1, 0.005 * 43.1);
  // Steady running: residuals carry over by 0.563 a cycle.
  EXPECT_NEAR(figures(180.0, 30).quality / (degree * degree), 64.0, 0.02 * 64.0);
}

// The mode that is taken out of the state is what rings in the dwell once the drive's own mode has died.
TEST(StandModel, ModalResidualIsWhatRingsInTheDwell) {
  const auto motion = indexing("parabola", 30.0, 180.0);
  const double speed = 130.0 * turns_a_minute;
  const auto mode = load_mode(study_drive());
  const auto c = modal_residual(study_drive(), motion, speed, pi);
  for (const auto& s : transfer_response(study_drive(), motion, {.master_speed = speed})) {
    const double t = (s.master - pi) / speed;
    if (t < 0.12) continue;  // 13 time constants of the drive
    EXPECT_NEAR(s.position - 30.0 * degree, 2.0 * (c * std::exp(mode.pole * t)).real(), 1e-7);
  }
}

// At constant speed friction C holds the rotor C/k_D behind, and the load with it; a set-point that friction holds
// moves nothing.
TEST(StandModel, CoulombFrictionHoldsTheRotorBehindTheSetPoint) {
  const auto drive = study_drive();
  const double coulomb = 33.0;  // 1 N m at the motor
  Cam cam{.name = "ramp"};
  cam.periodic = false;
  cam.segments = {{.length = 1.0, .stroke = 0.5, .law = "parabola"}, {.length = 5.28}};
  Cam steady{.name = "steady"};
  steady.periodic = false;
  steady.segments = {{.length = 20.0, .stroke = 20.0, .law = "linear"}};
  const auto states = lagrange_response(drive, compose(steady), {.master_speed = 1.0}, coulomb);
  EXPECT_NEAR(states.back().position, 20.0 - coulomb / drive.drive_stiffness, 1e-8);
  cam.segments[0].stroke = 0.9 * coulomb / drive.drive_stiffness;
  for (const auto& state : lagrange_response(drive, compose(cam), {.master_speed = 0.01}, coulomb))
    ASSERT_EQ(state.position, 0.0);
}

TEST(Dwell, GoesOnOverTheSeamAndIsNotFoundWhereNothingRests) {
  Cam cam{.name = "a"};
  cam.segments = {{.length = 1.0},
                  {.length = 1.0, .stroke = 0.5, .law = "polynomial_3_4_5"},
                  {.length = 1.5},
                  {.length = 1.0, .stroke = -0.5, .law = "polynomial_3_4_5"},
                  {.length = 0.9}};
  const auto dwell = longest_dwell(compose(cam));
  ASSERT_TRUE(dwell);
  EXPECT_NEAR(dwell->begin, 4.5, 1e-12);
  EXPECT_NEAR(dwell->length, 1.9, 1e-12);
  Cam never{.name = "b"};
  never.segments = {{.length = 1.0, .stroke = 1.0, .law = "sloping_sine"},
                    {.length = 1.0, .stroke = -1.0, .law = "sloping_sine"}};
  EXPECT_FALSE(longest_dwell(compose(never)));
}

}  // namespace
}  // namespace stiction::sim::cam
