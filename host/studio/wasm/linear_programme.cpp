// The page has no solver of linear programmes: who asks for the lift that one finds is told so.
#include "sim/cam/law.hpp"
#include "sim/cam/shaping/band_optimal.hpp"

namespace stiction::sim::cam {

std::optional<OptimalLift> band_optimal_lift(const ShapingTask&) {
  throw CamError(
      "found a page, which solves no linear programmes; expected `stiction cam shape --method band-optimal`");
}

}  // namespace stiction::sim::cam
