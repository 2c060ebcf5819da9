// Edges that never came, told by the numbers of those that did: a kernel's queue that drops its oldest, as version 2 of
// the character device (kernel documentation, userspace-api/gpio/chardev: line_seqno, event_buffer_size), played by
// hand.
#include "hal/gpio/edge_sequence.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <deque>
#include <random>

#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

// A line that toggles, and what the kernel keeps of it. `numbered`: version 2, drops the oldest; else version 1, drops
// the newest.
class PlayedLine {
 public:
  struct Queued {
    bool rising;
    std::optional<std::uint32_t> number;
  };

  explicit PlayedLine(bool numbered, std::uint32_t before = 0) : numbered_(numbered), number_(before) {}

  void toggle() {
    level_ = !level_;
    ++number_;
    if (queue_.size() == room) {
      ++dropped_;
      if (!numbered_) return;
      queue_.pop_front();
    }
    queue_.push_back({level_, numbered_ ? std::optional(number_) : std::nullopt});
  }
  // Over before the interrupt's thread looks at the level: an edge of the kind of the one before.
  void glitch() {
    toggle();
    queue_.back().rising = !queue_.back().rising;
    level_ = queue_.back().rising;
  }
  std::deque<Queued> read() { return std::exchange(queue_, {}); }
  std::uint64_t dropped() const { return dropped_; }

 private:
  static constexpr std::size_t room = 16;
  bool numbered_;
  std::uint32_t number_;
  bool level_ = false;
  std::deque<Queued> queue_;
  std::uint64_t dropped_ = 0;
};

std::uint64_t lost_in(hal::EdgeSequence& sequence, PlayedLine& line) {
  std::uint64_t lost = 0;
  for (const auto& edge : line.read()) lost += sequence.take(edge.rising, edge.number);
  return lost;
}

TEST(EdgeSequence, CountsEveryEdgeThatTheKernelDroppedByItsNumber) {
  std::mt19937 random(1);
  hal::EdgeSequence sequence;
  PlayedLine line(true);
  std::uint64_t seen = 0;
  int bursts_with_loss = 0, bursts_seen = 0;
  for (int burst = 0; burst < 10'000; ++burst) {
    const auto before = line.dropped();
    for (auto edges = std::uniform_int_distribution(0, 40)(random); edges > 0; --edges) line.toggle();
    const auto lost = lost_in(sequence, line);
    seen += lost;
    ASSERT_EQ(lost, line.dropped() - before) << burst;
    bursts_with_loss += line.dropped() != before;
    bursts_seen += lost != 0;
  }
  EXPECT_GT(bursts_with_loss, 1000);
  figure("edges dropped by the kernel and seen by their number",
         fmt::format("{} of {} (bound: all)", seen, line.dropped()));
  EXPECT_EQ(bursts_seen, bursts_with_loss);
}

// Without numbers an even number of dropped edges leaves no trace in those that follow.
TEST(EdgeSequence, SeesAnOddNumberOfDroppedEdgesWithoutNumbersAndNoEvenOne) {
  for (const int dropped : {1, 2, 3, 4}) {
    hal::EdgeSequence sequence;
    PlayedLine line(false);
    for (int edge = 0; edge < 16 + dropped; ++edge) line.toggle();
    EXPECT_EQ(lost_in(sequence, line), 0u) << "the newest are dropped: nothing is seen yet";
    line.toggle();
    EXPECT_EQ(lost_in(sequence, line), dropped % 2 == 1 ? 1u : 0u) << dropped;
  }
}

TEST(EdgeSequence, CountsAPulseThatWasOverBeforeItsInterruptWasServedBesideThoseDropped) {
  for (const bool numbered : {false, true}) {
    hal::EdgeSequence sequence;
    PlayedLine line(numbered);
    line.toggle();
    line.glitch();
    EXPECT_EQ(lost_in(sequence, line), 1u) << numbered;
    EXPECT_TRUE(sequence.level()) << "high, a pulse down that was over, high";
  }
}

TEST(EdgeSequence, GoesOnOverTheEndOfTheKernelsNumbers) {
  constexpr std::uint32_t near_the_end = 0xFFFF'FFF0u;
  hal::EdgeSequence sequence;
  PlayedLine line(true, near_the_end);
  line.toggle();
  lost_in(sequence, line);
  for (int edge = 0; edge < 41; ++edge) line.toggle();
  EXPECT_EQ(lost_in(sequence, line), 25u);
  line.toggle();
  EXPECT_EQ(lost_in(sequence, line), 0u);
}

TEST(EdgeSequence, KnowsTheLevelOfTheLastEdgeAndThatFromBeforeTheFirst) {
  hal::EdgeSequence sequence;
  sequence.start(true);
  EXPECT_TRUE(sequence.level());
  EXPECT_EQ(sequence.take(false, 1u), 0u);
  EXPECT_FALSE(sequence.level());
}

}  // namespace
}  // namespace stiction::test
