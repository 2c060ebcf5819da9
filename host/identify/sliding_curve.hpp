// Friction over speed while sliding: which curve the data prefer, judged on blocks that were held out. From the rows of
// logs or from a table of steady states.
#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "host/identify/friction_fit.hpp"

namespace stiction::host {

// force = curve(|speed|) sign + others * weights.
struct SlidingData {
  Eigen::VectorXd speed;   // m/s, signed
  Eigen::VectorXd sign;    // of the friction force: 1, -1
  Eigen::VectorXd force;   // N
  Eigen::MatrixXd others;  // what else acts, a column each: acceleration, constant; may have no column
  std::vector<RowBlock> blocks;
};

// The rows of a fit in which its contact slides.
SlidingData sliding_data(const LogRows& rows, const FrictionFit& fit);

// The error of a curve on data that was held out.
struct CurveError {
  std::string curve;
  double held_out = 0.0;  // N rms
};

struct CurvePoint {
  double speed;             // m/s
  double force, low, high;  // N, the curve and its 95 % band
};

// What was measured at about one speed, in one direction.
struct MeasuredPoint {
  double speed;           // m/s, signed
  double force;           // N, positive when it opposes positive motion, without mass, constant force
  double standard_error;  // N; 0 for a single value
};

struct SlidingCurve {
  std::string curve;                        // "linear", "two-slope", "exponential", "power"
  std::vector<FittedParameter> parameters;  // of the chosen one
  std::vector<CurveError> errors;           // of all
  std::vector<CurvePoint> points;           // the chosen one over the speeds of the data
  std::vector<MeasuredPoint> measured;
};

// Curves: linear F_C + mu v; two-slope, mu changes at a speed; exponential, F_C + F_1 (1 - exp(-v/v_1)) + mu v; power,
// F_C + a v^p. A curve that is not linear is chosen when it takes at least 1 % of the held-out mean square away, and
// its nonlinear parameter lies within what was tried. `correlation`: rows that say one thing, for the standard errors
// of the measured points. `data`: speed and force of the rows; `settings`: of the bootstrap.
SlidingCurve choose_sliding_curve(const SlidingData& data, double correlation, const FitSettings& settings);

}  // namespace stiction::host
