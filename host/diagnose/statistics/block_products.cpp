#include "host/diagnose/statistics/block_products.hpp"

#include <algorithm>

namespace stiction::host {

void BlockProducts::add(Eigen::VectorXd column) {
  columns_.push_back(std::move(column));
  places_.emplace_back(columns_.size(), unknown);
}

void BlockProducts::truncate(std::size_t first) {
  columns_.resize(first);
  places_.resize(first);
  if (first > 0) return;
  totals_.clear();
  of_blocks_.clear();
}

std::size_t BlockProducts::known(std::size_t one, std::size_t other) const {
  auto& place = places_[std::max(one, other)][std::min(one, other)];
  if (place != unknown) return place;
  place = totals_.size();
  double total = 0.0;
  for (const auto& block : blocks_) {
    const auto begin = static_cast<Eigen::Index>(block.begin);
    const auto length = static_cast<Eigen::Index>(block.end - block.begin);
    of_blocks_.push_back(columns_[one].segment(begin, length).dot(columns_[other].segment(begin, length)));
    total += of_blocks_.back();
  }
  totals_.push_back(total);
  return place;
}

}  // namespace stiction::host
