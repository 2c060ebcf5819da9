// Contacts of step cams against discs and rays: how many there are, which the carousel does not need, and where a third
// one is left after relief.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "tests/host/cam/step/ray_cut.hpp"
#include "tests/support/figure.hpp"

namespace stiction::host::step {
namespace {

// The published cases (docs/step_cams.md): 30 to 130 mm, and the arcs of cam 1 as the prototypes print them.
struct PublishedArcs {
  double a, b, c;
  int rollers;
  double stroke, rise;  // deg
  double arcs[4];       // deg
};
constexpr PublishedArcs published_arcs[] = {
    {105, 52, 13, 4, 90, 180, {133.2, 167.9, 211.8, 219.3}},
    {105, 45, 12, 3, 120, 200, {133.5, 163.0, 212.5, 220.5}},
    {80, 40, 10, 4, 90, 180, {132.5, 169.0, 211.5, 221.0}},
    {130, 62, 16, 4, 90, 150, {138.5, 172.0, 208.0, 218.5}},
};
StepProject project_of(const PublishedArcs& row) {
  return step_project(row.a, row.b, row.c, row.rollers, row.stroke, row.rise);
}

// The angles of cam 1 where discs touch that the carousel does not need, as arcs: a disc is needed that pushes its way
// with the smallest pressure angle.
std::vector<ProfileArc> redundant_arcs(const RayCut& rays, int steps) {
  std::vector<double> angles;
  for (int k = 0; k < steps; ++k) {
    const auto contacts = rays.contacts(turn * k / steps, contact_gap);
    for (const RayContact& contact : contacts)
      for (const RayContact& other : contacts)
        if (contact.cam == 0 && contact.push * other.push > 0.0 && std::fabs(other.push) > std::fabs(contact.push))
          angles.push_back(wrapped(contact.angle));
  }
  std::sort(angles.begin(), angles.end());
  std::vector<ProfileArc> arcs;
  for (const double angle : angles) {
    if (arcs.empty() || angle > arcs.back().end + 1.0 * degree) arcs.push_back({angle, angle});
    arcs.back().end = angle;
  }
  return arcs;
}

// An eighth of a degree between the cam's angles, as the prototypes have it. Rows 2 to 4 of those are printed in bins
// of half a degree: the begin of the first bin, and the end of the bin behind the last one.
TEST(StepContacts, RedundantArcsAreThoseOfDiscsAgainstRays) {
  constexpr double bin = 0.5;  // deg
  double worst = 0.0;
  for (const auto& row : published_arcs) {
    const StepProject project = project_of(row);
    const StepLift lift = lift_of(*project.cam);
    const auto arcs = synthesize(project).couplings[0].redundant;
    const auto seen = redundant_arcs(RayCut(project, lift), 2880);
    ASSERT_EQ(arcs.size(), 2u);
    ASSERT_EQ(seen.size(), 2u);
    const double found[] = {arcs[0].begin / degree, arcs[0].end / degree, arcs[1].begin / degree, arcs[1].end / degree};
    const double by_rays[] = {seen[0].begin / degree, seen[0].end / degree, seen[1].begin / degree,
                              seen[1].end / degree};
    for (int k = 0; k < 4; ++k) {
      worst = std::max(worst, std::fabs(found[k] - by_rays[k]));
      // How much longer the printed arc is at this end.
      const double longer = k % 2 == 0 ? by_rays[k] - row.arcs[k] : row.arcs[k] - by_rays[k];
      if (&row == &published_arcs[0]) {
        EXPECT_NEAR(found[k], row.arcs[k], 0.3) << k;
      } else {
        EXPECT_GE(longer, (k % 2 == 0 ? 0.0 : bin) - 0.1) << row.a << " " << k;
        EXPECT_LE(longer, (k % 2 == 0 ? bin : 2.0 * bin) + 0.1) << row.a << " " << k;
      }
    }
  }
  EXPECT_LE(worst, 0.3);
  test::figure("step cams: arcs of cam 1 against discs on rays, four cases, worst",
               fmt::format("{:.2f} deg (bound 0.3 deg)", worst));
}

// The outline of a profile, between its points and corners.
struct Outline {
  explicit Outline(const StepProfile& profile) : step(profile.step()) {
    for (std::size_t j = 0; j < profile.points.size(); ++j) {
      places.push_back(profile.points[j].place());
      corner.push_back(profile.has_corner((static_cast<double>(j) + 0.5) * step, 0.5 * step));
    }
    for (const auto& vertex : profile.vertices) vertices.push_back(vertex.place());
  }
  double step;
  std::vector<Point> places, vertices;
  std::vector<bool> corner;  // between this point and the next one
};

// How far a disc is from an outline, and at which angle.
struct Near {
  double gap, angle;
};
Near near_gap(const Outline& outline, Point centre, double radius) {
  const auto count = static_cast<long>(outline.places.size());
  const double half = std::asin(radius / std::abs(centre)) + 1.0 * degree;
  double least = infinity;
  Point nearest;
  const auto include = [&](Point place) {
    if (std::norm(centre - place) < least) least = std::norm(centre - place), nearest = place;
  };
  for (long j = std::lround((std::arg(centre) - half) / outline.step);
       j <= std::lround((std::arg(centre) + half) / outline.step); ++j) {
    const auto at = static_cast<std::size_t>((j % count + count) % count);
    const Point from = outline.places[at], along = outline.places[(at + 1) % outline.places.size()] - from;
    include(from +
            (outline.corner[at] ? 0.0 : std::clamp(dot(centre - from, along) / std::norm(along), 0.0, 1.0)) * along);
  }
  for (const Point vertex : outline.vertices) include(vertex);
  return {std::sqrt(least) - radius, std::arg(nearest)};
}

// Whether an angle of a cam lies in a blend of one of the arcs, with a step of the profile beside it.
bool in_blend(const StepSynthesis& made, int cam, double angle) {
  const double step = made.profiles[0].step();
  for (const ReliefArc& arc : made.arcs) {
    if (arc.cam != cam) continue;
    const double in = wrapped(angle - arc.arc.begin + step) - step;
    const double out = arc.arc.length() - in;
    if (in < -step || out < -step) continue;
    if ((!arc.begins_at_corner && in <= arc.shape.blend + step) ||
        (!arc.ends_at_corner && out <= arc.shape.blend + step))
      return true;
  }
  return false;
}

// The contacts of every roller with the relieved profiles, by distances from outlines, at an eighth of a degree:
// exactly two but where a third one is at the beginning of a blend.
TEST(StepContacts, ReliefLeavesAThirdContactInItsBlendsOnly) {
  std::string printed;
  for (const auto& row : published_arcs)
    for (const double lead_in : {0.0, 4.0}) {
      StepProject project = project_of(row);
      project.relief.valley = project.relief.peak = {1e-4, 4.0 * degree, false};
      project.relief.lead_in = lead_in * degree;
      const StepSynthesis made = synthesize(project);
      const StepMechanism& m = project.mechanism;
      const Outline outlines[] = {Outline(made.profiles[0]), Outline(made.profiles[1])};
      int two = 0;
      for (int k = 0; k < 2880; ++k) {
        const double psi = turn * k / 2880;
        int touching = 0, harmless = 0;
        for (int cam = 0; cam < 2; ++cam)
          for (int n = 0; n < m.rollers; ++n) {
            const RollerPoint p = roller_at(m, m.base(cam) + n * m.pitch(), psi, made.lift.at(psi));
            if (std::fabs(around_zero(p.arm_angle)) > 1.6) continue;
            const Near near = near_gap(outlines[cam], p.centre, m.roller_radius);
            if (near.gap > contact_gap) continue;
            ++touching;
            const bool edge = made.profiles[static_cast<std::size_t>(cam)].has_corner(near.angle, 0.05 * degree);
            harmless += in_blend(made, cam, near.angle) || (lead_in == 0.0 && edge);
          }
        two += touching == 2;
        ASSERT_GE(touching, 2) << psi / degree;
        EXPECT_LE(touching - harmless, 2) << row.a << " lead-in " << lead_in << " at " << psi / degree;
      }
      if (&row == &published_arcs[0]) {
        EXPECT_GE(two, 0.97 * 2880) << lead_in;
      }
      printed += fmt::format("{}{:.2f}", printed.empty() ? "" : ", ", 100.0 * two / 2880);
    }
  test::figure("step cams: exactly two contacts after relief, four cases, lead-in 0 and 4 deg",
               printed + " % (bound 97 % in the first case)");
}

}  // namespace
}  // namespace stiction::host::step
