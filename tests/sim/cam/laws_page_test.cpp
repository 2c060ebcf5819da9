// docs/cam.md and its picture show the table of laws as it is.
#include "sim/cam/laws_page.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace stiction::sim::cam {
namespace {

std::string content_of(const std::string& file) {
  std::ifstream in(std::string(STICTION_SOURCE_DIR) + "/docs/" + file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

TEST(CamLawsPage, OfTheDocumentationIsTheTableOfTheProgramme) {
  EXPECT_NE(content_of("cam.md").find(laws_markdown()), std::string::npos)
      << "found a different table in docs/cam.md; expected what `stiction cam laws --markdown` prints";
}

TEST(CamLawsPage, PictureIsThatOfTheProgramme) {
  EXPECT_TRUE(content_of("cam-laws.svg") == laws_svg())
      << "found a different docs/cam-laws.svg; expected what `stiction cam laws --picture` writes";
}

}  // namespace
}  // namespace stiction::sim::cam
