#include "firmware/stictiond/log_ring.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "stiction/drive/faults.hpp"

namespace stiction::test {
namespace {

struct Lines {
  std::unique_ptr<drive::LogRing> ring = std::make_unique<drive::LogRing>();
  std::vector<std::pair<drive::LogLevel, std::string>> said;
  drive::LogReader reader{*ring,
                          [this](drive::LogLevel level, std::string_view text) { said.emplace_back(level, text); }};
};

TEST(LogRing, SaysNumbersAndNamesInTheOrderOfTheLoop) {
  Lines lines;
  lines.ring->push(1'500'000'000, drive::LogLevel::error, "axis {}: fault {} ({})",
                   {1, name_of(Fault::encoder_frozen), static_cast<int>(Fault::encoder_frozen)});
  lines.ring->push(1'500'062'500, drive::LogLevel::info, "stopped after {} us", {-3});
  EXPECT_EQ(lines.reader.drain(), 2u);
  ASSERT_EQ(lines.said.size(), 2u);
  EXPECT_EQ(lines.said[0].first, drive::LogLevel::error);
  EXPECT_EQ(lines.said[0].second, "1.500000 s: axis 1: fault encoder frozen (16)");
  EXPECT_EQ(lines.said[1].second, "1.500063 s: stopped after -3 us");
  EXPECT_EQ(lines.reader.drain(), 0u);
}

TEST(LogRing, LosesWhatFindsNoRoomCountsItAndSaysSoOnce) {
  Lines lines;
  for (std::size_t i = 0; i < drive::LogRing::capacity; ++i)
    EXPECT_TRUE(lines.ring->push(0, drive::LogLevel::info, "{}", {i}));
  for (int i = 0; i < 7; ++i) EXPECT_FALSE(lines.ring->push(0, drive::LogLevel::info, "lost"));
  EXPECT_EQ(lines.ring->lost(), 7u);
  EXPECT_EQ(lines.reader.drain(), drive::LogRing::capacity);
  ASSERT_EQ(lines.said.size(), drive::LogRing::capacity + 1);
  EXPECT_EQ(lines.said.front().second, "0.000000 s: 0");  // the oldest are kept
  EXPECT_EQ(lines.said.back().first, drive::LogLevel::warning);
  EXPECT_EQ(lines.said.back().second, "7 messages of the loop were lost because the buffer was full");
  EXPECT_TRUE(lines.ring->push(0, drive::LogLevel::info, "again"));
  lines.said.clear();
  lines.reader.drain();
  ASSERT_EQ(lines.said.size(), 1u);
}

TEST(LogRing, GoesOnAroundItsEnd) {
  Lines lines;
  for (std::size_t i = 0; i < 3 * drive::LogRing::capacity; ++i) {
    ASSERT_TRUE(lines.ring->push(0, drive::LogLevel::info, "{}", {i}));
    drive::LogRecord record;
    ASSERT_TRUE(lines.ring->pop(record));
    ASSERT_EQ(record.values[0].number(), static_cast<std::int64_t>(i));
  }
}

}  // namespace
}  // namespace stiction::test
