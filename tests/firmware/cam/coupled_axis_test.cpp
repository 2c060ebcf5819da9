// An axis that a bus couples to a master by a gear: what the drive does with set-points that it must not follow.
#include <gtest/gtest.h>

#include "tests/firmware/cam/cam_bench.hpp"
#include "tests/firmware/drive/served_axis.hpp"

namespace stiction::test {
namespace {

using S = FixedSignals;

// In the mode of a gear of 1 m a cycle, behind a virtual master of up to 1 cycle/s.
class ACoupledAxis {
 public:
  explicit ACoupledAxis(HomingMethod method) : axis({}, method) {
    config.motion =
        CamMotion::Config::of(limits(3.0, 2000.0, 5e6), limits(1.0, 5.0, 50.0), limits(0.1, 1.0, 10.0), 1024);
    config.rate = S::rate(tick_ns);
    config.low = si<S::Position>(-ServedAxis::end);
    config.high = si<S::Position>(ServedAxis::end);
    mode.asked().gear_way = raw_position(1.0);
    mode.asked().slave_relative = true;
    axis.remote.cam().attach(mode, master);
    EXPECT_TRUE(axis.enable());
    axis.remote.ask(OperationMode::gear);
    axis.remote.ask(controlword::enable_operation);
    run(64);
    EXPECT_EQ(axis.remote.mode(), OperationMode::gear);
  }

  void run(int ticks) {
    for (int k = 0; k < ticks && axis.drive.fault() == Fault::none; ++k) {
      master.step();
      axis.step();
    }
  }
  void engage() {
    axis.remote.ask(CamCommand::engage);
    EXPECT_FALSE(axis.remote.cam().refused());
  }

  CamMaster master{CamMaster::Config{.virtual_master = VirtualMaster::Config::of(limits(1.0, 5.0, 50.0))}};
  CamMode::Config config;
  CamMode mode{config};
  ServedAxis axis;
};

TEST(CoupledAxis, FaultsAtTheEndOfItsTravel) {
  ACoupledAxis coupled(HomingMethod::none);
  coupled.engage();
  ASSERT_TRUE(coupled.master.run(master_speed(0.1)));
  coupled.run(4 * 16'000);
  EXPECT_EQ(coupled.axis.drive.fault(), Fault::none);
  coupled.run(4 * 16'000);
  EXPECT_EQ(coupled.axis.drive.fault(), Fault::set_point);
  EXPECT_NEAR(coupled.axis.x, ServedAxis::end, 0.1 * tick);
}

TEST(CoupledAxis, HasNoEndsWithoutAZero) {
  ACoupledAxis coupled(HomingMethod::here);
  coupled.engage();
  ASSERT_TRUE(coupled.master.run(master_speed(0.1)));
  coupled.run(8 * 16'000);
  EXPECT_EQ(coupled.axis.drive.fault(), Fault::none);
  EXPECT_GT(coupled.axis.x, ServedAxis::end + 0.1);
}

// From standstill to 1 m/s in 2 ms: 3/2 of the mean acceleration, 750 m/s^2, where the format ends at 512.
TEST(CoupledAxis, FaultsWhereASetPointIsBeyondTheFormats) {
  ACoupledAxis coupled(HomingMethod::none);
  ASSERT_TRUE(coupled.master.run(master_speed(1.0)));
  coupled.run(16'000);
  coupled.mode.asked().approach = CamApproach::ticks;
  coupled.mode.asked().ticks = 32;
  coupled.engage();
  coupled.run(32);
  EXPECT_FALSE(coupled.axis.remote.cam().refused());
  EXPECT_EQ(coupled.axis.drive.fault(), Fault::set_point);
  EXPECT_LT(coupled.axis.x, 1e-3);
}

}  // namespace
}  // namespace stiction::test
