// What forces outside of the vocabulary make of a motion: their columns.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "host/diagnose/classes/candidate.hpp"

namespace {

using namespace stiction::host;

// A swing of 20 um in 2 s, sampled each 0.5 ms: 31 nm from sample to sample at most, less than a reversal takes.
Motion slow_swing(double seconds) {
  Motion motion;
  for (int i = 0; i < static_cast<int>(seconds / 5e-4); ++i) {
    motion.t.push_back(5e-4 * i);
    motion.x.push_back(10e-6 * std::sin(std::numbers::pi * motion.t.back()));
  }
  motion.v.resize(motion.t.size());
  return motion;
}

}  // namespace

// Turns at 0.5, 1.5, 2.5 s; each is seen 2 um on, and 90 % of what began there is gone 0.23 s later.
TEST(Signatures, a_force_after_reversals_begins_at_slow_ones_too) {
  const auto motion = slow_swing(3.5);
  const auto column = signatures::force_after_reversal::shape.columns({}, motion, 0.1).front();
  const auto at = [&](double t) { return column[static_cast<std::size_t>(std::lround(t / 5e-4))]; };
  const double seen = std::acos(0.8) / std::numbers::pi;  // s after the turn
  EXPECT_EQ(at(0.4), 0.0);                                // no reversal yet
  for (int turn = 0; turn < 3; ++turn) {
    const double begins = 0.5 + turn + seen, along = turn % 2 == 0 ? -1.0 : 1.0;
    EXPECT_NEAR(along * at(begins + 1e-3), 1.0, 0.02) << turn;
    EXPECT_NEAR(along * at(begins + 0.1), std::exp(-1.0), 0.01) << turn;
    EXPECT_LT(std::abs(at(begins - 0.1)), 1e-2) << turn;
  }
}
