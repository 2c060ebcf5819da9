#include "firmware/machine/file/nearest_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace stiction::machine {
namespace {

// Nobody types more than this; a file with a name of megabytes must not cost its square.
constexpr std::size_t longest_name = 100;

// What is compared: "Force-Ripple" is "force_ripple".
std::string comparable(std::string_view name) {
  std::string text;
  for (const char c : name) {
    if (c == ' ' || c == '-' || c == '_') continue;
    text += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return text;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before, row(b.size() + 1), next(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    next[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      next[j + 1] = std::min({row[j] + (a[i] == b[j] ? 0 : 1), row[j + 1] + 1, next[j] + 1});
      const bool exchanged = i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j];
      if (exchanged) next[j + 1] = std::min(next[j + 1], before[j - 1] + 1);
    }
    before = row;
    std::swap(row, next);
  }
  return row.back();
}

// The only known name that begins with `text`, three characters or more of it; empty where there are none or several.
std::string_view only_completion(const std::string& text, const std::vector<std::string_view>& known) {
  std::string_view found;
  if (text.size() < 3) return found;
  for (const std::string_view candidate : known) {
    if (!comparable(candidate).starts_with(text)) continue;
    if (!found.empty()) return {};
    found = candidate;
  }
  return found;
}

}  // namespace

std::string_view nearest_name(std::string_view name, const std::vector<std::string_view>& known) {
  const std::string text = comparable(name.substr(0, longest_name));
  if (text.empty()) return {};
  std::string_view nearest;
  std::size_t limit = std::min(1 + text.size() / 5, text.size() - 1);  // something of the name must remain
  for (const std::string_view candidate : known) {
    const std::size_t distance = edit_distance(text, comparable(candidate));
    if (distance > limit || (distance == limit && !nearest.empty())) continue;
    limit = distance;
    nearest = candidate;
  }
  return nearest.empty() ? only_completion(text, known) : nearest;
}

std::string did_you_mean(std::string_view name, const std::vector<std::string_view>& known) {
  const std::string_view nearest = nearest_name(name, known);
  return nearest.empty() ? "" : fmt::format("; did you mean \"{}\"?", nearest);
}

}  // namespace stiction::machine
