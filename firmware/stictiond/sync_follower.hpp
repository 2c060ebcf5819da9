// A loop's clock held to a motion controller's SYNC: a phase-locked loop of second order over the cycles, as drives on
// CANopen have it (two clocks that differ by 10 ppm are a cycle of 1 ms apart after 100 s). SYNC is wanted a quarter of
// the cycle after its beginning, so that targets sent behind it are there when the next cycle begins, and jitter of a
// quarter to either side does no harm.
#pragma once

#include <cstdint>

namespace stiction::drive {

class SyncFollower {
 public:
  // Of the cycle, by which its length may be changed: crystals differ by less, and no loop notices it.
  static constexpr std::int64_t largest_share = 5000;  // one part in
  // Of the cycle, within which the phase is held; once inside, SYNC is said to be followed.
  static constexpr std::int64_t locked_share = 50;

  explicit constexpr SyncFollower(std::int64_t cycle_ns) : cycle_ns_(cycle_ns) {}

  // Once a cycle in which a SYNC came, with its age when the next cycle begins. Returns how much later that and all to
  // come must begin, ns.
  constexpr std::int64_t step(std::int64_t age_ns) {
    std::int64_t error = 3 * cycle_ns_ / 4 - age_ns % cycle_ns_;
    if (error > cycle_ns_ / 2) error -= cycle_ns_;
    if (error < -cycle_ns_ / 2) error += cycle_ns_;
    const std::int64_t most = cycle_ns_ / largest_share;
    // Proportional and integral weight for a damping of 0.7: Kp^2 / (4 Ki) = 1/2.
    const std::int64_t wanted = error / 16 + (drift_ + error) / 512;
    const bool held = wanted > most || wanted < -most;
    if (!held) drift_ += error;
    locked_ = error < cycle_ns_ / locked_share && error > -cycle_ns_ / locked_share;
    return wanted > most ? most : wanted < -most ? -most : wanted;
  }

  constexpr bool locked() const { return locked_; }

 private:
  std::int64_t cycle_ns_;
  std::int64_t drift_ = 0;  // sum of the errors, ns
  bool locked_ = false;
};

}  // namespace stiction::drive
