#include "host/identify/log_rows.hpp"

#include <algorithm>

namespace stiction::host {
namespace {

auto as_vector(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

constexpr std::size_t shortest_rest = 16;  // rows: a reversal is none

// Marks those of a log's rows in which its set-point stays, given the set-point of each (m).
void mark_rest(std::span<const double> set_point, std::span<double> at_rest) {
  for (std::size_t begin = 0, end = 0; begin < set_point.size(); begin = end) {
    end = begin + 1;  // a value that is no number differs from itself
    while (end < set_point.size() && set_point[end] == set_point[begin]) ++end;
    if (end - begin >= shortest_rest)
      std::fill(at_rest.begin() + static_cast<std::ptrdiff_t>(begin),
                at_rest.begin() + static_cast<std::ptrdiff_t>(end), 1.0);
  }
}

// The column of samples that count less than whole. Force and regressors are multiplied by the same weight before they
// are filtered, so that the equation of each sample keeps holding and nothing of a sample that does not count reaches
// a row.
std::vector<double> weighed(const Motion& motion, std::vector<double> column) {
  for (std::size_t i = 0; i < motion.weight.size(); ++i) column[i] *= motion.weight[i];
  return column;
}

}  // namespace

LogRows::LogRows(std::vector<Motion> motions, const SignalSettings& settings) : motions_(std::move(motions)) {
  std::size_t count = 0;
  for (const auto& motion : motions_) {
    filters_.emplace_back(motion, settings);
    logs_.push_back(count);
    count += filters_.back().rows();
  }
  force.resize(static_cast<Eigen::Index>(count));  // stacked() takes the number of rows from it
  counts_ = Eigen::VectorXd::Ones(force.size());
  force = stacked([](const Motion& m) { return m.force; });
  acceleration = stacked([](const Motion& m) { return m.a; });
  velocity = stacked([](const Motion& m) { return m.v; });
  at_rest_.resize(count);
  for (std::size_t k = 0; k < motions_.size(); ++k)
    if (!motions_[k].x_set.empty())
      mark_rest(filters_[k].sampled(motions_[k].x_set), std::span(at_rest_).subspan(logs_[k], filters_[k].rows()));
  weight = counts_;
  if (std::any_of(motions_.begin(), motions_.end(), [](const Motion& m) { return !m.weight.empty(); }))
    weight = stacked([](const Motion& m) { return std::vector<double>(m.t.size(), 1.0); });
  one = weight;
  if (std::any_of(motions_.begin(), motions_.end(), [](const Motion& m) { return !m.constant.empty(); }))
    one = stacked([](const Motion& m) { return m.constant; });
  time = sampled([](const Motion& m) { return m.t; });
}

void LogRows::weigh(Eigen::VectorXd counts) {
  counts_ = std::move(counts);
  for (auto* row : {&force, &acceleration, &velocity, &weight, &one}) *row = row->cwiseProduct(counts_);
}

Eigen::VectorXd LogRows::stacked(const std::function<std::vector<double>(const Motion&)>& column) const {
  Eigen::VectorXd all(force.size());
  for (std::size_t k = 0; k < motions_.size(); ++k) {
    const auto rows = filters_[k](weighed(motions_[k], column(motions_[k])));
    all.segment(static_cast<Eigen::Index>(logs_[k]), static_cast<Eigen::Index>(rows.size())) = as_vector(rows);
  }
  return all.cwiseProduct(counts_);
}

std::vector<Eigen::VectorXd> LogRows::stacked_together(
    const std::function<std::vector<std::vector<double>>(const Motion&)>& columns) const {
  std::vector<Eigen::VectorXd> all;
  for (std::size_t k = 0; k < motions_.size(); ++k) {
    auto all_of_log = columns(motions_[k]);
    for (auto& column : all_of_log) column = weighed(motions_[k], std::move(column));
    const auto rows = filters_[k](all_of_log);
    if (k == 0) all.assign(rows.size(), Eigen::VectorXd(force.size()));
    for (std::size_t c = 0; c < rows.size(); ++c)
      all[c].segment(static_cast<Eigen::Index>(logs_[k]), static_cast<Eigen::Index>(rows[c].size())) =
          as_vector(rows[c]);
  }
  for (auto& column : all) column = column.cwiseProduct(counts_);
  return all;
}

Eigen::VectorXd LogRows::sampled(const std::function<std::vector<double>(const Motion&)>& column) const {
  Eigen::VectorXd all(force.size());
  for (std::size_t k = 0; k < motions_.size(); ++k) {
    const auto rows = filters_[k].sampled(column(motions_[k]));
    all.segment(static_cast<Eigen::Index>(logs_[k]), static_cast<Eigen::Index>(rows.size())) = as_vector(rows);
  }
  return all;
}

std::vector<std::vector<double>> LogRows::transposed(const Eigen::VectorXd& weights) const {
  const Eigen::VectorXd counted = weights.cwiseProduct(counts_);
  std::vector<std::vector<double>> all;
  for (std::size_t k = 0; k < motions_.size(); ++k)
    all.push_back(weighed(motions_[k],
                          filters_[k].transposed({&counted[static_cast<Eigen::Index>(logs_[k])], filters_[k].rows()})));
  return all;
}

void LogRows::read_as(const LogRows& measured) {
  for (std::size_t k = 0; k < motions_.size(); ++k) motions_[k].read = measured.motions_[k].read;
}

void LogRows::read_as(std::span<const std::vector<double>> read) {
  for (std::size_t k = 0; k < motions_.size(); ++k) motions_[k].read = read[k];
}

Eigen::VectorXd LogRows::of_log(std::size_t log, const std::vector<double>& column) const {
  Eigen::VectorXd all = Eigen::VectorXd::Zero(force.size());
  const auto rows = filters_[log](weighed(motions_[log], column));
  all.segment(static_cast<Eigen::Index>(logs_[log]), static_cast<Eigen::Index>(rows.size())) = as_vector(rows);
  return all.cwiseProduct(counts_);
}

}  // namespace stiction::host
