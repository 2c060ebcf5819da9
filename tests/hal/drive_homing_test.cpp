// Homing on the simulated cross table with the noise of a real encoder.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "tests/hal/fault_cases.hpp"
#include "tests/support/figure.hpp"
#include "tests/support/shipped_machine.hpp"

namespace stiction::test {
namespace {

using machine::HomingMethod;

constexpr double search = 0.05, creep = 0.002;  // m/s
constexpr double period = 62.5e-6;              // s

struct Place {
  const char* name;
  HomingMethod method;
  double mark;  // m, where X has it in the encoder's coordinates; it begins at 90 mm
};

// m, the machine's position of the mark: the ends of the travel.
double offset_of(HomingMethod method) { return method == HomingMethod::limit_negative ? -0.25 : 0.25; }

Bench homing_bench(HomingMethod method) {
  const auto machine = cross_table({"axis.*.encoder.velocity=estimated", "axis.*.encoder.noise=5 nm"});
  auto setup = drive_setup(machine);
  setup.axes.at("X").homing = {method, search, creep, offset_of(method)};
  setup.axes.at("Y").homing.method = HomingMethod::here;
  Bench bench(machine, setup);
  EXPECT_TRUE(bench.enable());
  EXPECT_FALSE(bench.loop.drive(0).referenced());
  return bench;
}

void home(Bench& bench, int ticks) {
  bench.mode = OperationMode::homing;
  bench.extra_bits = controlword::homing_start_bit;
  const auto done = [&] { return bench.loop.drive(0).homing_phase() == Homing<FixedSignals>::Phase::done; };
  for (int i = 0; i < ticks && !done() && !bench.loop.faulted(); ++i) bench.tick();
  EXPECT_EQ(done(), (bench.loop.statusword(0) & statusword::homed_bit) != 0);
}

void place_mark(Bench& bench, const Place& place) {
  auto& marks = bench.backend.marks(0);
  if (place.method == HomingMethod::limit_negative) marks.limit_negative = place.mark;
  if (place.method == HomingMethod::limit_positive) marks.limit_positive = place.mark;
  if (place.method == HomingMethod::index_negative || place.method == HomingMethod::index_positive)
    marks.index = place.mark;
}

class HomingOfX : public ::testing::TestWithParam<Place> {};

TEST_P(HomingOfX, FindsItsMarkAndThenHasTheMachinesCoordinates) {
  const auto place = GetParam();
  auto bench = homing_bench(place.method);
  place_mark(bench, place);
  home(bench, 100000);
  ASSERT_TRUE(bench.events.empty()) << name_of(bench.events.front().event.fault);
  EXPECT_TRUE(bench.loop.drive(0).referenced());
  // A switch is sampled once a tick: it opens at most a creep step before the tick that sees it. An index mark comes
  // with its position.
  const bool index = place.method == HomingMethod::index_negative || place.method == HomingMethod::index_positive;
  const double error = machine::to_si(bench.loop.drive(0).origin()) - (place.mark - offset_of(place.method));
  EXPECT_LE(std::abs(error), index ? 2e-12 : creep * period + 30e-9);
  EXPECT_NEAR(bench.position(0),
              machine::to_si(bench.loop.loop().feedback()[0].position) - (place.mark - offset_of(place.method)), 1e-6);
  // It stands, and goes on from there with set-points of the machine's coordinates.
  EXPECT_LT(std::abs(bench.simulated.plant(0).velocity()), 2e-3);
  bench.mode = OperationMode::cyclic_position;
  bench.extra_bits = 0;
  bench.hold_here();
  bench.run(1000);
  bench.move({.feed = 0.1, .radius = 0.02});
  bench.run(16000);
  EXPECT_TRUE(bench.events.empty());
  EXPECT_TRUE(bench.loop.all_in(DriveState::operation_enabled));
}

std::string name_of_place(const ::testing::TestParamInfo<Place>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Drive, HomingOfX,
                         ::testing::Values(Place{"limit_negative", HomingMethod::limit_negative, -0.02},
                                           Place{"limit_positive", HomingMethod::limit_positive, 0.15},
                                           Place{"index_negative", HomingMethod::index_negative, 0.0871},
                                           Place{"index_positive", HomingMethod::index_positive, 0.0922},
                                           Place{"here", HomingMethod::here, 0.09}),
                         name_of_place);

TEST(DriveHoming, BeginsOnTheSwitchItself) {
  auto bench = homing_bench(HomingMethod::limit_negative);
  bench.backend.marks(0).limit_negative = 0.0905;  // reached already
  home(bench, 100000);
  EXPECT_TRUE(bench.events.empty());
  EXPECT_NEAR(machine::to_si(bench.loop.drive(0).origin()), 0.0905 - offset_of(HomingMethod::limit_negative),
              creep * period + 30e-9);
}

TEST(DriveHoming, IsInterruptedWithItsStartBitAndBeginsAnew) {
  auto bench = homing_bench(HomingMethod::index_positive);
  bench.backend.marks(0).index = 0.0922;
  home(bench, 2000);
  EXPECT_GT(bench.simulated.plant(0).velocity(), 1e-3);
  bench.extra_bits = 0;
  bench.run(2000);
  EXPECT_LT(std::abs(bench.simulated.plant(0).velocity()), 1e-3);
  EXPECT_EQ(bench.loop.drive(0).homing_phase(), Homing<FixedSignals>::Phase::idle);
  EXPECT_FALSE(bench.loop.drive(0).referenced());
  home(bench, 100000);
  EXPECT_TRUE(bench.loop.drive(0).referenced());
}

TEST(DriveHoming, OfASwitchThatIsStuckClosedEndsInAFault) {
  auto bench = homing_bench(HomingMethod::limit_negative);
  bench.backend.faults(0).negative_switch = hal::SwitchFault::stuck_closed;
  home(bench, 2'000'000);
  ASSERT_FALSE(bench.events.empty());
  EXPECT_EQ(bench.events.front().event.fault, Fault::homing);
  EXPECT_NE(bench.loop.statusword(0) & statusword::homing_error_bit, 0);
  bench.run(8000);
  EXPECT_FALSE(bench.powered(0));
  EXPECT_EQ(bench.loop.statusword(0) & 0x3400, 0x2400) << "homing error, at rest: until the reset";
}

TEST(DriveHoming, IntoTheOtherSwitchStopsThere) {
  auto bench = homing_bench(HomingMethod::index_positive);
  bench.backend.marks(0).limit_positive = 0.0905;
  home(bench, 100000);
  ASSERT_FALSE(bench.events.empty());
  EXPECT_EQ(bench.events.front().event.fault, Fault::limit_switch);
}

TEST(DriveHoming, IsLostWithTheEncodersPlace) {
  auto bench = homing_bench(HomingMethod::here);
  home(bench, 1000);
  ASSERT_TRUE(bench.loop.drive(0).referenced());
  bench.backend.faults(0).encoder_shift = 1e-3;
  bench.run(3);
  EXPECT_EQ(bench.loop.fault(0), Fault::encoder_jump);
  bench.run(100);
  EXPECT_TRUE(bench.reset());
  EXPECT_FALSE(bench.loop.drive(0).referenced());
}

TEST(DriveHoming, IsLostWithTheSignalsOfAnEncoderThatCounts) {
  auto bench = homing_bench(HomingMethod::here);
  home(bench, 1000);
  ASSERT_TRUE(bench.loop.drive(0).referenced());
  bench.backend.faults(0).encoder_signal = true;
  bench.run(3);
  EXPECT_EQ(bench.loop.fault(0), Fault::encoder_signal);
  EXPECT_FALSE(bench.reset()) << "the cause is there";
  bench.backend.faults(0).encoder_signal = false;
  bench.run(100);
  EXPECT_TRUE(bench.reset());
  EXPECT_FALSE(bench.loop.drive(0).referenced());
}

TEST(DriveHoming, OfAnAbsoluteEncoderChangesNothing) {
  const auto machine = cross_table({"axis.*.encoder.velocity=estimated"});
  Bench bench(machine, drive_setup(machine));
  ASSERT_TRUE(bench.enable());
  home(bench, 10);
  EXPECT_TRUE(bench.loop.drive(0).referenced());
  EXPECT_EQ(bench.loop.drive(0).origin(), FixedSignals::Position{});
}

}  // namespace
}  // namespace stiction::test
