#include "host/sweep/samples.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <numbers>

namespace stiction::host {
namespace {

// Polynomials and first direction numbers of the first rows of new-joe-kuo-6.21201 (Joe, Kuo 2008).
struct Directions {
  std::uint32_t polynomial;
  std::array<std::uint32_t, 7> first;
};
constexpr std::array<Directions, sobol_dimensions> direction_rows{{{1, {1}},
                                                                   {3, {1}},
                                                                   {7, {1, 3}},
                                                                   {11, {1, 3, 1}},
                                                                   {13, {1, 1, 1}},
                                                                   {19, {1, 1, 3, 3}},
                                                                   {25, {1, 3, 5, 13}},
                                                                   {37, {1, 1, 5, 5, 17}},
                                                                   {41, {1, 1, 5, 5, 5}},
                                                                   {47, {1, 1, 7, 11, 19}},
                                                                   {55, {1, 1, 5, 1, 1}},
                                                                   {59, {1, 1, 1, 3, 11}},
                                                                   {61, {1, 3, 5, 5, 31}},
                                                                   {67, {1, 3, 3, 9, 7, 49}},
                                                                   {91, {1, 1, 1, 15, 21, 21}},
                                                                   {97, {1, 3, 1, 13, 27, 49}},
                                                                   {103, {1, 1, 1, 15, 7, 5}},
                                                                   {109, {1, 3, 1, 15, 13, 25}},
                                                                   {115, {1, 1, 5, 5, 19, 61}},
                                                                   {131, {1, 3, 7, 11, 23, 15, 103}}}};

constexpr unsigned places = 32;
using Numbers = std::array<std::uint32_t, places>;

// All direction numbers of a row, by the recurrence of its polynomial (Bratley, Fox 1988).
constexpr Numbers numbers_of(const Directions& row) {
  Numbers m{};
  const auto degree = static_cast<unsigned>(std::bit_width(row.polynomial)) - 1;
  if (degree == 0) {
    m.fill(1);  // van der Corput
  } else {
    for (unsigned k = 0; k < places; ++k) {
      if (k < degree) {
        m[k] = row.first[k];
        continue;
      }
      std::uint32_t next = m[k - degree];
      for (unsigned j = 1; j <= degree; ++j)
        if ((row.polynomial >> (degree - j)) & 1U) next ^= m[k - j] << j;
      m[k] = next;
    }
  }
  for (unsigned k = 0; k < places; ++k) m[k] <<= places - 1 - k;
  return m;
}

constexpr std::array<Numbers, sobol_dimensions> direction_numbers = [] {
  std::array<Numbers, sobol_dimensions> all{};
  for (std::uint32_t k = 0; k < sobol_dimensions; ++k) all[k] = numbers_of(direction_rows[k]);
  return all;
}();

// The finalizer of SplitMix64 (Steele, Lea, Flood 2014): each bit of its result depends on each of its argument.
constexpr std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}

}  // namespace

std::uint32_t sobol_places(std::uint64_t point, std::uint32_t dimension) {
  std::uint32_t result = 0;
  std::uint64_t gray = point ^ (point >> 1U);
  for (unsigned k = 0; k < places && gray != 0; ++k, gray >>= 1U)
    if (gray & 1U) result ^= direction_numbers.at(dimension)[k];
  return result;
}

std::uint64_t permuted(std::uint64_t index, std::uint64_t count, std::uint64_t key) {
  if (count < 2) return index;
  const unsigned half = (static_cast<unsigned>(std::bit_width(count - 1)) + 1) / 2;
  const std::uint64_t mask = (std::uint64_t{1} << half) - 1;
  do {
    std::uint64_t left = index >> half, right = index & mask;
    for (std::uint64_t round = 0; round < 4; ++round) {
      const std::uint64_t next = left ^ (mixed(right ^ mixed(key + round)) & mask);
      left = right;
      right = next;
    }
    index = (left << half) | right;
  } while (index >= count);
  return index;
}

double sample(SampleMethod method, std::uint64_t point, std::uint64_t count, std::uint32_t dimension,
              std::uint64_t seed) {
  const std::uint64_t key = mixed(seed ^ mixed(dimension));
  if (method == SampleMethod::sobol) {
    const auto shift = static_cast<std::uint32_t>(mixed(key) >> 32U);
    return (static_cast<double>(sobol_places(point, dimension) ^ shift) + 0.5) * 0x1p-32;
  }
  const double within = (static_cast<double>(mixed(key ^ mixed(point)) >> 12U) + 0.5) * 0x1p-52;
  return (static_cast<double>(permuted(point, count, key)) + within) / static_cast<double>(count);
}

double normal_quantile(double probability) {
  constexpr std::array a{-3.969683028665376e+01, 2.209460984245205e+02,  -2.759285104469687e+02,
                         1.383577518672690e+02,  -3.066479806614716e+01, 2.506628277459239e+00};
  constexpr std::array b{-5.447609879822406e+01, 1.615858368580409e+02, -1.556989798598866e+02, 6.680131188771972e+01,
                         -1.328068155288572e+01};
  constexpr std::array c{-7.784894002430293e-03, -3.223964580411365e-01, -2.400758277161838e+00,
                         -2.549732539343734e+00, 4.374664141464968e+00,  2.938163982698783e+00};
  constexpr std::array d{7.784695709041462e-03, 3.224671290700398e-01, 2.445134137142996e+00, 3.754408661907416e+00};
  const auto polynomial = [](const auto& coefficients, double x) {
    double sum = 0.0;
    for (const double each : coefficients) sum = sum * x + each;
    return sum;
  };
  constexpr double tail = 0.02425;
  double x = 0.0;
  if (probability < tail || probability > 1.0 - tail) {
    const double q = std::sqrt(-2.0 * std::log(probability < tail ? probability : 1.0 - probability));
    x = polynomial(c, q) / (polynomial(d, q) * q + 1.0);
    if (probability > 0.5) x = -x;
  } else {
    const double q = probability - 0.5, r = q * q;
    x = polynomial(a, r) * q / (polynomial(b, r) * r + 1.0);
  }
  const double error = 0.5 * std::erfc(-x / std::numbers::sqrt2) - probability;
  const double u = error * std::sqrt(2.0 * std::numbers::pi) * std::exp(0.5 * x * x);
  return x - u / (1.0 + 0.5 * x * u);
}

}  // namespace stiction::host
