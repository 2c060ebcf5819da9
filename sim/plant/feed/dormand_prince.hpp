// One step of the method of Dormand and Prince, of order 5 with an error estimate of order 4 (Hairer, Norsett, Wanner,
// Solving Ordinary Differential Equations I, table 5.2).
#pragma once

#include <array>
#include <cstddef>

namespace stiction::sim {

template <std::size_t N>
struct DormandPrinceStep {
  std::array<double, N> state;       // at the end of the step
  std::array<double, N> derivative;  // there
  std::array<double, N> error;       // estimate of the step's error
};

// From `state` with `derivative` over `h`; `f(state)` gives the derivative.
template <std::size_t N, class F>
DormandPrinceStep<N> dormand_prince(const std::array<double, N>& state, const std::array<double, N>& derivative,
                                    double h, F&& f) {
  static constexpr double a[6][6] = {
      {1.0 / 5.0},
      {3.0 / 40.0, 9.0 / 40.0},
      {44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0},
      {19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0},
      {9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0},
      {35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0}};
  static constexpr double e[7] = {71.0 / 57600.0,      0.0,          -71.0 / 16695.0, 71.0 / 1920.0,
                                  -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0};
  std::array<std::array<double, N>, 7> k;
  k[0] = derivative;
  std::array<double, N> at{};
  for (std::size_t stage = 0; stage < 6; ++stage) {
    for (std::size_t i = 0; i < N; ++i) {
      double sum = 0.0;
      for (std::size_t j = 0; j <= stage; ++j) sum += a[stage][j] * k[j][i];
      at[i] = state[i] + h * sum;
    }
    k[stage + 1] = f(at);
  }
  DormandPrinceStep<N> step{at, k[6], {}};
  for (std::size_t i = 0; i < N; ++i)
    for (std::size_t j = 0; j < 7; ++j) step.error[i] += h * e[j] * k[j][i];
  return step;
}

}  // namespace stiction::sim
