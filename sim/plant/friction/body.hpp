// What a friction model acts on: a rigid mass advanced in fixed steps.
#pragma once

namespace stiction::sim {

struct Body {
  double mass;  // kg
  double step;  // s
};

}  // namespace stiction::sim
