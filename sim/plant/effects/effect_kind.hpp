// An effect as others see it: its name, its keys with units, and what it may be confused with. Made from the effects'
// own tables (effects.hpp).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "firmware/machine/model/parameter.hpp"

namespace stiction::sim {

struct EffectKey {
  std::string_view key;                  // in the machine file: "viscous"
  std::string_view unit;                 // SI: "N s/m"; "1" for dimensionless
  std::string_view unit_of_force_motor;  // where it differs with a motor that is a force source; else empty
  std::string suffix;                    // of the name in verdict.json: "_N_s_per_m"; empty for dimensionless
  machine::Range range;                  // of each value
  bool list = false;
  bool required = true;   // otherwise 0 when left out
  bool optional = false;  // nothing when left out
  std::string_view text;
};

struct EffectAlias {
  std::string_view effect;       // a name of the whole vocabulary, also of an effect that has no row yet
  std::string_view separate_by;  // the experiment that tells the two apart
};

struct EffectKind {
  std::string_view name;
  std::string_view text;  // what the simulation lacks or has wrong
  bool several = false;   // whether one axis may have more than one of it
  std::vector<EffectKey> keys;
  std::vector<EffectAlias> aliases;
};

}  // namespace stiction::sim
