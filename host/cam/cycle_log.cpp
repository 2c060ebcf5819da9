#include "host/cam/cycle_log.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>

namespace stiction::host {
namespace {

// A master that is slower than this share over this time has been stopped: encoders of masters have less jitter.
constexpr double stopped_share = 0.5, stopped_time = 10e-3;  // 1, s

// Of the slave's way, which the set-points go while an encoder stays: more than what any encoder is late by.
constexpr double unseen_share = 0.05;

}  // namespace

std::optional<std::string> stop_in_cycle(const CycleSamples& samples, double master_speed, double scale,
                                         const std::string& unit) {
  const auto& [time, master, load, set] = samples;
  std::size_t from = 0;
  for (std::size_t k = 1; k < time.size(); ++k) {
    while (time[k] - time[from + 1] >= stopped_time) ++from;
    const double passed = time[k] - time[from];
    if (passed < stopped_time || master[k] - master[from] >= stopped_share * master_speed * passed) continue;
    // To where it turns again.
    std::size_t end = k;
    while (end + 1 < time.size() &&
           master[end + 1] - master[end] < stopped_share * master_speed * (time[end + 1] - time[end]))
      ++end;
    return fmt::format(
        "found a master that stops at {:.4g} {} for {:.3g} ms; expected a cycle without a stop, since the dwell is "
        "counted from the master",
        master[k] * scale, unit, (time[end] - time[from]) * 1e3);
  }
  return std::nullopt;
}

std::optional<std::string> encoder_at_its_end(const CycleSamples& samples, double range, double scale,
                                              const std::string& unit) {
  const auto& [time, master, load, set] = samples;
  if (set.empty()) return std::nullopt;
  std::size_t from = 0;
  for (std::size_t k = 1; k < load.size(); ++k) {
    if (load[k] != load[from]) {
      from = k;
      continue;
    }
    if (std::fabs(set[k] - set[from]) < unseen_share * range) continue;
    return fmt::format(
        "found an encoder at the load that stays where it is from the master's {:.4g} {} on, while the set-points go "
        "{:.0f} % of the stroke; expected one that follows, not one at the end of its range",
        master[from] * scale, unit, 100.0 * unseen_share);
  }
  return std::nullopt;
}

}  // namespace stiction::host
