// What is wrong with a table or a request, in words: each has words of its own.
#include "stiction/motion/cam_words.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace stiction {
namespace {

TEST(CamWords, AreThoseOfTheirProblemAndOfNoOtherOne) {
  EXPECT_STREQ(words_of(CamTableProblem::none), "a whole table");
  EXPECT_STREQ(words_of(CamTableProblem::checksum), "a table with a changed byte");
  EXPECT_STREQ(words_of(CamTableProblem::segment_order), "a table whose segments do not follow each other");
  std::set<std::string> all;
  const int last = static_cast<int>(CamTableProblem::track_windows);
  for (int k = 0; k <= last; ++k) all.insert(words_of(static_cast<CamTableProblem>(k)));
  EXPECT_EQ(all.size(), last + 1u);
}

TEST(CamWords, AreThoseOfTheirRefusalAndOfNoOtherOne) {
  EXPECT_STREQ(words_of(CamRefusal::none), "nothing is refused");
  EXPECT_STREQ(words_of(CamRefusal::unknown_table), "a table that was not given");
  EXPECT_STREQ(words_of(CamRefusal::beyond_travel), "a track of positions that leaves the travel");
  std::set<std::string> all;
  for (std::size_t k = 0; k < cam_refusals; ++k) all.insert(words_of(static_cast<CamRefusal>(k)));
  EXPECT_EQ(all.size(), cam_refusals);
}

}  // namespace
}  // namespace stiction
