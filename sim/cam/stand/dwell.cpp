#include "sim/cam/stand/dwell.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/cam/characteristics.hpp"

namespace stiction::sim::cam {
namespace {

// Whether the piece moves by less than rounding, of the range of the whole motion.
bool rests(const Piece& piece, double range) {
  if (!piece.bells.empty()) return false;
  for (const double share : {0.0, 0.13, 0.5, 0.87, 1.0})
    if (std::fabs(piece.derivative(piece.begin + share * piece.length(), 1)) * piece.length() > 1e-12 * range)
      return false;
  return true;
}

}  // namespace

std::optional<Dwell> longest_dwell(const Motion& motion) {
  const auto& curve = motion.curve;
  const auto positions = extremes(curve, 0);
  const double range = positions.highest.value - positions.lowest.value;
  std::vector<Dwell> dwells;
  bool resting = false;
  for (const Piece& piece : curve.pieces()) {
    const bool rest = rests(piece, range);
    if (rest && resting)
      dwells.back().length += piece.length();
    else if (rest)
      dwells.push_back({piece.begin, piece.length()});
    resting = rest;
  }
  if (dwells.empty()) return std::nullopt;
  // Over the seam.
  if (motion.cam.periodic && dwells.size() > 1 && resting && dwells.front().begin == curve.begin()) {
    dwells.back().length += dwells.front().length;
    dwells.erase(dwells.begin());
  }
  return *std::max_element(dwells.begin(), dwells.end(),
                           [](const Dwell& a, const Dwell& b) { return a.length < b.length; });
}

DwellFigures dwell_figures(const std::vector<LoadState>& states, const Motion& motion, const Dwell& dwell) {
  const auto& curve = motion.curve;
  const double cycle = curve.length(), rise = curve.derivative(curve.end(), 0, Side::left) - curve(curve.begin());
  const double rounding = 1e-9 * cycle;
  // States of a clocked drive may end a step before the cycle does.
  const double step = states.size() > 1 ? states.back().master - states[states.size() - 2].master : 0.0;
  const double whole = std::floor((states.back().master + step - dwell.end() + rounding) / cycle);
  const double begin = dwell.begin + whole * cycle, end = dwell.end() + whole * cycle;
  const double wanted = curve(dwell.begin) + whole * rise;
  DwellFigures figures;
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest, mean = 0.0;
  const LoadState* last = nullptr;
  for (const LoadState& state : states) {
    if (state.master < begin - rounding || state.master > end + rounding) continue;
    lowest = std::min(lowest, state.position);
    highest = std::max(highest, state.position);
    if (last != nullptr) {
      const double length = 0.5 * (state.master - last->master);
      figures.quality += length * (std::fabs(state.position - wanted) + std::fabs(last->position - wanted));
      mean += length * (state.position + last->position - 2.0 * wanted);
    }
    last = &state;
  }
  if (last != nullptr) {
    figures.peak_to_peak = highest - lowest;
    figures.mean = mean / dwell.length;
  }
  return figures;
}

}  // namespace stiction::sim::cam
