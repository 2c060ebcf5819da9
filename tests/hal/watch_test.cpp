// The watches over ticks and frames at their thresholds.
#include <gtest/gtest.h>

#include <cstdint>

#include "hal/frame_watch.hpp"
#include "hal/tick_watch.hpp"

namespace stiction::hal {
namespace {

constexpr std::int64_t period = 62500;  // ns
constexpr int second = 16000;           // ticks

TEST(TickWatch, BearsOneLateTickAndNotTwoInARow) {
  TickWatch watch(period);
  std::int64_t now = 7;
  EXPECT_EQ(watch.step(now), Fault::none);
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(watch.step(now += 2 * period), Fault::none);
    EXPECT_EQ(watch.step(now += period), Fault::none);
  }
  EXPECT_EQ(watch.missed(), 10u);
  EXPECT_EQ(watch.step(now += 2 * period), Fault::none);
  EXPECT_EQ(watch.step(now += 2 * period), Fault::missed_deadline);
  EXPECT_EQ(watch.step(now += 2 * period), Fault::missed_deadline);
  EXPECT_EQ(watch.step(now += period), Fault::none);
}

TEST(TickWatch, BearsNoTwoTicksMissedAtOnce) {
  TickWatch watch(period);
  watch.step(0);
  EXPECT_EQ(watch.step(3 * period), Fault::missed_deadline);
  EXPECT_EQ(watch.step(4 * period), Fault::none);
  watch.restart();
  EXPECT_EQ(watch.step(1000 * period), Fault::none) << "the first again";
}

TEST(TickWatch, TakesWhatIsLessThanAPeriodLateForJitter) {
  TickWatch watch(period);
  std::int64_t now = 0;
  watch.step(now);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(watch.step(now += 2 * period - 1), Fault::none);
  EXPECT_EQ(watch.missed(), 0u);
}

TEST(TickWatch, SeesAClockThatGoesBackOrOnByMoreThanATenthOfASecond) {
  for (const std::int64_t gap : {-1'000'000'000LL, -1LL, 0LL, 100'000'001LL}) {
    TickWatch watch(period);
    watch.step(1'000'000'000);
    EXPECT_EQ(watch.step(1'000'000'000 + gap), Fault::clock_jump) << gap;
    EXPECT_EQ(watch.step(1'000'000'000 + gap + period), Fault::none) << gap;
  }
  TickWatch watch(period);
  watch.step(0);
  EXPECT_EQ(watch.step(100'000'000), Fault::missed_deadline);
}

class Frames {
 public:
  Fault tick(const FrameCounts& counts = {.valid = true}) { return watch_.step(counts); }

 private:
  FrameWatch watch_{period};
};

TEST(FrameWatch, BearsTwoLostFramesAndNotThree) {
  Frames f;
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(f.tick(), Fault::none);
    EXPECT_EQ(f.tick({}), Fault::none);
    EXPECT_EQ(f.tick({}), Fault::none);
  }
  f.tick();
  f.tick({});
  f.tick({});
  EXPECT_EQ(f.tick({}), Fault::frames_lost);
  EXPECT_EQ(f.tick({}), Fault::frames_lost);
  EXPECT_EQ(f.tick(), Fault::none);
}

TEST(FrameWatch, SeesTheEleventhDisturbedFrameWithinASecondOfTheFirst) {
  for (const int spacing : {1, 7, 1000}) {
    Frames f;
    for (int k = 1; k <= 11; ++k) {
      ASSERT_EQ(f.tick({.valid = true, .disturbed = 1}), k > 10 ? Fault::frames_disturbed : Fault::none) << k;
      for (int i = 1; i < spacing; ++i) ASSERT_EQ(f.tick(), k > 10 ? Fault::frames_disturbed : Fault::none);
    }
    // It lasts until the first of eleven is a second back.
    int lasts = 0;
    while (f.tick() != Fault::none && lasts < 2 * second) ++lasts;
    EXPECT_EQ(lasts, second - 11 * spacing);
  }
}

TEST(FrameWatch, BearsTenDisturbedFramesASecondForEver) {
  Frames f;
  for (int i = 0; i < 20 * second; ++i)
    ASSERT_EQ(f.tick({.valid = true, .disturbed = i % 1600 == 0 ? 1u : 0u}), Fault::none) << i;
}

TEST(FrameWatch, CountsSeveralDisturbedFramesOfOneTick) {
  Frames f;
  EXPECT_EQ(f.tick({.valid = true, .disturbed = 10}), Fault::none);
  EXPECT_EQ(f.tick({.valid = true, .disturbed = 1000}), Fault::frames_disturbed);
}

TEST(FrameWatch, SeesMoreThanSixteenForeignFramesWithinSixteenTicks) {
  Frames f;
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(f.tick({.valid = true, .foreign = 1}), Fault::none);
  EXPECT_EQ(f.tick({.valid = true, .foreign = 2}), Fault::bus_overload);
  for (int i = 1; i < 16; ++i) EXPECT_EQ(f.tick({.valid = true, .foreign = 1}), Fault::bus_overload) << i;
  EXPECT_EQ(f.tick({.valid = true, .foreign = 1}), Fault::none);
}

TEST(FrameWatch, NamesTheBusBeforeItsFrames) {
  Frames f;
  EXPECT_EQ(f.tick({.bus_off = true}), Fault::bus_off);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(f.tick({.bus_off = true}), Fault::bus_off);
  EXPECT_EQ(f.tick({.valid = false}), Fault::frames_lost);
  EXPECT_EQ(f.tick(), Fault::none);
}

}  // namespace
}  // namespace stiction::hal
