#include "host/sweep/chunks.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "firmware/machine/file/whole_file.hpp"

namespace stiction::host {
namespace {

namespace fs = std::filesystem;

// Read by nobody but this programme, on the machine that wrote it or on one of the same kind.
constexpr std::string_view chunk_mark = "stiction sweep chunk 1\n";

std::uint32_t checksum(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      ::crc32_z(::crc32_z(0, nullptr, 0), reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

template <class T>
void put(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// Takes values off the front of `bytes`; false at their end.
template <class T>
bool take(std::string_view& bytes, T& value) {
  if (bytes.size() < sizeof value) return false;
  std::memcpy(&value, bytes.data(), sizeof value);
  bytes.remove_prefix(sizeof value);
  return true;
}

std::optional<ChunkResult> unpacked(std::string_view bytes, std::uint64_t rows, std::size_t figures) {
  std::uint32_t sum = 0;
  if (bytes.size() < chunk_mark.size() + sizeof sum || !bytes.starts_with(chunk_mark)) return std::nullopt;
  std::string_view end = bytes.substr(bytes.size() - sizeof sum);
  take(end, sum);
  bytes.remove_suffix(sizeof sum);
  if (checksum(bytes) != sum) return std::nullopt;
  bytes.remove_prefix(chunk_mark.size());
  ChunkResult result;
  result.figures.resize(rows * figures);
  result.status.resize(rows);
  result.message.resize(rows);
  for (auto& figure : result.figures)
    if (!take(bytes, figure)) return std::nullopt;
  for (std::size_t k = 0; k < rows; ++k) {
    std::uint32_t length = 0;
    if (!take(bytes, result.status[k]) || !take(bytes, length) || bytes.size() < length) return std::nullopt;
    result.message[k] = bytes.substr(0, length);
    bytes.remove_prefix(length);
  }
  if (!bytes.empty()) return std::nullopt;
  return result;
}

}  // namespace

ChunkFiles::ChunkFiles(fs::path folder, std::uint64_t rows, std::uint64_t length, std::size_t figures)
    : folder_(std::move(folder)), rows_(rows), length_(length), figures_(figures) {}

std::uint64_t ChunkFiles::rows_of(std::uint64_t chunk) const { return std::min(length_, rows_ - first_row(chunk)); }

fs::path ChunkFiles::file_of(std::uint64_t chunk) const { return folder_ / fmt::format("{:08}.chunk", chunk); }

bool ChunkFiles::has(std::uint64_t chunk) const {
  std::error_code none;
  return fs::exists(file_of(chunk), none);
}

void ChunkFiles::write(std::uint64_t chunk, const ChunkResult& result) const {
  std::string bytes(chunk_mark);
  for (const double figure : result.figures) put(bytes, figure);
  for (std::size_t k = 0; k < result.status.size(); ++k) {
    put(bytes, result.status[k]);
    put(bytes, static_cast<std::uint32_t>(result.message[k].size()));
    bytes += result.message[k];
  }
  put(bytes, checksum(bytes));
  const auto place = file_of(chunk);
  auto pending = place;
  pending += ".part";
  std::error_code error;
  try {
    machine::write_whole_file(pending, bytes, place);
  } catch (...) {
    fs::remove(pending, error);
    throw;
  }
  fs::rename(pending, place, error);
  if (error) throw std::runtime_error(fmt::format("{}: cannot be written: {}", place.string(), error.message()));
}

std::optional<ChunkResult> ChunkFiles::read(std::uint64_t chunk) const {
  std::string bytes;
  try {
    bytes = machine::read_whole_file(file_of(chunk), "a chunk of a sweep");
  } catch (const machine::UnreadableFile&) {
    return std::nullopt;
  }
  auto result = unpacked(bytes, rows_of(chunk), figures_);
  std::error_code ignored;
  if (!result) fs::remove(file_of(chunk), ignored);
  return result;
}

void ChunkFiles::remove_all() const {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

ChunkResult ChunkFiles::present(std::uint64_t chunk) const {
  auto result = read(chunk);
  if (!result)
    throw std::runtime_error(fmt::format(
        "{}: found no such chunk, or a damaged one; run the sweep again, which repeats it", file_of(chunk).string()));
  return std::move(*result);
}

std::vector<double> ChunkFiles::column(std::size_t figure) const {
  std::vector<double> values;
  values.reserve(rows_);
  for_each([&](std::uint64_t, const ChunkResult& chunk) {
    for (std::size_t k = figure; k < chunk.figures.size(); k += figures_) values.push_back(chunk.figures[k]);
  });
  return values;
}

}  // namespace stiction::host
