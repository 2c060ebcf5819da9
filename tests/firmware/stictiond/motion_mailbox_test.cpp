// Commands from a server's thread to the loop: never full, and no stop is lost behind what follows it.
#include "firmware/stictiond/motion_mailbox.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <tuple>
#include <vector>

namespace stiction::test {
namespace {

using drive::MotionWrite;
using What = MotionWrite::What;
using Taken = std::vector<std::tuple<std::size_t, What, double>>;

void put(drive::MotionMailbox& mailbox, const std::vector<MotionWrite>& writes) { mailbox.put(writes); }
Taken taken(drive::MotionMailbox& mailbox) {
  Taken all;
  mailbox.take([&](const MotionWrite& write) { all.emplace_back(write.axis, write.what, write.value); });
  return all;
}

TEST(MotionMailbox, GivesTheNewestOfEachCommandOnce) {
  drive::MotionMailbox mailbox;
  EXPECT_TRUE(taken(mailbox).empty());
  for (int i = 0; i < 100'000; ++i) put(mailbox, {{0, What::target, 1e-6 * i}, {1, What::velocity, 0.1}});
  put(mailbox, {{0, What::controlword, 0x1f}});
  EXPECT_EQ(taken(mailbox),
            (Taken{{0, What::controlword, 0x1f}, {0, What::target, 1e-6 * 99'999}, {1, What::velocity, 0.1}}));
  EXPECT_TRUE(taken(mailbox).empty());
}

TEST(MotionMailbox, TakesAStopBeforeTheWordsThatFollowedIt) {
  for (const double stop : {0.0, 2.0, 6.0, 7.0, 0x80 + 0.0}) {  // voltage off, quick stop, shutdown, disable, reset
    drive::MotionMailbox mailbox;
    put(mailbox, {{2, What::controlword, 0xf}});
    EXPECT_EQ(taken(mailbox), (Taken{{2, What::controlword, 0xf}}));
    put(mailbox, {{2, What::controlword, stop}});
    put(mailbox, {{2, What::controlword, 0x1f}});
    put(mailbox, {{2, What::controlword, 0xf}});
    EXPECT_EQ(taken(mailbox), (Taken{{2, What::controlword, stop}}));
    EXPECT_EQ(taken(mailbox), (Taken{{2, What::controlword, 0xf}}));
    EXPECT_TRUE(taken(mailbox).empty());
  }
}

// Each stop is written among words that enable, at full speed beside the reader: the reader sees one for each round.
TEST(MotionMailbox, LosesNoStopBesideARunningLoop) {
  constexpr int rounds = 1000;
  drive::MotionMailbox mailbox;
  std::atomic<int> seen{0};
  std::atomic<bool> done{false};
  std::thread loop([&] {
    while (!done) mailbox.take([&](const MotionWrite& write) { seen += drive::MotionMailbox::stops(write) ? 1 : 0; });
  });
  for (int i = 0; i < rounds; ++i) {
    put(mailbox, {{0, What::controlword, 0xf}});
    put(mailbox, {{0, What::controlword, 6.0}});
    put(mailbox, {{0, What::controlword, 0xf}});
    while (seen <= i) std::this_thread::yield();
  }
  done = true;
  loop.join();
  EXPECT_EQ(seen, rounds);
}

}  // namespace
}  // namespace stiction::test
