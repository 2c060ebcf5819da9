// Choices of one axis: each is the branch that its name says.
#include "stiction/number/choice.hpp"

#include <gtest/gtest.h>

#include "stiction/number/fixed_signals.hpp"

namespace stiction {
namespace {

TEST(Choice, OfOneAxisIsABranch) {
  static_assert(OneAxis<FixedSignals>);
  for (const bool condition : {false, true}) {
    EXPECT_EQ(any(condition), condition);
    EXPECT_EQ(all(condition), condition);
    EXPECT_EQ(select(condition, 3, 4), condition ? 3 : 4);
    int to = 1;
    assign(condition, to, 2);
    EXPECT_EQ(to, condition ? 2 : 1);
  }
}

}  // namespace
}  // namespace stiction
