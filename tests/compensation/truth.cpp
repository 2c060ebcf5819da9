#include "tests/compensation/truth.hpp"

#include <array>
#include <cmath>
#include <numeric>
#include <string>
#include <variant>

#include "firmware/machine/file/machine_file.hpp"
#include "sim/machine_file.hpp"
#include "sim/plant/friction/friction.hpp"
#include "sim/plant/friction/maxwell_slip.hpp"
#include "sim/plant/friction/parameters.hpp"

namespace stiction::compensation {
namespace {

double coulomb(const machine::AxisModel& axis) { return sim::coulomb_of(axis.friction); }

// Eleven elements, none where the compensation's fit has a distance, with a curve between power law and exponential;
// levels that follow the speed over 30 N of 90, and viscous friction that bends.
void many_elements(machine::AxisModel& axis) {
  const double level = axis.name == "X" ? 85.0 : 210.0;
  sim::MaxwellSlipParameters p;
  constexpr int count = 11;
  double sum = 0.0;
  std::vector<double> distance, share;
  for (int k = 0; k < count; ++k) {
    distance.push_back(0.37e-6 * std::pow(2.13, k));
    share.push_back(std::exp(-std::pow((k - 6.3) / 2.6, 2.0)));
    sum += share.back();
  }
  for (std::size_t k = 0; k < count; ++k) {
    p.level.push_back(level * share[k] / sum);
    p.stiffness.push_back(p.level.back() / distance[k]);
  }
  p.viscous = axis.name == "X" ? 430.0 : 1100.0;
  p.rise = 0.15 * level;
  p.rise_velocity = 0.02;
  sim::set_parameters<sim::MaxwellSlip<>>(axis.friction, p);
  axis.friction.use = "maxwell_slip";
  axis.effects.push_back({"viscous_nonlinear", {{"force", {0.4 * level}}, {"velocity", {0.15}}}});
}

void lugre(machine::AxisModel& axis) { axis.friction.use = "lugre"; }

void lugre_stribeck(machine::AxisModel& axis) {
  axis.friction.use = "lugre";
  axis.friction.models["lugre"]["static_ratio"] = {1.1};
}

void asymmetric(machine::AxisModel& axis) {
  many_elements(axis);
  axis.effects.push_back({"friction_asymmetry",
                          {{"coulomb", {0.1 * coulomb(axis)}}, {"viscous", {0.1 * sim::viscous_of(axis.friction)}}}});
}

// The level rises from one end of the circle to the other.
void along_the_stroke(machine::AxisModel& axis) {
  axis.friction.use = "lugre";
  const double part = 0.12 * coulomb(axis);
  axis.effects.push_back({"position_dependent_friction",
                          {{"position", {-0.1, -0.03, 0.02, 0.1}}, {"force", {-part, 0.4 * part, -0.5 * part, part}}}});
}

void rigid(machine::AxisModel& axis) { axis.friction.use = "classical"; }

void scale_friction(machine::AxisModel& axis, double factor) {
  sim::set_coulomb(axis.friction, factor * coulomb(axis));
  sim::set_viscous(axis.friction, factor * sim::viscous_of(axis.friction));
}
void change_mass(machine::AxisModel& axis, double factor) {
  axis.effects.push_back({"mass_mismatch", {{"mass", {factor * axis.mass}}}});
}
void change_delay(machine::AxisModel& axis, double by) { axis.inverter.dead_time += by; }

}  // namespace

machine::Machine cross_table() {
  return sim::read_machine(std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/mcfv5050ln.toml",
                           {"circle", {"axis.*.encoder.velocity=estimated", "axis.*.encoder.noise=2 nm"}});
}

std::span<const Truth> truths() {
  static constexpr std::array<Truth, 6> table{{
      {"elements", "eleven Maxwell-slip elements whose levels follow the speed, viscous friction that bends",
       many_elements},
      {"LuGre", "the shipped machine's LuGre contact", lugre},
      {"LuGre, Stribeck", "the same with static friction 10 % above Coulomb's", lugre_stribeck},
      {"asymmetric", "the elements with 10 % more friction in +x and 10 % less in -x", asymmetric},
      {"along the stroke", "LuGre with a level that varies by +-12 % along the stroke", along_the_stroke},
      {"rigid", "classical friction without any presliding: a limit, no machine", rigid, false},
  }};
  return table;
}

std::span<const Change> changes() {
  static constexpr std::array<Change, 6> table{{
      {"friction +20 %", [](machine::AxisModel& axis) { scale_friction(axis, 1.2); }},
      {"friction -20 %", [](machine::AxisModel& axis) { scale_friction(axis, 0.8); }},
      {"mass +10 %", [](machine::AxisModel& axis) { change_mass(axis, 1.1); }},
      {"mass -10 %", [](machine::AxisModel& axis) { change_mass(axis, 0.9); }},
      {"delay +62.5 us", [](machine::AxisModel& axis) { change_delay(axis, 62.5e-6); }},
      {"delay -62.5 us", [](machine::AxisModel& axis) { change_delay(axis, -62.5e-6); }},
  }};
  return table;
}

}  // namespace stiction::compensation
