#include "host/log/repeating_motion.hpp"

#include <algorithm>
#include <cmath>

namespace stiction::host {
namespace {

constexpr double straight = 0.005;   // of a cycle, by which the master may leave a straight line
constexpr double same_again = 1e-3;  // of the stroke, by which a cycle may differ from the next one

}  // namespace

UnwoundMaster unwound(const std::vector<double>& master) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < master.size(); ++k) steps.push_back(master[k] - master[k - 1]);
  auto sorted = steps;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double usual = *middle;
  UnwoundMaster result;
  result.turned.push_back(0.0);
  double jumps = 0.0;
  int count = 0;
  for (const double step : steps) {
    // A step against the master's direction, and much longer than one in it.
    const bool jump = step * usual < 0.0 && std::abs(step) > 10.0 * std::abs(usual);
    if (jump) jumps += std::abs(step - usual), ++count;
    result.turned.push_back(result.turned.back() + (jump ? usual : step));
  }
  if (count > 0) result.cycle = jumps / count;
  return result;
}

std::optional<RepeatingMotion> repeating_motion(const Log& log, const AxisLog& channels, const SetPoints& points) {
  if (channels.master.size() < 3 || channels.master.size() != log.t.size()) return std::nullopt;
  const auto [turned, cycle] = unwound(channels.master);
  const double way = turned.back(), duration = log.t.back() - log.t.front();
  if (cycle == 0.0 || std::abs(way) < cycle) return std::nullopt;
  for (std::size_t k = 0; k < turned.size(); ++k)
    if (std::abs(turned[k] - way * (log.t[k] - log.t.front()) / duration) > straight * cycle) return std::nullopt;

  RepeatingMotion found;
  found.period = duration * cycle / std::abs(way);
  const auto [low, high] = std::minmax_element(points.position().begin(), points.position().end());
  double least = 0.0, most = 0.0, sum = 0.0;
  std::size_t count = 0;
  for (std::size_t k = 0; k < log.t.size() && log.t[k] + found.period <= log.t.back(); ++k, ++count) {
    const double rise = points.at(log.t[k] + found.period).position - points.position()[k];
    least = count == 0 ? rise : std::min(least, rise);
    most = count == 0 ? rise : std::max(most, rise);
    sum += rise;
  }
  if (count == 0 || most - least > same_again * (*high - *low)) return std::nullopt;
  found.rise = sum / static_cast<double>(count);
  return found;
}

}  // namespace stiction::host
