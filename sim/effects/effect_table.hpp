// The folders of effects. The definition is made by CMake from their names (effect_folders.cmake); a programme that
// defines the function itself, from folders of its own, replaces the product's vocabulary.
#pragma once

#include <span>
#include <string_view>

#include "sim/effects/effect_descriptor.hpp"

namespace stiction::sim {

struct EffectFolder {
  EffectDescriptor (*describe)();
  std::string_view folder;  // from the repository's root
};

// In no order.
std::span<const EffectFolder> effect_folders();

}  // namespace stiction::sim
