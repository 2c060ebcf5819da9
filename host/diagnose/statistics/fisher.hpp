// Tail of Fisher's F distribution, by the continued fraction of the incomplete beta function (Press, Teukolsky,
// Vetterling, Flannery, Numerical Recipes, 6.4).
#pragma once

namespace stiction::host {

// Probability that F with `above` and `below` degrees of freedom exceeds `f`.
double fisher_tail(double f, double above, double below);
// The same of |t| with `freedom` degrees: both tails.
inline double student_tails(double t, double freedom) { return fisher_tail(t * t, 1.0, freedom); }
// The |t| that is exceeded with a probability of 5 %; `freedom` at least 1.
double student_limit(double freedom);

}  // namespace stiction::host
