// What the firmware holds in memory for two axes, the trace aside.
#include <gtest/gtest.h>

#include "stiction/drive/axis.hpp"
#include "stiction/drive/friction_compensation.hpp"
#include "stiction/drive/ticker.hpp"
#include "stiction/number/fixed_signals.hpp"
#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

TEST(Memory, OfTwoAxesFitsIntoFourKibibytes) {
  constexpr std::size_t bytes = 2 * sizeof(Axis<FixedSignals>) + sizeof(Ticker);
  figure("memory of the firmware state of two axes, configuration included",
         fmt::format("{} bytes (bound 4096)", bytes));
  EXPECT_LE(bytes, 4096u);
}

TEST(Memory, OfTwoAxesWithFrictionCompensationFitsIntoFourKibibytes) {
  constexpr std::size_t each = sizeof(FrictionCompensation<FixedSignals>);
  constexpr std::size_t bytes = 2 * (sizeof(Axis<FixedSignals>) + each) + sizeof(Ticker);
  figure("memory of the same with friction compensation",
         fmt::format("{} bytes, {} an axis for the compensation (bound 4096)", bytes, each));
  EXPECT_LE(bytes, 4096u);
}

}  // namespace
}  // namespace stiction::test
