#include "sim/cam/stand/transfer_function.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stiction::sim::cam {
namespace {

using Complex = std::complex<double>;

template <std::size_t n>
Complex polynomial(const std::array<double, n>& coefficients, Complex s) {
  Complex sum = 0.0;
  for (std::size_t k = n; k-- > 0;) sum = sum * s + coefficients[k];
  return sum;
}

// Roots by the iteration of Weierstrass, Durand and Kerner from points on a circle, in units of their geometric mean.
std::vector<Complex> roots(std::vector<double> coefficients) {
  while (coefficients.size() > 1 && coefficients.back() == 0.0) coefficients.pop_back();
  const std::size_t degree = coefficients.size() - 1;
  if (degree == 0) return {};
  const double scale = power(std::fabs(coefficients.front() / coefficients.back()), 1.0 / static_cast<double>(degree));
  const double highest = coefficients.back() * power(scale, static_cast<double>(degree));
  std::vector<Complex> monic(degree + 1);
  for (std::size_t k = 0; k <= degree; ++k) monic[k] = coefficients[k] * power(scale, static_cast<double>(k)) / highest;
  std::vector<Complex> found(degree, 1.0);
  for (std::size_t k = 1; k < degree; ++k) found[k] = found[k - 1] * Complex(0.4, 0.9);
  constexpr int most_steps = 500;
  for (int step = 0; step < most_steps; ++step) {
    double moved = 0.0;
    for (std::size_t i = 0; i < degree; ++i) {
      Complex value = 0.0, product = 1.0;
      for (std::size_t k = degree + 1; k-- > 0;) value = value * found[i] + monic[k];
      for (std::size_t j = 0; j < degree; ++j)
        if (j != i) product *= found[i] - found[j];
      const Complex change = quotient(value, product);
      found[i] -= change;
      moved = std::max(moved, magnitude(change) / (1.0 + magnitude(found[i])));
    }
    if (moved < 1e-15) break;
  }
  for (Complex& root : found) {
    root *= scale;
    if (std::fabs(root.imag()) < 1e-9 * magnitude(root)) root = root.real();
  }
  std::sort(found.begin(), found.end(), [](const Complex& a, const Complex& b) {
    if (std::fabs(a.real() - b.real()) > 1e-9 * magnitude(a)) return a.real() > b.real();
    return a.imag() > b.imag();
  });
  return found;
}

}  // namespace

Complex TransferFunction::at(Complex s) const { return quotient(polynomial(numerator, s), polynomial(denominator, s)); }

std::vector<Complex> TransferFunction::poles() const { return roots({denominator.begin(), denominator.end()}); }

std::vector<Complex> TransferFunction::zeros() const { return roots({numerator.begin(), numerator.end()}); }

TransferFunction transfer_function(const ElasticDrive& drive) {
  const double z = drive.load_inertia, j = drive.rotor_inertia, k_h = drive.shaft_stiffness, b_h = drive.shaft_damping;
  const double k_d = drive.drive_stiffness, b_d = drive.drive_damping;
  TransferFunction g;
  // (b_D s + k_D)(b_H s + k_H) over (J s^2 + b s + k)(I_Z s^2 + b_H s + k_H) + I_Z s^2 (b_H s + k_H).
  g.numerator = {k_d * k_h, b_d * k_h + b_h * k_d, b_d * b_h};
  g.denominator = {k_d * k_h, b_d * k_h + b_h * k_d, k_h * j + k_d * z + b_d * b_h + k_h * z,
                   b_h * j + b_d * z + b_h * z, j * z};
  return g;
}

TransferFunction printed_transfer_function(const StudyParameters& study) {
  const double p2 = study.ratio * study.ratio, rp = study.rotor_inertia, z = study.load_inertia;
  const double k_m = study.drive_stiffness, b_m = study.drive_damping;
  const double k_h = study.shaft_stiffness, b_h = study.shaft_damping;
  TransferFunction g;
  g.numerator = {k_m * k_h, b_m * k_h + b_h * k_m, b_m * b_h};
  g.denominator = {k_m * k_h, b_m * k_h + b_h * k_m, k_h * rp + k_m * z + b_m * b_h + p2 * k_h * z,
                   b_h * rp + b_m * z + p2 * b_h * z, rp * z};
  return g;
}

StudyParameters study_parameters(const ElasticDrive& drive, double ratio) {
  const double square = ratio * ratio;
  return {.rotor_inertia = drive.rotor_inertia * square,
          .load_inertia = drive.load_inertia,
          .drive_stiffness = drive.drive_stiffness * square,
          .drive_damping = drive.drive_damping * square,
          .shaft_stiffness = drive.shaft_stiffness,
          .shaft_damping = drive.shaft_damping,
          .ratio = ratio};
}

double Mode::period() const { return 2.0 * std::numbers::pi / pole.imag(); }

Mode load_mode(const ElasticDrive& drive) {
  Mode mode;
  for (const Complex& pole : transfer_function(drive).poles())
    if (pole.imag() > 0.0 && (mode.pole == 0.0 || Mode{pole}.damping_ratio() < mode.damping_ratio())) mode.pole = pole;
  if (mode.pole == 0.0) throw StandError("found a drive without a pole that vibrates; expected one to shape for");
  return mode;
}

}  // namespace stiction::sim::cam
