// Intervals of tolerances against 10 000 mechanisms that are drawn within them.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "host/cam/step/tolerance.hpp"
#include "tests/host/cam/step/step_case.hpp"
#include "tests/support/figure.hpp"

namespace stiction::host::step {
namespace {

// 10 000 mechanisms within the tolerances, each with its rollers moved as a whole against the profile.
TEST(StepTolerance, IntervalsOfThePlayHoldAllSamplesAndAreNotWide) {
  StepProject project = relieved_case();
  const StepSynthesis made = synthesize(project);
  const ContactSearch search(project.mechanism, made.lift, made.profiles);
  double widest = 0.0;
  std::mt19937_64 engine(5);
  const auto drawn = [&] { return 2e-5 * (static_cast<double>(engine() >> 11) * 0x1p-53 - 0.5); };
  for (const double psi : {0.3, 2.2, 3.1, 4.4}) {
    const ContactSet set = search.at(psi);
    const Range interval = play_at(set, project.tolerances, 0.0, 13e-3);
    double low = infinity, high = -infinity;
    for (int k = 0; k < 10'000; ++k) {
      StepMechanism built = project.mechanism;
      const double preload = drawn(), profile = drawn(), roller = drawn();
      built.axis_distance += drawn() - preload;
      built.arm += drawn();
      double play = 0.0;
      for (const int way : {1, -1}) {
        const Contact& contact = *set.pushing(way);
        const RollerPoint p =
            roller_at(built, built.base(contact.cam) + contact.roller * built.pitch(), psi, made.lift.at(psi));
        // The profile lies where it is; the roller comes from where its centre is now.
        play += (search.gap_of(contact.cam, p, 1e-4) - roller - profile) / std::fabs(contact.push);
      }
      low = std::min(low, play), high = std::max(high, play);
    }
    EXPECT_LE(interval.low, low) << psi;
    EXPECT_GE(interval.high, high) << psi;
    EXPECT_LE(interval.width(), 1.3 * (high - low)) << psi;
    widest = std::max(widest, interval.width() / (high - low));
  }
  test::figure("step cams: interval of the play over the range of 10 000 samples",
               fmt::format("{:.3f} (bound 1.3)", widest));
}

// A contact of a drawn mechanism.
struct Pressed {
  double gap, lever, curvature;  // m, m, 1/m
};

// The highest force times curvature of springs that balance `torque`: the carousel turns to where the sum of their
// torques, a broken line that falls, has that value. Between its corners it is solved as a straight line.
double highest_load(const std::vector<Pressed>& all, double stiffness, double torque, double roller) {
  const auto sum = [&](double turned) {
    double given = 0.0;
    for (const Pressed& each : all) given += stiffness * std::max(0.0, -each.gap - each.lever * turned) * each.lever;
    return given;
  };
  std::vector<double> corners{-1e-2, 1e-2};
  for (const Pressed& each : all) corners.push_back(-each.gap / each.lever);
  std::sort(corners.begin(), corners.end());
  double turned = corners.front();
  for (std::size_t k = 0; k + 1 < corners.size(); ++k)
    if (sum(corners[k]) >= torque && sum(corners[k + 1]) <= torque && corners[k] < corners[k + 1])
      turned = corners[k] + (corners[k + 1] - corners[k]) * (sum(corners[k]) - torque) /
                                std::max(1e-12, sum(corners[k]) - sum(corners[k + 1]));
  double highest = 0.0;
  for (const Pressed& each : all)
    highest =
        std::max(highest, stiffness * std::max(0.0, -each.gap - each.lever * turned) * (1.0 / roller + each.curvature));
  return highest;
}

// The peak of the Hertz pressure over a turn of drawn mechanisms: every roller where its own dimensions put it, against
// the profile as it was cut. 7.5 degrees between the cam's angles, the same ones for the interval.
TEST(StepTolerance, IntervalsOfTheHertzPressureHoldAllSamplesAndAreNotWide) {
  StepProject project = relieved_case();
  project.steps = 1440;
  project.load.stiffness = 1e8;
  project.load.preload = 2e-5;
  const StepSynthesis made = synthesize(project);
  const StepMechanism& m = project.mechanism;
  std::vector<ContactSet> sets;
  for (std::size_t k = 0; k < made.contacts.size(); k += 30) sets.push_back(made.contacts[k]);
  const Range interval = tolerance_of(m, made.lift, project.load, sets, project.tolerances).pressure;
  const ContactSearch search(m, made.lift, made.profiles);
  const double soft = 2.0 * (1.0 - 0.3 * 0.3) / 210e9;
  std::mt19937_64 engine(6);
  const auto drawn = [&] { return 2e-5 * (static_cast<double>(engine() >> 11) * 0x1p-53 - 0.5); };
  double low = infinity, high = 0.0;
  std::vector<Pressed> pressed;
  for (int sample = 0; sample < 10'000; ++sample) {
    StepMechanism built = m;
    const double roller = drawn(), profile = drawn();
    built.axis_distance += drawn() - project.load.preload - drawn();
    built.arm += drawn();
    double peak = 0.0;
    for (const ContactSet& set : sets) {
      const LiftState lift = made.lift.at(set.psi);
      pressed.clear();
      for (int cam = 0; cam < 2; ++cam)
        for (int n = 0; n < m.rollers; ++n) {
          const RollerPoint p = roller_at(built, built.base(cam) + n * built.pitch(), set.psi, lift);
          if (std::fabs(around_zero(p.arm_angle)) > 1.6) continue;
          const double gap = search.gap_of(cam, p, 2e-4) - roller - profile;
          if (gap < 2e-4)
            pressed.push_back({gap, built.arm * p.push(set.psi), p.curvature / (1.0 - m.roller_radius * p.curvature)});
        }
      const double torque = -project.load.inertia * project.load.speed * project.load.speed * lift.acceleration;
      peak = std::max(peak, highest_load(pressed, project.load.stiffness, torque, m.roller_radius + roller));
    }
    const double pressure = std::sqrt(peak / (std::numbers::pi * m.roller_width) / soft);
    low = std::min(low, pressure), high = std::max(high, pressure);
  }
  EXPECT_LE(interval.low, low);
  EXPECT_GE(interval.high, high);
  EXPECT_LE(interval.width(), 1.3 * (high - low));
  test::figure("step cams: interval of the Hertz peak over the range of 10 000 samples",
               fmt::format("{:.3f} ({:.0f} to {:.0f} MPa, bound 1.3)", interval.width() / (high - low),
                           1e-6 * interval.low, 1e-6 * interval.high));
}

}  // namespace
}  // namespace stiction::host::step
