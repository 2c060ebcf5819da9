// The band of a regression that follows the data. One filter takes force and regressors alike, so what is cut away
// biases nothing: it costs information. What is let in costs more the further the rows reach, as the noise of an
// acceleration from positions grows with the fourth power of the frequency. So the widest band is taken whose intervals
// are as narrow as those of the best, among those in which the noise of the acceleration stays a small share of its
// signal; and the estimates of the other bands say how far the result depends on the choice.
#pragma once

#include <array>
#include <vector>

#include "host/identify/followed_motion.hpp"
#include "host/identify/instruments.hpp"

namespace stiction::host {

// A trial. In the order of the columns: mass (kg), viscous friction (N s/m), constant force (N), Coulomb friction (N)
// and, 0 where the level does not rise with a weight, by how much it rises from none to all of it (N).
struct BandPoint {
  double cutoff = 0.0;                                 // Hz
  std::array<double, 5> value{}, error{};              // estimates; half of their 95 % intervals over 1.96
  double friction = 0.0;                               // N, mean level: what the error of the Coulomb friction means
  double attenuation = 0.0;                            // share of the mass that noise would take in plain least squares
  double speed_noise = 0.0, acceleration_noise = 0.0;  // m/s, m/s^2 rms in the rows, the noisiest log's
  std::size_t blocks = 0;

  // Whether it may be chosen: blocks enough, little noise in the acceleration, a positive mass.
  bool sound() const;
};

struct Band {
  std::vector<BandPoint> trials;  // from the widest on
  std::size_t chosen = 0;
  double position_noise = 0.0;  // m rms, of the noisiest log
  bool instruments = false;     // every log has set-points

  const BandPoint& best() const { return trials[chosen]; }
  // Factor by which each interval grows for what its blocks cannot show: how far the estimates move with the band (mean
  // square of their differences, over the bands with intervals of about the same width), and what all blocks have wrong
  // alike.
  Eigen::VectorXd widening() const;
};

// One log of an axis.
struct LogOfAxis {
  const Log* log;
  const AxisLog* channels;
};

// `logs`: at least one, of `axis`; `amperes`: convention of their currents; `model`: of the friction's level; `held`:
// values that are not estimated. Throws LogError when no band has rows enough.
Band choose_band(const std::vector<LogOfAxis>& logs, const machine::AxisModel& axis, Amperes amperes,
                 const LevelModel& model, const Held& held);

// Rows of `logs` up to `cutoff` (Hz); `axis`, `amperes`, `model`: as above.
LogRows followed_rows(const std::vector<LogOfAxis>& logs, const machine::AxisModel& axis, Amperes amperes,
                      double cutoff, const LevelModel& model);

// Blocks for a residual of `rows`: the direction of motion is `rows.velocity`'s. `correlation`: gets the length, in
// rows, over which the residual is correlated.
std::vector<RowBlock> blocks_for(const LogRows& rows, const Eigen::VectorXd& residual, double* correlation = nullptr);

}  // namespace stiction::host
