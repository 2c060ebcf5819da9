#include "host/response/margins.hpp"

#include <cmath>
#include <numbers>

namespace stiction::host {
namespace {

// Points further apart, with others between that were no answer, are not joined.
constexpr double widest_gap = 2.0;

bool apart(const Curve& curve, std::size_t k) { return curve.frequency[k + 1] > widest_gap * curve.frequency[k]; }

// Between point k and the next one, `part` of the way on a logarithmic scale.
double frequency_between(const Curve& curve, std::size_t k, double part) {
  return curve.frequency[k] * std::pow(curve.frequency[k + 1] / curve.frequency[k], part);
}

double magnitude_between(const Curve& curve, std::size_t k, double part) {
  return std::exp((1.0 - part) * std::log(std::abs(curve.value[k])) + part * std::log(std::abs(curve.value[k + 1])));
}

}  // namespace

std::optional<GainMargin> gain_margin(const Curve& open) {
  std::optional<GainMargin> margin;
  for (std::size_t k = 0; k + 1 < open.value.size(); ++k) {
    if (apart(open, k)) continue;
    // Angles seen from -180 deg; a change of sign far from there crosses 0 deg.
    const double here = std::arg(-open.value[k]), next = std::arg(-open.value[k + 1]);
    if (here * next > 0.0 || std::abs(here - next) > std::numbers::pi || here == next) continue;
    const double part = here / (here - next);
    const double factor = 1.0 / magnitude_between(open, k, part);
    if (factor > 1.0 && (!margin || factor < margin->factor)) margin = {frequency_between(open, k, part), factor};
  }
  return margin;
}

std::optional<PhaseMargin> phase_margin(const Curve& open) {
  std::optional<PhaseMargin> margin;
  for (std::size_t k = 0; k + 1 < open.value.size(); ++k) {
    if (apart(open, k)) continue;
    const double here = std::log(std::abs(open.value[k])), next = std::log(std::abs(open.value[k + 1]));
    if ((here > 0.0) == (next > 0.0)) continue;
    const double part = here / (here - next);
    const double turn = std::arg(open.value[k + 1] / open.value[k]);
    const double degrees =
        std::remainder(std::arg(open.value[k]) + part * turn + std::numbers::pi, 2.0 * std::numbers::pi) * 180.0 /
        std::numbers::pi;
    if (!margin || std::abs(degrees) < std::abs(margin->degrees)) margin = {frequency_between(open, k, part), degrees};
  }
  return margin;
}

std::optional<double> bandwidth(const Curve& closed) {
  const double limit = -0.5 * std::numbers::ln2;  // -3 dB
  for (std::size_t k = 0; k + 1 < closed.value.size(); ++k) {
    if (apart(closed, k)) continue;
    const double here = std::log(std::abs(closed.value[k])), next = std::log(std::abs(closed.value[k + 1]));
    if (here >= limit && next < limit) return frequency_between(closed, k, (here - limit) / (here - next));
  }
  return std::nullopt;
}

Curve with_decay(const Curve& open, double decay) {
  Curve result;
  for (std::size_t k = 1; k + 1 < open.value.size(); ++k) {
    if (apart(open, k - 1) || apart(open, k)) continue;
    const double step = 2.0 * std::numbers::pi * (open.frequency[k + 1] - open.frequency[k - 1]);
    const std::complex<double> slope =
        (std::log(open.value[k + 1] / open.value[k]) + std::log(open.value[k] / open.value[k - 1])) / step;
    result.add(open.frequency[k], open.value[k] * std::exp(std::complex<double>(0.0, decay) * slope));
  }
  return result;
}

}  // namespace stiction::host
