#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "host/diagnose/classes/effect_regressor.hpp"
#include "sim/effects/effects.hpp"

namespace stiction::host {

const EffectRegressor* regressor_of(sim::EffectId effect) {
  const auto folders = regressor_folders();
  const auto found = std::find_if(folders.begin(), folders.end(),
                                  [&](const RegressorFolder& folder) { return folder.effect == effect->name; });
  return found == folders.end() ? nullptr : found->regressor;
}

std::span<const Candidate> candidates() {
  static const std::vector<Candidate> table = [] {
    std::vector<Candidate> made;
    for (const sim::EffectId effect : sim::all_effects())
      if (const auto* regressor = regressor_of(effect)) {
        if (regressor->force.columns != nullptr) made.emplace_back(regressor->force).effect = effect;
        for (const auto& force : regressor->other_forces) made.emplace_back(force).effect = effect;
      }
    for (const Candidate& shape :
         {signatures::localised_force::shape, signatures::ripple_with_speed::shape,
          signatures::force_after_reversal::shape, signatures::force_after_reversal::shape_on_way_back,
          signatures::force_with_acceleration::shape, signatures::drifting_force::shape})
      made.push_back(shape);
    for (const Candidate& function : signatures::smooth_functions::all()) made.push_back(function);
    return made;
  }();
  return table;
}

bool one_cause(std::size_t a, std::size_t b) {
  const auto &one = candidates()[a], &other = candidates()[b];
  return a == b || (one.effect && one.effect == other.effect);
}

std::optional<std::size_t> candidate_index(sim::EffectId effect) {
  const auto all = candidates();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Candidate& each) { return each.effect == effect; });
  if (found == all.end()) return std::nullopt;
  return static_cast<std::size_t>(found - all.begin());
}

std::span<const CommandParameter> command_parameters() {
  static const std::vector<CommandParameter> table = [] {
    std::vector<CommandParameter> made;
    for (const sim::EffectId effect : sim::all_effects())
      if (const auto* regressor = regressor_of(effect))
        for (const CommandParameter& parameter : regressor->command) made.emplace_back(parameter).effect = effect;
    std::stable_partition(made.begin(), made.end(), [](const CommandParameter& each) { return !each.is_delay; });
    return made;
  }();
  return table;
}

EffectParameter effect_parameter(const machine::AxisModel& axis, sim::EffectId effect, std::string_view key,
                                 std::vector<double> values, std::vector<double> errors) {
  const auto known = std::find_if(effect->keys.begin(), effect->keys.end(),
                                  [&](const machine::ValueKey& each) { return each.key == key; });
  if (known == effect->keys.end())
    throw std::logic_error(fmt::format("effect {}: found no key {}", effect.name(), key));
  const auto own = axis.coordinate.own(sim::key_unit(*known, axis));
  for (auto* all : {&values, &errors})
    for (double& value : *all) value = own.from_linear(value);
  return {std::string(key), std::string(own.unit), known->list, std::move(values), std::move(errors)};
}

namespace effects {

void add_key(const SearchContext& context, Finding& finding, std::string_view key, std::vector<double> values,
             std::vector<double> errors) {
  finding.values[std::string(key)] = values;
  finding.parameters.push_back(
      effect_parameter(context.axis, finding.effect, key, std::move(values), std::move(errors)));
}

void add_wave_keys(const SearchContext& context, Finding& finding, std::string_view length, double shape,
                   const Eigen::VectorXd& w, const Eigen::MatrixXd& c) {
  add_key(context, finding, length, {shape}, {std::sqrt(c(2, 2))});
  add_key(context, finding, "cosine", {w[0]}, {std::sqrt(c(0, 0))});
  add_key(context, finding, "sine", {w[1]}, {std::sqrt(c(1, 1))});
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
