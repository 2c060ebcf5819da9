#include "host/diagnose/spectrum/wave_sums.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/FFT>

namespace stiction::host {
namespace {

using Complex = std::complex<double>;

// Of the bell curve exp(-narrowness d^2), d in cells: with twice the cells that the orders need it is as small at its
// ends as what the grid folds back.
constexpr double narrowness(std::size_t reach) { return 0.75 * std::numbers::pi / static_cast<double>(reach); }

// Keeps its tables from scan to scan.
Eigen::FFT<double>& plans() {
  thread_local Eigen::FFT<double> fft(Eigen::FFT<double>::impl_type(), Eigen::FFT<double>::Unscaled);
  return fft;
}

// The transform of the bell curve at an order.
double spread(double narrowness, double order, double cells) {
  const double angle = std::numbers::pi * order / cells;
  return std::sqrt(std::numbers::pi / narrowness) * std::exp(-angle * angle / narrowness);
}

// Of WavePower: tens of megabytes, which cost as much to get anew as to fill.
struct Room {
  std::vector<double> grid;
  std::vector<Complex> spectrum;
  Eigen::FFT<double> fft{
      Eigen::FFT<double>::impl_type(),
      static_cast<Eigen::FFT<double>::Flag>(Eigen::FFT<double>::Unscaled | Eigen::FFT<double>::HalfSpectrum)};
};
Room& room() {
  thread_local Room room;
  return room;
}

}  // namespace

std::size_t power_of_two(std::size_t at_least) {
  std::size_t n = 1;
  while (n < at_least) n *= 2;
  return n;
}

double gain_of(Complex moment, Complex twice, double square) {
  const double cc = 0.5 * (square + twice.real()), ss = 0.5 * (square - twice.real()), cs = 0.5 * twice.imag();
  const double determinant = cc * ss - cs * cs;
  if (determinant <= 1e-6 * square * square) return 0.0;
  const double cr = moment.real(), sr = moment.imag();
  return (ss * cr * cr - 2.0 * cs * cr * sr + cc * sr * sr) / determinant;
}

WaveSums::WaveSums(double step, double highest_order)
    : cells_(power_of_two(static_cast<std::size_t>(16.0 * highest_order / step) + 1) / bins_per_cell),
      bins_per_metre_(step * static_cast<double>(cells_ * bins_per_cell)),
      grid_(cells_) {
  for (std::size_t bin = 0; bin < bins_per_cell; ++bin)
    for (std::size_t i = 0; i < 2 * reach; ++i) {
      const double away = static_cast<double>(i) + 1.0 - static_cast<double>(reach) -
                          static_cast<double>(bin) / static_cast<double>(bins_per_cell);
      bell_[bin][i] = std::exp(-narrowness(reach) * away * away);
    }
}

void WaveSums::transform(const Eigen::VectorXd& place, const Eigen::VectorXd& one, const Eigen::VectorXd& other) {
  // Of like size, so that neither is lost in the other's rounding.
  size_ = {std::max(one.lpNorm<1>(), 1e-300), std::max(other.lpNorm<1>(), 1e-300)};
  std::fill(grid_.begin(), grid_.end(), 0.0);
  for (Eigen::Index i = 0; i < place.size(); ++i) {
    const Eigen::Vector2d weight(one[i] / size_[0], other[i] / size_[1]);
    if (weight.isZero(0.0)) continue;
    const auto bin = static_cast<std::size_t>(std::lround(place[i] * bins_per_metre_));
    // All lie reach - 1 cells further on, where none is below 0.
    auto* const cell = reinterpret_cast<double*>(&grid_[bin / bins_per_cell]);
    Eigen::Map<Eigen::Matrix<double, 2, 2 * reach>>(cell) += weight.lazyProduct(bell_[bin % bins_per_cell]);
  }
  plans().inv(spectrum_, grid_);  // e^(+i ..)
}

Complex WaveSums::one(std::size_t order) const {
  return size_[0] * 0.5 * (spectrum_[order] + std::conj(mirrored(order))) /
         spread(narrowness(reach), static_cast<double>(order), static_cast<double>(cells_));
}

Complex WaveSums::other(std::size_t order) const {
  return size_[1] * Complex(0.0, -0.5) * (spectrum_[order] - std::conj(mirrored(order))) /
         spread(narrowness(reach), static_cast<double>(order), static_cast<double>(cells_));
}

WavePower::WavePower(double step, std::size_t highest) : step_(step), cells_(power_of_two(4 * highest)) {}

void WavePower::transform(const Eigen::VectorXd& place, const Eigen::VectorXd& weight, const Eigen::VectorXd& slope) {
  auto& [grid, spectrum, fft] = room();
  grid.assign(cells_, 0.0);
  const double narrow = narrowness(reach), cells_per_metre = step_ * static_cast<double>(cells_);
  std::array<double, 2 * reach> bell{};
  for (std::size_t i = 0; i < bell.size(); ++i) {
    const double away = static_cast<double>(i) + 1.0 - static_cast<double>(reach);
    bell[i] = std::exp(-narrow * away * away);
  }
  for (Eigen::Index i = 0; i < place.size(); ++i) {
    if (weight[i] == 0.0 && slope[i] == 0.0) continue;
    const double at = place[i] * cells_per_metre, cell = std::floor(at), past = at - cell;
    // exp(-narrow (away - past)^2), away a number of cells, in its three factors.
    const double by_step = std::exp(2.0 * narrow * past);
    double factor = std::exp(-narrow * past * past - 2.0 * narrow * past * (static_cast<double>(reach) - 1.0));
    const double rise = 2.0 * narrow * cells_per_metre * slope[i];
    double* const first = &grid[static_cast<std::size_t>(cell)];
    for (std::size_t k = 0; k < bell.size(); ++k, factor *= by_step) {
      const double away = static_cast<double>(k) + 1.0 - static_cast<double>(reach) - past;
      first[k] += bell[k] * factor * (weight[i] + rise * away);
    }
  }
  fft.fwd(spectrum, grid);
}

double WavePower::at(std::size_t order) const {
  const double spread_by = spread(narrowness(reach), static_cast<double>(order), static_cast<double>(cells_));
  return std::norm(room().spectrum[order]) / (spread_by * spread_by);
}

}  // namespace stiction::host
