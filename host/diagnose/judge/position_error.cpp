#include "host/diagnose/judge/position_error.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "host/simulate/control_run.hpp"

namespace stiction::host {

std::size_t first_compared(const Log& log) {
  constexpr double ignored = 0.25;  // s
  return std::min(static_cast<std::size_t>(ignored / log.period), log.t.size() / 2);
}

double difference_rms(const Positions& a, const Positions& b, const std::vector<Log>& logs) {
  double square = 0.0;
  std::size_t count = 0;
  for (std::size_t k = 0; k < logs.size(); ++k)
    for (std::size_t i = first_compared(logs[k]); i < a[k].size(); ++i, ++count)
      square += (a[k][i] - b[k][i]) * (a[k][i] - b[k][i]);
  return std::sqrt(square / static_cast<double>(std::max<std::size_t>(count, 1)));
}

double largest_difference(const Positions& a, const Positions& b, const std::vector<Log>& logs) {
  double largest = 0.0;
  for (std::size_t k = 0; k < logs.size(); ++k)
    for (std::size_t i = first_compared(logs[k]); i < a[k].size(); ++i)
      largest = std::max(largest, std::abs(a[k][i] - b[k][i]));
  return largest;
}

ReplaySetup extended_setup(ReplaySetup setup, const std::vector<Finding>& findings) {
  for (const auto& finding : findings)
    for (auto& axis : setup.machine.axes)
      if (axis.name == finding.axis) axis.effects.push_back(finding.row());
  return setup;
}

std::optional<Positions> positions_under(const Disturbance& disturbance, ReplaySetup setup, std::uint64_t seed) {
  for (std::size_t k = 0; k < setup.logs.size(); ++k) {
    auto& force = setup.logs[k].axes.front().external_force;
    const auto drawn = disturbance.drawn(setup.logs[k].t, seed * setup.logs.size() + k);
    force.resize(drawn.size(), 0.0);
    std::transform(force.begin(), force.end(), drawn.begin(), force.begin(), std::plus<>());
  }
  try {
    return simulated_positions(setup);
  } catch (const FaultTripped&) {
    return {};
  }
}

}  // namespace stiction::host
