#include "host/diagnose/statistics/block_products.hpp"

#include <algorithm>
#include <iterator>

namespace stiction::host {

void BlockProducts::add(Eigen::VectorXd column) {
  columns_.push_back(std::move(column));
  places_.emplace_back(columns_.size(), unknown);
}

void BlockProducts::truncate(std::size_t first) {
  if (first == 0) {
    totals_.clear();
    of_blocks_.clear();
    free_.clear();
  } else {
    for (std::size_t column = first; column < places_.size(); ++column)
      std::copy_if(places_[column].begin(), places_[column].end(), std::back_inserter(free_),
                   [](std::size_t place) { return place != unknown; });
  }
  columns_.resize(first);
  places_.resize(first);
}

void BlockProducts::replace(std::size_t index, Eigen::VectorXd column) {
  columns_[index] = std::move(column);
  for (std::size_t other = 0; other < columns_.size(); ++other)
    if (const auto place = places_[std::max(index, other)][std::min(index, other)]; place != unknown)
      multiply(index, other, place);
}

std::size_t BlockProducts::known(std::size_t one, std::size_t other) const {
  auto& place = places_[std::max(one, other)][std::min(one, other)];
  if (place != unknown) return place;
  if (free_.empty()) {
    place = totals_.size();
    totals_.push_back(0.0);
    of_blocks_.resize(of_blocks_.size() + blocks_.size());
  } else {
    place = free_.back();
    free_.pop_back();
  }
  multiply(one, other, place);
  return place;
}

void BlockProducts::multiply(std::size_t one, std::size_t other, std::size_t place) const {
  totals_[place] = 0.0;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const auto begin = static_cast<Eigen::Index>(blocks_[b].begin);
    const auto length = static_cast<Eigen::Index>(blocks_[b].end - blocks_[b].begin);
    const double product = columns_[one].segment(begin, length).dot(columns_[other].segment(begin, length));
    of_blocks_[place * blocks_.size() + b] = product;
    totals_[place] += product;
  }
}

}  // namespace stiction::host
