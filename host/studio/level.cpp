#include "host/studio/level.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

namespace stiction::host {
namespace {

using sim::cam::Cam;
using sim::cam::CamError;

bool moves(const sim::cam::Segment& segment) { return segment.rise() != 0.0 || segment.law != "linear"; }

Cam consistent(Cam cam) {
  if (const auto problem = problem_of(cam); !problem.empty()) throw CamError(problem);
  return cam;
}

}  // namespace

Cam with_level(const Cam& cam, std::size_t at, double position) {
  const std::size_t n = cam.segments.size();
  if (at >= n) throw CamError(fmt::format("found segment {} of {}; expected one of them", at + 1, n));
  Cam result = cam;
  const double change = position - cam.position_of(at + 1);
  if (change == 0.0) return result;
  std::optional<std::size_t> before, behind;
  for (std::size_t k = at + 1; k-- > 0 && !before;)
    if (moves(cam.segments[k])) before = k;
  for (std::size_t k = at + 1; k < n && !behind; ++k)
    if (moves(cam.segments[k])) behind = k;
  // A motion that begins at rest is lifted as a whole there; its last level is the first one of the next cycle.
  if (!before && !behind) {
    result.start += change;
    return consistent(std::move(result));
  }
  if (before)
    result.segments[*before].stroke += change;
  else
    result.start += change;
  if (behind) {
    result.segments[*behind].stroke -= change;
  } else if (cam.periodic && cam.modulo) {
    const double turns = std::nearbyint((cam.position_of(n) - cam.start) / *cam.modulo);
    const double rise = result.position_of(n) - result.start;
    // A cycle that advances by nothing may advance by whole multiples of the modulo.
    if (turns == 0.0) return consistent(std::move(result));
    if (!(rise / turns > 0.0)) throw CamError("found a cycle without advance; expected one of the modulo's direction");
    result.modulo = rise / turns;
  } else if (cam.periodic && before) {
    throw CamError("found the level at which the cycle closes; expected a different one, or a different start");
  }
  // The level before the first movement is that behind the last one.
  if (!before && cam.periodic && !cam.modulo)
    for (std::size_t k = n; k-- > 0;)
      if (moves(cam.segments[k])) {
        result.segments[k].stroke += change;
        break;
      }
  return consistent(std::move(result));
}

Cam with_cycle(const Cam& cam, double length) {
  if (!(length > 0.0)) throw CamError(fmt::format("found a cycle of {}; expected more than 0", length));
  Cam result = cam;
  const double factor = length / cam.cycle();
  for (auto& segment : result.segments) {
    if (segment.points) throw CamError("found a table of points; expected laws, of which the length can be changed");
    segment.length *= factor;
  }
  for (auto& track : result.tracks) {
    for (auto& window : track.windows) window.first *= factor, window.last *= factor;
    track.hysteresis *= factor;
  }
  return consistent(std::move(result));
}

}  // namespace stiction::host
