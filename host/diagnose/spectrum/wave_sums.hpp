// Sums of weights times waves over rows, at many orders (waves per unit of place) one after the other: what a line of a
// residual is looked for with.
#pragma once

#include <Eigen/Dense>
#include <array>
#include <complex>
#include <cstddef>
#include <vector>

namespace stiction::host {

std::size_t power_of_two(std::size_t at_least);

// What weight times (cosine, sine) takes off the residual's square, from the sums over residual times weight times
// wave, weight squared times the wave of twice the order, and weight squared. `moment`: scalar products of the waves
// with the residual.
double gain_of(std::complex<double> moment, std::complex<double> twice, double square);

// For all orders 0, step, 2 step, .. at once (Dutt, Rokhlin 1993; Greengard, Lee 2004): the places fall into bins, fine
// beside the shortest period that is looked at; each bin is spread over a coarser grid as a bell curve, whose transform
// is known and divided out of the grid's. Against the sums themselves over the bins that leaves 1e-10.
class WaveSums {
 public:
  WaveSums(double step, double highest_order);

  // Two sets of weights at `place` (m, from 0 to an eighth of 1/step). `one` and `other`: two real sequences.
  void transform(const Eigen::VectorXd& place, const Eigen::VectorXd& one, const Eigen::VectorXd& other);
  // Their sums, at an order that counts steps.
  std::complex<double> one(std::size_t order) const;
  std::complex<double> other(std::size_t order) const;

 private:
  static constexpr std::size_t bins_per_cell = 4;
  static constexpr std::size_t reach = 12;  // cells to either side

  std::complex<double> mirrored(std::size_t order) const { return spectrum_[order == 0 ? 0 : cells_ - order]; }

  std::size_t cells_;
  double bins_per_metre_;
  std::array<Eigen::Matrix<double, 1, 2 * reach>, bins_per_cell> bell_;
  std::array<double, 2> size_{};
  std::vector<std::complex<double>> grid_, spectrum_;  // of the one plus i times the other
};

// The square of | sum over rows of (weight + slope d/dx) exp(2 pi i order x) |, for all orders 0, step, 2 step, ..: of
// a great many at once, to a part in 1e5 of the largest. As above, but that each place is spread by itself, and the
// slope is spread as the bell curve's own.
class WavePower {
 public:
  // `highest`: order, counted in steps.
  WavePower(double step, std::size_t highest);

  // `place`: m, from 0 to half of 1/step; `weight` and `slope` of each.
  void transform(const Eigen::VectorXd& place, const Eigen::VectorXd& weight, const Eigen::VectorXd& slope);
  // At an order that counts steps.
  double at(std::size_t order) const;

 private:
  static constexpr std::size_t reach = 6;  // cells to either side

  double step_;
  std::size_t cells_;
};

}  // namespace stiction::host
