#include "host/diagnose/search/calibration.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "host/diagnose/search/price.hpp"
#include "host/diagnose/statistics/level.hpp"
#include "host/identify/regression.hpp"

namespace stiction::host {
namespace {

constexpr std::size_t records_drawn = 24;
constexpr std::size_t fewest_drawn = 8;  // from which a tail is told
constexpr int sizing_rounds = 2;         // in which the force that is drawn finds its size

// Forces under which the exact machine leaves about as much as the record does: the encoder's steps and the loop's
// answer add to those that are drawn. They are not made larger.
Eigen::VectorXd sized(const SearchContext& context, Eigen::VectorXd noise) {
  const double wanted = noise.norm();
  for (int round = 0; round < sizing_rounds; ++round) {
    const auto made = context.exact_records(noise)(0);
    if (!made || !(made->target.norm() > wanted)) break;
    noise *= wanted / made->target.norm();
  }
  return noise;
}

// Log odds that are exceeded with a probability of `chance`: behind the median they fall off exponentially, as twice
// the log of a likelihood ratio does (Wilks 1938).
double exceeded_with(double chance, std::vector<double> odds) {
  const auto middle = odds.begin() + static_cast<std::ptrdiff_t>(odds.size() / 2);
  std::nth_element(odds.begin(), middle, odds.end());
  const double above = std::accumulate(middle, odds.end(), 0.0) / static_cast<double>(odds.end() - middle) - *middle;
  return *middle + above * std::log(0.5 / chance);
}

}  // namespace

Calibration::Calibration(const SearchContext& context, const Eigen::VectorXd& noise) {
  const auto drawn = context.exact_records(sized(context, noise));
  for (std::size_t draw = 0; draw < records_drawn; ++draw)
    if (auto record = drawn(draw)) records_.push_back(std::move(*record));
  if (records_.size() < fewest_drawn) records_.clear();
}

std::vector<double> Calibration::prices(const std::function<std::vector<double>(const ExactRecord&)>& odds_in) const {
  std::vector<std::vector<double>> odds;
  for (const auto& record : records_) {
    const auto of_record = odds_in(record);
    odds.resize(of_record.size());
    for (std::size_t k = 0; k < odds.size(); ++k)
      if (std::isfinite(of_record[k])) odds[k].push_back(of_record[k]);
  }
  const double chance = level_of_design / static_cast<double>(candidates().size());
  std::vector<double> prices(odds.size(), 0.0);
  for (std::size_t k = 0; k < odds.size(); ++k)
    if (odds[k].size() >= fewest_drawn) prices[k] = std::max(exceeded_with(chance, odds[k]) - sure, 0.0);
  return prices;
}

}  // namespace stiction::host
