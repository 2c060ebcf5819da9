// Which answers count and which are only counted.
#include "hal/can/answer_check.hpp"

#include <gtest/gtest.h>

namespace stiction::hal::can {
namespace {

constexpr std::uint32_t mask = 0xFF;

// A watch over one frame a tick, 16000 ticks a second; ticks of 100 ns.
struct Bench {
  AnswerCheck watch{1, mask};
  std::uint32_t tick = 0;
  void begin() {
    ++tick;
    watch.begin(tick, std::int64_t{tick} * 100);
  }
  bool answer(std::uint32_t of_tick) { return watch.take(0, of_tick & mask, std::int64_t{tick} * 100 + 10); }
  void good_tick() {
    begin();
    EXPECT_TRUE(answer(tick));
    watch.end();
  }
};

TEST(AnswerCheck, TakesTheAnswerOfThisTickOnce) {
  Bench b;
  for (int i = 0; i < 1000; ++i) b.good_tick();
  b.begin();
  EXPECT_TRUE(b.answer(b.tick));
  EXPECT_FALSE(b.answer(b.tick));
  b.watch.end();
  EXPECT_EQ(b.watch.counts().good, 1001u);
  EXPECT_EQ(b.watch.counts().duplicate, 1u);
}

TEST(AnswerCheck, TellsLateFromOutOfOrderFromStale) {
  Bench b;
  for (int i = 0; i < 5; ++i) b.good_tick();
  b.begin();
  EXPECT_FALSE(b.answer(b.tick - 1));
  EXPECT_FALSE(b.answer(b.tick - 2));
  EXPECT_FALSE(b.answer(b.tick + 1));
  EXPECT_FALSE(b.watch.take(0, b.tick & mask, std::int64_t{b.tick} * 100 - 1)) << "on the bus before SYNC";
  b.watch.take_damaged();
  const auto& counts = b.watch.counts();
  EXPECT_EQ(counts.late, 1u);
  EXPECT_EQ(counts.out_of_order, 2u);
  EXPECT_EQ(counts.stale, 1u);
  EXPECT_EQ(counts.damaged, 1u);
}

TEST(AnswerCheck, CountsTicksWithoutAnAnswerAndBadFramesTickByTick) {
  Bench b;
  b.good_tick();
  b.begin();
  b.watch.end();
  EXPECT_EQ(b.watch.counts().lost, 1u);
  b.begin();
  EXPECT_FALSE(b.answer(b.tick - 1));
  EXPECT_FALSE(b.answer(b.tick - 2));
  EXPECT_EQ(b.watch.bad_in_tick(), 2u);
  b.good_tick();
  EXPECT_EQ(b.watch.bad_in_tick(), 0u);
  EXPECT_EQ(b.watch.counts().bad(), 2u);
}

TEST(AnswerCheck, AnAnswerOfTwoFramesNeedsBoth) {
  AnswerCheck watch(2, 0x0F);
  watch.begin(3, 0);
  EXPECT_TRUE(watch.take(0, 3, 1));
  EXPECT_FALSE(watch.complete());
  watch.end();
  EXPECT_EQ(watch.counts().lost, 1u);
  watch.begin(4, 10);
  EXPECT_TRUE(watch.take(1, 4, 11));
  EXPECT_TRUE(watch.take(0, 4, 12));
  EXPECT_TRUE(watch.complete());
}

}  // namespace
}  // namespace stiction::hal::can
