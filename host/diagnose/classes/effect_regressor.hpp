// How a diagnosis looks for an effect: regressor.cpp in the effect's folder defines one EffectRegressor, `regressor`,
// in the namespace effects::FOLDER.
#pragma once

#include <span>
#include <string_view>

#include "host/diagnose/classes/candidate.hpp"
#include "host/diagnose/classes/command_parameter.hpp"
#include "host/diagnose/classes/encoder_cause.hpp"

namespace stiction::host {

struct EffectRegressor {
  Candidate force{};                            // in the residual force; without columns: it does not show there
  std::span<const Candidate> other_forces{};    // of other arrangements of the same parts
  std::span<const CommandParameter> command{};  // in the command residual
  EncoderCause encoders{};                      // in the difference of two encoders; without columns: not there
  std::string_view not_looked_for{};            // why, where it is looked for in none of them
};

struct RegressorFolder {
  std::string_view effect;  // the folder's name
  const EffectRegressor* regressor;
};

// The folders that have a regressor.cpp. The definition is made by CMake from their names (effect_folders.cmake); a
// programme that defines the function itself, from folders of its own, replaces the product's.
std::span<const RegressorFolder> regressor_folders();

// Null for an effect whose folder has none.
const EffectRegressor* regressor_of(sim::EffectId effect);

}  // namespace stiction::host
