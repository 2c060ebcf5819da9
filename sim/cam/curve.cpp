#include "sim/cam/curve.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace stiction::sim::cam {

Curve::Curve(std::vector<Piece> pieces) : pieces_(std::move(pieces)) {
  if (pieces_.empty()) throw std::invalid_argument("found a curve of no piece; expected one or more");
  for (std::size_t k = 0; k < pieces_.size(); ++k) {
    if (!(pieces_[k].length() > 0.0)) throw std::invalid_argument("found a piece of no length; expected end > begin");
    if (k == 0) continue;
    const double gap = pieces_[k].begin - pieces_[k - 1].end;
    if (absolute(gap) > 1e-12 * (absolute(pieces_[k].begin) + length()))
      throw std::invalid_argument("found a gap between pieces; expected each to begin where the last one ends");
    // A rounding of the scaling; a joint is one number.
    (pieces_[k].from_end ? pieces_[k].begin : pieces_[k - 1].end) =
        pieces_[k].from_end ? pieces_[k - 1].end : pieces_[k].begin;
  }
}

std::size_t Curve::piece_at(double x, Side side) const {
  const auto before = [&](const Piece& piece) { return side == Side::right ? piece.end <= x : piece.end < x; };
  const auto found = std::partition_point(pieces_.begin(), pieces_.end(), before);
  return static_cast<std::size_t>(std::min(found - pieces_.begin(), std::ssize(pieces_) - 1));
}

Curve Curve::placed(const Placement& placement) const {
  std::vector<Piece> pieces;
  for (const Piece& piece : pieces_) pieces.push_back(cam::placed(piece, placement));
  return Curve(std::move(pieces));
}

Curve Curve::mirrored() const {
  std::vector<Piece> pieces;
  for (auto piece = pieces_.rbegin(); piece != pieces_.rend(); ++piece)
    pieces.push_back(cam::mirrored(*piece, begin() + end()));
  return Curve(std::move(pieces));
}

Curve Curve::with_line(double slope) const {
  std::vector<Piece> pieces = pieces_;
  for (Piece& piece : pieces) add_line(piece, slope, begin());
  return Curve(std::move(pieces));
}

Curve joined(const Curve& first, const Curve& second) {
  std::vector<Piece> pieces = first.pieces();
  pieces.insert(pieces.end(), second.pieces().begin(), second.pieces().end());
  return Curve(std::move(pieces));
}

Curve symmetric(const std::vector<Piece>& half) {
  std::vector<Piece> pieces = half;
  for (auto piece = half.rbegin(); piece != half.rend(); ++piece)
    pieces.push_back(placed(mirrored(*piece, 1.0), {.gain = -1.0, .offset = 1.0}));
  return Curve(std::move(pieces));
}

Curve even(const std::vector<Piece>& half) {
  std::vector<Piece> pieces = half;
  for (auto piece = half.rbegin(); piece != half.rend(); ++piece) pieces.push_back(mirrored(*piece, 1.0));
  return Curve(std::move(pieces));
}

Piece polynomial_piece(double begin, double end, std::vector<double> coefficients) {
  return {.begin = begin, .end = end, .polynomial = std::move(coefficients)};
}

}  // namespace stiction::sim::cam
