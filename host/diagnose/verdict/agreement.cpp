#include "host/diagnose/verdict/agreement.hpp"

#include <fmt/format.h>

#include <cmath>

namespace stiction::host {
namespace {

constexpr double position_margin = 2.0;  // over what noise leaves
constexpr double drowned = 0.3;          // of the force

}  // namespace

std::string_view name_of(Status status) {
  return status == Status::agrees ? "agrees" : status == Status::does_not_agree ? "does not agree" : "cannot tell";
}

Agreement agreement_of(const Remainder& rest, const std::string& withheld, const ShownUnits& units) {
  const auto force = units.force, deviation = units.deviation;
  auto left = fmt::format("{:.3g} {} rms of residual force where noise alone leaves {:.3g} {}", force(rest.force_rms),
                          force.unit, force(rest.noise_force_rms), force.unit);
  if (rest.force_rms > force_margin * rest.noise_force_rms) {
    if (rest.repeats) return {Status::does_not_agree, left};
    left += fmt::format(
        "; the rest, {:.2g} % of the force, repeats with nothing that was looked at and counts as what "
        "disturbs the axis",
        100.0 * rest.force_rms / rest.record_force_rms);
    if (rest.force_rms > drowned * rest.record_force_rms) return {Status::does_not_agree, left};
  }
  if (rest.noise_force_rms > drowned * rest.record_force_rms)
    return {Status::cannot_tell,
            fmt::format("noise alone leaves {:.3g} {} rms of these records unexplained, whose force is {:.3g} {} rms: "
                        "record with a finer encoder, a higher rate or larger accelerations",
                        force(rest.noise_force_rms), force.unit, force(rest.record_force_rms), force.unit)};
  if (!rest.position_error_rms)
    return {Status::cannot_tell,
            left + (withheld.empty() ? "; without set-points there is no closed loop to compare: log x_set"
                                     : "; the closed loop could not be compared. " + withheld)};
  const double noise = std::hypot(rest.noise_position_rms, rest.disturbed_position_rms);
  const auto position =
      fmt::format("{:.2g} {} rms of position error where noise alone leaves {:.2g} {}",
                  deviation(*rest.position_error_rms), deviation.unit, deviation(noise), deviation.unit);
  const bool near = *rest.position_error_rms <= position_margin * noise;
  return {near ? Status::agrees : Status::does_not_agree, fmt::format("{}; {}", left, position)};
}

}  // namespace stiction::host
