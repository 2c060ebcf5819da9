// Arrays in NumPy's format, one file: `numpy.load` reads them without us (NumPy Enhancement Proposal 1, format 1.0, in
// a ZIP archive). No date is in it: the same columns give the same bytes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace stiction::host {

class NpzWriter {
 public:
  // Writes `place`, which is there when commit() has returned, and as it was before until then.
  explicit NpzWriter(std::filesystem::path place);
  NpzWriter(const NpzWriter&) = delete;
  NpzWriter& operator=(const NpzWriter&) = delete;
  ~NpzWriter();

  // A column `name` of `rows` doubles, which `values` gives when its turn to be written comes.
  void add_numbers(const std::string& name, std::uint64_t rows, std::function<std::vector<double>()> values);
  // A column `name` of `rows` texts (UTF-8), the longest of `longest` characters; `text` gives that of a row.
  void add_texts(const std::string& name, std::uint64_t rows, std::size_t longest,
                 std::function<std::string(std::uint64_t row)> text);

  // Throws std::runtime_error when the disk does not take it, and what `values` and `text` throw.
  void commit();

  struct Column;

 private:
  std::filesystem::path place_;
  std::vector<std::unique_ptr<Column>> columns_;
};

// Characters (code points) of `text` in UTF-8; bytes that are none count as one each.
std::u32string code_points(std::string_view text);

}  // namespace stiction::host
