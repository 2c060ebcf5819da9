// A motion over the master: pieces that follow each other without a gap. What a lift law, a table of points and a whole
// cam are when they are evaluated.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "sim/cam/piece.hpp"

namespace stiction::sim::cam {

enum class Side { left, right };

class Curve {
 public:
  Curve() = default;
  // Throws std::invalid_argument without a piece, and for pieces of no length or with gaps between them.
  explicit Curve(std::vector<Piece> pieces);

  const std::vector<Piece>& pieces() const { return pieces_; }
  double begin() const { return pieces_.front().begin; }
  double end() const { return pieces_.back().end; }
  double length() const { return end() - begin(); }

  // The piece at the master's place `x`; at a joint the one on that `side` of it. Logarithmic in their number. Beyond
  // the ends the first or last one.
  std::size_t piece_at(double x, Side side = Side::right) const;

  // The derivative of `order` at `x`, at a joint that of the piece on that `side`.
  double derivative(double x, int order, Side side = Side::right) const {
    return pieces_[piece_at(x, side)].derivative(x, order);
  }
  double operator()(double x) const { return derivative(x, 0); }

  // The curve over a different part of the master and with a different stroke (Placement).
  Curve placed(const Placement& placement) const;
  // Read backwards between the same ends.
  Curve mirrored() const;
  // y + slope * (x - begin()).
  Curve with_line(double slope) const;

 private:
  std::vector<Piece> pieces_;
};

// One curve behind the other; the second begins where the first ends.
Curve joined(const Curve& first, const Curve& second);

// A law on [0, 1] from its first half on [0, 1/2], which rises from 0 to 1/2: f(x) = 1 - f(1 - x).
Curve symmetric(const std::vector<Piece>& half);

// A rise and return on [0, 1] from its first half: f(x) = f(1 - x).
Curve even(const std::vector<Piece>& half);

// One piece on [begin, end] that is the polynomial in x - begin with these `coefficients`, of the constant first.
Piece polynomial_piece(double begin, double end, std::vector<double> coefficients);

}  // namespace stiction::sim::cam
