// A figure that a test measured and holds to a bound: printed and kept, so that `toolchain/test` ends in a table.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

namespace stiction::test {

// `text`: what was measured with its unit and bound, e.g. "0.03 um mean (bound 0.3 um)".
inline void figure(const std::string& name, const std::string& text) {
  const auto line = fmt::format("{:<64} {}\n", name, text);
  fmt::print("{}", line);
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  const std::filesystem::path folder(STICTION_FIGURES_DIR);
  std::filesystem::create_directories(folder);
  std::string file = std::string(test->test_suite_name()) + "." + test->name() + ".txt";
  std::replace(file.begin(), file.end(), '/', '_');  // of parameterised tests
  std::ofstream(folder / file, std::ios::app) << line;
}

}  // namespace stiction::test
