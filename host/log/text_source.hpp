// The text of a table in blocks of whole rows, from a file (plain or gzip) or from memory: UTF-8 without its byte-order
// mark, UTF-16 with one turned into UTF-8. A file of any size takes the memory of one block.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace stiction::host {

// Told how many bytes of a file more were read; of a compressed one, of its compressed bytes.
using BytesRead = std::function<void(std::size_t)>;

class TextSource {
 public:
  // `text`: must outlive the source; `name`: for messages.
  TextSource(std::string_view text, std::string name);
  // `file`: of plain text or compressed by gzip; `progress`: may be empty. Throws LogError when the file cannot be
  // read.
  TextSource(const std::filesystem::path& file, BytesRead progress);
  TextSource(TextSource&&) noexcept;
  ~TextSource();

  // The next rows, which end with their line end but for the last of the text; empty at the end of the text. Valid
  // until the call after. A line end within quotes ends no row. Throws LogError: a damaged archive, text that is no
  // UTF-16, a row longer than `longest_row`.
  std::string_view next();

  static constexpr std::size_t longest_row = std::size_t{16} << 20;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// All text of a file, as above but in one piece, for formats that are read as a whole. `file`: to read; `expected`:
// what it should be, for the message. Throws LogError, also where the unpacked text is larger than 2 GiB.
std::string read_plain_or_gzip(const std::filesystem::path& file, std::string_view expected = "a log");

// The first bytes of a file, unpacked where it is compressed by gzip, UTF-16 as UTF-8, fewer at its end: to tell its
// format.
std::string first_bytes(const std::filesystem::path& file, std::size_t count);

}  // namespace stiction::host
