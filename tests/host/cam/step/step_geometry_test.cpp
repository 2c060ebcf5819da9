// The geometry of step cams against other formulations: the published formulas of polar coordinates, discs against
// rays.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/host/cam/step/step_case.hpp"
#include "tests/support/figure.hpp"

namespace stiction::host::step {
namespace {

// Of the carousel's arm angle v over the cam's angle.
struct Arm {
  double v, rate;
};

// Dostrasil 2014, as docs/step_cams.md has it: polar coordinates of centre and contact with the angle nu of the normal.
struct Polar {
  Point centre, contact;
};
Polar published(const StepMechanism& m, double psi, const Arm& arm) {
  const double a = m.axis_distance, b = m.arm, c = m.roller_radius;
  const double u = std::sqrt(a * a - 2.0 * a * b * std::cos(arm.v) + b * b);
  const double phi = psi + std::atan2(b * std::sin(arm.v), a - b * std::cos(arm.v));
  const double nu = -std::atan(arm.rate * a * b * std::sin(arm.v) / (u * u + arm.rate * b * (a * std::cos(arm.v) - b)));
  const double phi1 = phi - std::atan(c * std::sin(nu) / (u - c * std::cos(nu)));
  const double u1 = std::sqrt(u * u - 2.0 * c * u * std::cos(nu) + c * c);
  return {std::polar(u, phi), std::polar(u1, phi1)};
}

TEST(StepGeometry, ContactsAreARollerRadiusFromItsCentreAlongTheNormalOfItsPath) {
  double off = 0.0, tilt = 0.0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const StepProject project = drawn_case(seed);
    const StepMechanism& m = project.mechanism;
    const StepLift lift = lift_of(*project.cam);
    for (int k = 0; k < 400; ++k) {
      const double psi = (k + 0.3) * turn / 400;
      const RollerPoint p = roller_at(m, m.base(0), psi, lift.at(psi));
      if (std::fabs(around_zero(p.arm_angle)) > 1.4)
        continue;  // far from the cam the published arctangent is ambiguous
      const Polar other = published(m, psi, {p.arm_angle, p.arm_speed});
      EXPECT_LE(std::abs(other.centre - p.centre), 1e-13);
      EXPECT_LE(std::abs(other.contact - p.contact(m.roller_radius)), 1e-13);
      EXPECT_NEAR(std::abs(p.contact(m.roller_radius) - p.centre), m.roller_radius, 1e-13);
      off = std::max(off, std::fabs(std::abs(other.contact - p.centre) - m.roller_radius));
      // The path's tangent from its points, by differences of fourth order.
      const double h = 2e-4;
      const auto at = [&](double offset) {
        return roller_at(m, m.base(0), psi + offset, lift.at(psi + offset)).centre;
      };
      const Point tangent = 8.0 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h));
      tilt = std::max(tilt, std::fabs(dot(p.normal, tangent / std::abs(tangent))));
      EXPECT_LE(tilt, 1e-9) << seed << " " << psi;
    }
  }
  test::figure("step cams: published contact from the roller's centre, less its radius",
               fmt::format("{:.1g} mm (bound 1e-10 mm)", 1e3 * off));
  test::figure("step cams: normal against the path's tangent", fmt::format("{:.1g} (bound 1e-9)", tilt));
}

// What a ray from the cam's axis meets first of all discs of a turn: rollers as they stand, at a twentieth of a degree.
double ray_against_discs(const StepProject& project, const StepLift& lift, int row, double angle) {
  const StepMechanism& m = project.mechanism;
  const Point ray = std::polar(1.0, angle);
  double least = infinity;
  for (int k = 0; k < 7200; ++k) {
    const double psi = k * turn / 7200;
    const double way = (m.against ? -1.0 : 1.0) * lift.at(psi).way;
    for (int n = 0; n < m.rollers; ++n) {
      const double v = m.base(row) + n * m.pitch() + way;
      const Point centre = std::polar(1.0, psi) * Point(m.axis_distance - m.arm * std::cos(v), m.arm * std::sin(v));
      const double along = dot(centre, ray), off = cross(ray, centre);
      const double half = m.roller_radius * m.roller_radius - off * off;
      if (along > 0.0 && half > 0.0) least = std::min(least, along - std::sqrt(half));
    }
  }
  return least;
}

TEST(StepGeometry, ProfilesAreWhatDiscsLeaveOfRays) {
  double worst = 0.0;
  for (std::uint64_t seed = 31; seed <= 60; ++seed) {
    const StepProject project = drawn_case(seed);
    const StepLift lift = lift_of(*project.cam);
    const StepProfile profile = cut_profile(project.mechanism, sampled(lift, 3600), static_cast<int>(seed % 2), 3600);
    for (std::size_t j = 3; j < 3600; j += 131) {
      const double ray = ray_against_discs(project, lift, static_cast<int>(seed % 2), profile.points[j].angle);
      worst = std::max(worst, std::fabs(profile.points[j].radius - ray));
      EXPECT_NEAR(profile.points[j].radius, ray, 2e-6) << seed << " at " << profile.points[j].angle / degree;
    }
  }
  test::figure("step cams: 30 profiles against discs on rays, worst",
               fmt::format("{:.2f} um (bound 2 um)", 1e6 * worst));
}

// Whatever a roller does, it is never inside of a cam; and some roller is on each place of it.
TEST(StepGeometry, NoRollerIsEverInsideOfACam) {
  for (std::uint64_t seed = 61; seed <= 70; ++seed) {
    const StepProject project = drawn_case(seed);
    const StepSynthesis made = synthesize(project);
    const ContactSearch search(project.mechanism, made.lift, made.cut);
    for (int k = 0; k < 500; ++k) {
      const ContactSet set = search.at((k + 0.5) * turn / 500, 1e-4);
      for (const Contact& contact : set.contacts) EXPECT_GE(contact.gap, -5e-8) << seed << " " << set.psi / degree;
    }
  }
}

// A spline through rows of one degree, looked at each tenth of a degree, in unit lift. Where the acceleration jumps the
// spline is split, or it is off by a thousand times as much.
TEST(StepGeometry, SplinesThroughMeasuredRowsHoldTheLift) {
  const auto error = [](const std::string& law, bool split) {
    const auto cam = step_motion(60.0, 180.0, law);
    const auto motion = sim::cam::compose(cam);
    MeasuredLift table;
    for (int k = 0; k <= 360; ++k) {
      table.psi.push_back(k == 360 ? turn : k * degree);
      table.way.push_back(motion.curve(std::min(table.psi.back(), motion.curve.end())));
    }
    if (split) table.splits = {table.psi[90], table.psi[180], table.psi[270]};
    std::vector<std::string> notes;
    const StepLift lift = lift_of(table, notes);
    double worst = 0.0;
    for (int k = 0; k < 3600; ++k)
      worst = std::max(worst, std::fabs(lift.at(0.1 * k * degree).way - motion.curve(0.1 * k * degree)));
    return worst / (60.0 * degree);
  };
  double whole = 0.0, split = 0.0;
  for (const char* smooth : {"modified_sine", "sloping_sine", "3-4-5", "4-5-6-7", "modified_trapezoid"}) {
    whole = std::max(whole, error(smooth, false));
    EXPECT_LE(error(smooth, false), 2e-8) << smooth;
  }
  for (const char* jumping : {"parabola", "simple_sine", "cubic"}) {
    split = std::max(split, error(jumping, true));
    EXPECT_LE(error(jumping, true), 2e-8) << jumping;
    EXPECT_GE(error(jumping, false), 1e-6) << jumping;
  }
  test::figure("step cams: spline through rows of 1 deg, unit lift, C2 laws and split ones, worst",
               fmt::format("{:.2g}, {:.2g} (bound 2e-8)", whole, split));
}

}  // namespace
}  // namespace stiction::host::step
