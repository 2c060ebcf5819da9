// Friction that remembers, as regressors: states driven by the measured motion alone, so that a force is linear in
// their weights. The LuGre contact (Canudas de Wit, Olsson, Astrom, Lischinsky 1995) and stop operators (Prandtl,
// Ishlinskii; a Maxwell-slip element is one of them).
#pragma once

#include <span>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/identify/motion.hpp"

namespace stiction::host {

// The contact of unit Coulomb level: s' = k (v - |v| s / g(v)), g(v) = 1 + (static_ratio - 1) stribeck(v/v_s), the
// law's own curve (sim/plant/friction/lugre.hpp). With the Coulomb level F_C, F_C s is the LuGre model's k_s z and k =
// k_s / F_C.
struct ContactShape {
  double inverse_length = 0.0;  // k, 1/m
  double static_ratio = 1.0;
  double stribeck_velocity = 1e-3;  // m/s
  // The law whose contact it is, rate-independent, drawn out until its stiffness over its level is `inverse_length`;
  // nullptr: LuGre's, as above.
  const machine::FrictionParameters* law = nullptr;
};

struct Contact {
  std::vector<double> level;   // s
  std::vector<double> rate;    // s', 1/s
  std::vector<double> memory;  // what is left of a unit level at the log's start: the state then is not known
};

// Each step is exact for the displacement it covers, whatever its length.
Contact contact_of(const Motion& motion, const ContactShape& shape);

// stribeck(v/v_s) times the level of the contact: what Stribeck's effect adds to the force for one newton. `motion`: of
// the log; `level`: from contact_of(); `stribeck_velocity`: v_s, m/s, above 0.
std::vector<double> stribeck_column(const Motion& motion, const std::vector<double>& level, double stribeck_velocity);

// Stop operator: a spring of unit stiffness (N/m) whose slider gives way at the displacement `distance` (m).
std::vector<double> stop_operator(const Motion& motion, double distance);

}  // namespace stiction::host
