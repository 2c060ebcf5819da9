// The page of faults is the table's.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "firmware/stictiond/fault_page.hpp"

namespace stiction::test {
namespace {

TEST(FaultPage, IsCurrent) {
  std::ifstream stream(std::string(STICTION_SOURCE_DIR) + "/docs/faults.md");
  const std::string page{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_TRUE(page == drive::fault_page()) << "docs/faults.md is another one; print it with: stictiond --faults";
}

}  // namespace
}  // namespace stiction::test
