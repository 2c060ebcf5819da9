// A machine that runs on and on, whose cam may be a different one in each cycle, and whose gear warms as it runs.
#pragma once

#include <memory>

#include "tests/cam_tuning/truth.hpp"

namespace stiction::cam_tuning {

class Production {
 public:
  // The machine of `truth` at rest, whose shaft loses `stiffness_loss` of its stiffness with the time constant
  // `warming_time` (s).
  Production(const Truth& truth, double stiffness_loss, double warming_time);
  ~Production();
  Production(const Production&) = delete;
  Production& operator=(const Production&) = delete;

  // One more cycle along `cam`. Its record and its quality, with the load as it is.
  Cycle run(const sim::cam::Cam& cam);

 private:
  struct Running;
  std::unique_ptr<Running> running_;
};

// How a cam was tuned in the first cycles of a machine and followed for the rest of `cycles`; the gear loses
// `stiffness_loss` of its stiffness, 95 % of that within them.
struct Followed {
  double first = 0.0;   // deg^2, J of the untuned cycles
  double tuned = 0.0;   // of the first cycle that was tuned
  double worst = 0.0;   // behind the tuning, which takes five cycles at most
  double last = 0.0;    // in the last hundredth, at most
  int corrections = 0;  // of production
};
// `follow`: or whether the first tuning was the only one.
Followed followed(const Truth& truth, double stiffness_loss, int cycles, bool follow);

}  // namespace stiction::cam_tuning
