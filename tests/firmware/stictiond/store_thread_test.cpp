// Jobs for a disk that may take for ever, and the limits of what comes from outside.
#include "firmware/stictiond/store_thread.hpp"

#include <gtest/gtest.h>

#include <future>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>

#include "firmware/stictiond/rate_limit.hpp"
#include "firmware/stictiond/said_lines.hpp"
#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

using Outcome = drive::StoreThread::Outcome;

Outcome settled(const drive::StoreThread& store, std::uint64_t ticket) {
  while (store.outcome(ticket) == Outcome::under_way) std::this_thread::yield();
  return store.outcome(ticket);
}

TEST(StoreThread, SaysHowAJobEnded) {
  drive::StoreThread store;
  EXPECT_EQ(settled(store, store.ask([] {})), Outcome::stored);
  EXPECT_EQ(settled(store, store.ask([] { throw std::runtime_error("full"); })), Outcome::failed);
}

// Whoever asks is told "under way" at once, and how it ended when the disk has answered, in any order of both.
TEST(StoreThread, TellsNothingBeforeASlowDiskHasAnswered) {
  drive::StoreThread store;
  int as_it_was = 0;
  constexpr int tries = 100;
  for (int i = 0; i < tries; ++i) {
    std::promise<void> disk;
    const bool fails = i % 3 == 0;
    const auto ticket = store.ask([fails, ready = disk.get_future().share()] {
      ready.wait();
      if (fails) throw std::runtime_error("full");
    });
    const bool waited = store.outcome(ticket) == Outcome::under_way;
    disk.set_value();
    const bool ended = settled(store, ticket) == (fails ? Outcome::failed : Outcome::stored);
    as_it_was += waited && ended ? 1 : 0;
  }
  EXPECT_EQ(as_it_was, tries);
  figure("stores on a slow disk: told as they ended, and nothing before",
         fmt::format("{} of {} (bound all)", as_it_was, tries));
}

TEST(StoreThread, HoldsUpNobodyWhileTheDiskIsSlowAndStoresTheLastThatWasAsked) {
  drive::StoreThread store;
  std::promise<void> disk;
  int stored = 0;
  const auto first = store.ask([&, ready = disk.get_future().share()] { ready.wait(), stored = 1; });
  const auto second = store.ask([&] { stored = 2; });
  const auto third = store.ask([&] { stored = 3; });
  EXPECT_EQ(store.outcome(first), Outcome::under_way);
  EXPECT_EQ(store.outcome(third), Outcome::under_way);
  disk.set_value();
  EXPECT_EQ(settled(store, third), Outcome::stored);
  EXPECT_EQ(store.outcome(second), Outcome::stored);
  EXPECT_EQ(stored, 3);
}

TEST(StoreThread, EndsWhileADiskDoesNotAnswer) {
  const auto disk = std::make_shared<std::promise<void>>();
  {
    drive::StoreThread store;
    store.ask([disk, ready = disk->get_future().share()] { ready.wait(); });
  }
  disk->set_value();
}

TEST(RateLimit, GivesABurstAndThenSoManyASecond) {
  drive::RateLimit limit(3, 2);
  const auto in_a_row = [&](std::int64_t now_ms) {
    int count = 0;
    while (limit.take(now_ms * 1'000'000)) ++count;
    return count;
  };
  EXPECT_EQ(in_a_row(1000), 3);
  EXPECT_EQ(in_a_row(1400), 0);
  EXPECT_EQ(in_a_row(1500), 1);
  EXPECT_EQ(in_a_row(2500), 2);
  EXPECT_EQ(in_a_row(100'000), 3);
}

TEST(SaidLines, CountsWhatIsTooMuchAndSaysSoOnceASecond) {
  drive::SaidLines said;
  constexpr std::int64_t second = 1'000'000'000;
  for (int i = 0; i < 100'000; ++i) said.say("Modbus: ...", 10 * second);
  auto lines = said.take(10 * second);
  ASSERT_EQ(lines.size(), 101U);
  EXPECT_EQ(lines.back(), "99900 further messages of clients were not logged");
  said.say("one", 10 * second);
  EXPECT_TRUE(said.take(10 * second + second / 2).empty());
  lines = said.take(11 * second);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0], "1 further messages of clients were not logged");
}

}  // namespace
}  // namespace stiction::test
