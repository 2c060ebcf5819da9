// Effects that a programme gives while it runs and no folder has: forces on the carriage, such as a function of Python.
// An axis names one in a row as it names the others; no file can, as their names are none.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "firmware/machine/model/effect.hpp"
#include "sim/effects/carriage_state.hpp"

namespace stiction::sim {

class GivenForce {
 public:
  // N on the carriage, positive in +x. Asked once or several times a step of the plant, and of several plants from
  // several threads: its value depends on the state alone. What it throws leaves the plant's tick.
  using Law = std::function<double(const CarriageState&)>;

  // Plants that are made from now on know `law` under a name of its own, until this is destroyed.
  explicit GivenForce(Law law);
  GivenForce(const GivenForce&) = delete;
  GivenForce& operator=(const GivenForce&) = delete;
  ~GivenForce();

  // The row with which an axis has it.
  machine::Effect effect() const { return {name_, {}}; }

 private:
  std::string name_;
};

// The law of the row `effect` of an axis; null: it is none of a GivenForce that is there.
std::shared_ptr<const GivenForce::Law> given_force(const machine::Effect& effect);

}  // namespace stiction::sim
