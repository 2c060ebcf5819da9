// 1 - exp(-a) for the steps of relaxing states, where it takes a large part of a simulation's time.
#pragma once

#include <algorithm>

namespace stiction::sim {

namespace detail {

// a / (1 - exp(-a)) up to `longest`: exact at 0, minimax to 1.9e-8. Its series 1 + a / 2 + a^2 / 12 - a^4 / 720 has no
// third power, so that two terms do what the inverse needs three for, and the division takes the place of a product.
inline constexpr double longest = 0.117;
inline constexpr double divisor_c1 = 0.50000150353258043, divisor_c2 = 0.083302942132800786;
constexpr double relaxation_divisor(double a) { return 1.0 + a * (divisor_c1 + a * divisor_c2); }

}  // namespace detail

// For a >= 0, relative error below 2e-8, which is less than what the step itself leaves. Steps are short, so a is small
// most of the time: there the series is. Longer steps are halved until it holds and put together again,
// 1 - exp(-2 a) = s + s (1 - s), which lets no relative error grow and ends at 1 (s (2 - s) can stop a bit before it).
// Nothing is called: a call costs the loop around it its registers.
inline double one_minus_exp(double a) {
  int doublings = 0;
  if (a > detail::longest) [[unlikely]] {
    for (a = std::min(a, 64.0); a > detail::longest; a *= 0.5) ++doublings;  // exp(-64) is nothing beside 1
  }
  double s = a / detail::relaxation_divisor(a);
  for (; doublings > 0; --doublings) s += s * (1.0 - s);
  return s;
}

// The same for where it is seldom needed: as a function without effects that is called, its loop costs what stands
// around it neither registers nor stores. Inline it cost LuGre's circle 30 instructions a tick.
[[gnu::const, gnu::noinline]] inline double seldom_one_minus_exp(double a) { return one_minus_exp(a); }

// a / (1 - exp(-a)), the rate of a relaxation at the beginning of a step in units of its mean over the step.
[[gnu::always_inline]] inline double relaxation_divisor(double a) {
  if (a > detail::longest) [[unlikely]]
    return a / seldom_one_minus_exp(a);
  return detail::relaxation_divisor(a);
}

}  // namespace stiction::sim
