#include "host/diagnose/search/refinement.hpp"

#include <algorithm>
#include <cmath>

#include "host/algebra/least_squares.hpp"
#include "host/diagnose/classes/candidate_columns.hpp"

namespace stiction::host {
namespace {

constexpr int golden_steps = 14;  // the last two values are 0.1 % of the range apart
constexpr int settling_steps = 4, settling_halvings = 2;
constexpr double settled = 0.01;  // of the weight

class Refinement {
 public:
  Refinement(const LogRows& rows, const Evidence& searched, const SearchContext& context, std::vector<Term>& terms)
      : rows_(rows),
        searched_(searched),
        scene_(context),
        terms_(terms),
        white_target_(searched.whitening()(searched.target())) {
    const double variance =
        searched.whitening() ? 1.0 : searched.target().squaredNorm() / static_cast<double>(searched.rows());
    std::vector<double> precision;
    for (const auto& term : terms) {
      const auto columns = group(term, term.shape);
      for (const auto& column : columns)
        precision.push_back(term.size > 0.0
                                ? variance * static_cast<double>(columns.size()) * std::pow(rms(column) / term.size, 2)
                                : 0.0);
      white_.push_back(whitened(columns));
    }
    precision_ = Eigen::Map<const Eigen::VectorXd>(precision.data(), static_cast<Eigen::Index>(precision.size()));
  }

  Eigen::VectorXd run() {
    for (int round = 0; round < (terms_.size() > 1 ? 2 : 1); ++round)
      for (std::size_t k = 0; k < terms_.size(); ++k) {
        if (candidate(k).at_weight)
          settle(k);
        else if (candidate(k).shape)
          bracket(k);
      }
    return conclude();
  }

 private:
  using Group = std::vector<Eigen::VectorXd>;

  const Candidate& candidate(std::size_t k) const { return candidates()[terms_[k].candidate]; }
  // What the lines of a periodic one are resolved over: m, or s.
  double extent(std::size_t k) const { return std::max(candidate(k).scan(scene_).extent, 1e-6); }
  Group group(const Term& term, double shape) const {
    return group_columns(rows_, scene_, candidates()[term.candidate], shape);
  }
  Group whitened(Group columns) const {
    for (auto& column : columns) column = searched_.whitening()(column);
    return columns;
  }
  Eigen::MatrixXd stacked() const {
    Eigen::Index count = 0, at = 0;
    for (const auto& g : white_) count += static_cast<Eigen::Index>(g.size());
    Eigen::MatrixXd columns(rows_.rows(), count);
    for (const auto& g : white_)
      for (const auto& c : g) columns.col(at++) = c;
    return columns;
  }
  Eigen::VectorXd weights_of(const Eigen::MatrixXd& columns) const {
    const Eigen::VectorXd scale = columns.colwise().norm().cwiseMax(1e-300).cwiseInverse().transpose();
    Eigen::MatrixXd products = transposed_product(columns, columns);
    products.diagonal() += precision_;
    const Eigen::MatrixXd gram = scale.asDiagonal() * products * scale.asDiagonal();
    const Eigen::VectorXd moment = scale.cwiseProduct(transposed_times(columns, white_target_));
    return scale.cwiseProduct(LeastSquares(gram).solve(moment));
  }
  double left_with(std::size_t k, double shape) {
    white_[k] = whitened(group(terms_[k], shape));
    const auto columns = stacked();
    return (white_target_ - columns * weights_of(columns)).squaredNorm();
  }
  Eigen::Index first_weight(std::size_t k) const {
    Eigen::Index at = 0;
    for (std::size_t j = 0; j < k; ++j) at += static_cast<Eigen::Index>(white_[j].size());
    return at;
  }

  // The place of the slope moves to the weight that the slope gives, for as long as that fits better; of one that
  // replays, or part of the way there: far from its own size a loop answers otherwise, and the weight says little of
  // it.
  void settle(std::size_t k) {
    Eigen::VectorXd weights = weights_of(stacked());
    double left = (white_target_ - stacked() * weights).squaredNorm();
    for (int i = 0; i < settling_steps; ++i) {
      const double weight = weights[first_weight(k)], from = terms_[k].shape;
      if (weight == 0.0 || !std::isfinite(weight) || std::abs(weight - from) < settled * std::abs(weight)) break;
      double place = weight;
      bool moved = false;
      const int halvings_tried = candidate(k).replays ? settling_halvings : 0;
      for (int half = 0; half <= halvings_tried && !moved; ++half, place = between(from, place)) {
        const auto before = white_[k];
        const double next = left_with(k, place);
        moved = next <= left;
        if (moved)
          terms_[k].shape = place, left = next, weights = weights_of(stacked());
        else
          white_[k] = before;
      }
      if (!moved) break;
    }
  }
  static double between(double from, double to) {
    return from * to > 0.0 ? std::copysign(std::sqrt(from * to), from) : 0.5 * (from + to);
  }

  // Golden section within a step of the grid to either side: in 1/pitch an eighth of 1/stroke, else a factor.
  void bracket(std::size_t k) {
    constexpr double golden = 0.6180339887498949;
    auto& value = terms_[k].shape;
    const double factor = candidate(k).periodic ? 1.0 / (1.0 - std::min(0.2 * value / extent(k), 0.5)) : 1.6;
    double low = value / factor, high = value * factor;
    double a = high * std::pow(low / high, golden), b = low * std::pow(high / low, golden);
    double left_a = left_with(k, a), left_b = left_with(k, b);
    for (int i = 0; i < golden_steps; ++i) {
      if (left_a < left_b) {
        high = b;
        b = a;
        left_b = left_a;
        left_a = left_with(k, a = high * std::pow(low / high, golden));
      } else {
        low = a;
        a = b;
        left_a = left_b;
        left_b = left_with(k, b = low * std::pow(high / low, golden));
      }
    }
    value = left_a < left_b ? a : b;
    left_with(k, value);
  }

  // How the term's force changes with its nonlinear parameter.
  Eigen::VectorXd slope(std::size_t k) const {
    const auto& term = terms_[k];
    const double by = candidate(k).periodic ? 0.02 * term.shape * term.shape / extent(k) : 0.02 * term.shape;
    const auto up = group(term, term.shape + by), down = group(term, term.shape - by);
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(rows_.rows());
    for (std::size_t i = 0; i < up.size(); ++i)
      sum += term.coefficients[static_cast<Eigen::Index>(i)] * (up[i] - down[i]) / (2.0 * by);
    return sum;
  }

  // Weights; and with the slope of each nonlinear parameter beside them, covariances.
  Eigen::VectorXd conclude() {
    const auto coefficients = weights_of(stacked());
    Evidence evidence(searched_.target(), searched_.row_blocks());
    evidence.whiten(searched_.whitening());
    Eigen::VectorXd all(0);
    std::vector<Eigen::Index> first;
    for (std::size_t k = 0; k < terms_.size(); ++k) {
      auto own = group(terms_[k], terms_[k].shape);
      const auto count = static_cast<Eigen::Index>(own.size());
      terms_[k].coefficients = coefficients.segment(first_weight(k), count);
      if (candidate(k).shape) own.push_back(slope(k));
      first.push_back(evidence.add(own));
      all.conservativeResize(first.back() + static_cast<Eigen::Index>(own.size()));
      all.segment(first.back(), count) = terms_[k].coefficients;
      if (candidate(k).shape) all[first.back() + count] = 0.0;
    }
    ColumnIndices chosen(static_cast<std::size_t>(all.size()));
    for (std::size_t i = 0; i < chosen.size(); ++i) chosen[i] = static_cast<Eigen::Index>(i);
    const auto covariance = evidence.interval_covariance(chosen, all);
    for (std::size_t k = 0; k < terms_.size(); ++k) {
      const auto count = terms_[k].coefficients.size() + (candidate(k).shape ? 1 : 0);
      terms_[k].covariance = covariance.block(first[k], first[k], count, count);
    }
    return evidence.residual(chosen, all);
  }

  const LogRows& rows_;
  const Evidence& searched_;
  const SearchContext& scene_;
  std::vector<Term>& terms_;
  Eigen::VectorXd white_target_;
  std::vector<Group> white_;   // columns of each term, whitened
  Eigen::VectorXd precision_;  // of the weights beforehand
};

}  // namespace

Eigen::VectorXd refine(const LogRows& rows, const Evidence& searched, const SearchContext& context,
                       std::vector<Term>& terms) {
  if (terms.empty()) return searched.target();
  return Refinement(rows, searched, context, terms).run();
}

}  // namespace stiction::host
