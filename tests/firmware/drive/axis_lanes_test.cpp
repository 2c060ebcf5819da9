// The firmware's cascade over a batch against the same cascade over doubles, one bench for each lane: equal to the bit,
// also where the lanes part: one misses samples, one trips, each holds its current back by a time of its own.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "firmware/machine/batch/batch_lane.hpp"
#include "stiction/drive/friction_compensation.hpp"
#include "tests/firmware/drive/axis_bench.hpp"

namespace stiction::axis_lanes {
namespace {

// The set that every processor of its kind has.
#if defined(__x86_64__)
using Isa = machine::Sse2;
#else
using Isa = machine::Neon;
#endif
using Batch = machine::BatchSignals<Isa>;
using Lane = machine::DoubleSignals;
using test::si;
constexpr std::size_t lanes = machine::Batch<Isa>::lanes;

// What a lane's axis is given in tick `n`.
struct Inputs {
  double x_set, v_set, x;
  std::array<double, 3> i;
  bool sampled = true, input_fault = false;
};
// From rest, to and fro, at a pace and with currents of the lane's own; the axis stays 2 % behind.
Inputs inputs(std::size_t lane, int n) {
  const double pace = 200.0 + 30.0 * static_cast<double>(lane), t = test::tick * n;
  const double x = 1e-3 * (1.0 - std::cos(pace * t));
  return {x,
          1e-3 * pace * std::sin(pace * t),
          0.98 * x,
          {std::sin(pace * t), std::sin(pace * t + 2.0), std::sin(pace * t + 4.0)}};
}

AxisConfig<Lane> axis_config(std::size_t lane) {
  auto config = test::bench_config<Lane>();
  config.current_loop = CurrentLoop::three_phase;
  config.position_gain = si<Lane::PositionGain>(60.0 + 10.0 * static_cast<double>(lane));
  return config;
}
FrictionCompensationConfig<Lane> compensation_config(std::size_t lane) {
  FrictionCompensationConfig<Lane> config;
  config.kind = CompensationKind::friction;
  config.set_point_delay = 4;
  config.lag_ticks = static_cast<std::uint32_t>(lane % 3);
  config.lag_fraction = si<Lane::TickFraction>(0.25 * static_cast<double>(lane % 4));
  config.friction.limit = si<Lane::Current>(10.0);
  config.friction.elements[0] = {si<Lane::Step>(0.5e-6), si<Lane::ContactStiffness>(2e6)};
  return config;
}

SetPoint<Lane> set_point(const Inputs& in) {
  SetPoint<Lane> set;
  set.position = si<Lane::Position>(in.x_set);
  set.velocity = si<Lane::Velocity>(in.v_set);
  return set;
}

// One axis with its friction compensation.
struct OneAxisBench {
  explicit OneAxisBench(std::size_t lane) : bench(axis_config(lane)), compensation(compensation_config(lane)) {
    compensation.start(bench.feedback.position);
  }
  void tick(const Inputs& in) {
    bench.set = set_point(in);
    compensation.step(bench.set, terms);
    bench.feedback.position = si<Lane::Position>(in.x);
    for (std::size_t phase = 0; phase < 3; ++phase) bench.feedback.current[phase] = si<Lane::Current>(in.i[phase]);
    bench.feedback.position_valid = in.sampled;
    bench.feedback.fault = in.input_fault;
    bench.tick();
  }

  test::Bench<Lane> bench;
  FrictionCompensation<Lane> compensation;
  FrictionCompensationSignals<Lane> terms{};
};

// The same axes as lanes.
struct BatchBench {
  BatchBench() : axis(configs()), compensation(compensations()) {
    feedback.position_valid = machine::BatchMask<Isa>(true);
    feedback.position_time_ns = static_cast<double>(ticker.now_ns());
    axis.start(feedback);
    compensation.start(feedback.position);
  }
  static AxisConfig<Batch> configs() {
    AxisConfig<Batch> all{};
    for (std::size_t k = 0; k < lanes; ++k) machine::set_lane(all, k, axis_config(k));
    return all;
  }
  static FrictionCompensationConfig<Batch> compensations() {
    FrictionCompensationConfig<Batch> all{};
    for (std::size_t k = 0; k < lanes; ++k) machine::set_lane(all, k, compensation_config(k));
    return all;
  }
  void tick(const std::array<Inputs, lanes>& in) {
    SetPoint<Batch> set{};
    machine::Batch<Isa> sampled, failed;
    for (std::size_t k = 0; k < lanes; ++k) {
      set.position.set_lane(k, in[k].x_set);
      set.velocity.set_lane(k, in[k].v_set);
      feedback.position.set_lane(k, in[k].x);
      for (std::size_t phase = 0; phase < 3; ++phase) feedback.current[phase].set_lane(k, in[k].i[phase]);
      sampled.set_lane(k, in[k].sampled ? 1.0 : 0.0);
      failed.set_lane(k, in[k].input_fault ? 1.0 : 0.0);
    }
    feedback.position_valid = sampled != 0.0;
    feedback.fault = failed != 0.0;
    feedback.position_time_ns = static_cast<double>(ticker.now_ns());
    compensation.step(set, terms);
    axis.tick(set, feedback, ticker.now_ns(), ticker.slow(), signals);
    ticker.advance();
  }

  Axis<Batch> axis;
  FrictionCompensation<Batch> compensation;
  FrictionCompensationSignals<Batch> terms{};
  Ticker ticker{test::tick_ns, test::ticks_per_slow_tick};
  Feedback<Batch> feedback{};
  AxisSignals<Batch> signals{};
};

std::map<std::string, double> values_of(const AxisSignals<Lane>& signals) {
  std::map<std::string, double> values;
  for_each_signal(signals, [&](auto name, auto, auto, auto value) { values[name] = machine::to_si(value); });
  return values;
}

// Runs both for 200 ticks; `part` changes a lane's inputs. Gives each lane's fault.
template <class Part>
std::vector<Fault> compare(const Part& part) {
  BatchBench batch;
  std::vector<OneAxisBench> alone;
  for (std::size_t k = 0; k < lanes; ++k) alone.emplace_back(k);
  for (int n = 0; n < 200; ++n) {
    std::array<Inputs, lanes> in;
    for (std::size_t k = 0; k < lanes; ++k) {
      in[k] = inputs(k, n);
      part(k, n, in[k]);
      alone[k].tick(in[k]);
    }
    batch.tick(in);
    for (std::size_t k = 0; k < lanes; ++k) {
      AxisSignals<Lane> lane;
      machine::get_lane(batch.signals, k, lane);
      EXPECT_EQ(values_of(lane), values_of(alone[k].bench.signals)) << "lane " << k << ", tick " << n;
      EXPECT_EQ(batch.axis.fault().lane(k), alone[k].bench.axis.fault()) << "lane " << k << ", tick " << n;
      if (testing::Test::HasFailure()) return {};
    }
  }
  std::vector<Fault> faults;
  for (std::size_t k = 0; k < lanes; ++k) faults.push_back(batch.axis.fault().lane(k));
  return faults;
}

TEST(AxisLanes, AreTheAxesAloneToTheBit) {
  EXPECT_EQ(compare([](std::size_t, int, Inputs&) {}), std::vector<Fault>(lanes, Fault::none));
}

TEST(AxisLanes, LaneThatTripsLeavesTheOthersAsTheyAre) {
  const auto faults = compare([](std::size_t k, int n, Inputs& in) {
    if (k == 1 && n == 100) in.input_fault = true;
    if (k == 2 && n >= 120) in.i[0] = 60.0;
  });
  ASSERT_EQ(faults.size(), lanes);
  EXPECT_EQ(faults[0], Fault::none);
  EXPECT_EQ(faults[1], Fault::drive_input);
  EXPECT_EQ(faults[2], Fault::over_current);
}

TEST(AxisLanes, LaneThatMissesSamplesLeavesTheOthersAsTheyAre) {
  const auto faults = compare([](std::size_t k, int n, Inputs& in) {
    if (k == 0 && n % 7 == 0) in.sampled = false;  // one now and then is allowed
    if (k == 3 && n >= 150) in.sampled = false;
  });
  ASSERT_EQ(faults.size(), lanes);
  EXPECT_EQ(faults[0], Fault::none);
  EXPECT_EQ(faults[1], Fault::none);
  EXPECT_EQ(faults[3], Fault::position_lost);
}

}  // namespace
}  // namespace stiction::axis_lanes
