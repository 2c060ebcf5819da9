#include "sim/cam/shaping/input_shapers.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "sim/number/arithmetic.hpp"

namespace stiction::sim::cam {
namespace {

double kept(double damping_ratio, double periods) {
  return sim::exponential(-damping_ratio * 2.0 * std::numbers::pi * periods /
                          std::sqrt(1.0 - damping_ratio * damping_ratio));
}

// Impulses with these undamped shares, each less by what the vibration of the first has lost until then.
std::vector<Impulse> damped(std::vector<Impulse> impulses, double damping_ratio) {
  double sum = 0.0;
  for (Impulse& impulse : impulses) {
    impulse.share *= kept(damping_ratio, impulse.time);
    sum += impulse.share;
  }
  for (Impulse& impulse : impulses) impulse.share /= sum;
  return impulses;
}

std::vector<Impulse> zv(double z) { return damped({{0.0, 1.0}, {0.5, 1.0}}, z); }

std::vector<Impulse> mzv(double z) {
  const double outer = 1.0 - std::numbers::sqrt2 / 2.0, middle = std::numbers::sqrt2 - 1.0;
  return damped({{0.0, outer}, {0.375, middle}, {0.75, outer}}, z);
}

std::vector<Impulse> zvd(double z) { return damped({{0.0, 1.0}, {0.5, 2.0}, {1.0, 1.0}}, z); }

std::vector<Impulse> ei(double z) {
  constexpr double v = ei_tolerance;
  return damped({{0.0, 0.25 * (1.0 + v)}, {0.5, 0.5 * (1.0 - v)}, {1.0, 0.25 * (1.0 + v)}}, z);
}

std::vector<Impulse> two_hump_ei(double z) {
  constexpr double v = ei_tolerance;
  const double x = power(v * v * (std::sqrt(1.0 - v * v) + 1.0), 1.0 / 3.0);
  const double outer = (3.0 * x * x + 2.0 * x + 3.0 * v * v) / (16.0 * x);
  return damped({{0.0, outer}, {0.5, 0.5 - outer}, {1.0, 0.5 - outer}, {1.5, outer}}, z);
}

constexpr std::array<InputShaper, 5> shapers{
    {{"zv", zv}, {"mzv", mzv}, {"zvd", zvd}, {"ei", ei}, {"two-hump-ei", two_hump_ei}}};

}  // namespace

std::span<const InputShaper> input_shapers() { return shapers; }

}  // namespace stiction::sim::cam
