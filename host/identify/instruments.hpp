// Least squares with regressors that carry the encoder's noise. The noise of an acceleration makes the mass too small
// (attenuation: Fuller 1987, 1.1). Where a log has set-points their derivatives are instruments: they move as the axis
// does and know nothing of its encoder (Young 1970; IDIM-IV: Janot, Vandanjon, Gautier 2014, who simulate the loop for
// them; with a controller that tracks well the set-points themselves lose nothing against that, and no error of the
// machine file enters). In closed loop the axis follows the encoder's errors, too, so that this part of the noise is
// correlated with the force: instruments from the set-points are free of it, a known variance of the noise is not.
// Where a log has none the expected noise is taken from the normal equations (Fuller 1987, 2.2).
//
// Intervals: delete-one-block jackknife (Cameron, Miller 2015: CR3), so that correlated residuals and a model's misfit
// count, with the degrees of freedom that the blocks' shares leave (Satterthwaite 1946).
#pragma once

#include <Eigen/Dense>
#include <array>
#include <optional>
#include <vector>

#include "host/identify/followed_motion.hpp"
#include "host/identify/log_rows.hpp"
#include "host/identify/regression.hpp"

namespace stiction::host {

// Values that are held, not estimated; in the order of the columns.
using Held = std::array<std::optional<double>, 4>;

// What a regression works on.
struct NoisyEquations {
  Eigen::MatrixXd columns, instruments;  // a row each; the first columns in the order of fitting::acceleration etc.
  Eigen::VectorXd force;                 // N
  // Expected square of the noise of acceleration and velocity, a value for each row; 0 where the row has instruments.
  Eigen::VectorXd acceleration_noise, velocity_noise;
  double all_noise = 0.0;  // (m/s^2)^2, expected square of the acceleration's noise over all rows
};

// Share of the mass above which noise is treated: below it instruments cost more than the noise does, as they follow
// the motion less closely than the measured columns do.
inline constexpr double noise_to_treat = 1e-4;

// Mass, viscous friction, constant force and Coulomb level of `rows`, whose motions have a level; and what the level
// rises by with the whole of a weight, where `model` says so: the level times the share of the weight that its angle
// leaves. The weight alone is the load: a force of inertia from noisy positions would be all noise within a magnitude.
NoisyEquations equations_of(const LogRows& rows, const LevelModel& model);

// N, mean level of the friction over the rows by `weights` of their `columns`, as equations_of() has them.
double friction_level(const Eigen::MatrixXd& columns, const Eigen::VectorXd& weights);

// Share of the mass that the noise of the acceleration would take in plain least squares of `columns`. `all_noise`:
// expected square of the noise over all rows; `held`: columns that do not count.
double attenuation_of(const Eigen::MatrixXd& columns, double all_noise, const Held& held);

// The same with these columns in place of the level's and any others beside it; the instruments of acceleration and
// velocity stay.
NoisyEquations equations_of(const LogRows& rows, const Eigen::MatrixXd& columns);

class InstrumentFit {
 public:
  // `equations`: columns, instruments and force; `blocks`: of their rows; `held`: columns that are not estimated.
  InstrumentFit(const NoisyEquations& equations, std::vector<RowBlock> blocks, const Held& held);

  const Eigen::VectorXd& weights() const { return weights_; }
  // Half of the 95 % interval over 1.96, of each weight.
  const Eigen::VectorXd& errors() const { return errors_; }
  // Share of the mass that the noise of the acceleration would take in plain least squares.
  double attenuation() const { return attenuation_; }
  // Replicates of the weights, a row each, that scatter as the estimate does. `count`: of them; `seed`: of the signs;
  // `wider`: a factor for each weight.
  Eigen::MatrixXd replicates(int count, std::uint64_t seed, const Eigen::VectorXd& wider) const;
  // Force (N rms) that is left on blocks that were held out, each once.
  double held_out() const;

 private:
  struct Sums {
    Eigen::MatrixXd gram;
    Eigen::VectorXd moment;
  };
  Sums sums_of(const RowBlock& block) const;
  Eigen::VectorXd solve(const Sums& sums) const;

  NoisyEquations equations_;
  std::vector<RowBlock> blocks_;
  Held held_;
  std::vector<Eigen::Index> free_;
  Eigen::VectorXd scale_;
  std::vector<Sums> sums_;
  Sums total_;
  Eigen::VectorXd weights_, errors_;
  Eigen::MatrixXd pulls_;    // of each block (row) on each weight
  Eigen::VectorXd student_;  // factor of each weight's scatter
  double attenuation_ = 0.0;
};

// The 97.5 % point of Student's distribution of so many degrees of freedom, at least 2 (Cornish, Fisher 1938).
double student_975(double freedom);

}  // namespace stiction::host
