#include "host/diagnose/describe/residual_diagnostics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <numeric>

#include "host/diagnose/spectrum/line_scan.hpp"
#include "host/diagnose/statistics/evidence.hpp"
#include "host/diagnose/statistics/fisher.hpp"

namespace stiction::host {
namespace {

constexpr double least_diagnostic_gain = 0.02;  // of the cross-validated residual
constexpr double block_significance = 0.001;    // of the blocks' t-test

struct Signature {
  double gain = 0.0;  // cross-validated share of the residual's square
  std::string text;
};

struct CrossValidated {
  double gain = 0.0, p_value = 1.0;
};

CrossValidated cross_validate(Evidence& evidence, const std::vector<Eigen::VectorXd>& columns) {
  const auto first = evidence.add(columns);
  ColumnIndices chosen(columns.size());
  std::iota(chosen.begin(), chosen.end(), first);
  const auto without = evidence.held_out({}), with = evidence.held_out(chosen);
  evidence.truncate(first);
  const double n = static_cast<double>(with.size());
  double before = 0.0, mean = 0.0, square = 0.0;
  for (std::size_t b = 0; b < with.size(); ++b) {
    const double gain = without[b] - with[b];
    before += without[b];
    mean += gain / n;
    square += gain * gain / n;
  }
  const double error = std::sqrt(std::max(square - mean * mean, 0.0) / (n - 1.0));
  return {mean * n / before, mean > 0.0 ? 0.5 * student_tails(mean / error, n - 1.0) : 1.0};
}

// Indicators of equally filled ranges of a quantity, each times `factor`.
std::vector<Eigen::VectorXd> ranges(const Eigen::VectorXd& quantity, const Eigen::VectorXd& factor, int count) {
  std::vector<double> sorted(quantity.data(), quantity.data() + quantity.size());
  std::sort(sorted.begin(), sorted.end());
  std::vector<Eigen::VectorXd> columns;
  for (int k = 0; k < count; ++k) {
    const auto edge = [&](int i) {
      return sorted[std::min(sorted.size() - 1,
                             sorted.size() * static_cast<std::size_t>(i) / static_cast<std::size_t>(count))];
    };
    const double low = edge(k), high = edge(k + 1);
    Eigen::VectorXd column = Eigen::VectorXd::Zero(quantity.size());
    for (Eigen::Index i = 0; i < quantity.size(); ++i)
      if (quantity[i] >= low && (quantity[i] < high || k + 1 == count)) column[i] = factor[i];
    columns.push_back(std::move(column));
  }
  return columns;
}

// Frequency (Hz) of the residual's strongest line over its surroundings; 0: none stands out.
double strongest_line(const LogRows& rows, const Eigen::VectorXd& residual) {
  const std::size_t n = rows.logs().size() > 1 ? rows.logs()[1] : static_cast<std::size_t>(rows.rows());
  const double period = rows.period(0);
  const std::size_t lines = static_cast<std::size_t>(0.4 * static_cast<double>(n));
  if (n < 200) return 0.0;
  std::vector<double> power(lines);
  for (std::size_t k = 3; k < lines; ++k) {
    const auto turn = std::polar(1.0, 2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(n));
    std::complex<double> sum = 0.0, wave = 1.0;
    for (std::size_t i = 0; i < n; ++i) {
      sum += residual[static_cast<Eigen::Index>(i)] * wave;
      wave *= turn;
    }
    power[k] = std::norm(sum);
  }
  std::size_t best = 0;
  double highest = 0.0;
  for (std::size_t k = 3; k < lines; ++k) {
    const std::size_t from = k > 23 ? k - 20 : 3, to = std::min(lines, k + 21);
    std::vector<double> around(power.begin() + static_cast<std::ptrdiff_t>(from),
                               power.begin() + static_cast<std::ptrdiff_t>(to));
    const auto middle = around.begin() + static_cast<std::ptrdiff_t>(around.size() / 2);
    std::nth_element(around.begin(), middle, around.end());
    const double ratio = power[k] / std::max(*middle / std::numbers::ln2, 1e-300);
    if (ratio > highest) {
      highest = ratio;
      best = k;
    }
  }
  // A line of noise exceeds this once in a thousand records.
  if (highest < std::log(static_cast<double>(lines) / 1e-3)) return 0.0;
  return static_cast<double>(best) / (static_cast<double>(n) * period);
}

}  // namespace

Unexplained signature_of(const LogRows& rows, const Eigen::VectorXd& residual, double baseline_square,
                         double correlation, const ShownUnits& units) {
  const double n = static_cast<double>(rows.rows());
  const auto shortest = static_cast<std::size_t>(std::clamp(6.0 * correlation, n / 100.0, n / 30.0)) + 1;
  Evidence plain(residual, blocks_of(rows.velocity, rows.logs(), shortest)), white = plain;
  const Whitening whitening(residual, rows.logs());
  white.whiten(whitening);
  std::vector<Signature> found;
  const auto look = [&](const std::vector<Eigen::VectorXd>& columns, const std::string& text) {
    for (auto* evidence : {&plain, &white}) {
      const auto cv = cross_validate(*evidence, columns);
      if (cv.gain > least_diagnostic_gain && cv.p_value < block_significance) found.push_back({cv.gain, text});
    }
  };
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(rows.rows());
  const Eigen::VectorXd sign = rows.velocity.array().sign();
  const auto position = rows.sampled([](const Motion& m) { return m.x; });
  const auto waves = [&](const Eigen::VectorXd& place, double per_unit) {
    const Eigen::VectorXd angle = 2.0 * std::numbers::pi * per_unit * place;
    return std::vector<Eigen::VectorXd>{angle.array().cos(), angle.array().sin()};
  };
  const auto scan = scan_pitches(rows, residual, whitening, one, {}, 1);
  if (!scan.periods.empty())
    look(waves(position, 1.0 / scan.periods.front()),
         fmt::format("periodic in position with pitch {:.4g} {}", units.position(scan.periods.front()),
                     units.position.unit));
  if (const double frequency = strongest_line(rows, residual); frequency > 0.0)
    look(waves(rows.time, frequency), fmt::format("periodic in time with frequency {:.4g} Hz", frequency));
  look(ranges(position, one, 12), "force that depends on position");
  look(ranges(position, sign, 12), "friction that depends on position");
  look(ranges(rows.velocity.cwiseAbs(), sign, 10), "friction that depends on speed");
  look(ranges(rows.acceleration, one, 10), "growing with acceleration");
  look(ranges(rows.time, one, 8), "force that drifts with time");
  look(ranges(rows.time, sign, 8), "friction that drifts with time");
  const double highest = rows.velocity.cwiseAbs().maxCoeff();
  Eigen::VectorXd near = Eigen::VectorXd::Zero(rows.rows());
  for (Eigen::Index i = 0; i < near.size(); ++i)
    if (std::abs(rows.velocity[i]) < 0.05 * highest) near[i] = rows.acceleration[i] < 0.0 ? -1.0 : 1.0;
  look({near}, "at reversals");
  if (found.empty()) return {};
  const auto best = std::max_element(found.begin(), found.end(),
                                     [](const Signature& a, const Signature& b) { return a.gain < b.gain; });
  return {best->gain * residual.squaredNorm() / baseline_square, best->text};
}

}  // namespace stiction::host
