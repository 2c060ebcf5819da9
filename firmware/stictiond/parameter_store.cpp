#include "firmware/stictiond/parameter_store.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>

namespace stiction::drive {
namespace {

constexpr std::string_view format = "stiction.parameters/1";
// Longer ones are not of this program; the shipped machine's has some 2 kB.
constexpr std::size_t longest_file = 1 << 20;

// Lines of a file, and messages that name them.
class Lines {
 public:
  Lines(std::string_view bytes, const std::string& file) : rest_(bytes), file_(file) {}

  [[noreturn]] void fail(std::string_view found, std::string_view expected) const {
    throw ParametersDamaged(fmt::format(
        "{}:{}: found {}; expected {}; the file is not used. Remove it, or replace it by the previous set: {}", file_,
        number_, found, expected, previous_of(file_).string()));
  }
  bool empty() const { return rest_.empty(); }
  std::string_view rest() const { return rest_; }

  std::string_view next(std::string_view expected) {
    ++number_;
    const std::size_t end = rest_.find('\n');
    if (end == std::string_view::npos) fail("the end of the file within a line", expected);
    const std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    return line;
  }
  // What follows `key` and a space.
  std::string_view value_of(std::string_view key, std::string_view expected) {
    const std::string_view line = next(expected);
    if (!line.starts_with(key) || line.size() <= key.size() || line[key.size()] != ' ') fail(shown(line), expected);
    return line.substr(key.size() + 1);
  }
  // Bytes as a message may show them.
  static std::string shown(std::string_view text) {
    std::string plain(text.substr(0, 60));
    for (char& c : plain)
      if (c < ' ' || c > '~') c = '?';
    return '"' + plain + '"';
  }

 private:
  std::string_view rest_;
  std::string file_;
  int number_ = 0;
};

std::uint32_t checksum(std::string_view bytes) {
  return static_cast<std::uint32_t>(::crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

template <class Number, class... Base>
std::optional<Number> number_in(std::string_view text, Base... base) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base...);
  if (error != std::errc{} || end != text.data() + text.size()) return {};
  return value;
}

bool is_name(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c <= '~'; });
}

// Length and checksum before a value is looked at.
void check_head(Lines& lines) {
  const std::string_view version = lines.next(fmt::format("\"{}\"", format));
  if (version != format) lines.fail(Lines::shown(version), fmt::format("\"{}\"", format));
  const std::string_view length_text = lines.value_of("length", "\"length\" and a number of bytes");
  const auto length = number_in<std::size_t>(length_text);
  if (!length) lines.fail(Lines::shown(length_text), "a number of bytes");
  const std::string_view sum_text = lines.value_of("crc32", "\"crc32\" and eight digits of base 16");
  const auto sum = number_in<std::uint32_t>(sum_text, 16);
  if (!sum || sum_text.size() != 8) lines.fail(Lines::shown(sum_text), "eight digits of base 16");
  if (lines.rest().size() != *length)
    lines.fail(fmt::format("{} bytes after this line", lines.rest().size()), fmt::format("{}", *length));
  const std::uint32_t found = checksum(lines.rest());
  if (found != *sum) lines.fail(fmt::format("the checksum {:08x}", found), fmt::format("{:08x}", *sum));
}

}  // namespace

std::filesystem::path previous_of(const std::filesystem::path& file) { return file.string() + ".previous"; }

std::string encode(const ParameterSet& set) {
  if (!is_name(set.machine)) throw std::invalid_argument("a machine's id without spaces expected");
  std::string body = fmt::format("machine {}\n", set.machine);
  for (const auto& [key, value] : set.values) {
    if (!is_name(key))
      throw std::invalid_argument(fmt::format("found the key \"{}\"; expected one without spaces", key));
    if (!std::isfinite(value))
      throw std::invalid_argument(fmt::format("{}: found {}; expected a finite number", key, value));
    body += fmt::format("{} {}\n", key, value);
  }
  return fmt::format("{}\nlength {}\ncrc32 {:08x}\n{}", format, body.size(), checksum(body), body);
}

ParameterSet decode(std::string_view bytes, const std::string& file) {
  Lines lines(bytes, file);
  if (bytes.size() > longest_file)
    lines.fail(fmt::format("{} bytes", bytes.size()), fmt::format("at most {}", longest_file));
  check_head(lines);
  ParameterSet set;
  set.machine = lines.value_of("machine", "\"machine\" and its id");
  if (!is_name(set.machine)) lines.fail(Lines::shown(set.machine), "a machine's id without spaces");
  while (!lines.empty()) {
    const std::string_view expected = "a key and a finite number";
    const std::string_view line = lines.next(expected);
    const std::size_t space = line.find(' ');
    const std::string_view key = line.substr(0, space);
    if (space == std::string_view::npos || !is_name(key)) lines.fail(Lines::shown(line), expected);
    const auto value = number_in<double>(line.substr(space + 1));
    if (!value || !std::isfinite(*value)) lines.fail(Lines::shown(line), expected);
    if (!set.values.emplace(key, *value).second) lines.fail(Lines::shown(line), "each key once");
  }
  return set;
}

std::optional<ParameterSet> read_parameters(const std::filesystem::path& file, FileOperations& files) {
  const auto bytes = files.read(file);
  if (!bytes) return {};
  return decode(*bytes, file.string());
}

void write_parameters(const std::filesystem::path& file, const ParameterSet& set, KeepAsPrevious keep,
                      FileOperations& files) {
  const std::string bytes = encode(set);
  const std::filesystem::path fresh = file.string() + ".new";
  files.create(fresh);
  files.append(fresh, bytes);
  files.sync(fresh);
  if (keep == KeepAsPrevious::the_file && files.read(file)) {
    files.remove(previous_of(file));
    files.link(file, previous_of(file));
  }
  files.rename(fresh, file);
  files.sync_folder(file.has_parent_path() ? file.parent_path() : ".");
}

}  // namespace stiction::drive
