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

constexpr std::size_t records_kept = 24;  // and looked at in any case
constexpr std::size_t most_drawn = 120;
constexpr std::size_t fewest_drawn = 8;  // from which a tail is told
constexpr double margin = 2.0;           // standard errors of a price, within which more are drawn
constexpr int sizing_rounds = 2;         // in which the force that is drawn finds its size

// Forces under which the exact machine leaves about as much as the record does: the encoder's steps and the loop's
// answer add to those that are drawn. They are not made larger.
Eigen::VectorXd sized(const SearchContext& context, Eigen::VectorXd noise) {
  const double wanted = noise.norm();
  for (int round = 0; round < sizing_rounds; ++round) {
    const auto made = context.exact_records(noise)(0, 1);
    if (made.empty() || !(made.front().target.norm() > wanted)) break;
    noise *= wanted / made.front().target.norm();
  }
  return noise;
}

struct Limit {
  double median, odds, error;  // the last the standard error of the odds
};

// Log odds that are exceeded with a probability of `chance`: behind the median they fall off exponentially, as twice
// the log of a likelihood ratio does (Wilks 1938). The mean of such values is known to its part in their root.
Limit exceeded_with(double chance, std::vector<double> odds) {
  const auto middle = odds.begin() + static_cast<std::ptrdiff_t>(odds.size() / 2);
  std::nth_element(odds.begin(), middle, odds.end());
  const auto count = static_cast<double>(odds.end() - middle);
  const double above = std::accumulate(middle, odds.end(), 0.0) / count - *middle;
  const double behind = above * std::log(0.5 / chance);
  return {*middle, *middle + behind, behind / std::sqrt(count)};
}

}  // namespace

Calibration::Calibration(const SearchContext& context, const Eigen::VectorXd& noise)
    : drawn_(context.exact_records(sized(context, noise))) {
  kept_ = drawn_(0, records_kept);
  if (kept_.size() < fewest_drawn) kept_.clear();
  records_ = kept_.size();
}

std::vector<Calibration::Price> Calibration::prices(
    const std::function<std::vector<double>(const ExactRecord&)>& odds_in,
    const std::vector<std::optional<double>>& own) {
  std::vector<std::vector<double>> odds(own.size());
  const auto look_at = [&](const ExactRecord& record) {
    const auto of_record = odds_in(record);
    for (std::size_t k = 0; k < odds.size(); ++k)
      if (std::isfinite(of_record[k])) odds[k].push_back(of_record[k]);
  };
  for (const auto& record : kept_) look_at(record);
  const double chance = level_of_design / static_cast<double>(candidates().size());
  std::vector<Price> prices(own.size());
  // Whether the records that were drawn tell each name's side.
  const auto told = [&] {
    bool all = true;
    for (std::size_t k = 0; k < odds.size(); ++k) {
      if (odds[k].size() < fewest_drawn) continue;
      const auto limit = exceeded_with(chance, odds[k]);
      prices[k].limit = std::max(limit.odds - sure, 0.0);
      prices[k].typical = std::clamp(limit.median, 0.0, prices[k].limit);
      all = all && (!own[k] || *own[k] < sure || std::abs(*own[k] - limit.odds) > margin * limit.error);
    }
    return all;
  };
  std::size_t looked_at = kept_.size();
  for (std::size_t drawn = records_kept; !told() && !kept_.empty() && drawn < most_drawn; drawn += records_kept)
    for (const auto& record : drawn_(drawn, drawn + records_kept)) look_at(record), ++looked_at;
  records_ = std::max(records_, looked_at);
  return prices;
}

}  // namespace stiction::host
