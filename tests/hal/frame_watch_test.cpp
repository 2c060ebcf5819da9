// Which answers count, which are only counted, and when that is a fault.
#include "hal/can/frame_watch.hpp"

#include <gtest/gtest.h>

namespace stiction::hal::can {
namespace {

constexpr std::uint32_t mask = 0xFF;

// A watch over one frame a tick, 16000 ticks a second; ticks of 100 ns.
struct Bench {
  FrameWatch watch{1, mask, 16000};
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

TEST(FrameWatch, TakesTheAnswerOfThisTickOnce) {
  Bench b;
  for (int i = 0; i < 1000; ++i) b.good_tick();
  b.begin();
  EXPECT_TRUE(b.answer(b.tick));
  EXPECT_FALSE(b.answer(b.tick));
  EXPECT_EQ(b.watch.counts().good, 1001u);
  EXPECT_EQ(b.watch.counts().duplicate, 1u);
  EXPECT_EQ(b.watch.fault(), Fault::none);
}

TEST(FrameWatch, TellsLateFromOutOfOrderFromStale) {
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

TEST(FrameWatch, BearsTwoTicksWithoutAnswerAndNotThree) {
  Bench b;
  b.good_tick();
  for (int i = 0; i < 2; ++i) {
    b.begin();
    b.watch.end();
    EXPECT_EQ(b.watch.fault(), Fault::none);
  }
  b.begin();
  b.watch.end();
  EXPECT_EQ(b.watch.fault(), Fault::frames_lost);
  b.good_tick();
  EXPECT_EQ(b.watch.fault(), Fault::none) << "the cause has gone; who reacts keeps the fault";
}

TEST(FrameWatch, BearsTenBadFramesASecondAndNotEleven) {
  Bench b;
  const auto bad_tick = [&] {
    b.begin();
    EXPECT_FALSE(b.answer(b.tick - 1));
    EXPECT_TRUE(b.answer(b.tick));
    b.watch.end();
  };
  for (int i = 0; i < 10; ++i) bad_tick();
  EXPECT_EQ(b.watch.fault(), Fault::none);
  bad_tick();
  EXPECT_EQ(b.watch.fault(), Fault::frames_disturbed);
  for (int i = 0; i < 16000; ++i) b.good_tick();
  EXPECT_EQ(b.watch.fault(), Fault::none) << "a second later";
}

TEST(FrameWatch, AnAnswerOfTwoFramesNeedsBoth) {
  FrameWatch watch(2, 0x0F, 2000);
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
