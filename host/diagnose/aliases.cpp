#include "host/diagnose/aliases.hpp"

#include <array>

namespace stiction::host {
namespace {

constexpr std::string_view turn = "turn the axis, move another payload, or read the current at standstill";
constexpr std::string_view added_mass = "move with a known added mass, at several levels of acceleration";
constexpr std::string_view elastic = "load the standing axis and read its elastic slope, or fit a second encoder";
constexpr std::string_view slow = "record more speeds below 10 mm/s";
constexpr std::string_view reversals = "record small reversals of several amplitudes";
constexpr std::string_view response = "measure the frequency response: a delay's phase falls in proportion to frequency";

// Each pair stands once and holds both ways.
constexpr std::array<Alias, 14> pairs{{
    {"friction_asymmetry", "constant_force", turn, true},
    {"position_spring", "constant_force", "reach further along the stroke: a spring's force grows with it"},
    {"mass_mismatch", "force_constant_mismatch", added_mass},
    {"coulomb_mismatch", "force_constant_mismatch", added_mass},
    {"viscous_mismatch", "force_constant_mismatch", added_mass},
    {"backlash", "presliding_hysteresis", elastic},
    {"time_skew", "viscous_mismatch", response},
    {"viscous_nonlinear", "stribeck", slow},
    {"viscous_nonlinear", "viscous_mismatch", "record more speeds over the whole range"},
    {"viscous_nonlinear", "coulomb_mismatch", slow},
    {"stribeck", "coulomb_mismatch", slow},
    {"presliding_hysteresis", "coulomb_mismatch", reversals},
    {"presliding_hysteresis", "stribeck", reversals},
    {"mass_mismatch", "force_saturation", added_mass},
}};

}  // namespace

std::vector<Alias> aliases_of(std::string_view effect) {
  std::vector<Alias> found;
  for (const auto& pair : pairs) {
    if (pair.effect == effect) found.push_back(pair);
    if (pair.other == effect) found.push_back({effect, pair.effect, pair.separate_by, pair.exact});
  }
  return found;
}

}  // namespace stiction::host
