#include "sim/cam/modification.hpp"

namespace stiction::sim::cam {
namespace {

// The first half of the law over [0, t]: slope * x + (V - slope) / Cv * 2 t f(x / 2 t), so that its speed begins with
// `slope` and ends with V.
std::vector<Piece> first_part(const Curve& law, double t, double slope, double speed_gain) {
  std::vector<Piece> pieces;
  for (const Piece& piece : law.pieces()) {
    if (piece.begin >= 0.5) break;
    pieces.push_back(placed(piece, {.stretch = 2.0 * t, .gain = 2.0 * t * speed_gain}));
    add_line(pieces.back(), slope, 0.0);
  }
  return pieces;
}

}  // namespace

Curve modified(const Curve& law, const Modification& how) {
  if (how == Modification{}) return law;
  const double peak = law.derivative(0.5, 1);
  const double t1 = how.c * how.lambda, t2 = how.c - t1;
  const double mean = how.start_slope * t1 + how.end_slope * t2;
  const double speed = (1.0 - (1.0 - 1.0 / peak) * mean) / (how.c / peak + 1.0 - how.c);

  std::vector<Piece> pieces = first_part(law, t1, how.start_slope, (speed - how.start_slope) / peak);
  const double risen = pieces.back().derivative(pieces.back().end, 0);
  if (how.c < 1.0) pieces.push_back(polynomial_piece(t1, 1.0 - t2, {risen, speed}));
  const auto last = first_part(law, t2, how.end_slope, (speed - how.end_slope) / peak);
  for (auto piece = last.rbegin(); piece != last.rend(); ++piece)
    pieces.push_back(placed(mirrored(*piece, 1.0), {.gain = -1.0, .offset = 1.0}));
  return Curve(std::move(pieces));
}

}  // namespace stiction::sim::cam
