// Three-phase motors whose encoder's zero is not the motor's: the plant has the true offset, the drive stores or finds
// its own. On every shipped machine with such a motor, with friction and load as shipped.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "sim/experiment/set_point.hpp"
#include "tests/support/figure.hpp"
#include "tests/support/motor_bench.hpp"

namespace stiction::test {
namespace {

struct ShippedMotor {
  const char* machine;
  std::vector<const char*> axes;
};
const std::array<ShippedMotor, 5> shipped_motors{{{"mcfv5050ln", {"X", "Y"}},
                                                  {"belt-axis", {"X"}},
                                                  {"screw-motor-encoder", {"X"}},
                                                  {"vertical-axis", {"Z"}},
                                                  {"servo-joint", {"J"}}}};

std::vector<std::string> with_offset(const ShippedMotor& motor, double true_degrees, const std::string& method) {
  std::vector<std::string> settings;
  for (const char* axis : motor.axes) {
    settings.push_back(fmt::format("axis.{}.encoder.commutation_offset={} deg", axis, true_degrees));
    settings.push_back(fmt::format("axis.{}.encoder.velocity=estimated", axis));
    settings.push_back(fmt::format("drive.axis.{}.commutation.method={}", axis, method));
    // Of 15 microradians an increment; the default is for fine encoders.
    if (*axis == 'J') settings.emplace_back("drive.axis.J.encoder_jump=1 mrad");
  }
  return settings;
}

// Moves every axis by constant acceleration (m/s^2) for `count` ticks from rest, and returns by how much (m) the axes
// went the other way, at most.
double way_against(MotorBench& bench, double acceleration, int count) {
  std::vector<double> start, from;
  for (std::size_t i = 0; i < bench.machine.axes.size(); ++i) {
    start.push_back(bench.x(i));
    from.push_back(machine::to_si(bench.loop.drive(i).set_position()));
  }
  double against = 0.0;
  for (int k = 1; k <= count; ++k) {
    const double t = k * bench.period();
    for (std::size_t i = 0; i < start.size(); ++i)
      bench.set(i) =
          sim::to_set_point<FixedSignals>({from[i] + 0.5 * acceleration * t * t, acceleration * t, acceleration});
    bench.tick();
    for (std::size_t i = 0; i < start.size(); ++i)
      against = std::max(against, acceleration > 0.0 ? start[i] - bench.x(i) : bench.x(i) - start[i]);
  }
  return against;
}

// What the plants' positions cover while commutation and brake are tested.
class TestedWay {
 public:
  explicit TestedWay(MotorBench& bench) : bench_(bench) {
    for (std::size_t i = 0; i < bench.machine.axes.size(); ++i) start_.push_back(bench.x(i));
    farthest_.resize(start_.size());
    bench.before_tick = [this] {
      for (std::size_t i = 0; i < start_.size(); ++i)
        if (!bench_.loop.drive(i).follows()) farthest_[i] = std::max(farthest_[i], std::abs(bench_.x(i) - start_[i]));
    };
  }
  ~TestedWay() { bench_.before_tick = nullptr; }
  TestedWay(const TestedWay&) = delete;
  TestedWay& operator=(const TestedWay&) = delete;
  double of(std::size_t axis) const { return farthest_[axis]; }

 private:
  MotorBench& bench_;
  std::vector<double> start_, farthest_;
};

class CommutationOf : public ::testing::TestWithParam<ShippedMotor> {};

// The pole pair pitch is the scale of the way: a fiftieth of it is 7 degrees.
TEST_P(CommutationOf, IsFoundFromAnyElectricalAngleAndTheFirstMotionIsForwards) {
  const auto& motor = GetParam();
  std::vector<double> worst(motor.axes.size()), way(motor.axes.size());
  double longest = 0.0, against = 0.0, pitch = 0.0;
  for (int degrees = 0; degrees < 360; ++degrees) {
    MotorBench bench(motor.machine, with_offset(motor, degrees + 0.5, "test"));
    {
      const TestedWay tested(bench);
      ASSERT_TRUE(bench.enable()) << degrees << " " << name_of(bench.loop.fault(0));
      for (std::size_t i = 0; i < motor.axes.size(); ++i) {
        worst[i] = std::max(worst[i], std::abs(bench.offset_error(i)));
        pitch = bench.machine.axes[i].motor.pole_pair_pitch;
        way[i] = std::max(way[i], tested.of(i) / pitch);
      }
    }
    longest = std::max(longest, static_cast<double>(bench.ticks) * bench.period());
    bench.hold_here();
    bench.run(4800);  // 0.3 s: a load settles on the control when the brake opens
    ASSERT_FALSE(bench.loop.faulted()) << degrees;
    against = std::max(against, way_against(bench, degrees % 2 == 0 ? 0.5 : -0.5, 800) / pitch);
    ASSERT_FALSE(bench.loop.faulted()) << degrees;
  }
  for (std::size_t i = 0; i < motor.axes.size(); ++i) {
    EXPECT_LE(worst[i], 2.0) << motor.axes[i];
    EXPECT_LE(way[i], 1.0 / 50.0) << motor.axes[i];
    figure(fmt::format("commutation test, {} {}", motor.machine, motor.axes[i]),
           fmt::format("{:.3f} deg off, {:.2f} % of a pole pair moved, {:.2f} s (bounds 2 deg, 2 %)", worst[i],
                       100.0 * way[i], longest));
  }
  // A thousandth of a pole pair: what friction and the control's steps of the error leave of the axis' hold.
  EXPECT_LE(against, 1e-3);
  figure(fmt::format("first motion the wrong way, {}", motor.machine),
         fmt::format("{:.4f} % of a pole pair (bound 0.1 %)", 100.0 * against));
}

// Without presliding an axis does not move at all below the force that breaks it away.
TEST_P(CommutationOf, IsFoundWithFrictionThatSticksExactly) {
  const auto& motor = GetParam();
  double worst = 0.0;
  for (int degrees = 0; degrees < 360; degrees += 15) {
    auto settings = with_offset(motor, degrees + 0.5, "test");
    for (const char* axis : motor.axes) settings.push_back(fmt::format("axis.{}.friction.use=classical", axis));
    MotorBench bench(motor.machine, settings);
    ASSERT_TRUE(bench.enable()) << degrees << " " << name_of(bench.loop.fault(0));
    for (std::size_t i = 0; i < motor.axes.size(); ++i) worst = std::max(worst, std::abs(bench.offset_error(i)));
  }
  EXPECT_LE(worst, 2.0);
  figure(fmt::format("commutation test with exact sticking, {}", motor.machine),
         fmt::format("{:.3f} deg off (bound 2 deg)", worst));
}

TEST(Commutation, IsFoundWithEveryFrictionModelOfTheCrossTable) {
  const auto& motor = shipped_motors.front();
  for (const char* model : {"coulomb_viscous", "classical", "linear_ramp", "parabolic", "lugre", "maxwell_slip", "dahl",
                            "elasto_plastic", "curve"})
    for (int degrees = 0; degrees < 360; degrees += 30) {
      auto settings = with_offset(motor, degrees + 0.5, "test");
      for (const char* axis : motor.axes) settings.push_back(fmt::format("axis.{}.friction.use={}", axis, model));
      MotorBench bench(motor.machine, settings);
      ASSERT_TRUE(bench.enable()) << model << " " << degrees << " " << name_of(bench.loop.fault(0));
      for (std::size_t i = 0; i < motor.axes.size(); ++i) EXPECT_LE(std::abs(bench.offset_error(i)), 2.0) << model;
    }
}

// The test counts in ticks; what the vector makes of the axis in a turn differs by the square of the period.
TEST_P(CommutationOf, IsFoundAtOtherPeriods) {
  const auto& motor = GetParam();
  for (const char* period : {"50 us", "125 us"})
    for (int degrees = 0; degrees < 360; degrees += 30) {
      auto settings = with_offset(motor, degrees + 0.5, "test");
      settings.push_back(fmt::format("timing.fast_period={}", period));
      settings.emplace_back("timing.set_point_delay=750 us");  // a multiple of each
      for (const char* axis : motor.axes)
        settings.push_back(fmt::format("axis.{}.inverter.dead_time={}", axis, period));
      MotorBench bench(motor.machine, settings);
      ASSERT_TRUE(bench.enable(96000)) << period << " " << degrees << " " << name_of(bench.loop.fault(0));
      for (std::size_t i = 0; i < motor.axes.size(); ++i) EXPECT_LE(std::abs(bench.offset_error(i)), 2.0) << period;
    }
}

TEST_P(CommutationOf, AWrongStoredOffsetIsAFaultBeforeTheAxisFollows) {
  const auto& motor = GetParam();
  double farthest = 0.0;
  for (int wrong = 20; wrong <= 340; wrong += 5) {
    auto settings = with_offset(motor, 77.0, "stored");
    for (const char* axis : motor.axes)
      settings.push_back(fmt::format("drive.axis.{}.commutation.offset={} deg", axis, 77.0 + wrong));
    MotorBench bench(motor.machine, settings);
    const TestedWay tested(bench);
    EXPECT_FALSE(bench.enable()) << wrong;
    // Of two axes the one that sees it first stops the other one.
    bool seen = false;
    for (std::size_t i = 0; i < motor.axes.size(); ++i) seen |= bench.loop.fault(i) == Fault::commutation_offset;
    EXPECT_TRUE(seen) << wrong << " " << name_of(bench.loop.fault(0));
    bench.run(1600);
    for (std::size_t i = 0; i < motor.axes.size(); ++i) EXPECT_FALSE(bench.loop.drive(i).powered());
    for (std::size_t i = 0; i < motor.axes.size(); ++i)
      farthest = std::max(farthest, tested.of(i) / bench.machine.axes[i].motor.pole_pair_pitch);
  }
  EXPECT_LE(farthest, 1.0 / 50.0);
  figure(fmt::format("wrong stored offset, 20 to 180 deg, {}", motor.machine),
         fmt::format("{:.2f} % of a pole pair moved before the fault (bound 2 %)", 100.0 * farthest));
}

TEST_P(CommutationOf, ARightStoredOffsetIsTakenAsItIs) {
  const auto& motor = GetParam();
  for (const int off : {-10, 0, 10}) {
    auto settings = with_offset(motor, 200.0, "stored");
    for (const char* axis : motor.axes)
      settings.push_back(fmt::format("drive.axis.{}.commutation.offset={} deg", axis, 200.0 + off));
    MotorBench bench(motor.machine, settings);
    ASSERT_TRUE(bench.enable()) << off << " " << name_of(bench.loop.fault(0));
    for (std::size_t i = 0; i < motor.axes.size(); ++i) EXPECT_NEAR(bench.offset_error(i), off, 1e-6);
  }
}

// Trusted without a check, an offset of the wrong sign is left to the watches over force and following error.
TEST_P(CommutationOf, AnUncheckedOffsetOfTheWrongSignIsSeenInItsFirstMotion) {
  const auto& motor = GetParam();
  double farthest = 0.0;
  for (const int wrong : {120, 150, 180, 210, 240}) {
    auto settings = with_offset(motor, 77.0, "stored");
    for (const char* axis : motor.axes) {
      settings.push_back(fmt::format("drive.axis.{}.commutation.offset={} deg", axis, 77.0 + wrong));
      settings.push_back(fmt::format("drive.axis.{}.commutation.check=none", axis));
    }
    MotorBench bench(motor.machine, settings);
    ASSERT_TRUE(bench.enable()) << wrong;
    std::vector<double> start;
    for (std::size_t i = 0; i < motor.axes.size(); ++i) start.push_back(bench.x(i));
    way_against(bench, 0.5, 1600);
    bool seen = true;
    for (std::size_t i = 0; i < motor.axes.size(); ++i) {
      seen &= !bench.loop.drive(i).powered();
      farthest = std::max(farthest, std::abs(bench.x(i) - start[i]) / bench.machine.axes[i].motor.pole_pair_pitch);
    }
    EXPECT_TRUE(seen) << wrong << " " << name_of(bench.loop.fault(0));
  }
  fmt::print("{}: {:.3f} of a pole pair moved within 0.1 s\n", motor.machine, farthest);
}

TEST_P(CommutationOf, AJammedAxisIsAFaultAndNothingMoves) {
  const auto& motor = GetParam();
  auto settings = with_offset(motor, 123.0, "test");
  for (const char* axis : motor.axes) {
    const char* unit = *axis == 'J' ? "N m" : "N";
    settings.push_back(fmt::format("axis.{}.friction.use=classical", axis));
    settings.push_back(fmt::format("axis.{}.friction.classical.coulomb=1e6 {}", axis, unit));
  }
  MotorBench bench(motor.machine, settings);
  const TestedWay tested(bench);
  EXPECT_FALSE(bench.enable());
  EXPECT_EQ(bench.loop.fault(0), Fault::commutation_not_found) << name_of(bench.loop.fault(0));
  // The longest growth of the current: 16 turns by a quarter each.
  EXPECT_LE(static_cast<double>(bench.ticks) * bench.period(), 0.5);
  bench.run(1600);
  EXPECT_FALSE(bench.loop.drive(0).powered());
  EXPECT_EQ(tested.of(0), 0.0);
  EXPECT_TRUE(bench.reset());
}

// Half of a sector at first, the edge itself from the first one on.
TEST_P(CommutationOf, FollowsFromHallSignals) {
  const auto& motor = GetParam();
  double at_first = 0.0, at_edge = 0.0;
  for (int degrees = 0; degrees < 360; degrees += 15) {
    MotorBench bench(motor.machine, with_offset(motor, degrees + 0.5, "hall"));
    for (std::size_t i = 0; i < motor.axes.size(); ++i) bench.backend.signals(i).hall_wired = true;
    ASSERT_TRUE(bench.enable()) << degrees << " " << name_of(bench.loop.fault(0));
    for (std::size_t i = 0; i < motor.axes.size(); ++i) at_first = std::max(at_first, std::abs(bench.offset_error(i)));
    bench.hold_here();
    bench.run(4800);
    // A pole pair and a half at constant acceleration.
    const double pitch = bench.machine.axes[0].motor.pole_pair_pitch, acceleration = 0.2;
    const double time = std::sqrt(3.0 * pitch / acceleration);
    way_against(bench, acceleration, static_cast<int>(time / bench.period()));
    ASSERT_FALSE(bench.loop.faulted()) << degrees << " " << name_of(bench.loop.fault(0));
    for (std::size_t i = 0; i < motor.axes.size(); ++i) at_edge = std::max(at_edge, std::abs(bench.offset_error(i)));
  }
  EXPECT_LE(at_first, 30.0);
  EXPECT_LE(at_edge, 2.0);
  figure(
      fmt::format("commutation from Hall signals, {}", motor.machine),
      fmt::format("{:.1f} deg off at first, {:.2f} deg from the first edge on (bounds 30, 2 deg)", at_first, at_edge));
}

INSTANTIATE_TEST_SUITE_P(Shipped, CommutationOf, ::testing::ValuesIn(shipped_motors), [](const auto& info) {
  std::string name = info.param.machine;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

const ShippedMotor& screw = shipped_motors[2];

TEST(Commutation, NoHallSignalIsAFaultAndNothingMoves) {
  for (const std::uint8_t code : {std::uint8_t{0}, std::uint8_t{7}}) {
    MotorBench bench(screw.machine, with_offset(screw, 50.0, "hall"));
    bench.backend.signals(0).hall_wired = true;
    bench.backend.signals(0).hall = code;
    const TestedWay tested(bench);
    EXPECT_FALSE(bench.enable());
    EXPECT_EQ(bench.loop.fault(0), Fault::commutation_not_found);
    bench.run(1600);
    EXPECT_EQ(tested.of(0), 0.0);
    // In order again when the signals are.
    EXPECT_TRUE(bench.reset());
    bench.backend.signals(0).hall = {};
    EXPECT_TRUE(bench.enable());
  }
}

TEST(Commutation, AHallSignalThatIsLostUnderPowerIsAFault) {
  MotorBench bench(screw.machine, with_offset(screw, 50.0, "hall"));
  bench.backend.signals(0).hall_wired = true;
  ASSERT_TRUE(bench.enable());
  bench.hold_here();
  bench.run(1600);
  bench.backend.signals(0).hall = std::uint8_t{0};
  bench.run(2);
  EXPECT_EQ(bench.loop.fault(0), Fault::commutation_not_found);
  EXPECT_FALSE(bench.loop.drive(0).powered());
}

TEST(Commutation, TheIndexMarkMakesTheOffsetExactOrIsAFault) {
  constexpr double true_degrees = 250.0, mark = 1e-3;
  const machine::Machine machine = MotorBench(screw.machine, {}).machine;
  const double at_mark = true_degrees + 360.0 * mark / machine.axes[0].motor.pole_pair_pitch;
  for (const double off : {0.0, 40.0}) {
    auto settings = with_offset(screw, true_degrees, "hall");
    settings.push_back(fmt::format("drive.axis.X.commutation.index_offset={} deg", at_mark + off));
    MotorBench bench(screw.machine, settings);
    bench.backend.signals(0).hall_wired = true;
    bench.backend.signals(0).index = mark;
    ASSERT_TRUE(bench.enable());
    bench.hold_here();
    bench.run(1600);
    way_against(bench, 0.2, 1700);
    if (off == 0.0) {
      EXPECT_FALSE(bench.loop.faulted()) << name_of(bench.loop.fault(0));
      EXPECT_LE(std::abs(bench.offset_error(0)), 0.2);
    } else {
      EXPECT_EQ(bench.loop.fault(0), Fault::commutation_offset);
    }
  }
}

// The test is of the start: the next enabling knows.
TEST(Commutation, IsTestedOnceAndAnEnablingThatIsBrokenOffBeginsAgain) {
  MotorBench bench(screw.machine, with_offset(screw, 300.0, "test"));
  EXPECT_FALSE(bench.enable(4000));
  EXPECT_TRUE(bench.loop.drive(0).preparing());
  bench.want_on = false;
  bench.run(200);
  EXPECT_FALSE(bench.loop.drive(0).preparing());
  EXPECT_FALSE(bench.loop.drive(0).powered());
  EXPECT_FALSE(bench.loop.drive(0).commutation().known());
  ASSERT_TRUE(bench.enable());
  bench.want_on = false;
  bench.run(3200);
  EXPECT_TRUE(bench.enable(2000));
}

// Behind a fault by which the encoder may have lost its place the angle is tested again.
TEST(Commutation, IsLostWithTheEncodersPlace) {
  MotorBench bench(screw.machine, with_offset(screw, 300.0, "test"));
  ASSERT_TRUE(bench.enable());
  for (const Fault fault : {Fault::over_speed, Fault::encoder_jump}) {
    bench.loop.trip(0, fault);
    bench.run(2);
    EXPECT_EQ(bench.loop.fault(0), fault);
    bench.want_on = false;
    bench.run(200);
    ASSERT_TRUE(bench.reset());
    EXPECT_EQ(bench.loop.drive(0).commutation().known(), !loses_reference(fault));
    ASSERT_TRUE(bench.enable());
    EXPECT_LE(std::abs(bench.offset_error(0)), 2.0);
  }
}

// Nothing but the true offset of the plant differs, and every bit of the drive's is the same.
TEST(Commutation, NoPathOfTheDriveReadsThePlantsOffset) {
  const auto drives = [](double degrees) {
    const MotorBench bench(screw.machine, with_offset(screw, degrees, "stored"));
    return bench.loop.drive(0).commutation().offset().raw;
  };
  EXPECT_EQ(drives(0.0), drives(123.0));
}

}  // namespace
}  // namespace stiction::test
