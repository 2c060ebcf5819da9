// One blind case: a machine file, logs of a truth that it describes except for what is hidden, and the key to it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/log/log.hpp"
#include "tests/blind/truth/hidden.hpp"

namespace stiction::blind {

// What to hide. The share of each is V(effect) / (V(effect) + V(noise)) of the residual force, mean squares in the
// zero-phase band 0 to 100 Hz over all training logs, the effect's part taken from two runs without noise.
struct CaseOrder {
  std::vector<std::string> hidden;  // names of hideables()
  double share = 0.1;
  bool slightly_off = false;  // the file's mass, Coulomb and viscous friction are a few per cent off
  std::uint64_t seed = 1;
};

struct BlindCase {
  CaseOrder order;
  machine::Machine machine;  // one axis
  std::vector<host::Log> training, holdout;
  std::vector<machine::Effect> truth;  // of each hidden one, with its parameters
  double noise_rms = 0.0;              // N, of the residual force without any effect
  // N^2: by how much the true effects' own signals, fitted on the training logs, lower the residual force's mean square
  // on the held-out logs.
  double oracle_cut = 0.0;
};

// `machine`: the shipped cross table. Throws Tripped where no drive of eight drawn gets through.
BlindCase make_case(const machine::Machine& machine, const CaseOrder& order);

}  // namespace stiction::blind
