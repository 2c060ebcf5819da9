#include "host/cam/step/feasibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sim/cam/law.hpp"

namespace stiction::host::step {
namespace {

using sim::cam::CamError;
// A stroke that is nearer to a whole number of pitches than this is one.
constexpr double pitch_tolerance = 1e-9;
// A path is of the profile where its contact is no higher above it, m.
constexpr double on_profile = 2e-4;

// A number as the fraction above/below; below 0: it is none with a denominator up to 720.
struct Fraction {
  int above = 0, below = 0;

  std::string text() const { return below == 1 ? fmt::format("{}", above) : fmt::format("{}/{}", above, below); }
};
Fraction fraction_of(double value) {
  for (int below = 1; below <= 720; ++below) {
    const double above = std::round(value * below);
    if (std::fabs(above / below - value) < 1e-9) return {static_cast<int>(above), below};
  }
  return {};
}

std::string misfit(const StepMechanism& m, double stroke) {
  const Fraction pitches = fraction_of(stroke / m.pitch()), share = fraction_of(stroke / turn);
  const std::string found =
      fmt::format("found a stroke of {:.6g}° with {} rollers a row, {} pitches of {:.6g}°", stroke / degree, m.rollers,
                  pitches.below > 0 ? pitches.text() : fmt::format("{:.6g}", stroke / m.pitch()), m.pitch() / degree);
  if (share.below <= 0) return found + "; expected a whole number of pitches";
  const Fraction paths = fraction_of(static_cast<double>(m.rollers) / share.below);
  return found + fmt::format(
                     "; expected a whole number: the carousel is back after {} turns of the cam, which leaves {} "
                     "paths on it. {} rollers a row, or a multiple, fit this stroke",
                     share.below, paths.text(), share.below);
}

void require_dimensions(const StepMechanism& m) {
  const double lowest = m.axis_distance - m.arm - m.roller_radius;
  if (!(lowest > m.hub_radius))
    throw CamError(
        fmt::format("found rollers that come within {:.4g} mm of the cam's axis, where the hub has {:.4g} mm; "
                    "expected axis distance - arm - roller radius above the hub's radius: a shorter arm or a "
                    "larger axis distance",
                    1e3 * lowest, 1e3 * m.hub_radius));
  const double apart = 2.0 * m.arm * sim::sine_cosine(std::numbers::pi / m.rollers).sine;
  if (m.rollers > 1 && !(apart > 2.0 * m.roller_radius))
    throw CamError(
        fmt::format("found {} rollers a row, {:.4g} mm apart and {:.4g} mm thick, which hit each other; "
                    "expected less thickness than distance: fewer or thinner rollers or a longer arm",
                    m.rollers, 1e3 * apart, 2e3 * m.roller_radius));
}

}  // namespace

StepCount count_steps(const StepMechanism& m, const StepLift& lift) {
  require_dimensions(m);
  const double pitches = std::fabs(lift.stroke()) / m.pitch();
  const int whole = static_cast<int>(std::lround(pitches));
  if (!(lift.stroke() > 0.0))
    throw CamError(
        fmt::format("found a lift that ends {:.6g}° from its start; expected a step above 0", lift.stroke() / degree));
  if (whole < 1 || std::fabs(pitches - whole) > pitch_tolerance * std::max(1.0, pitches))
    throw CamError(misfit(m, lift.stroke()));
  const int paths = std::gcd(whole, m.rollers);
  return {m.rollers / paths, paths};
}

namespace {

// Every sample of every path near the cam, until `refuses` throws.
template <class Refuses>
void for_each_sample(const StepMechanism& m, const SampledLift& lift, std::span<const StepProfile> profiles,
                     Refuses refuses) {
  for (const StepProfile& profile : profiles)
    for (int k = 0; k < m.rollers; ++k)
      for (std::size_t i = 0; i < lift.psi.size(); ++i) {
        const RollerPoint p = roller_at(m, m.base(profile.row) + k * m.pitch(), lift.psi[i], lift.states[i]);
        if (std::fabs(around_zero(p.arm_angle)) > 0.25 * turn) continue;
        refuses(profile, p, [&] {
          return fmt::format("at {:.5g}° of the cam, roller {} of row {} {:.4g}° from the line between the axes",
                             lift.psi[i] / degree, k + 1, profile.row + 1, around_zero(p.arm_angle) / degree);
        });
      }
}

}  // namespace

void require_buildable(const StepMechanism& m, const SampledLift& lift, std::span<const StepProfile> profiles) {
  const double c = m.roller_radius;
  for_each_sample(m, lift, profiles, [&](const StepProfile&, const RollerPoint& p, auto place) {
    if (p.turning > 0.0) return;
    throw CamError(
        fmt::format("found a pitch path that turns back, phi' = {:.4g}, {}; expected more than 0: a smaller "
                    "stroke, a longer rise, a law with less peak speed or a shorter arm. The lift's speed there "
                    "is {:.4g}; on the line between the axes {:.4g} is the most",
                    p.turning, place(), std::fabs(p.arm_speed), (m.axis_distance - m.arm) / m.arm));
  });
  for_each_sample(m, lift, profiles, [&](const StepProfile& profile, const RollerPoint& p, auto place) {
    if (c * p.curvature < 1.0) return;
    const Point contact = p.contact(c);
    if (sim::magnitude(contact) > profile.radius_at(sim::angle_of(contact)) + on_profile) return;
    throw CamError(
        fmt::format("found an undercut profile, the pitch path's radius of {:.4g} mm is not above the roller's "
                    "{:.4g} mm, {}; expected a larger one: thinner rollers, a longer rise or a law with less "
                    "acceleration",
                    1e3 / p.curvature, 1e3 * c, place()));
  });
}

void require_held(const StepMechanism& m, const std::vector<ContactSet>& contacts) {
  std::size_t lost = 0;
  double first = 0.0;
  std::string missing;
  for (const ContactSet& set : contacts) {
    bool touched[2] = {false, false};
    for (const Contact& contact : set.contacts) touched[contact.cam] = true;
    const bool up = set.pushing(1) != nullptr, down = set.pushing(-1) != nullptr;
    if (touched[0] && touched[1] && up && down) continue;
    if (lost++ > 0) continue;
    first = set.psi;
    missing = !touched[0] || !touched[1] ? fmt::format("no contact with cam {}", touched[0] ? 2 : 1)
                                         : fmt::format("no contact that pushes the carousel {}", up ? "back" : "on");
  }
  if (lost == 0) return;
  throw CamError(
      fmt::format("found {} at {:.5g}° of the cam, and a loose carousel in {:.3g} % of the turn; expected both "
                  "cams in contact at every angle, one pushing each way{}",
                  missing, first / degree, 100.0 * static_cast<double>(lost) / static_cast<double>(contacts.size()),
                  m.against ? ": rows half a pitch apart and rollers at rest a quarter of a pitch from the line "
                              "between the axes hold it"
                            : ": the carousel has to turn against the cam"));
}

}  // namespace stiction::host::step
