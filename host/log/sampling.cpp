#include "host/log/sampling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stiction::host {
namespace {

double median_step(const std::vector<double>& t) {
  std::vector<double> steps(t.size() - 1);
  for (std::size_t k = 0; k < steps.size(); ++k) steps[k] = t[k + 1] - t[k];
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

std::string ms(double seconds) { return fmt::format("{:.6g} ms", seconds * 1e3); }

}  // namespace

double StampDigits::resolution_at(double t) const {
  const double magnitude = std::abs(t);
  const double rounding = magnitude > 0.0 ? std::pow(10.0, std::floor(std::log10(magnitude)) + 1.0 - significant) : 0.0;
  return std::max(finest, rounding);
}

void check_sampling(Log& log, const StampDigits& digits, const std::function<std::string(std::size_t)>& place) {
  const auto& t = log.t;
  if (t.size() < 2)
    throw LogError(
        fmt::format("{}: found {} sample{}; expected at least 2", place(t.size()), t.size(), t.size() == 1 ? "" : "s"));
  log.period = (t.back() - t.front()) / static_cast<double>(t.size() - 1);
  // Stamps coarser than half a step can only be whole steps: rounding explains nothing then.
  const double coarsest = std::max(digits.resolution_at(t.front()), digits.resolution_at(t.back()));
  const bool rounded = coarsest <= 0.5 * log.period;
  const double usual = rounded && coarsest > 0.1 * log.period ? log.period : median_step(t);
  const auto allowed = [&](std::size_t k) { return rounded ? digits.resolution_at(t[k]) : 0.0; };
  for (std::size_t k = 1; k < t.size(); ++k) {
    const double step = t[k] - t[k - 1];
    // Compared first without the digits' resolution, whose logarithm costs more than the rest of the loop.
    const double off = std::abs(step - usual);
    if (off <= step_tolerance * usual || off <= step_tolerance * usual + allowed(k)) continue;
    const double missing = std::round(step / usual) - 1.0;
    if (missing >= 1.0)
      throw LogError(
          fmt::format("{}: found a gap of {} before this sample, where {:.0f} sample{} missing; expected "
                      "uniform steps of {}",
                      place(k), ms(step), missing, missing > 1.0 ? "s are" : " is", ms(usual)));
    throw LogError(fmt::format("{}: found a step of {} before this sample; expected uniform steps of {}", place(k),
                               ms(step), ms(usual)));
  }
  // A rate that drifts within the tolerance of each step.
  for (std::size_t k = 1; k < t.size(); ++k) {
    const double off = t[k] - (t.front() + static_cast<double>(k) * log.period);
    if (std::abs(off) > 0.5 * usual && std::abs(off) > 0.5 * usual + allowed(k))
      throw LogError(
          fmt::format("{}: found this sample {} away from a uniform rate of {}; expected less than half a "
                      "step: the sampling rate changes",
                      place(k), ms(off), ms(log.period)));
  }
}

}  // namespace stiction::host
