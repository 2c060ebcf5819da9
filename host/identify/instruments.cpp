#include "host/identify/instruments.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "host/algebra/least_squares.hpp"
#include "host/identify/fit_support.hpp"

namespace stiction::host {
namespace {

constexpr std::size_t folds = 10;
constexpr double normal_975 = 1.959963985;

Eigen::VectorXd set_column(const LogRows& rows, std::vector<double> Motion::*set,
                           std::vector<double> Motion::*measured) {
  return rows.stacked([&](const Motion& m) { return (m.*set).empty() ? m.*measured : m.*set; });
}

}  // namespace

double student_975(double freedom) {
  const double n = std::max(freedom, 2.0), z = normal_975;
  const double z2 = z * z;
  return z + z * (z2 + 1.0) / (4.0 * n) + z * (5.0 * z2 * z2 + 16.0 * z2 + 3.0) / (96.0 * n * n) +
         z * (3.0 * z2 * z2 * z2 + 19.0 * z2 * z2 + 17.0 * z2 - 15.0) / (384.0 * n * n * n);
}

double attenuation_of(const Eigen::MatrixXd& columns, double all_noise, const Held& held) {
  std::vector<Eigen::Index> others;
  for (Eigen::Index c = 1; c < columns.cols(); ++c)
    if (columns.col(c).squaredNorm() > 0.0 && (c >= 4 || !held[static_cast<std::size_t>(c)])) others.push_back(c);
  if (others.empty()) return 1e300;  // no sample counts
  Eigen::MatrixXd m(columns.rows(), static_cast<Eigen::Index>(others.size()));
  for (std::size_t i = 0; i < others.size(); ++i)
    m.col(static_cast<Eigen::Index>(i)) = columns.col(others[i]).normalized();
  const Eigen::VectorXd a = columns.col(fitting::acceleration);
  const Eigen::VectorXd fit = LeastSquares(transposed_product(m, m), 1e-11).solve(transposed_times(m, a));
  return all_noise / std::max((a - m * fit).squaredNorm(), 1e-300);
}

NoisyEquations equations_of(const LogRows& rows, const Eigen::MatrixXd& columns) {
  NoisyEquations e;
  e.columns = columns;
  e.instruments = columns;
  e.instruments.col(fitting::acceleration) = set_column(rows, &Motion::set_a, &Motion::a);
  e.instruments.col(fitting::velocity) = set_column(rows, &Motion::set_v, &Motion::v);
  e.force = rows.force;
  e.acceleration_noise = e.velocity_noise = Eigen::VectorXd::Zero(rows.rows());
  for (std::size_t k = 0; k < rows.motions().size(); ++k) {
    const auto& motion = rows.motions()[k];
    const auto begin = static_cast<Eigen::Index>(rows.logs()[k]);
    const auto end = static_cast<Eigen::Index>(rows.end(k));
    const Eigen::ArrayXd share = rows.weight.segment(begin, end - begin).array().square();
    e.all_noise += share.sum() * std::pow(motion.acceleration_noise, 2);
    if (!motion.set_a.empty()) continue;
    e.acceleration_noise.segment(begin, end - begin) = share * std::pow(motion.acceleration_noise, 2);
    e.velocity_noise.segment(begin, end - begin) = share * std::pow(motion.speed_noise, 2);
  }
  if (attenuation_of(columns, e.all_noise, {}) < noise_to_treat) e.instruments = columns;
  return e;
}

NoisyEquations equations_of(const LogRows& rows, const LevelModel& model) {
  Eigen::MatrixXd columns(rows.rows(), model.rises_with_weight ? 5 : 4);
  columns.leftCols(4) << rows.acceleration, rows.velocity, rows.one,
      rows.stacked([](const Motion& m) { return m.level; });
  if (model.rises_with_weight)
    columns.col(fitting::risen_level) = rows.stacked([](const Motion& m) {
      auto level = m.level;
      for (std::size_t i = 0; i < level.size(); ++i) level[i] *= std::abs(m.constant[i]);
      return level;
    });
  return equations_of(rows, columns);
}

double friction_level(const Eigen::MatrixXd& columns, const Eigen::VectorXd& weights) {
  double level = std::abs(weights[fitting::level]);
  if (weights.size() <= fitting::risen_level) return level;
  const double share = columns.col(fitting::risen_level).norm() / std::max(columns.col(fitting::level).norm(), 1e-300);
  return level + std::abs(weights[fitting::risen_level]) * share;
}

InstrumentFit::InstrumentFit(const NoisyEquations& equations, std::vector<RowBlock> blocks, const Held& held)
    : equations_(equations), blocks_(std::move(blocks)), held_(held) {
  const Eigen::Index width = equations_.columns.cols();
  Eigen::VectorXd force = equations_.force;
  weights_ = errors_ = Eigen::VectorXd::Zero(width);
  for (Eigen::Index c = 0; c < width; ++c) {
    const auto given = c < 4 ? held_[static_cast<std::size_t>(c)] : std::nullopt;
    if (!given) {
      free_.push_back(c);
      continue;
    }
    weights_[c] = *given;
    force -= *given * equations_.columns.col(c);
  }
  equations_.force = force;
  scale_ = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(free_.size()));
  for (Eigen::Index i = 0; i < scale_.size(); ++i) {
    const double length = equations_.columns.col(free_[static_cast<std::size_t>(i)]).norm();
    if (length > 0.0) scale_[i] = 1.0 / length;
  }
  const auto n = scale_.size();
  total_ = {Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
  for (const auto& block : blocks_) {
    sums_.push_back(sums_of(block));
    total_.gram += sums_.back().gram;
    total_.moment += sums_.back().moment;
  }
  const Eigen::VectorXd centre = solve(total_);
  pulls_ = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(blocks_.size()), n);
  for (std::size_t b = 0; b < sums_.size(); ++b) {
    const Eigen::VectorXd left = sums_[b].moment - sums_[b].gram * centre.cwiseQuotient(scale_);
    pulls_.row(static_cast<Eigen::Index>(b)) = solve({total_.gram - sums_[b].gram, left}).transpose();
  }
  const double blocks_count = std::max(1.0, static_cast<double>(blocks_.size()));
  pulls_ *= std::sqrt((blocks_count - 1.0) / blocks_count);
  student_ = Eigen::VectorXd::Ones(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double square = pulls_.col(i).squaredNorm(), fourth = pulls_.col(i).array().pow(4).sum();
    // Normal blocks of one size: as many as there are.
    student_[i] = student_975(fourth > 0.0 ? 3.0 * square * square / fourth : blocks_count) / normal_975;
    weights_[free_[static_cast<std::size_t>(i)]] = centre[i];
    errors_[free_[static_cast<std::size_t>(i)]] = student_[i] * std::sqrt(square);
  }
  attenuation_ = attenuation_of(equations_.columns, equations_.all_noise, held_);
}

InstrumentFit::Sums InstrumentFit::sums_of(const RowBlock& block) const {
  const auto begin = static_cast<Eigen::Index>(block.begin);
  const auto length = static_cast<Eigen::Index>(block.end - block.begin);
  Eigen::MatrixXd a(length, scale_.size()), z(length, scale_.size());
  for (Eigen::Index i = 0; i < scale_.size(); ++i) {
    const auto c = free_[static_cast<std::size_t>(i)];
    a.col(i) = scale_[i] * equations_.columns.col(c).segment(begin, length);
    z.col(i) = scale_[i] * equations_.instruments.col(c).segment(begin, length);
  }
  Sums sums{transposed_product(z, a), transposed_times(z, equations_.force.segment(begin, length))};
  for (std::size_t i = 0; i < free_.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    if (free_[i] == fitting::acceleration)
      sums.gram(k, k) -= equations_.acceleration_noise.segment(begin, length).sum() * scale_[k] * scale_[k];
    if (free_[i] == fitting::velocity)
      sums.gram(k, k) -= equations_.velocity_noise.segment(begin, length).sum() * scale_[k] * scale_[k];
  }
  return sums;
}

Eigen::VectorXd InstrumentFit::solve(const Sums& sums) const {
  return LeastSquares(sums.gram, 1e-11).solve(sums.moment).cwiseProduct(scale_);
}

Eigen::MatrixXd InstrumentFit::replicates(int count, std::uint64_t seed, const Eigen::VectorXd& wider) const {
  std::mt19937_64 random(seed);
  Eigen::MatrixXd result = weights_.transpose().replicate(count, 1);
  for (int r = 0; r < count; ++r) {
    Eigen::VectorXd moved = Eigen::VectorXd::Zero(pulls_.cols());
    for (Eigen::Index b = 0; b < pulls_.rows(); ++b)
      moved += (random() >> 63 != 0 ? 1.0 : -1.0) * pulls_.row(b).transpose();
    for (Eigen::Index i = 0; i < moved.size(); ++i) {
      const auto c = free_[static_cast<std::size_t>(i)];
      result(r, c) += moved[i] * student_[i] * wider[c];
    }
  }
  return result;
}

double InstrumentFit::held_out() const {
  double sum = 0.0;
  std::size_t rows = 0;
  for (std::size_t fold = 0; fold < std::min(folds, blocks_.size()); ++fold) {
    Sums train = total_;
    for (std::size_t b = fold; b < blocks_.size(); b += folds) {
      train.gram -= sums_[b].gram;
      train.moment -= sums_[b].moment;
    }
    const Eigen::VectorXd w = solve(train);
    for (std::size_t b = fold; b < blocks_.size(); b += folds) {
      const auto begin = static_cast<Eigen::Index>(blocks_[b].begin);
      const auto length = static_cast<Eigen::Index>(blocks_[b].end - blocks_[b].begin);
      Eigen::VectorXd left = equations_.force.segment(begin, length);
      for (std::size_t i = 0; i < free_.size(); ++i)
        left -= w[static_cast<Eigen::Index>(i)] * equations_.columns.col(free_[i]).segment(begin, length);
      sum += left.squaredNorm();
      rows += static_cast<std::size_t>(length);
    }
  }
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(rows, 1)));
}

}  // namespace stiction::host
