#include "host/requests/names.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "firmware/machine/file/nearest_name.hpp"
#include "host/log/message.hpp"
#include "host/requests/usage_error.hpp"

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

}  // namespace stiction::host
