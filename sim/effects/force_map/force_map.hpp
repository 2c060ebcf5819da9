// A force that was measured and has no name: a table over position, over velocity, or over both, linear between its
// places and constant beyond them. At a reversal the force of one direction turns to that of the other with the
// direction of carriage_state.hpp, so that a table whose two sides differ at standstill does not chatter.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "firmware/machine/model/parameter.hpp"
#include "sim/effects/carriage_state.hpp"
#include "sim/effects/effect_values.hpp"

namespace stiction::sim {

class ForceMap {
 public:
  struct Parameters {
    std::vector<double> position, velocity, force;
  };
  static constexpr std::string_view name = "force_map";
  static constexpr std::string_view text = "a force over position, velocity, or both, from a table";
  static constexpr bool several = true;
  static constexpr std::array<machine::Parameter<Parameters>, 3> parameters{{
      {"position", "m", machine::any_value(), &Parameters::position, {}, "rising positions; one: the same at all"},
      {"velocity",
       "m/s",
       machine::any_value(),
       &Parameters::velocity,
       {},
       "rising velocities, of both directions; one: the same at all"},
      {"force",
       "N",
       machine::any_value(),
       &Parameters::force,
       {},
       "on the carriage, positive in +x: at the first position for each velocity, then at the next"},
  }};
  static constexpr bool is_friction = false;

  // Throws EffectError.
  static void check(const Parameters& p) {
    rising("position", "m", p.position);
    rising("velocity", "m/s", p.velocity);
    if (const auto expected = p.position.size() * p.velocity.size(); p.force.size() != expected)
      throw EffectError(name, fmt::format("a list of {} as force", p.force.size()),
                        fmt::format("a list of {}, one for each position and velocity", expected));
  }

  ForceMap(const Parameters& p, Body) : p_(p) {}

  double force(const CarriageState& s) const {
    const double speed = std::abs(s.velocity), share = 0.5 * (1.0 + s.direction);
    return share * at(s.position, speed) + (1.0 - share) * at(s.position, -speed);
  }

  // N, at a position (m) and velocity (m/s).
  double at(double position, double velocity) const {
    const Place x = place(p_.position, position), v = place(p_.velocity, velocity);
    const auto row = [&](std::size_t i) {
      const double* first = p_.force.data() + i * p_.velocity.size();
      return first[v.low] + v.share * (first[v.high] - first[v.low]);
    };
    const double low = row(x.low);
    return low + x.share * (row(x.high) - low);
  }

 private:
  struct Place {
    std::size_t low, high;
    double share;  // of the way from low to high
  };
  static Place place(const std::vector<double>& places, double at) {
    const auto next = static_cast<std::size_t>(std::upper_bound(places.begin(), places.end(), at) - places.begin());
    if (next == 0) return {0, 0, 0.0};
    if (next == places.size()) return {next - 1, next - 1, 0.0};
    return {next - 1, next, (at - places[next - 1]) / (places[next] - places[next - 1])};
  }
  static void rising(std::string_view key, std::string_view unit, const std::vector<double>& places) {
    if (places.empty()) throw EffectError(name, fmt::format("no {}", key), "at least one");
    for (std::size_t k = 1; k < places.size(); ++k)
      if (!(places[k] > places[k - 1]))
        throw EffectError(name, fmt::format("{:g} {} behind {:g} {}", places[k], unit, places[k - 1], unit),
                          fmt::format("a rising {}", key));
  }

  Parameters p_;
};

}  // namespace stiction::sim
