// A motion from the shape of its acceleration, part by part: each part is integrated twice in closed form, from the
// position and speed with which the part before it ends.
#pragma once

#include <utility>
#include <vector>

#include "sim/cam/curve.hpp"

namespace stiction::sim::cam {

class AccelerationProfile {
 public:
  // Rising or falling in a line from `first` to `last` over `length`; a part of no length is left out.
  AccelerationProfile& line(double length, double first, double last) {
    return length > 0.0 ? add(length, {0.5 * first, (last - first) / (6.0 * length)}, {}) : *this;
  }

  // peak * sin(rate * u + phase) + level, with u from 0 to `length`; rate in rad over the unit of length.
  AccelerationProfile& sine(double length, double peak, double rate, double phase, double level = 0.0) {
    return length > 0.0 ? add(length, {0.5 * level}, {{-peak / (rate * rate), rate, phase}}) : *this;
  }

  double length() const { return at_; }
  double height() const { return position_; }
  double speed() const { return speed_; }

  // The motion so far, with stroke `height`. What it rises to must not be 0.
  std::vector<Piece> scaled_to(double height) const {
    std::vector<Piece> result;
    for (const Piece& piece : pieces_) result.push_back(placed(piece, {.gain = height / position_}));
    return result;
  }

 private:
  AccelerationProfile& add(double length, std::vector<double> square_and_cube, std::vector<Wave> waves) {
    Piece piece{.begin = at_, .end = at_ + length, .polynomial = {0.0, 0.0}, .waves = std::move(waves)};
    piece.polynomial.insert(piece.polynomial.end(), square_and_cube.begin(), square_and_cube.end());
    piece.polynomial[0] = position_ - piece.derivative(at_, 0);
    piece.polynomial[1] = speed_ - piece.derivative(at_, 1);
    at_ += length;
    position_ = piece.derivative(at_, 0);
    speed_ = piece.derivative(at_, 1);
    pieces_.push_back(std::move(piece));
    return *this;
  }

  std::vector<Piece> pieces_;
  double at_ = 0.0, position_ = 0.0, speed_ = 0.0;
};

}  // namespace stiction::sim::cam
