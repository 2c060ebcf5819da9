#include "sim/cam/check.hpp"

#include <array>
#include <cmath>

namespace stiction::sim::cam {
namespace {

class JumpFinder {
 public:
  JumpFinder(const Motion& motion, double tolerance)
      : motion_(motion), sizes_(derivative_sizes(motion.curve)), tolerance_(tolerance) {}

  void compare(double x, const std::array<double, 4>& before, const std::array<double, 4>& behind, JumpPlace where,
               std::size_t segment) {
    for (std::size_t order = 0; order < 4; ++order) {
      const double height = behind[order] - before[order];
      if (std::fabs(height) > tolerance_ * sizes_[order])
        jumps.push_back({{x, static_cast<int>(order), height},
                         where,
                         segment,
                         sizes_[order] > 0.0 ? std::fabs(height) / sizes_[order] : 1.0});
    }
  }

  static std::array<double, 4> state(const Piece& piece, double x) {
    return {piece.derivative(x, 0), piece.derivative(x, 1), piece.derivative(x, 2), piece.derivative(x, 3)};
  }

  void seam(double rise_beyond_turns) {
    const auto& pieces = motion_.curve.pieces();
    auto before = state(pieces.back(), pieces.back().end);
    const auto behind = state(pieces.front(), pieces.front().begin);
    before[0] -= rise_beyond_turns;
    compare(motion_.curve.end(), before, behind, JumpPlace::seam, motion_.segments.size() - 1);
  }

  // A cam that runs once begins and ends at rest, as it is what comes before and behind it.
  void ends() {
    const auto& pieces = motion_.curve.pieces();
    const auto first = state(pieces.front(), pieces.front().begin), last = state(pieces.back(), pieces.back().end);
    compare(motion_.curve.begin(), {first[0], 0.0, 0.0, 0.0}, first, JumpPlace::ends, 0);
    compare(motion_.curve.end(), last, {last[0], 0.0, 0.0, 0.0}, JumpPlace::ends, motion_.segments.size() - 1);
  }

  std::vector<MotionJump> jumps;

 private:
  const Motion& motion_;
  std::array<double, 4> sizes_;
  double tolerance_;
};

}  // namespace

std::vector<MotionJump> jumps_of(const Motion& motion, double tolerance) {
  JumpFinder finder(motion, tolerance);
  const Cam& cam = motion.cam;
  if (!cam.periodic) finder.ends();
  const auto& pieces = motion.curve.pieces();
  for (std::size_t k = 1; k < pieces.size(); ++k) {
    const std::size_t segment = motion.segment_of(k - 1);
    finder.compare(pieces[k].begin, JumpFinder::state(pieces[k - 1], pieces[k - 1].end),
                   JumpFinder::state(pieces[k], pieces[k].begin),
                   segment == motion.segment_of(k) ? JumpPlace::inside : JumpPlace::joint, segment);
  }
  if (cam.periodic) {
    const double rise = motion.curve.derivative(motion.curve.end(), 0, Side::left) - motion.curve(motion.curve.begin());
    finder.seam(cam.modulo ? *cam.modulo * std::nearbyint(rise / *cam.modulo) : 0.0);
  }
  return std::move(finder.jumps);
}

std::string_view derivative_name(int order) {
  constexpr std::string_view names[] = {"position", "speed", "acceleration", "jerk"};
  return names[order];
}

std::string_view name_of(JumpPlace place) {
  constexpr std::string_view names[] = {"inside a law", "between segments", "over the seam", "at the ends"};
  return names[static_cast<std::size_t>(place)];
}

}  // namespace stiction::sim::cam
