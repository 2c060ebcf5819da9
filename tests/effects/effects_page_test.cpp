// docs/effects.md shows the vocabulary that the program has.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "sim/effects/effects_markdown.hpp"

namespace stiction::test {
namespace {

// Between these lines; what it should be lies beside the figures after a failure.
TEST(EffectsPage, HasTheCurrentTables) {
  const std::string begin = "<!-- tables: sim/effects/effects_markdown.hpp -->\n", end = "<!-- end of tables -->\n";
  std::ifstream stream(std::string(STICTION_SOURCE_DIR) + "/docs/effects.md");
  const std::string page{std::istreambuf_iterator<char>(stream), {}};
  const auto from = page.find(begin), to = page.find(end);
  ASSERT_TRUE(from != std::string::npos && to != std::string::npos && from < to);
  const auto current = page.substr(0, from) + begin + sim::effects_markdown() + page.substr(to);
  if (page != current) {
    std::filesystem::create_directories(STICTION_FIGURES_DIR "/..");
    std::ofstream(STICTION_FIGURES_DIR "/../effects.md") << current;
  }
  EXPECT_TRUE(page == current) << "docs/effects.md is another one; the current page is in build/release/effects.md";
}

}  // namespace
}  // namespace stiction::test
