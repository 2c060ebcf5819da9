// What the truth can hide: the table of effects with how they are drawn, what their true parameters are at a strength,
// and what they change in the mechanics. Inside the vocabulary the names and keys are the machine file's.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "firmware/machine/model/effect.hpp"
#include "tests/blind/truth/axis.hpp"
#include "tests/blind/truth/trajectory.hpp"

namespace stiction::blind {

// True parameters, SI, of one drawn effect at a strength; strength 0 is no effect, 1 a usual one, and the residual
// force grows with it.
using AtStrength = std::function<machine::Effect(double)>;

struct Hideable {
  const char* name;
  bool in_vocabulary;  // false: `name` says what it is; a name that the vocabulary may have for it is in `accepted`
  const char* accepted;
  AtStrength (*draw)(Random&, const Mechanics& file);
  void (*apply)(const machine::Effect&, Mechanics&);
  bool in_command = false;  // shows in the command residual, not in the residual force
};

std::span<const Hideable> hideables();
const Hideable& hideable(const std::string& name);  // throws std::out_of_range

}  // namespace stiction::blind
