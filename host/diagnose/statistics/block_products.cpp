#include "host/diagnose/statistics/block_products.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

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

void BlockProducts::keep(std::span<const std::size_t> kept) {
  std::vector<Eigen::VectorXd> columns;
  for (const auto column : kept) columns.push_back(std::move(columns_[column]));
  truncate(0);
  for (auto& column : columns) add(std::move(column));
}

void BlockProducts::replace(std::size_t index, Eigen::VectorXd column) {
  columns_[index] = std::move(column);
  std::vector<Pair> pairs;
  for (std::size_t other = 0; other < columns_.size(); ++other)
    if (const auto place = places_[std::max(index, other)][std::min(index, other)]; place != unknown)
      pairs.push_back({index, other, place});
  multiply(pairs);
}

void BlockProducts::ask_for(std::span<const std::size_t> some, std::span<const std::size_t> others) const {
  std::vector<Pair> pairs;
  const auto ask = [&](std::size_t one, std::size_t other) {
    auto& place = places_[std::max(one, other)][std::min(one, other)];
    if (place == unknown) pairs.push_back({one, other, place = new_place()});
  };
  for (const auto one : some) {
    for (const auto other : some) ask(one, other);
    for (const auto other : others) ask(one, other);
  }
  multiply(pairs);
}

std::size_t BlockProducts::known(std::size_t one, std::size_t other) const {
  auto& place = places_[std::max(one, other)][std::min(one, other)];
  if (place == unknown) {
    place = new_place();
    multiply(std::array{Pair{one, other, place}});
  }
  return place;
}

std::size_t BlockProducts::new_place() const {
  if (!free_.empty()) {
    const std::size_t place = free_.back();
    free_.pop_back();
    return place;
  }
  totals_.push_back(0.0);
  of_blocks_.resize(of_blocks_.size() + blocks_.size());
  return totals_.size() - 1;
}

void BlockProducts::multiply(std::span<const Pair> pairs) const {
  for (const auto& pair : pairs) totals_[pair.place] = 0.0;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const auto begin = static_cast<Eigen::Index>(blocks_[b].begin);
    const auto length = static_cast<Eigen::Index>(blocks_[b].end - blocks_[b].begin);
    for (const auto& [one, other, place] : pairs) {
      const double product = columns_[one].segment(begin, length).dot(columns_[other].segment(begin, length));
      of_blocks_[place * blocks_.size() + b] = product;
      totals_[place] += product;
    }
  }
}

}  // namespace stiction::host
