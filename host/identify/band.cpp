#include "host/identify/band.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/identify/fit_support.hpp"

namespace stiction::host {
namespace {

// Half an octave apart, about; the widest is that of the fixed recipe.
constexpr std::array<double, 12> cutoffs{40.0, 28.0, 20.0, 14.0, 10.0, 7.0, 5.0, 3.5, 2.5, 1.8, 1.2, 0.8};  // Hz
// Of the log's rate: there the acceleration from 11 points is right to 1.2 %; the speed, 6 % low at the very end, to 1
// % up to four fifths of it.
constexpr double of_rate = 0.3;
// Of the mass. What noise takes is put back by instruments or by its known variance, neither of which is exact; and a
// plain least squares of the same rows predicts better by half of it.
constexpr double noisiest = 0.03;
constexpr std::size_t least_blocks_of_band = 10;
constexpr double as_narrow = 0.3;   // sum of the logarithms of two intervals' widths
constexpr double same_width = 2.5;  // ratio of intervals that are compared
// What all blocks of a record have wrong alike, their scatter does not show: the reversals' jumps that no rate
// resolves, the shape of the contact. Both as found on simulated axes of known truth (tests/logs, seeds apart from
// those that are reported): the factor of every interval, and a part of the value itself.
constexpr double common = 1.2;
constexpr std::array<double, 5> floors{5e-4, 1e-3, 0.0, 1e-3, 1e-3};

BandPoint trial(const std::vector<LogOfAxis>& logs, const machine::AxisModel& axis, Amperes amperes, double cutoff,
                const LevelModel& model, const Held& held) {
  const auto rows = followed_rows(logs, axis, amperes, cutoff, model);
  const auto equations = equations_of(rows, model);
  const Eigen::VectorXd left = equations.force - equations.columns * fitting::weights_of(equations.columns, rows.force);
  auto blocks = blocks_for(rows, left);
  BandPoint point;
  point.cutoff = cutoff;
  point.blocks = blocks.size();
  const InstrumentFit fit(equations, std::move(blocks), held);
  for (std::size_t c = 0; c < static_cast<std::size_t>(fit.weights().size()); ++c) {
    point.value[c] = fit.weights()[static_cast<Eigen::Index>(c)];
    point.error[c] = fit.errors()[static_cast<Eigen::Index>(c)];
  }
  point.friction = friction_level(equations.columns, fit.weights());
  point.attenuation = fit.attenuation();
  for (const auto& motion : rows.motions()) {
    point.speed_noise = std::max(point.speed_noise, motion.speed_noise);
    point.acceleration_noise = std::max(point.acceleration_noise, motion.acceleration_noise);
  }
  return point;
}

// Narrower is better: mass and Coulomb friction, the two that every use needs.
double width_of(const BandPoint& p) {
  double width = 0.0;
  for (const auto c : {fitting::acceleration, fitting::level}) {
    const auto k = static_cast<std::size_t>(c);
    const double size = c == fitting::level ? p.friction : std::abs(p.value[k]);
    if (p.error[k] > 0.0) width += std::log(p.error[k] / std::max(size, 1e-12));
  }
  return width;
}

}  // namespace

bool BandPoint::sound() const {
  return blocks >= least_blocks_of_band && attenuation < noisiest &&
         std::all_of(value.begin(), value.end(), [](double v) { return std::isfinite(v); }) && value[0] > 0.0;
}

std::vector<RowBlock> blocks_for(const LogRows& rows, const Eigen::VectorXd& residual, double* correlation) {
  constexpr double correlation_lengths = 3.0;
  constexpr std::size_t least_rows = 10;
  const double length = correlation_length(residual, rows.logs());
  if (correlation != nullptr) *correlation = length;
  const auto longest = static_cast<std::size_t>(rows.rows()) / 12;  // a slow motion in a long band still has blocks
  return blocks_of(
      rows.velocity, rows.logs(),
      std::max(std::min(static_cast<std::size_t>(std::ceil(correlation_lengths * length)), longest), least_rows));
}

LogRows followed_rows(const std::vector<LogOfAxis>& logs, const machine::AxisModel& axis, Amperes amperes,
                      double cutoff, const LevelModel& model) {
  std::vector<Motion> motions;
  for (const auto& each : logs)
    motions.push_back(followed_motion(*each.log, *each.channels, axis, amperes, cutoff, model));
  return {std::move(motions), followed_signals(cutoff)};
}

Band choose_band(const std::vector<LogOfAxis>& logs, const machine::AxisModel& axis, Amperes amperes,
                 const LevelModel& model, const Held& held) {
  double slowest = 1e300;
  Band band;
  band.instruments = true;
  for (const auto& each : logs) {
    slowest = std::min(slowest, 1.0 / each.log->period);
    band.position_noise = std::max(band.position_noise, position_noise(*each.channels, axis));
    band.instruments = band.instruments && !each.channels->x_set.empty();
  }
  for (const double cutoff : cutoffs)
    if (cutoff <= of_rate * slowest) band.trials.push_back(trial(logs, axis, amperes, cutoff, model, held));
  if (band.trials.empty()) band.trials.push_back(trial(logs, axis, amperes, of_rate * slowest, model, held));
  double narrowest = 1e300;
  for (const auto& p : band.trials)
    if (p.sound()) narrowest = std::min(narrowest, width_of(p));
  const auto wide = std::find_if(band.trials.begin(), band.trials.end(),
                                 [&](const auto& p) { return p.sound() && width_of(p) < narrowest + as_narrow; });
  // Too short for any: the one with the most blocks of those that are not too noisy, else the narrowest.
  if (wide != band.trials.end()) {
    band.chosen = static_cast<std::size_t>(wide - band.trials.begin());
    return band;
  }
  band.chosen = band.trials.size() - 1;
  for (std::size_t k = band.trials.size(); k-- > 0;)
    if (band.trials[k].attenuation < noisiest && band.trials[k].blocks >= band.best().blocks) band.chosen = k;
  return band;
}

Eigen::VectorXd Band::widening() const {
  const auto& own = best();
  Eigen::VectorXd factor = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(own.value.size()));
  for (std::size_t c = 0; c < own.value.size(); ++c) {
    if (own.error[c] <= 0.0) continue;
    double sum = 0.0;
    int count = 0;
    for (std::size_t k = 0; k < trials.size(); ++k) {
      const auto& p = trials[k];
      if (k == chosen || !p.sound() || p.error[c] > same_width * own.error[c]) continue;
      sum += std::pow(p.value[c] - own.value[c], 2);
      ++count;
    }
    // Nothing to compare with: as much again.
    const double moved = count > 0 ? sum / count / std::pow(own.error[c], 2) : 1.0;
    const double least = floors[c] * own.value[c] / own.error[c];
    factor[static_cast<Eigen::Index>(c)] = std::sqrt(common * common * (1.0 + moved) + least * least);
  }
  return factor;
}

}  // namespace stiction::host
