#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "host/cam/exchange.hpp"

namespace stiction::host {
namespace {

using sim::cam::CamError;

struct Line {
  std::size_t number;
  std::string_view text;
};

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

// The lines that are not empty.
std::vector<Line> lines_of(std::string_view text) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  std::vector<Line> lines;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const auto end = std::min(text.find('\n'), text.size());
    if (const auto line = trimmed(text.substr(0, end)); !line.empty()) lines.push_back({number, line});
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

// Cells between separators; of ' ' between runs of blanks.
std::vector<std::string_view> cells_of(std::string_view line, char separator) {
  std::vector<std::string_view> cells;
  if (separator == ' ') {
    for (line = trimmed(line); !line.empty(); line = trimmed(line)) {
      const auto end = std::min(line.find_first_of(" \t"), line.size());
      cells.push_back(line.substr(0, end));
      line.remove_prefix(end);
    }
    return cells;
  }
  for (;;) {
    const auto end = std::min(line.find(separator), line.size());
    cells.push_back(trimmed(line.substr(0, end)));
    if (end == line.size()) return cells;
    line.remove_prefix(end + 1);
  }
}

std::optional<double> number_of(std::string_view cell, char decimal) {
  std::string text(cell);
  if (decimal != '.') std::replace(text.begin(), text.end(), decimal, '.');
  if (text.starts_with('+')) text.erase(0, 1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

[[noreturn]] void fail(const Line& line, std::string_view found, std::string_view expected) {
  throw CamError(fmt::format("line {}: found '{}'; expected {}", line.number, found.substr(0, 40), expected));
}

double required_number(const Line& line, std::string_view cell, char decimal) {
  const auto value = number_of(cell, decimal);
  if (value) return *value;
  if (decimal == '.' && cell.find(',') != std::string_view::npos && number_of(cell, ','))
    fail(line, cell, "a number with a decimal point; for a decimal comma use --format csv --decimal ,");
  fail(line, cell, "a number");
}

// How the rows of a file are written.
struct RowLayout {
  char separator = ' ';
  char decimal = '.';
  std::string columns = "xy";
  std::string_view last{};  // a word at the end of each row
};

struct RawRows {
  std::vector<double> x, y, v, a;
};

RawRows rows_of(const std::vector<Line>& lines, const RowLayout& layout) {
  RawRows rows;
  const std::size_t wanted = layout.columns.size() + (layout.last.empty() ? 0 : 1);
  for (const Line& line : lines) {
    const auto cells = cells_of(line.text, layout.separator);
    if (cells.size() != wanted) fail(line, line.text, fmt::format("a row of {} cells", wanted));
    if (!layout.last.empty() && cells.back() != layout.last) fail(line, cells.back(), layout.last);
    for (std::size_t k = 0; k < layout.columns.size(); ++k) {
      const double value = required_number(line, cells[k], layout.decimal);
      const char c = layout.columns[k];
      (c == 'x' ? rows.x : c == 'y' ? rows.y : c == 'v' ? rows.v : rows.a).push_back(value);
    }
    if (const auto n = rows.x.size(); n > 1 && !(rows.x[n - 1] > rows.x[n - 2]))
      fail(line, cells.front(), fmt::format("a master above {} of the row before", rows.x[n - 2]));
  }
  return rows;
}

struct FileParts {
  std::vector<Line> rows;
  RowLayout layout;
  std::optional<bool> cyclic;
};

// The lines behind `begin`, up to `end` where there is one.
std::vector<Line> between(const std::vector<Line>& lines, std::string_view begin, std::string_view end) {
  const auto is = [](std::string_view word) { return [word](const Line& line) { return line.text == word; }; };
  const auto first = std::find_if(lines.begin(), lines.end(), is(begin));
  if (first == lines.end()) throw CamError(fmt::format("found no line {}; expected one before the rows", begin));
  const auto last = std::find_if(first, lines.end(), is(end));
  return {first + 1, last};
}

FileParts parts_of_sew(std::vector<Line> lines) {
  const auto count = number_of(lines.front().text, '.');
  if (!count || *count != static_cast<double>(lines.size() - 1))
    fail(lines.front(), lines.front().text, fmt::format("the count of the rows behind it, {}", lines.size() - 1));
  lines.erase(lines.begin());
  return {std::move(lines), {}, {}};
}

FileParts parts_of_kollmorgen(const std::vector<Line>& lines) {
  FileParts parts{between(lines, "TABLE_BEGIN", "TABLE_END"), {';', '.', "xy", "SPLINE"}, {}};
  if (!parts.rows.empty() && parts.rows.front().text == "X;Y;SPLINE") parts.rows.erase(parts.rows.begin());
  for (const Line& line : lines) {
    if (line.text == "CYCLIC;YES") parts.cyclic = true;
    if (line.text == "CYCLIC;NO") parts.cyclic = false;
  }
  return parts;
}

FileParts parts_of_xyva(std::vector<Line> lines) {
  if (!number_of(cells_of(lines.front().text, ',').front(), '.')) lines.erase(lines.begin());
  return {std::move(lines), {',', '.', "xyva", ""}, {}};
}

FileParts parts_of_csv(std::vector<Line> lines, const CsvLayout& csv) {
  if (csv.header && !lines.empty()) lines.erase(lines.begin());
  return {std::move(lines), {csv.separator, csv.decimal, csv.columns, ""}, {}};
}

FileParts parts_of(const std::string& text, const ExchangeFormat& format, const ExchangeSettings& settings) {
  auto lines = lines_of(text);
  if (lines.empty()) throw CamError(fmt::format("found an empty file; expected one of {}", format.name));
  if (format.name == "sew") return parts_of_sew(std::move(lines));
  if (format.name == "kollmorgen-csv") return parts_of_kollmorgen(lines);
  if (format.name == "isg") return {between(lines, "Begintable", "Endtable"), {}, {}};
  if (format.name == "codesys-xy") return {std::move(lines), {}, {}};
  if (format.name == "xyva") return parts_of_xyva(std::move(lines));
  return parts_of_csv(std::move(lines), settings.csv);
}

bool all_rows_have(const std::vector<Line>& lines, std::size_t from, char separator, std::size_t cells) {
  return lines.size() > from &&
         std::all_of(lines.begin() + static_cast<std::ptrdiff_t>(from), lines.end(), [&](auto& line) {
           const auto found = cells_of(line.text, separator);
           return found.size() == cells &&
                  std::all_of(found.begin(), found.end(), [](auto cell) { return number_of(cell, '.').has_value(); });
         });
}

}  // namespace

std::string_view looks_like(const std::string& text) {
  if (text.starts_with("SCAM")) return "a table for the drive";
  if (text.find("stiction.cam/") != std::string::npos) return "a motion file";
  const auto lines = lines_of(text);
  const auto has = [&](std::string_view word) {
    return std::any_of(lines.begin(), lines.end(), [&](const Line& line) { return line.text.starts_with(word); });
  };
  if (has("TABLE_BEGIN") || has("CYCLIC;")) return "kollmorgen-csv";
  if (has("Begintable")) return "isg";
  if (lines.empty()) return "";
  if (lines.front().text.starts_with("<")) return "XML";
  if (number_of(lines.front().text, '.') && all_rows_have(lines, 1, ' ', 2)) return "sew";
  if (all_rows_have(lines, 0, ' ', 2)) return "codesys-xy";
  if (all_rows_have(lines, 1, ',', 4)) return "xyva";
  return "";
}

detail::ExchangeRows detail::read_rows(const std::string& text, const ExchangeFormat& format,
                                       const ExchangeSettings& settings, const sim::cam::Cam& like) {
  FileParts parts;
  RawRows raw;
  try {
    parts = parts_of(text, format, settings);
    raw = rows_of(parts.rows, parts.layout);
  } catch (const CamError& error) {
    const auto other = looks_like(text);
    if (other.empty() || other == format.name) throw;
    throw CamError(fmt::format("{}; the file looks like {}", error.what(), other));
  }
  if (raw.x.size() < 2)
    throw CamError(fmt::format("found {}; expected two rows or more", raw.x.empty() ? "no row" : "one row"));
  const auto [master, slave] = units_of(settings, like);
  const double rate = table_master(settings, 1.0) - table_master(settings, 0.0);
  ExchangeRows rows;
  rows.cyclic = parts.cyclic;
  for (const double x : raw.x) rows.master.push_back(axis_master(settings, x * master));
  for (const double y : raw.y) rows.slave.push_back(y * slave);
  for (const double v : raw.v) rows.speed.push_back(v * slave / master * rate);
  for (const double a : raw.a) rows.acceleration.push_back(a * slave / (master * master) * rate * rate);
  return rows;
}

}  // namespace stiction::host
