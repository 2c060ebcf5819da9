// An incremental encoder on the lines of a real kernel's gpiochip, played edge by edge by a thread of its own: what is
// counted, up to which rate, and that what cannot be counted is a fault and never a wrong position.
#include <atomic>
#include <cmath>
#include <thread>
#include <utility>
#include <vector>

#include "hal/gpio/quadrature_input.hpp"
#include "hal/tick_clock.hpp"
#include "tests/hil/gpio_loop.hpp"

namespace stiction::test {
namespace {

using hal::Bias;
using hal::Lines;
using hal::QuadratureFault;

constexpr plant::EncoderLines::Wiring tracks{.a = wire::a, .b = wire::b};

// Steps the encoder through `turns` (ends of straight runs, counts) with an edge every `interval_ns`.
void play(plant::EncoderLines& encoder, std::vector<std::int64_t> turns, std::int64_t interval_ns) {
  sleep_exactly();
  std::int64_t next_ns = monotonic_ns() + 1'000'000;
  for (const auto turn : turns)
    while (encoder.count() != turn) {
      sleep_until(next_ns);
      encoder.step(turn > encoder.count());
      next_ns += interval_ns;
    }
}

struct Run {
  std::int64_t played = 0;
  std::int64_t counted = 0;
  std::int64_t ticks = 0;
  double rate = 0.0;  // edges a second that were really played
  QuadratureFault fault = QuadratureFault::none;
};

// Counts in a loop of `period_ns` what a thread plays, and three ticks longer.
Run run(plant::GpioSim& sim, double stated_rate, std::vector<std::int64_t> turns, double rate, std::int64_t period_ns) {
  plant::EncoderLines encoder(sim, tracks);
  Lines lines(chip, Bias::as_is);
  hal::QuadratureInput input(lines, {.a = {wire::a}, .b = {wire::b}, .increment = 1e-6, .rate = stated_rate}, "X");
  std::atomic<bool> done = false;
  std::int64_t edges = 0, from = 0;
  for (const auto turn : turns) edges += std::abs(turn - std::exchange(from, turn));
  const std::int64_t begin_ns = monotonic_ns();
  std::int64_t end_ns = 0;
  std::thread player([&] {
    play(encoder, turns, std::llround(1e9 / rate));
    end_ns = monotonic_ns();
    done = true;
  });
  hal::TickClock clock(period_ns);
  Run result;
  for (int after = 0; after < 3; after += done ? 1 : 0) {
    const std::int64_t now_ns = clock.wait();
    lines.poll(now_ns);
    input.update(now_ns, {}, false);
    ++result.ticks;
  }
  player.join();
  result.played = encoder.count();
  result.counted = input.count();
  result.fault = input.fault();
  result.rate = static_cast<double>(edges) * 1e9 / static_cast<double>(end_ns - begin_ns - 1'000'000);
  return result;
}

TEST_F(GpioLoop, CountsEveryEdgeThereAndBack) {
  if (!simulated_time()) GTEST_SKIP() << "in user mode's real time the loop does not keep to its ticks";
  const auto result = run(*sim_, 0.0, {1000, -1000, 1}, 9e3, 62'500);
  EXPECT_EQ(result.fault, QuadratureFault::none) << name_of(result.fault);
  EXPECT_EQ(result.counted, 1);
  EXPECT_EQ(result.counted, result.played);
  measured("edges counted of 4001 there and back", fmt::format("all, {:.0f} 1/s, {} ticks", result.rate, result.ticks));
}

TEST_F(GpioLoop, TakesARateAboveTheStatedOneForAFault) {
  if (!simulated_time()) GTEST_SKIP() << "rates are exact in simulated time alone";
  EXPECT_EQ(run(*sim_, 10e3, {200}, 9.9e3, 62'500).fault, QuadratureFault::none);
  EXPECT_EQ(run(*sim_, 10e3, {200}, 10.5e3, 62'500).fault, QuadratureFault::too_fast);
}

// Up to the rate that fills a track's queue between two ticks; beyond, a fault.
TEST_F(GpioLoop, CountsExactlyOrReportsAFaultAtEveryRate) {
  struct Sweep {
    std::int64_t period_ns;
    std::vector<double> rates;
  };
  for (const auto& [period_ns, rates] : {Sweep{62'500, {10e3, 30e3, 100e3, 200e3, 300e3, 400e3, 450e3, 500e3, 700e3}},
                                         Sweep{1'000'000, {2e3, 5e3, 10e3, 15e3, 20e3, 25e3, 28e3, 32e3, 50e3}}}) {
    double held = 0.0, lost = 0.0;
    for (const double rate :
         {2e3, 5e3, 10e3, 15e3, 20e3, 25e3, 28e3, 32e3, 50e3, 100e3, 200e3, 300e3, 400e3, 450e3, 500e3, 700e3}) {
      const auto result = run(*sim_, 0.0, {400, 0, -300}, rate, period_ns);
      if (result.fault != QuadratureFault::none) {
        lost = lost == 0.0 ? result.rate : lost;
        continue;
      }
      EXPECT_EQ(result.counted, result.played) << rate << " 1/s: wrong without a fault";
      if (lost == 0.0) held = result.rate;
    }
    // A track gives half of the edges; 15 of them in a tick are sure to be all.
    const double queue = 2.0 * (hal::kernel_queue - 1) * 1e9 / static_cast<double>(period_ns);
    measured(fmt::format("edges a second held, ticks of {} us", static_cast<double>(period_ns) * 1e-3),
             fmt::format("{:.0f} (first fault at {:.0f}; the kernel's queue ends at {:.0f}; {})", held, lost, queue,
                         simulated_time() ? "work takes no time here" : "in real time"));
    if (simulated_time()) {
      EXPECT_GE(held, 0.8 * queue);
      EXPECT_LE(held, 1.01 * queue);
      EXPECT_GT(lost, 0.0);
    }
  }
}

// A programme that was held for as long as fills the queue must not go on as if nothing had been.
TEST_F(GpioLoop, TakesALoopThatWasHeldTooLongForAFault) {
  plant::EncoderLines encoder(*sim_, tracks);
  Lines lines(chip, Bias::as_is);
  hal::QuadratureInput input(lines, {.a = {wire::a}, .b = {wire::b}, .increment = 1e-6}, "X");
  std::thread player([&] { play(encoder, {64}, 200'000); });
  player.join();
  lines.poll(monotonic_ns());
  input.update(monotonic_ns(), {}, false);
  // Two tracks of 32 edges each, of which the kernel kept 16; only numbers tell how many it dropped.
  EXPECT_EQ(input.fault(), dropped_edges());
  if (hal::gpiod::numbers_edges()) {
    EXPECT_EQ(input.lost_edges(), 32u);
  }
  EXPECT_FALSE(input.valid());
  input.restart();
  encoder.step(true);
  sleep_until(monotonic_ns() + 200'000);
  lines.poll(monotonic_ns());
  input.update(monotonic_ns(), {}, false);
  EXPECT_EQ(input.fault(), QuadratureFault::none);
  EXPECT_EQ(input.count(), 1);
}

}  // namespace
}  // namespace stiction::test
