#include "host/cli/choices.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <limits>

#include "host/log/message.hpp"

namespace stiction::host {

CLI::Validator one_of(const std::vector<std::string>& names) {
  return CLI::Validator(
      [names](std::string& found) {
        if (std::find(names.begin(), names.end(), found) != names.end()) return std::string();
        std::string expected;
        for (std::size_t k = 0; k < names.size(); ++k)
          expected += (k == 0 ? "" : k + 1 == names.size() ? " or " : ", ") + names[k];
        return fmt::format("found '{}'; expected {}{}", excerpt(found), expected, nearest_words(found, names));
      },
      fmt::format("{{{}}}", fmt::join(names, ",")));
}

CLI::Validator whole_number() {
  return CLI::Validator(
      [](std::string& found) {
        std::uint64_t number = 0;
        const auto* end = found.data() + found.size();
        const auto read = std::from_chars(found.data(), end, number);
        if (read.ec == std::errc{} && read.ptr == end) return std::string();
        return fmt::format("found '{}'; expected a whole number from 0 to {}", excerpt(found),
                           std::numeric_limits<std::uint64_t>::max());
      },
      "");
}

CLI::Validator whole_number_between(int least, int most) {
  return CLI::Validator(
      [least, most](const std::string& text) {
        int value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool whole = error == std::errc() && end == text.data() + text.size();
        if (whole && value >= least && value <= most) return std::string();
        return fmt::format("found '{}'; expected a whole number from {} to {}", excerpt(text), least, most);
      },
      "");
}

CLI::Validator number_between(double least, double most) {
  return CLI::Validator(
      [least, most](const std::string& text) {
        double value = 0.0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool number = error == std::errc() && end == text.data() + text.size();
        if (number && value >= least && value <= most) return std::string();
        return fmt::format("found '{}'; expected a number from {} to {}", excerpt(text), least, most);
      },
      "");
}

}  // namespace stiction::host
