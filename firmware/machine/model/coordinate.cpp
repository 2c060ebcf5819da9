#include "firmware/machine/model/coordinate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace stiction::machine {
namespace {

// A unit with lengths, what takes its place with angles, and the power of the radius in one of the second.
struct UnitPair {
  std::string_view linear, rotary;
  int power;
};
constexpr std::array unit_pairs{
    UnitPair{"m", "rad", 1},
    UnitPair{"m/s", "rad/s", 1},
    UnitPair{"m/s^2", "rad/s^2", 1},
    UnitPair{"m/s^3", "rad/s^3", 1},
    UnitPair{"N", "N m", -1},
    UnitPair{"N/m", "N m/rad", -2},
    UnitPair{"N s/m", "N m s/rad", -2},
    UnitPair{"kg", "kg m^2", -2},
    UnitPair{"N/A", "N m/A", -1},
    UnitPair{"N/V", "N m/V", -1},
    UnitPair{"V s/m", "V s/rad", -1},
    UnitPair{"A s/m", "A s/rad", -1},
    UnitPair{"V/m", "V/rad", -1},
    UnitPair{"A/m", "A/rad", -1},
};

constexpr std::array key_pairs{
    SpelledPair{"mass", "inertia"},
    SpelledPair{"force_constant", "torque_constant"},
    SpelledPair{"phase_force_constant", "phase_torque_constant"},
    SpelledPair{"force", "moment"},
};
// Data sheets give the pole pairs of a turn, not the angle of one.
constexpr SpelledPair pitch_and_pairs{"pole_pair_pitch", "pole_pairs"};

}  // namespace

OwnQuantity Coordinate::own(std::string_view unit) const {
  OwnQuantity quantity{{}, unit};
  if (!rotary()) return quantity;
  const auto pair = std::find_if(unit_pairs.begin(), unit_pairs.end(), [&](const auto& p) { return p.linear == unit; });
  if (pair == unit_pairs.end()) return quantity;
  quantity.unit = pair->rotary;
  quantity.factor = std::pow(radius, pair->power);
  return quantity;
}

OwnQuantity Coordinate::own(std::string_view key, std::string_view unit) const {
  if (rotary() && key == pitch_and_pairs.linear)
    return {pitch_and_pairs.rotary, "1", 2.0 * std::numbers::pi * radius, true};
  auto quantity = own(unit);
  quantity.key = key;
  if (!rotary()) return quantity;
  const auto pair = std::find_if(key_pairs.begin(), key_pairs.end(), [&](const auto& p) { return p.linear == key; });
  if (pair != key_pairs.end()) quantity.key = pair->rotary;
  return quantity;
}

std::vector<SpelledPair> rotary_units() {
  std::vector<SpelledPair> pairs;
  for (const auto& pair : unit_pairs) pairs.push_back({pair.linear, pair.rotary});
  return pairs;
}

std::vector<SpelledPair> rotary_keys() {
  std::vector<SpelledPair> pairs(key_pairs.begin(), key_pairs.end());
  pairs.push_back(pitch_and_pairs);
  return pairs;
}

}  // namespace stiction::machine
