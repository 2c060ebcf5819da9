// What the rows look like where nothing but noise is in them: the noise's spectrum, and how far each row may be out. A
// few rows that are far out count less, as Student's t has it (Lange, Little, Taylor, J. Am. Stat. Assoc. 84, 1989), so
// that one odd event names nothing.
#pragma once

#include <Eigen/Dense>

#include "host/diagnose/statistics/whitening.hpp"

namespace stiction::host {

// Makes rows white with a variance of one, those at rest and those in motion each. `residual`: what is taken for noise,
// in `rows`, 0 in those that do not count; `memory`: of its autoregression.
Whitening noise_of(const Eigen::VectorXd& residual, const NoiseRows& rows, Memory memory = Memory::of_rows);

// The log likelihood of noise that may wander for seconds, nats, but for a constant: what tells two residuals of the
// same rows apart.
double noise_log_likelihood(const Eigen::VectorXd& residual, const NoiseRows& rows);
// The same with rows that count as another noise has it, which `known` makes white: only the spectrum is the residual's
// own. `residual` and `rows`: as above.
double noise_log_likelihood(const Eigen::VectorXd& residual, const NoiseRows& rows, const Whitening& known);

}  // namespace stiction::host
