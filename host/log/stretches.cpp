#include "host/log/stretches.hpp"

#include <algorithm>
#include <utility>

namespace stiction::host {

std::vector<Log> stretches_of(Log log) {
  auto all = std::exchange(log.others, {});
  const auto at = static_cast<std::ptrdiff_t>(std::min(log.clock.stretch, all.size()));
  all.insert(all.begin() + at, std::move(log));
  return all;
}

}  // namespace stiction::host
