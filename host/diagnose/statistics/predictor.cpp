#include "host/diagnose/statistics/predictor.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "host/algebra/least_squares.hpp"
#include "host/diagnose/statistics/noise_rows.hpp"

namespace stiction::host {
namespace {

// Rows that have a weight each: slow and fast noise together have their poles and the zero between in them.
constexpr std::size_t single_rows = 8;
// White noise that is added to the residual's, of its variance: the rows end at 0.8 of their band, and what lies above
// is no silence to listen to. Of the variance of the innovations alone, what a model gets wrong high in the band would
// outweigh what slow noise leaves below: tried, it gave a quarter more wrong names.
constexpr double floor = 0.01;
// Of a log, how far back the furthest span ends: what wanders more slowly is seen too few times.
constexpr std::size_t looks_back = 4;
// Noise that the weights make of their own errors, over the noise that they are of: more is no model of it.
constexpr double most_made = 2.0;

struct Choice {
  Eigen::VectorXd weights;
  double innovation, odds;  // square of all errors; nats, but for a constant
};

// Sums of the rows before each, one more than there are rows.
Eigen::VectorXd sums_before(const Eigen::VectorXd& values) {
  Eigen::VectorXd sums(values.size() + 1);
  double sum = 0.0;
  for (Eigen::Index i = 0; i < values.size(); ++i) sums[i] = sum, sum += values[i];
  sums[values.size()] = sum;
  return sums;
}

}  // namespace

std::vector<Predictor::Span> Predictor::spans_up_to(std::size_t furthest) {
  std::vector<Span> spans;
  for (std::size_t k = 1; k <= single_rows; ++k) spans.push_back({k, k, 0.0});
  for (std::size_t nearest = single_rows + 1, length = single_rows; nearest + length - 1 <= furthest;
       nearest += length, length *= 2)
    spans.push_back({nearest, nearest + length - 1, 0.0});
  return spans;
}

void Predictor::take(const std::vector<Span>& spans) {
  rows_.clear(), means_.clear(), steps_.clear();
  double height = 0.0;
  for (const auto& span : spans) {
    if (span.furthest <= single_rows) {
      rows_.push_back(span.weight);
      continue;
    }
    means_.push_back(span);
    const double each = span.weight / static_cast<double>(span.furthest - span.nearest + 1);
    steps_.push_back({span.nearest, each - height});
    height = each;
  }
  if (!means_.empty()) steps_.push_back({means_.back().furthest + 1, -height});
}

// Whether errors of the variance `innovation` make a noise of that `variance` within a log's `length`.
bool Predictor::holds(double innovation, double variance, std::size_t length) const {
  Eigen::VectorXd answer = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(length)), sums(answer.size() + 1);
  double square = 0.0;
  sums[0] = 0.0;
  for (std::size_t i = 0; i < length; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    answer[row] = i == 0 ? 1.0 : expected(i, answer, sums);
    sums[row + 1] = sums[row] + answer[row];
    square += answer[row] * answer[row];
    if (!(innovation * square <= most_made * variance)) return false;
  }
  return true;
}

Predictor::Predictor(const Eigen::VectorXd& noise, std::span<const std::size_t> logs, Memory memory) {
  std::size_t longest = 0;
  for (std::size_t k = 0; k < logs.size(); ++k) longest = std::max(longest, end_of(logs, k, noise.size()) - logs[k]);
  auto spans = spans_up_to(memory == Memory::of_spans ? longest / looks_back : 0);
  const auto count = static_cast<Eigen::Index>(spans.size());
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(count, count);
  Eigen::VectorXd moment = Eigen::VectorXd::Zero(count);
  for (std::size_t k = 0; k < logs.size(); ++k) {
    const auto begin = static_cast<Eigen::Index>(logs[k]);
    const auto length = static_cast<Eigen::Index>(end_of(logs, k, noise.size())) - begin;
    const auto all = length + static_cast<Eigen::Index>(spans.back().furthest);
    const Eigen::VectorXd log = noise.segment(begin, length), sums = sums_before(log);
    const auto sum = [&](Eigen::Index i) { return sums[std::clamp<Eigen::Index>(i, 0, length)]; };
    Eigen::MatrixXd means(all, count);
    for (Eigen::Index c = 0; c < count; ++c) {
      const auto& span = spans[static_cast<std::size_t>(c)];
      const auto nearest = static_cast<Eigen::Index>(span.nearest), furthest = static_cast<Eigen::Index>(span.furthest);
      const double each = 1.0 / static_cast<double>(furthest - nearest + 1);
      for (Eigen::Index i = 0; i < all; ++i) means(i, c) = each * (sum(i - nearest + 1) - sum(i - furthest));
    }
    gram += transposed_product(means, means);
    moment += transposed_times(means.topRows(length), log);
  }
  const double variance = noise.squaredNorm();
  if (!(variance > 0.0)) return;
  for (Eigen::Index c = 0; c < count; ++c) {
    const auto& span = spans[static_cast<std::size_t>(c)];
    gram(c, c) += floor * variance / static_cast<double>(span.furthest - span.nearest + 1);
  }
  // As many spans as the noise needs (Schwarz, Ann. Stat. 6, 1978). Of the rows alone the weights always hold.
  const auto counted = static_cast<double>((noise.array() != 0.0).count());
  const double whole = (1.0 + floor) * variance;
  std::vector<Choice> choices;
  for (auto used = static_cast<Eigen::Index>(single_rows); used <= count; ++used) {
    const Eigen::VectorXd weights = solve_symmetric(gram.topLeftCorner(used, used), moment.head(used));
    const double innovation = std::max(whole - weights.dot(moment.head(used)), 1e-12 * whole);
    choices.push_back({weights, innovation,
                       -0.5 * counted * std::log(innovation) - 0.5 * static_cast<double>(used) * std::log(counted)});
  }
  std::sort(choices.begin(), choices.end(), [](const Choice& a, const Choice& b) { return a.odds > b.odds; });
  for (const auto& choice : choices) {
    std::vector<Span> used(spans.begin(), spans.begin() + choice.weights.size());
    for (std::size_t c = 0; c < used.size(); ++c) used[c].weight = choice.weights[static_cast<Eigen::Index>(c)];
    take(used);
    if (used.size() == single_rows || holds(choice.innovation, whole, longest)) return;
  }
}

Eigen::VectorXd Predictor::errors(const Eigen::VectorXd& log) const {
  Eigen::VectorXd out = log;
  const auto n = log.size();
  for (std::size_t k = 0; k < rows_.size(); ++k)
    if (const auto back = static_cast<Eigen::Index>(k + 1); back < n)
      out.tail(n - back) -= rows_[k] * log.head(n - back);
  if (steps_.empty()) return out;
  const Eigen::VectorXd sums = sums_before(log);
  for (const auto& step : steps_)
    if (const auto back = static_cast<Eigen::Index>(step.back); back < n)
      out.tail(n - back) -= step.height * sums.segment(1, n - back);
  return out;
}

Eigen::VectorXd Predictor::transposed(const Eigen::VectorXd& errors) const {
  Eigen::VectorXd out = errors;
  const auto n = errors.size();
  for (std::size_t k = 0; k < rows_.size(); ++k)
    if (const auto back = static_cast<Eigen::Index>(k + 1); back < n)
      out.head(n - back) -= rows_[k] * errors.tail(n - back);
  if (steps_.empty()) return out;
  Eigen::VectorXd behind(n);  // of this row and all later ones
  double sum = 0.0;
  for (Eigen::Index i = n; i-- > 0;) behind[i] = sum += errors[i];
  for (const auto& step : steps_)
    if (const auto back = static_cast<Eigen::Index>(step.back); back < n)
      out.head(n - back) -= step.height * behind.tail(n - back);
  return out;
}

double Predictor::expected(std::size_t i, const Eigen::VectorXd& values, const Eigen::VectorXd& sums) const {
  double expected = 0.0;
  for (std::size_t k = 0; k < rows_.size() && k < i; ++k)
    expected += rows_[k] * values[static_cast<Eigen::Index>(i - 1 - k)];
  for (const auto& step : steps_) {
    if (step.back > i) break;
    expected += step.height * sums[static_cast<Eigen::Index>(i - step.back + 1)];
  }
  return expected;
}

double Predictor::gain_square(double cycles) const {
  const auto turned = [&](double rows) { return std::polar(1.0, -2.0 * std::numbers::pi * cycles * rows); };
  std::complex<double> gain = 1.0;
  for (std::size_t k = 0; k < rows_.size(); ++k) gain -= rows_[k] * turned(static_cast<double>(k + 1));
  for (const auto& span : means_) {
    // The mean of turns that lie evenly: Dirichlet's kernel about the middle of the span.
    const double length = static_cast<double>(span.furthest - span.nearest + 1);
    const double half = std::numbers::pi * cycles, one = std::sin(half);
    const double kernel = std::abs(one) < 1e-12 ? 1.0 : std::sin(half * length) / (length * one);
    gain -= span.weight * kernel * turned(0.5 * static_cast<double>(span.nearest + span.furthest));
  }
  return std::norm(gain);
}

}  // namespace stiction::host
