// Work over a second shows that it goes on where a person reads it, and nowhere else.
#include "tests/host/cli/program.hpp"

namespace stiction::test {
namespace {

// Seconds on any machine: 1000 laps of a circle.
const std::string slow = "tune-friction --machine mcfv5050ln";

TEST_F(Cli, ATerminalShowsProgressAndTheLineIsWiped) {
  const auto result = run_shell("script -qec \"'{}' " + slow + "\" /dev/null </dev/null");
  ASSERT_EQ(result.code, 0) << result.out;
  EXPECT_NE(result.out.find("tuning ["), std::string::npos);
  const auto last = result.out.rfind("\r\x1b[K");
  ASSERT_NE(last, std::string::npos);
  const auto printed = result.out.substr(last + 4);
  EXPECT_TRUE(printed.starts_with("asked:") || printed.find("\nasked:") != std::string::npos) << printed;
  for (const char* bar : {"[#", "[.", " of "})
    EXPECT_EQ(printed.substr(0, printed.find("asked:")).find(bar), std::string::npos) << "progress is still there";
}

TEST_F(Cli, WithoutATerminalThereIsNoProgress) {
  const auto result = stiction(slow);
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.error, "");
  EXPECT_EQ(result.out.find('\x1b'), std::string::npos);
}

}  // namespace
}  // namespace stiction::test
