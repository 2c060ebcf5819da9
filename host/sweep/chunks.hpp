// The finished chunks of a sweep, a file each: the log from which a sweep resumes. A chunk is written under a name of
// its own and then moved, so that it is there or not.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace stiction::host {

enum class RowStatus : std::uint8_t { done = 0, failed = 1 };

struct ChunkResult {
  std::vector<double> figures;       // row by row, each with all figures of the sweep; NaN where a run gave none
  std::vector<RowStatus> status;     // of each row
  std::vector<std::string> message;  // of each row: why it failed; empty: it did not
};

class ChunkFiles {
 public:
  // In `folder`, which exists. `rows` of the sweep in chunks of `length` rows, with `figures` each.
  ChunkFiles(std::filesystem::path folder, std::uint64_t rows, std::uint64_t length, std::size_t figures);

  std::uint64_t count() const { return (rows_ + length_ - 1) / length_; }
  std::uint64_t first_row(std::uint64_t chunk) const { return chunk * length_; }
  std::uint64_t rows_of(std::uint64_t chunk) const;

  bool has(std::uint64_t chunk) const;
  // Throws std::runtime_error when the disk does not take it; then there is no such chunk.
  void write(std::uint64_t chunk, const ChunkResult& result) const;
  // None where it is missing, or is not what was written: then it is removed, to be run again.
  std::optional<ChunkResult> read(std::uint64_t chunk) const;
  void remove_all() const;

  // Figure `figure` of all rows; all chunks must be there. Throws std::runtime_error where one is not.
  std::vector<double> column(std::size_t figure) const;
  // Calls `take` with each chunk in order; throws as column().
  template <class Take>
  void for_each(Take&& take) const {
    for (std::uint64_t k = 0; k < count(); ++k) take(k, present(k));
  }

 private:
  std::filesystem::path file_of(std::uint64_t chunk) const;
  ChunkResult present(std::uint64_t chunk) const;

  std::filesystem::path folder_;
  std::uint64_t rows_, length_;
  std::size_t figures_;
};

}  // namespace stiction::host
