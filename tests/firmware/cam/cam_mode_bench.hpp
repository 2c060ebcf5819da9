// An axis in the mode of a cam, at standstill and behind a master that turns, for the tests of both.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <memory>

#include "stiction/drive/cam_mode.hpp"
#include "tests/firmware/cam/cam_bench.hpp"

namespace stiction::test {

class ACamMode : public ::testing::Test {
 protected:
  ACamMode() {
    EXPECT_EQ(CamCurve::prepare({.table = &cam->table}, tables[0].curve), CamRefusal::none);
    tables[0].high = raw_position(0.03);
    config.motion =
        CamMotion::Config::of(limits(1.0, 20.0, 20e3), limits(1.2, 5.0, 50.0), limits(0.1, 1.0, 10.0), 1024);
    config.rate = FixedSignals::rate(62'500);
    config.low = FixedSignals::Position::from_raw(raw_position(-0.1));
    config.high = FixedSignals::Position::from_raw(raw_position(0.1));
    mode.start(FixedSignals::Position{});
  }

  std::unique_ptr<TestCam> cam = test_cam(rise_and_return("3-4-5", 0.03));
  std::array<CamMode::Table, 1> tables{};
  CamMode::Config config;
  CamMode mode{config, tables};
};

// In sync with a master of 1 cycle/s, and with a ramp that brakes as hard as its limits let it.
class AMovingCam : public ACamMode {
 protected:
  AMovingCam() {
    config.stops.fill(Span::of(raw_acceleration(20.0)));
    master.run(master_speed(1.0));
    EXPECT_EQ(mode.command(CamCommand::engage, false, true), CamRefusal::none);
    run(20'000);
    EXPECT_TRUE(mode.status().in_sync);
  }
  void run(int ticks) {
    for (int k = 0; k < ticks; ++k) mode.step({master.step(), true});
  }

  VirtualMaster master{VirtualMaster::Config::of(limits(1.2, 5.0, 50.0))};
};

}  // namespace stiction::test
