#include "host/sweep/npz.hpp"

#include <fmt/format.h>
#include <zip.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <exception>
#include <stdexcept>

namespace stiction::host {

// Gives the bytes of one array piece by piece, since libzip asks for them when the archive is closed.
struct NpzWriter::Column {
  std::string name;
  std::string header;
  std::function<std::string(std::uint64_t from)> piece;  // the bytes of rows from `from` on; empty at the end
  std::function<void()> end;                             // frees what a column holds
  std::uint64_t piece_rows = 0, rows = 0, next_row = 0;
  std::string pending;
  std::size_t given = 0;
  std::exception_ptr failure;
  zip_error_t error{};

  void open() {
    pending = header;
    given = 0;
    next_row = 0;
  }
  std::int64_t read(char* to, std::uint64_t length) {
    std::uint64_t put = 0;
    while (put < length) {
      if (given == pending.size()) {
        if (next_row >= rows) break;
        pending = piece(next_row);
        next_row += piece_rows;
        given = 0;
        continue;
      }
      const auto count = std::min<std::uint64_t>(length - put, pending.size() - given);
      std::memcpy(to + put, pending.data() + given, count);
      given += count;
      put += count;
    }
    return static_cast<std::int64_t>(put);
  }
};

namespace {

constexpr std::uint64_t rows_at_once = 4096;
// 1 January 1980, the first day that an archive knows.
constexpr zip_uint16_t first_date = (1U << 5U) | 1U;

static_assert(std::endian::native == std::endian::little, "the arrays are written as they are in memory");

// Magic, version 1.0, length, a Python literal padded to a multiple of 64 bytes.
std::string array_header(const std::string& type, std::uint64_t rows) {
  std::string literal = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({},), }}", type, rows);
  constexpr std::size_t before = 10, multiple = 64;
  literal.append(multiple - 1 - (before + literal.size()) % multiple, ' ');
  literal += '\n';
  std::string header("\x93NUMPY\x01\x00", 8);
  header += static_cast<char>(literal.size() & 0xffU);
  header += static_cast<char>(literal.size() >> 8U);
  return header + literal;
}

zip_int64_t give(void* user, void* data, zip_uint64_t length, zip_source_cmd_t command) {
  auto& column = *static_cast<NpzWriter::Column*>(user);
  try {
    switch (command) {
      case ZIP_SOURCE_OPEN:
        column.open();
        return 0;
      case ZIP_SOURCE_READ:
        return column.read(static_cast<char*>(data), length);
      case ZIP_SOURCE_CLOSE:
        column.pending.clear();
        if (column.end) column.end();
        return 0;
      case ZIP_SOURCE_STAT:
        zip_stat_init(static_cast<zip_stat_t*>(data));
        return sizeof(zip_stat_t);
      case ZIP_SOURCE_ERROR:
        return zip_error_to_data(&column.error, data, length);
      case ZIP_SOURCE_FREE:
        return 0;
      case ZIP_SOURCE_SUPPORTS:
        return zip_source_make_command_bitmap(ZIP_SOURCE_OPEN, ZIP_SOURCE_READ, ZIP_SOURCE_CLOSE, ZIP_SOURCE_STAT,
                                              ZIP_SOURCE_ERROR, ZIP_SOURCE_FREE, -1);
      default:
        break;
    }
  } catch (...) {
    column.failure = std::current_exception();
  }
  zip_error_set(&column.error, ZIP_ER_INTERNAL, 0);
  return -1;
}

}  // namespace

std::u32string code_points(std::string_view text) {
  std::u32string points;
  for (std::size_t k = 0; k < text.size();) {
    const auto first = static_cast<unsigned char>(text[k]);
    const std::size_t more = first >= 0xf0 ? 3 : first >= 0xe0 ? 2 : first >= 0xc0 ? 1 : 0;
    std::uint32_t point = more == 0 ? first : first & (0x3fU >> more);
    bool whole = k + more < text.size() && first < 0xf8;
    for (std::size_t j = 1; whole && j <= more; ++j) {
      const auto next = static_cast<unsigned char>(text[k + j]);
      whole = (next & 0xc0U) == 0x80U;
      point = (point << 6U) | (next & 0x3fU);
    }
    points += whole ? static_cast<char32_t>(point) : U'\uFFFD';
    k += whole ? more + 1 : 1;
  }
  return points;
}

NpzWriter::NpzWriter(std::filesystem::path place) : place_(std::move(place)) {}
NpzWriter::~NpzWriter() = default;

void NpzWriter::add_numbers(const std::string& name, std::uint64_t rows, std::function<std::vector<double>()> values) {
  auto column = std::make_unique<Column>();
  column->name = name;
  column->header = array_header("<f8", rows);
  column->rows = rows;
  column->piece_rows = rows_at_once;
  const auto held = std::make_shared<std::vector<double>>();
  column->piece = [held, rows, values = std::move(values)](std::uint64_t from) {
    if (held->empty()) *held = values();
    const auto count = std::min(rows_at_once, rows - from);
    return std::string(reinterpret_cast<const char*>(held->data() + from), count * sizeof(double));
  };
  column->end = [held] { *held = {}; };
  columns_.push_back(std::move(column));
}

void NpzWriter::add_texts(const std::string& name, std::uint64_t rows, std::size_t longest,
                          std::function<std::string(std::uint64_t row)> text) {
  auto column = std::make_unique<Column>();
  column->name = name;
  const std::size_t width = std::max<std::size_t>(longest, 1);
  column->header = array_header(fmt::format("<U{}", width), rows);
  column->rows = rows;
  column->piece_rows = rows_at_once;
  column->piece = [rows, width, text = std::move(text)](std::uint64_t from) {
    const auto count = std::min(rows_at_once, rows - from);
    std::u32string cells(count * width, U'\0');
    for (std::uint64_t k = 0; k < count; ++k) {
      auto points = code_points(text(from + k));
      points.resize(std::min(points.size(), width));
      std::copy(points.begin(), points.end(), cells.begin() + static_cast<std::ptrdiff_t>(k * width));
    }
    return std::string(reinterpret_cast<const char*>(cells.data()), cells.size() * sizeof(char32_t));
  };
  columns_.push_back(std::move(column));
}

void NpzWriter::commit() {
  const auto fail = [&](const std::string& why) {
    throw std::runtime_error(fmt::format("{}: cannot be written: {}", place_.string(), why));
  };
  auto pending = place_;
  pending += ".part";
  int code = 0;
  zip_t* archive = zip_open(pending.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &code);
  if (archive == nullptr) {
    zip_error_t error;
    zip_error_init_with_code(&error, code);
    const std::string why = zip_error_strerror(&error);
    zip_error_fini(&error);
    fail(why);
  }
  std::error_code ignored;
  for (const auto& column : columns_) {
    zip_error_init(&column->error);
    zip_source_t* source = zip_source_function(archive, give, column.get());
    const auto index =
        source == nullptr ? -1 : zip_file_add(archive, (column->name + ".npy").c_str(), source, ZIP_FL_ENC_UTF_8);
    if (index < 0) {
      if (source != nullptr) zip_source_free(source);
      const std::string why = zip_strerror(archive);
      zip_discard(archive);
      fail(why);
    }
    zip_file_set_dostime(archive, static_cast<zip_uint64_t>(index), 0, first_date, 0);
  }
  if (zip_close(archive) != 0) {
    const std::string why = zip_strerror(archive);
    zip_discard(archive);
    std::filesystem::remove(pending, ignored);
    for (const auto& column : columns_)
      if (column->failure) std::rethrow_exception(column->failure);
    fail(why);
  }
  std::error_code error;
  std::filesystem::rename(pending, place_, error);
  if (error) fail(error.message());
}

}  // namespace stiction::host
