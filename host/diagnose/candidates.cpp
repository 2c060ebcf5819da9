#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "host/diagnose/candidate.hpp"

namespace stiction::host {

std::span<const Candidate> candidates() {
  static const std::array table{
      effects::mass_mismatch,
      effects::coulomb_mismatch,
      effects::viscous_mismatch,
      effects::viscous_nonlinear,
      effects::stribeck,
      effects::friction_asymmetry,
      effects::presliding_hysteresis,
      effects::friction_lag,
      effects::position_dependent_friction,
      effects::thermal_drift,
      effects::constant_force,
      effects::position_spring,
      effects::force_ripple,
      effects::force_constant_ripple,
      effects::force_constant_mismatch,
      effects::force_saturation,
      effects::backlash,
      effects::structural_resonance,
      effects::encoder_subdivision_error,
      effects::time_skew,
      effects::cross_axis_coupling,
      effects::periodic_disturbance,
      signatures::localised_force,
      signatures::ripple_with_speed,
      signatures::force_after_reversal,
      signatures::force_after_way_back,
      signatures::force_with_acceleration,
      signatures::drifting_force,
  };
  return table;
}

namespace effects {

void add_key(Finding& finding, const char* key, const char* suffix, std::vector<double> values,
             std::vector<double> errors) {
  finding.effect.values[key] = values;
  finding.parameters.push_back({std::string(key) + suffix, std::move(values), std::move(errors)});
}

Columns waves_over_position(const Motion& motion, double pitch, const std::vector<double>& size) {
  Columns pair(2, std::vector<double>(motion.x.size()));
  for (std::size_t i = 0; i < motion.x.size(); ++i) {
    const double phase = 2.0 * std::numbers::pi * motion.x[i] / pitch;
    pair[0][i] = -size[i] * std::cos(phase);
    pair[1][i] = -size[i] * std::sin(phase);
  }
  return pair;
}

std::array<double, 2> first_wave(const Eigen::VectorXd& coefficients) {
  const double amplitude = std::sqrt(coefficients.squaredNorm() / (0.5 * static_cast<double>(coefficients.size())));
  const double turn = amplitude / std::max(std::hypot(coefficients[0], coefficients[1]), 1e-300);
  return {turn * coefficients[0], turn * coefficients[1]};
}

std::vector<double> geometric(double low, double high, int count) {
  std::vector<double> values;
  for (int k = 0; k < count; ++k) values.push_back(low * std::pow(high / low, static_cast<double>(k) / (count - 1)));
  return values;
}

}  // namespace effects
}  // namespace stiction::host
