// Scalar products of columns over blocks of rows. A search asks for few of the pairs that its columns make, and for
// those again and again: each is worked out when it is first asked for, in one pass over the rows, and kept.
#pragma once

#include <Eigen/Dense>
#include <span>
#include <vector>

#include "host/identify/regression.hpp"

namespace stiction::host {

class BlockProducts {
 public:
  explicit BlockProducts(std::vector<RowBlock> blocks) : blocks_(std::move(blocks)) {}

  const Eigen::VectorXd& column(std::size_t index) const { return columns_[index]; }
  void add(Eigen::VectorXd column);
  // Another column in the place of one.
  void replace(std::size_t index, Eigen::VectorXd column);
  // Drops all columns from `first` on.
  void truncate(std::size_t first);
  // Leaves those with the indices `kept`, in this order, and none of the products.
  void keep(std::span<const std::size_t> kept);
  // Works out what is not known yet of the products of each of `some` with each of them and with each of `others`:
  // block by block, which takes less time than pair by pair.
  void ask_for(std::span<const std::size_t> some, std::span<const std::size_t> others) const;

  // Of two columns over the rows of all blocks, and over those of each: until other products are asked for.
  double total(std::size_t one, std::size_t other) const { return totals_[known(one, other)]; }
  std::span<const double> by_block(std::size_t one, std::size_t other) const {
    const std::size_t place = known(one, other);  // which may move what is kept
    return std::span(of_blocks_).subspan(place * blocks_.size(), blocks_.size());
  }

 private:
  static constexpr std::size_t unknown = static_cast<std::size_t>(-1);
  struct Pair {
    std::size_t one, other, place;  // the last in the products
  };
  // Place of a pair in the products.
  std::size_t known(std::size_t one, std::size_t other) const;
  // A place for the products of one more pair.
  std::size_t new_place() const;
  // Works out these products.
  void multiply(std::span<const Pair> pairs) const;

  std::vector<RowBlock> blocks_;
  std::vector<Eigen::VectorXd> columns_;
  // What has been asked for; of one thread at a time.
  mutable std::vector<std::vector<std::size_t>> places_;  // of each column with those up to itself
  mutable std::vector<std::size_t> free_;                 // places of pairs with a column that was dropped
  mutable std::vector<double> totals_, of_blocks_;
};

}  // namespace stiction::host
