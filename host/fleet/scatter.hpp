// How much the parameters of an axis differ from record to record, learned from the axis and from its fleet: the
// variance of each axis is drawn from the fleet's, so that an axis with few records borrows from the others (Smyth
// 2004, "moderated t").
#pragma once

#include <span>

namespace stiction::host {

// A variance and the degrees of freedom that it is worth.
struct Scatter {
  double variance = 0.0;
  double freedom = 0.0;  // 0: nothing is known
};

// The variance from which those of the axes are drawn (times an inverse chi square of its freedom): Smyth's moment
// estimate on the logarithms. `axes`: of each its own variance with its freedom; those without freedom or variance do
// not count. Without at least three axes nothing is known; the freedom is at most that of all axes together.
Scatter common_scatter(std::span<const Scatter> axes);

// `own` variance of an axis with the fleet's `common` one.
Scatter moderated(const Scatter& own, const Scatter& common);

double digamma(double x);   // x > 0
double trigamma(double x);  // x > 0
// The x > 0 with trigamma(x) = y; `y` above 0.
double inverse_trigamma(double y);

}  // namespace stiction::host
