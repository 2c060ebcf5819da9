#include "host/cam/step/lead_in.hpp"

#include <algorithm>

namespace stiction::host::step {
namespace {

// Of the cam's angle behind the corner: what a roller's own roundness spreads its entry over.
constexpr double entry = 1.0 * degree;
constexpr int looks = 40;

}  // namespace

std::vector<LeadIn> lead_ins(const StepMechanism& mechanism, const StepLift& lift,
                             const std::array<StepProfile, 2>& cut, const std::array<StepProfile, 2>& relieved,
                             double late) {
  std::vector<LeadIn> all;
  const ContactSearch before(mechanism, lift, cut), after(mechanism, lift, relieved);
  for (const StepProfile& profile : cut)
    for (const ProfileVertex& vertex : profile.vertices)
      for (const bool forwards : {true, false}) {
        const auto count = profile.points.size();
        const ProfilePoint& first = profile.points[forwards ? vertex.behind : (vertex.behind + count - 1) % count];
        LeadIn led{profile.row, vertex.angle, forwards};
        for (int k = 0; k <= looks; ++k) {
          const double psi = wrapped(first.psi + (forwards ? entry : -entry) * k / looks);
          const RollerPoint at =
              roller_at(mechanism, mechanism.base(profile.row) + first.roller * mechanism.pitch(), psi, lift.at(psi));
          const double nearer = late * std::fabs(at.push(psi));
          led.cut = std::max(led.cut, nearer - before.gap_of(profile.row, at, late));
          led.relieved = std::max(led.relieved, nearer - after.gap_of(profile.row, at, late));
        }
        all.push_back(led);
      }
  return all;
}

}  // namespace stiction::host::step
