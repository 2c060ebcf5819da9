// 10 000 random commands to an axis behind a virtual master that turns, stops and reverses under it. Truth is the watch
// over differences of set-points, and the motion in double precision.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>

#include "tests/firmware/cam/cam_bench.hpp"
#include "tests/sim/cam/random_motion.hpp"
#include "tests/support/figure.hpp"

namespace stiction {
namespace {

using test::limits;

const MotionLimits master_limits = limits(0.7, 7.0, 140.0), phasing_limits = limits(0.1, 1.0, 20.0);

struct Totals {
  int commands = 0, refused = 0, begun = 0, late = 0, in_sync = 0;
  double position_jump = 0.0, speed_jump = 0.0, over_velocity = 0.0, over_acceleration = 0.0, over_jerk = 0.0;
  double off_curve = 0.0, naive = 0.0;
};

// What is stated of a request that has begun, until it is kept or a new command comes.
struct Stated {
  bool open = false, distance = false, backward = false, absolute = false;
  std::int64_t ticks = 0;
  MasterPosition begin{};
};

class RandomAxis {
 public:
  RandomAxis(std::uint64_t seed, Totals& totals) : random_(seed), totals_(totals) {
    sim::cam::RandomMotion motions(seed);
    for (auto& cam : cams_) {
      sim::cam::Cam drawn = &cam == &cams_[1] ? motions.septics(4) : motions.rests(4);
      drawn.periodic = &cam != &cams_[2];
      cam = test::test_cam(drawn);
    }
    MotionLimits needed{};
    for (std::size_t k = 0; k < curves_.size(); ++k) {
      CamCurve::Config config;
      if (k < 5) {
        config.table = &cams_[k % 3]->table;
        config.periodic = k != 2;
        config.slave_scale = std::llround(between(0.3, 1.0) * 0x1p32) * (random_.whole(4) == 0 ? -1 : 1);
        config.slave_offset = test::raw_position(between(-1.0, 1.0));
        config.ratio = k == 3 ? GearRatio(-2, 3) : GearRatio(1, 1);
        config.master_offset = MasterPosition::way(test::raw_position(between(0.0, 1.0)));
      } else {
        config.rise = test::raw_position(between(-2.0, 2.0));
        config.ratio = k == 5 ? GearRatio(355, 113) : GearRatio(-1, 2);
      }
      EXPECT_EQ(CamCurve::prepare(config, curves_[k]), CamRefusal::none);
      const MotionLimits of_curve = curves_[k].motion(sum());
      needed.velocity = std::max(needed.velocity, of_curve.velocity);
      needed.acceleration = std::max(needed.acceleration, of_curve.acceleration);
      needed.jerk = std::max(needed.jerk, of_curve.jerk);
    }
    const auto with_reserve = [this](std::int64_t x) {
      return static_cast<std::int64_t>(static_cast<double>(x) * between(0.9, 3.0));
    };
    config_ = CamMotion::Config::of(
        {with_reserve(needed.velocity), with_reserve(needed.acceleration), with_reserve(needed.jerk)}, master_limits,
        phasing_limits, 64);
  }

  void run(int commands) {
    VirtualMaster master(VirtualMaster::Config::of(master_limits));
    CamMotion axis(config_);
    test::Watch watch(config_.slave);
    axis.start(test::raw_position(between(-2.0, 2.0)));
    for (int k = 0; k < commands; ++k) {
      command(master, axis);
      const auto ticks = static_cast<int>(between(1.0, random_.whole(3) == 0 ? 8000.0 : 800.0));
      for (int tick = 0; tick < ticks; ++tick) {
        const MasterPoint at = master.step();
        watch.see(axis.step(at));
        check(axis, at);
      }
    }
    ASSERT_EQ(axis.leave(0), CamRefusal::none);
    for (int tick = 0; tick < 200'000 && !axis.at_rest(); ++tick) watch.see(axis.step(master.step()));
    EXPECT_TRUE(axis.at_rest());
    EXPECT_EQ(axis.status().fault, CamFault::none);
    const auto raise = [](double& most, double x) { most = std::max(most, x); };
    raise(totals_.position_jump, watch.position_jump);
    raise(totals_.speed_jump, watch.speed_jump);
    raise(totals_.over_velocity, watch.over_velocity);
    raise(totals_.over_acceleration, watch.over_acceleration);
    raise(totals_.over_jerk, watch.over_jerk);
  }

 private:
  static MotionLimits sum() {
    return {master_limits.velocity + phasing_limits.velocity, master_limits.acceleration + phasing_limits.acceleration,
            master_limits.jerk + phasing_limits.jerk};
  }
  double between(double low, double high) { return random_.between(low, high); }

  void command(VirtualMaster& master, CamMotion& axis) {
    ++totals_.commands;
    switch (random_.whole(10)) {
      case 0:
        EXPECT_TRUE(master.run(test::master_speed(between(-0.7, 0.7))));
        return;
      case 1:
        EXPECT_TRUE(master.run(0));
        return;
      case 2:
        master.stop_at(static_cast<std::uint64_t>(between(0.0, 0x1p63)) * 2);
        return;
      case 3:
        axis.phase(test::raw_position(between(-1.0, 1.0)));
        return;
      case 4:
        stated_.open = false;
        EXPECT_EQ(axis.leave(random_.whole(2) == 0 ? 0 : config_.slave.velocity / 3), CamRefusal::none);
        return;
      default:
        engage(axis);
    }
  }

  void engage(CamMotion& axis) {
    CamRequest request;
    request.curve = &curves_[random_.whole(curves_.size())];
    if (random_.whole(8) == 0) request.goal = CamGoal::position;
    request.position = test::raw_position(between(-2.0, 2.0));
    request.trigger = static_cast<CamTrigger>(random_.whole(2) == 0 ? 0 : random_.whole(5));
    request.approach = static_cast<CamApproach>(random_.whole(3));
    request.master_relative = random_.whole(3) == 0;
    request.slave_relative = random_.whole(3) == 0;
    request.free_way = random_.whole(6) == 0;
    request.backward = random_.whole(2) == 0;
    request.at = MasterPosition::way(test::raw_position(between(-4.0, 4.0)));
    request.tolerance = {test::raw_position(0.3), test::raw_velocity(1.0), test::raw_acceleration(20.0)};
    request.span = Span::of(request.approach == CamApproach::distance ? test::raw_position(between(0.1, 3.0))
                                                                      : static_cast<std::int64_t>(between(200, 12000)));
    if (axis.engage(request) != CamRefusal::none) {
      ++totals_.refused;
      return;
    }
    requested_ = request;
    stated_.open = false;
    waits_ = true;
  }

  void check(const CamMotion& axis, const MasterPoint& at) {
    if (waits_ && !axis.status().waiting) {
      waits_ = false;
      if (axis.status().refusal != CamRefusal::none)
        ++totals_.refused;
      else
        ++totals_.begun;
      if (axis.status().refusal == CamRefusal::none && requested_.goal == CamGoal::curve && axis.status().active) {
        const bool relative = requested_.master_relative || requested_.slave_relative || requested_.free_way;
        stated_ = {true,
                   requested_.approach == CamApproach::distance,
                   requested_.backward,
                   !relative,
                   axis.ticks_left(),
                   phased(axis, at)};
        if (stated_.distance) stated_.ticks = 0;
        if (!relative) {
          const MasterPosition x = phased(axis, at);
          totals_.naive = std::max(
              totals_.naive, std::abs(test::position_of(axis.point().position - requested_.curve->slopes(x).position)));
        }
        return;
      }
    }
    if (!stated_.open || !axis.status().active) return;
    if (!stated_.distance && --stated_.ticks <= 0) {
      if (!axis.status().in_sync) ++totals_.late;
      ++totals_.in_sync;
      stated_.open = false;
    }
    if (stated_.distance) {
      const MasterPosition gone = phased(axis, at) - stated_.begin;
      const std::int64_t ahead = stated_.backward ? -gone.raw() : gone.raw();
      if (ahead >= requested_.span.length + 2) {
        if (!axis.status().in_sync) ++totals_.late;
        ++totals_.in_sync;
        stated_.open = false;
      }
    }
    if (axis.status().in_sync && stated_.absolute && axis.curve()->config().table != nullptr) {
      const auto& config = axis.curve()->config();
      std::size_t which = 0;
      while (&cams_[which]->table != config.table) ++which;
      const auto& cam = *cams_[which];
      const double x = test::cycles_of(axis.curve()->seen({phased_master(axis, at), 0, 0}).position);
      const double wanted = test::truth(cam, x).position * std::ldexp(static_cast<double>(config.slave_scale), -32) +
                            test::position_of(config.slave_offset);
      totals_.off_curve = std::max(totals_.off_curve, std::abs(wanted - test::position_of(axis.point().position)));
    }
  }
  // The master with its phasing.
  static MasterPosition phased_master(const CamMotion& axis, const MasterPoint& at) {
    return at.position + MasterPosition::way(axis.phasing().point().position);
  }
  MasterPosition phased(const CamMotion& axis, const MasterPoint& at) const {
    return axis.curve()->seen({phased_master(axis, at), 0, 0}).position;
  }

  sim::cam::RandomMotion random_;
  Totals& totals_;
  std::array<std::unique_ptr<test::TestCam>, 3> cams_;
  std::array<CamCurve, 7> curves_;
  CamMotion::Config config_;
  CamRequest requested_;
  Stated stated_;
  bool waits_ = false;
};

TEST(CamMotion, NothingEverJumpsInRandomCommands) {
  Totals totals;
  constexpr int axes = 400, commands = 25;
  for (int k = 0; k < axes; ++k) RandomAxis(1000 + static_cast<std::uint64_t>(k), totals).run(commands);
  test::figure("cam motion: 10 000 random commands: requests begun, refused",
               fmt::format("{} begun, {} refused of {} commands", totals.begun, totals.refused, totals.commands));
  test::figure("cam motion: 10 000 random commands: position jump",
               fmt::format("{:.2f} units of 2^-32 rad (bound 1)", totals.position_jump / test::position_unit));
  test::figure("cam motion: 10 000 random commands: speed jump",
               fmt::format("{:.2f} units of 2^-28 rad/s (bound 1)", totals.speed_jump / test::velocity_unit));
  test::figure("cam motion: 10 000 random commands: beyond velocity, acceleration, jerk",
               fmt::format("{:.2g} rad/s, {:.2g} rad/s^2, {:.2g} rad/s^3 (bound 0)", totals.over_velocity,
                           totals.over_acceleration, totals.over_jerk));
  test::figure("cam motion: 10 000 random commands: not in sync within what was stated",
               fmt::format("{} of {} (bound 0)", totals.late, totals.in_sync));
  test::figure("cam motion: 10 000 random commands: off the motion in double precision, in sync",
               fmt::format("{:.2g} rad (bound 3.3e-10)", totals.off_curve));
  test::figure("cam motion: jump of a naive absolute start, largest", fmt::format("{:.2f} rad", totals.naive));
  EXPECT_EQ(totals.commands, axes * commands);
  EXPECT_LE(totals.position_jump, test::position_unit);
  EXPECT_LE(totals.speed_jump, test::velocity_unit);
  EXPECT_LE(totals.over_velocity, 0.0);
  EXPECT_LE(totals.over_acceleration, 0.0);
  EXPECT_LE(totals.over_jerk, 0.0);
  EXPECT_EQ(totals.late, 0);
  // The table's tolerance and a unit.
  EXPECT_LE(totals.off_curve, 1e-10 + test::position_unit);
}

}  // namespace
}  // namespace stiction
