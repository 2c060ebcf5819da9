// Step cams against the figures of independent prototypes, closed forms, and what must hold of relief and tolerances.
#include <gtest/gtest.h>

#include <cmath>

#include "host/cam/step/lead_in.hpp"
#include "tests/host/cam/step/step_case.hpp"
#include "tests/support/figure.hpp"

namespace stiction::host::step {
namespace {

double worst_pressure_angle(const std::vector<ContactSet>& sets) {
  double worst = 0.0;
  for (const auto& set : sets)
    for (const auto& contact : set.contacts)
      if (contact.needed) worst = std::max(worst, contact.pressure_angle());
  return worst / degree;
}

struct Published {
  double a, b, c;
  int rollers;
  double stroke, rise;    // deg
  double least, largest;  // mm
  double three;           // % of the turn with three contacts
  double pressure_angle;  // deg
};

// Prototypes that cut by discs against rays at steps of a fortieth of a degree: the largest radius is that of such a
// ray, and the exact corner between two is up to 5 um farther out. For the arcs see step_contacts_test.cpp.
constexpr Published published_cases[] = {
    {105, 52, 13, 4, 90, 180, 40.000, 81.385, 29.8, 48.24},
    {105, 45, 12, 3, 120, 200, 48.000, 94.746, 24.9, 41.18},
    {80, 40, 10, 4, 90, 180, 30.000, 62.032, 30.1, 47.92},
    {130, 62, 16, 4, 90, 150, 52.000, 102.640, 28.5, 49.43},
};

TEST(StepSynthesis, HasTheFiguresOfIndependentPrototypes) {
  double radius = 0.0, three = 0.0, angle = 0.0;
  for (const auto& row : published_cases) {
    const StepProject project = step_project(row.a, row.b, row.c, row.rollers, row.stroke, row.rise);
    const StepSynthesis made = synthesize(project);
    double largest = 0.0;
    for (const auto& point : cut_profile(project.mechanism, sampled(made.lift, 3600), 0, 14400).points)
      largest = std::max(largest, point.radius);
    EXPECT_NEAR(1e3 * made.cut[0].least_radius, row.least, 1e-3);
    EXPECT_NEAR(1e3 * largest, row.largest, 1e-3);
    const auto shares = made.shares(made.unrelieved);
    EXPECT_NEAR(100.0 * shares.three, row.three, 0.3);
    EXPECT_EQ(shares.other, 0.0);
    EXPECT_NEAR(worst_pressure_angle(made.unrelieved), row.pressure_angle, 0.02);
    radius = std::max(
        {radius, std::fabs(1e3 * made.cut[0].least_radius - row.least), std::fabs(1e3 * largest - row.largest)});
    three = std::max(three, std::fabs(100.0 * shares.three - row.three));
    angle = std::max(angle, std::fabs(worst_pressure_angle(made.unrelieved) - row.pressure_angle));
  }
  test::figure("step cams: four cases against prototypes: radius, pressure angle, share of three",
               fmt::format("{:.4f} mm, {:.3f} deg, {:.2f} % (bounds 0.001 mm, 0.02 deg, 0.3 %)", radius, angle, three));
}

TEST(StepSynthesis, HasThePublishedCurvaturesOfNeededPlaces) {
  StepProject project = first_case();
  project.steps = 2880;
  const LeastRadii radii = least_radii(synthesize(project).unrelieved);
  EXPECT_NEAR(1e3 * radii.convex, 19.13, 0.05);
  EXPECT_NEAR(1e3 * radii.concave, 28.69, 0.05);
  test::figure("step cams: least convex, least concave radius where needed",
               fmt::format("{:.3f}, {:.3f} mm (19.13, 28.69 mm +- 0.05)", 1e3 * radii.convex, 1e3 * radii.concave));
}

// M_D = I w^2 stroke / rise^2 Ca and M_H = I w^2 stroke^2 / rise^3 C_M, both of the modified sine in closed form: its
// middle part has y' = k (1 - 3 cos t) and y'' = 4 k pi sin t with k = pi / (pi + 4), and y' y'' has its peak where
// 6 cos^2 t - cos t = 3. Force and pressure of the prototype.
TEST(StepSynthesis, HasTheForcesOfClosedFormsAndPrototype) {
  constexpr double pi = std::numbers::pi;
  StepProject project = first_case();
  project.steps = 2880;
  const StepSynthesis made = synthesize(project);
  const ForcePeaks peaks = peaks_of(made.forces, project.load.speed);
  const double w = project.load.speed, stroke = pi / 2, k = pi / (pi + 4), cosine = (1.0 - std::sqrt(73.0)) / 12.0;
  const double output = 0.02 * w * w * stroke / (pi * pi) * 4 * pi * k;
  const double input = 0.02 * w * w * stroke * stroke / (pi * pi * pi) * 4 * pi * k * k * (1.0 - 3.0 * cosine) *
                       std::sqrt(1.0 - cosine * cosine);
  // The peak of the acceleration is at an eighth of the rise, which is a step of the turn; that of M_H is not.
  EXPECT_NEAR(peaks.output_torque / output, 1.0, 1e-9);
  const double psi = pi / 2 + (std::acos(cosine) - pi / 3) * 3.0 / 4.0;
  const StepForces there = forces_at(project.mechanism, made.lift, project.load,
                                     ContactSearch(project.mechanism, made.lift, made.profiles).at(psi));
  EXPECT_NEAR(std::fabs(there.input_torque) / input, 1.0, 1e-9);
  EXPECT_NEAR(peaks.input_torque / input, 1.0, 1e-4);
  test::figure("step cams: M_D and M_H over their closed forms, less 1",
               fmt::format("{:.1g}, {:.1g} (bound 1e-9)", std::fabs(peaks.output_torque / output - 1.0),
                           std::fabs(std::fabs(there.input_torque) / input - 1.0)));
  EXPECT_NEAR(peaks.force, 424.8, 0.002 * 424.8);
  EXPECT_NEAR(1e-6 * peaks.pressure, 326.7, 0.002 * 326.7);
  test::figure(
      "step cams: largest contact force, Hertz pressure",
      fmt::format("{:.2f} N, {:.2f} MPa (424.8 N, 326.7 MPa within 0.2 %)", peaks.force, 1e-6 * peaks.pressure));
  EXPECT_NEAR(peaks.pressure_psi / degree, 251.75, 0.13);
  EXPECT_NEAR(peaks.pressure_angle / degree, 40.8, 0.1);
  for (const StepForces& at : made.forces)
    EXPECT_NEAR(at.input_torque, -at.output_torque * made.lift.at(at.psi).speed, 1e-9);
}

// Elastic: what the springs give balances the carousel, whatever they share, and the shafts' work is that of the rigid
// drive.
TEST(StepSynthesis, ElasticContactsBalanceTheCarousel) {
  StepProject project = relieved_case();
  project.load.stiffness = 1e8;
  project.load.preload = 2e-5;
  const StepSynthesis made = synthesize(project);
  for (const StepForces& at : made.forces) {
    double torque = 0.0;
    for (const auto& each : at.contacts) torque += each.force * project.mechanism.arm * each.contact.push;
    EXPECT_NEAR(torque, at.output_torque, 1e-6);
  }
  const double speed = speed_before_lift_off(project.mechanism, made.lift, project.load, made.contacts);
  EXPECT_GT(speed, project.load.speed);
  project.load.speed = 0.999 * speed;
  EXPECT_GT(peaks_of(synthesize(project).forces, speed).least_force, 0.0);
  project.load.speed = 1.001 * speed;
  EXPECT_EQ(peaks_of(synthesize(project).forces, speed).least_force, 0.0);
}

TEST(StepSynthesis, TheSecondCamIsTheMirroredFirstOneOnlyOfASymmetricLift) {
  const Symmetry symmetric = synthesize(first_case()).symmetry;
  EXPECT_LE(symmetric.distance, 1e-9);
  ASSERT_EQ(symmetric.axes.size(), 1u);
  EXPECT_NEAR(std::sin(symmetric.axis), 0.0, 1e-12);
  StepProject uneven = first_case();
  uneven.cam = step_motion(90, 180, "modified_sine", 0.4);
  const StepSynthesis made = synthesize(uneven);
  EXPECT_FALSE(made.symmetry.holds());
  EXPECT_NEAR(1e3 * made.symmetry.distance, 2.2, 0.05);
  // So it is where the rollers do not rest symmetrically.
  StepProject turned = first_case();
  turned.mechanism.dwell_position += 1.0 * degree;
  EXPECT_FALSE(synthesize(turned).symmetry.holds());
  test::figure("step cams: mirrored cam 1 against cam 2, symmetric lift and lambda 0.4",
               fmt::format("{:.1g}, {:.3f} mm (bounds 1e-6 mm, 2.2 mm)", 1e3 * symmetric.distance,
                           1e3 * made.symmetry.distance));
}

// The axis goes through the middle of the dwell, wherever it is in the turn, and with two steps in a turn there are
// two.
TEST(StepSynthesis, ZeroPinsAreOnEveryAxisOfSymmetry) {
  for (const double late : {-17.3, 24.0, 61.7}) {
    StepProject project = first_case();
    project.cam->segments[0].length += late * degree;
    project.cam->segments[2].length -= late * degree;
    const Symmetry found = synthesize(project).symmetry;
    ASSERT_EQ(found.axes.size(), 1u) << late;
    EXPECT_NEAR(std::sin(found.axis - late * degree), 0.0, 1e-7) << late;
  }
  StepProject twice = step_project(105, 45, 8, 8, 90, 90);
  twice.cam->segments = {{.length = 45 * degree},
                         {.length = 90 * degree, .stroke = 45 * degree, .law = "modified_sine"},
                         {.length = 90 * degree},
                         {.length = 90 * degree, .stroke = 45 * degree, .law = "modified_sine"},
                         {.length = 45 * degree}};
  const StepSynthesis made = synthesize(twice);
  EXPECT_EQ(made.count.turns, 4);
  ASSERT_EQ(made.symmetry.axes.size(), 2u);
  EXPECT_NEAR(made.symmetry.axes[1] - made.symmetry.axes[0], 0.25 * turn, 1e-9);
}

// Gaps by brute force: each roller's centre against every point and corner of a profile.
double brute_gap(const StepProfile& profile, Point centre, double radius) {
  double least = infinity;
  const auto count = profile.points.size();
  for (std::size_t j = 0; j < count; ++j) {
    const Point from = profile.points[j].place(), to = profile.points[(j + 1) % count].place();
    const double share = std::clamp(dot(centre - from, to - from) / std::norm(to - from), 0.0, 1.0);
    if (!profile.has_corner(profile.points[j].angle, profile.step()))
      least = std::min(least, std::abs(centre - from - share * (to - from)));
    else
      least = std::min(least, std::abs(centre - from));
  }
  for (const auto& vertex : profile.vertices) least = std::min(least, std::abs(centre - vertex.place()));
  return least - radius;
}

TEST(StepSynthesis, ReliefLeavesTwoContactsAndTheNeededOnesWhereTheyWere) {
  for (const double lead_in : {0.0, 4.0}) {
    StepProject project = relieved_case();
    project.relief.lead_in = lead_in * degree;
    const StepSynthesis made = synthesize(project);
    int two = 0, checked = 0;
    double moved = 0.0;
    for (int k = 0; k < 120; ++k) {
      const double psi = (k + 0.37) * 3.0 * degree;
      int touching = 0;
      for (int cam = 0; cam < 2; ++cam)
        for (int n = 0; n < 4; ++n) {
          const RollerPoint p = roller_at(
              project.mechanism, project.mechanism.base(cam) + n * project.mechanism.pitch(), psi, made.lift.at(psi));
          if (std::fabs(around_zero(p.arm_angle)) > 1.6) continue;
          touching += brute_gap(made.profiles[static_cast<std::size_t>(cam)], p.centre, 13e-3) <= 1.5e-6;
        }
      two += touching == 2;
      ++checked;
    }
    const ContactSearch before(project.mechanism, made.lift, made.cut, project.relief.lead_in);
    const ContactSearch after(project.mechanism, made.lift, made.profiles);
    for (int k = 0; k < 2880; ++k)
      for (const Contact& contact : before.at(k * turn / 2880).contacts) {
        if (!contact.needed) continue;
        const double psi = k * turn / 2880;
        const RollerPoint p = roller_at(
            project.mechanism, project.mechanism.base(contact.cam) + contact.roller * project.mechanism.pitch(), psi,
            made.lift.at(psi));
        moved = std::max(moved, after.gap_of(contact.cam, p, 1e-4) - contact.gap);
      }
    test::figure(
        fmt::format("step cams: relief, lead-in {:g} deg: needed contacts moved, pressure angle changed", lead_in),
        fmt::format("{:.3f} um, {:.1g} deg (bounds 0.05 um, unchanged)", 1e6 * std::max(0.0, moved),
                    std::fabs(worst_pressure_angle(made.contacts) - worst_pressure_angle(made.unrelieved))));
    EXPECT_GE(two, 0.97 * checked) << lead_in;
    EXPECT_GE(made.shares(made.contacts).two, 0.97) << lead_in;
    EXPECT_LE(moved, 0.05e-6) << lead_in;
    EXPECT_NEAR(worst_pressure_angle(made.contacts), worst_pressure_angle(made.unrelieved), 1e-9) << lead_in;
  }
}

// With both sides of each corner relieved, a roller that is late by 0.02 mm meets no step, whichever way the cam turns.
TEST(StepSynthesis, ALateRollerIsLedInWithoutAStepInBothDirections) {
  StepProject project = relieved_case();
  project.relief.lead_in = 4.0 * degree;
  const StepSynthesis made = synthesize(project);
  const auto all = lead_ins(project.mechanism, made.lift, made.cut, made.profiles, 2e-5);
  ASSERT_EQ(all.size(), 4u);  // a corner on each cam, both directions
  double share = 0.0;
  for (const auto& each : all) {
    share = std::max(share, each.relieved / each.cut);
    EXPECT_GT(each.cut, 1.5e-5);
    EXPECT_LE(each.relieved, 0.1 * each.cut) << each.cam << " " << each.forwards;
  }
  test::figure("step cams: roller 0.02 mm late over each corner, step of the force over the unrelieved one",
               fmt::format("{:.3f} (bound 0.1)", share));
}

}  // namespace
}  // namespace stiction::host::step
