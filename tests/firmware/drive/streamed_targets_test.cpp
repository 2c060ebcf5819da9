// Streams of targets: those that come wrong, and how late an axis is behind those that ask for all of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "tests/firmware/drive/asked_axis.hpp"
#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

// Targets that come too often, too late, twice or from elsewhere: the fault, and no step of the set speed.
struct WrongStream {
  std::string name;
  OperationMode mode;
  std::function<void(ServedAxis&, int cycle)> send;
  Fault fault;
};

std::vector<WrongStream> wrong_streams() {
  using enum OperationMode;
  const auto well = [](ServedAxis& a) { a.send(0.2); };
  const auto jump = [](double by) {
    return [by](ServedAxis& a, int k) {
      a.send(0.2);
      if (k == 40) a.remote.offer(si<FixedSignals::Position>(a.streamed + by), true);
    };
  };
  return {
      {"three targets a cycle, 0.2 m/s each", cyclic_position,
       [well](ServedAxis& a, int) {
         for (int i = 0; i < 3; ++i) well(a);
       },
       Fault::set_point},
      {"one doubled", cyclic_position,
       [well](ServedAxis& a, int k) {
         well(a);
         if (k == 40) well(a);
       },
       Fault::set_point},
      {"the same target twice", cyclic_position,
       [well](ServedAxis& a, int) {
         well(a);
         a.remote.offer(si<FixedSignals::Position>(a.streamed), true);
       },
       Fault::none},
      {"two too late", cyclic_position,
       [](ServedAxis& a, int k) {
         a.streamed += k == 40 || k == 41 ? 0.2 * ServedAxis::cycle_ticks * tick : 0.0;
         if (k != 40 && k != 41) a.send(0.2);
       },
       Fault::none},
      {"three too late", cyclic_position,
       [](ServedAxis& a, int k) {
         if (k < 40 || k > 42) a.send(0.2);
       },
       Fault::set_points_lost},
      {"a jump ahead", cyclic_position, jump(0.5e-3), Fault::set_point},
      {"a jump back", cyclic_position, jump(-0.5e-3), Fault::set_point},
      {"further than a cycle at max_velocity", cyclic_position, jump(5e-3), Fault::set_point},
      {"the same back", cyclic_position, jump(-5e-3), Fault::set_point},
      {"more than max_acceleration for long", cyclic_position,
       [](ServedAxis& a, int k) {
         const double t = k * ServedAxis::cycle_ticks * tick;
         a.remote.offer(si<FixedSignals::Position>(0.5 * 1.8 * ServedAxis::acceleration * t * t), true);
       },
       Fault::set_point},
      {"no number", cyclic_position,
       [](ServedAxis& a, int k) {
         a.send(0.2);
         if (k == 40) a.remote.offer({}, false);
       },
       Fault::set_point},
      {"speeds too late", cyclic_velocity,
       [](ServedAxis& a, int k) {
         if (k < 40) a.send(0.2);
       },
       Fault::set_points_lost},
      {"two speeds too late", cyclic_velocity,
       [](ServedAxis& a, int k) {
         if (k != 40 && k != 41) a.send(0.2);
       },
       Fault::none},
      {"a speed that jumps", cyclic_velocity, [](ServedAxis& a, int k) { a.send(k % 40 < 20 ? 0.2 : -0.2); },
       Fault::none},
      {"a speed beyond every limit", cyclic_velocity, [](ServedAxis& a, int k) { a.send(k < 5 ? 7.9 : 0.0); },
       Fault::none},
      {"many speeds a cycle", cyclic_velocity,
       [](ServedAxis& a, int) {
         for (const double v : {7.0, -7.0, 0.2}) a.send(v);
       },
       Fault::none},
      {"torques too late", cyclic_torque,
       [](ServedAxis& a, int k) {
         if (k < 40) a.send(0.2);
       },
       Fault::set_points_lost},
      {"two torques too late", cyclic_torque,
       [](ServedAxis& a, int k) {
         if (k != 40 && k != 41) a.send(0.2);
       },
       Fault::none},
      {"a torque that jumps", cyclic_torque,
       [](ServedAxis& a, int k) { a.remote.offer_torque(si<FixedSignals::Current>(k % 2 == 0 ? 40.0 : -40.0)); },
       Fault::none},
      {"a torque beyond every limit", cyclic_torque,
       [](ServedAxis& a, int) { a.remote.offer_torque(si<FixedSignals::Current>(2000.0)); }, Fault::none},
      {"many torques a cycle", cyclic_torque,
       [](ServedAxis& a, int) {
         for (const double i : {40.0, -40.0, 10.0}) a.remote.offer_torque(si<FixedSignals::Current>(i));
       },
       Fault::none},
      {"a speed that is no number", cyclic_velocity,
       [](ServedAxis& a, int k) {
         a.send(0.2);
         if (k == 40) a.remote.offer_speed({}, false);
       },
       Fault::set_point},
  };
}

TEST(WrongStreams, EndInTheFaultThatIsStatedAndNoStepOfTheSetSpeed) {
  int as_stated = 0, tried = 0;
  for (const auto& c : wrong_streams()) {
    SCOPED_TRACE(c.name);
    auto a = enabled_in(c.mode);
    double largest = 0.0;
    for (int k = 0; k < 100; ++k) {
      c.send(a, k);
      for (int i = 0; i < ServedAxis::cycle_ticks; ++i) {
        a.step();
        largest = std::max(largest, a.step_of_speed());
      }
    }
    EXPECT_EQ(a.drive.fault(), c.fault) << name_of(a.drive.fault());
    // max_acceleration, and the roundings of two speeds.
    EXPECT_LE(largest, ServedAxis::acceleration * tick + 0x1p-27);
    as_stated += a.drive.fault() == c.fault && largest <= ServedAxis::acceleration * tick + 0x1p-27 ? 1 : 0;
    ++tried;
    a.run(4000);
    EXPECT_EQ(a.set_speed, c.fault == Fault::none ? a.set_speed : 0.0);
  }
  figure("targets too many, too late, doubled or jumping in csp, csv and cst: no step, and the stated fault",
         std::to_string(as_stated) + " of " + std::to_string(tried) + " (bound all)");
}

// To 0.5 m/s and to rest again without a jerk limit: the interpolated speeds overshoot at each jump of the
// acceleration, and the set speed keeps max_acceleration. The less of it the stream uses, the sooner the lag is made up
// for. m.
double lag_of_a_stream(double share) {
  constexpr double top = 0.5, hold = 0.1;  // m/s, s
  const double rate = share * ServedAxis::acceleration, ramp = top / rate;
  const auto way = [&](double t) {
    const double up = std::clamp(t, 0.0, ramp), along = std::clamp(t - ramp, 0.0, hold);
    const double down = std::clamp(t - ramp - hold, 0.0, ramp);
    return 0.5 * rate * up * up + top * along + top * down - 0.5 * rate * down * down;
  };
  auto a = enabled_in(OperationMode::cyclic_position);
  while (a.ticks % ServedAxis::cycle_ticks != 0) a.stream(1, 0.0);
  constexpr double cycle = ServedAxis::cycle_ticks * tick;
  double latest = 0.0, largest = 0.0;
  for (int k = 1; k < 400; ++k) {
    a.remote.offer(si<FixedSignals::Position>(way(k * cycle)), true);
    for (int i = 0; i < ServedAxis::cycle_ticks; ++i) {
      a.step();
      // The target of a cycle is reached at its end.
      latest = std::max(latest, std::abs(machine::to_si(a.drive.set_position()) - way((k - 1) * cycle + i * tick)));
      largest = std::max(largest, a.step_of_speed());
    }
  }
  EXPECT_LE(largest, ServedAxis::acceleration * tick + 0x1p-27);
  EXPECT_NEAR(a.x, way(10.0), 1e-9);
  EXPECT_EQ(a.drive.fault(), Fault::none);
  return latest;
}

TEST(Streams, ThatJumpToAnAccelerationAreReachedAndLateOnlyWhereTheyUseAllOfIt) {
  EXPECT_LE(lag_of_a_stream(0.5), 3e-6);
  EXPECT_LE(lag_of_a_stream(0.8), 5e-6);
  EXPECT_LE(lag_of_a_stream(0.9), 5e-6);
  EXPECT_LE(lag_of_a_stream(1.0), 60e-6) << "docs/limits.md says so";
}

}  // namespace
}  // namespace stiction::test
