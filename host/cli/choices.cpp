#include "host/cli/choices.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "firmware/machine/file/nearest_name.hpp"
#include "host/cli/errors.hpp"
#include "host/log/message.hpp"

namespace stiction::host {

std::string nearest_words(std::string_view name, const std::vector<std::string>& known) {
  const auto nearest = machine::nearest_name(name, {known.begin(), known.end()});
  return nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest);
}

void require_known(std::string_view option, const std::string& name, std::string_view expected,
                   const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), name) != known.end()) return;
  throw UsageError(fmt::format("{}: found '{}'; expected {}: {}{}", option, excerpt(name), expected,
                               fmt::join(known, ", "), nearest_words(name, known)));
}

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

}  // namespace stiction::host
