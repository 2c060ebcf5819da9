// The stick-slip feed in time and its closed forms, beside the figures of docs/prototype_figures.md, 7.
#include "sim/plant/feed/stick_slip_feed.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/machine_file.hpp"
#include "sim/plant/feed/feed_per_revolution.hpp"
#include "sim/plant/feed/stick_slip_relations.hpp"
#include "tests/support/figure.hpp"

namespace stiction::sim {
namespace {

using stiction::test::figure;
constexpr auto ideal = FeedSource::constant_speed;
constexpr FeedEquations printed_damping{false, true}, printed_stick{true, false};

// The shipped lathe with a plain step of friction.
machine::FeedDrive lathe(double zeta = 0.05) {
  auto drive = *sim::read_machine(std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/stick-slip-feed.toml")
                    .feed_drive;
  drive.friction.static_short = drive.friction.static_long;
  drive.cutting.coefficient = 0.0;
  drive.carriage.damping_ratio = zeta;
  return drive;
}

double double_step(const machine::FeedDrive& drive) { return 2.0 * drive.friction.step() / drive.carriage.stiffness; }
double feed_of(double beta, const machine::FeedDrive& drive) {
  return beta * drive.friction.step() / std::sqrt(drive.carriage.stiffness * drive.carriage.mass);
}

TEST(StickSlipFeed, JumpsAsTheStudyAndTheFormulaSay) {
  struct Row {
    double zeta, study;
  };
  for (const auto& [zeta, study] : {Row{0.0, 1.0291}, Row{0.05, 0.9547}, Row{0.1, 0.8907}, Row{0.2, 0.7873}}) {
    const auto drive = lathe(zeta);
    const double ratio = jumping_at(drive, ideal, {}, feed_of(0.018, drive)).cycle.travel / double_step(drive);
    EXPECT_NEAR(ratio, study, 0.01 * study);
    EXPECT_NEAR(ratio, small_feed_jump_ratio(0.018, zeta), 0.006 * ratio);  // the prototype's own agreement
    figure(fmt::format("stick-slip feed: jump over 2 dF/c, zeta {:g}", zeta),
           fmt::format("{:.4f} ({:g} within 1 %)", ratio, study));
  }
}

TEST(StickSlipFeed, SlipsForHalfAPeriodAndRepeatsAfterJumpOverFeed) {
  const auto drive = lathe(0.0);
  const double feed = feed_of(0.018, drive);
  const auto cycle = jumping_at(drive, ideal, {}, feed).cycle;
  const double slip = cycle.slip_time * drive.carriage.natural_frequency() / std::numbers::pi;
  EXPECT_NEAR(slip, 1.014, 0.01);
  EXPECT_NEAR(cycle.period * feed / cycle.travel, 1.0, 1e-8);  // the mean speed is the feed
  figure("stick-slip feed: slip time over pi/omega", fmt::format("{:.4f} (1.014 within 1 %)", slip));
}

TEST(StickSlipFeed, BreaksAwayWhereTheDriveCarriesFrictionAndCutting) {
  for (const double zeta : {0.0, 0.05}) {
    const auto drive = lathe(zeta);
    const double feed = feed_of(0.018, drive), force = drive.friction.at_rest(1e9) + drive.cutting.constant_force;
    StickSlipFeed run(drive, ideal, {}, feed);
    ASSERT_TRUE(run.advance_to_standstill(10.0));
    const auto& jump = run.jumps().front();
    EXPECT_NEAR(jump.break_away_force, force, 1e-9 * force);
    // The damper carries its part: it is a hundredth of the force at most.
    EXPECT_NEAR(jump.start, (force - drive.carriage.damping() * feed) / (drive.carriage.stiffness * feed), 1e-9);
    const double ratio = jump.start * drive.carriage.stiffness * feed / force;
    EXPECT_NEAR(ratio, 1.0, 0.01);
    figure(fmt::format("stick-slip feed: first slip over (F_s + P)/(c v), zeta {:g}", zeta),
           fmt::format("{:.6f} (1 within 1 %)", ratio));
  }
}

TEST(StickSlipFeed, ConstantCuttingForceDoesNotChangeTheJump) {
  auto light = lathe(), heavy = light;
  light.cutting.constant_force = 0.0;
  heavy.cutting.constant_force = 2000.0;
  const double feed = feed_of(0.018, light);
  const double ratio =
      jumping_at(heavy, ideal, {}, feed).cycle.travel / jumping_at(light, ideal, {}, feed).cycle.travel;
  EXPECT_NEAR(ratio, 1.0, 1e-7);
  figure("stick-slip feed: jump with 2000 N of cutting over jump without", fmt::format("{:.8f} (1)", ratio));
}

TEST(StickSlipFeed, FeedPerRevolutionIsThatOfTheStudy) {
  const auto drive = lathe();
  constexpr double feed = 1e-3, revolution = 0.06;  // 1000 rpm, 0.06 mm a revolution
  const auto cycle = jumping_at(drive, ideal, {}, feed).cycle;
  EXPECT_NEAR(cycle.travel, 293e-6, 2.93e-6);
  EXPECT_NEAR(cycle.period / revolution, 4.89, 0.0489);
  StickSlipFeed run(drive, ideal, {}, feed);
  const double origin =
      (drive.friction.in_motion(0.0) + drive.cutting.constant_force) / (drive.carriage.stiffness * feed);
  const auto feeds = feed_per_revolution(run, origin, revolution, 8);
  std::string printed;
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_NEAR(feeds[i], i == 2 || i == 7 ? 293e-6 : 0.0, 2.93e-6) << "revolution " << i + 1;
    printed += fmt::format(" {:.3f}", feeds[i] * 1e3);
  }
  figure("stick-slip feed: jump and period at 0.06 mm and 1000 rpm",
         fmt::format("{:.1f} um, {:.3f} revolutions (293, 4.89 within 1 %)", cycle.travel * 1e6,
                     cycle.period / revolution));
  figure("stick-slip feed: feed of revolutions 1 to 8, mm", printed.substr(1));
}

// The critical feed has a closed form; the prototype stepped and found 0.6 to 1.8 % more.
TEST(StickSlipFeed, CriticalFeedCollapsesAndIsThatOfTheClosedForm) {
  struct Set {
    double step, stiffness, mass;
  };
  for (const auto& [step, stiffness, mass] :
       {Set{2000.0, 1.33e7, 300.0}, Set{2000.0, 4e7, 300.0}, Set{500.0, 4e7, 300.0}, Set{100.0, 1.33e7, 150.0}}) {
    auto drive = lathe();
    drive.carriage = {mass, stiffness, 0.05};
    drive.friction.static_long = drive.friction.static_short =
        drive.friction.sliding + step / drive.friction.normal_load;
    const double beta = critical_feed_by_bisection(drive, ideal, 1e-7) * std::sqrt(stiffness * mass) / step;
    EXPECT_NEAR(beta, critical_beta(0.05), 1e-6);
    EXPECT_GE(beta, 0.99 * 1.105);
    EXPECT_LE(beta, 1.01 * 1.118);
    figure(fmt::format("stick-slip feed: v_c sqrt(c m)/dF, {:g} N, {:g} N/m, {:g} kg", step, stiffness, mass),
           fmt::format("{:.4f} (1.105 to 1.118 within 1 %)", beta));
  }
  struct Row {
    double zeta, study;
  };
  for (const auto& [zeta, study] : {Row{0.1, 0.689}, Row{0.2, 0.368}}) {
    const auto drive = lathe(zeta);
    const double beta = critical_feed_by_bisection(drive, ideal, 1e-7) / feed_of(1.0, drive);
    EXPECT_NEAR(beta, critical_beta(zeta), 1e-6);
    figure(fmt::format("stick-slip feed: v_c sqrt(c m)/dF, zeta {:g}", zeta),
           fmt::format("{:.4f} (study {:g}: {:+.2f} %)", beta, study, 100.0 * (beta / study - 1.0)));
  }
}

// What explains the 1.3 % at zeta 0.1: a break-away noticed 0.1 ms late, at a force higher by what the spring gains.
TEST(StickSlipFeed, BreakAwayNoticedLateGivesTheStudysCriticalFeed) {
  const auto drive = lathe(0.1);
  const auto jumps_late = [&](double feed) {
    auto late = drive;
    late.friction.static_long += drive.carriage.stiffness * feed * 1e-4 / drive.friction.normal_load;
    late.friction.static_short = late.friction.static_long;
    return jumping_at(late, ideal, {}, feed).lasts;
  };
  double low = 0.5 * feed_of(1.0, drive), high = feed_of(1.0, drive);
  while (high - low > 1e-5 * high) (jumps_late(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
  const double beta = low / feed_of(1.0, drive);
  EXPECT_NEAR(beta, 0.689, 0.01 * 0.689);
  figure("stick-slip feed: the same at zeta 0.1, break-away noticed 0.1 ms late",
         fmt::format("{:.4f} (0.689 within 1 %)", beta));
}

// The prototype's figures of (7), (10) with PI loops are those of the printed damping term.
TEST(StickSlipFeed, WithPiLoopsAndThePrintedDampingItIsTheStudysDrive) {
  const auto drive = lathe();
  const auto at = [&](double mm_per_min) {
    return jumping_at(drive, FeedSource::pi_drive, printed_damping, mm_per_min / 60e3);
  };
  const auto slow = at(60.0), fast = at(1500.0);
  EXPECT_NEAR(slow.cycle.travel, 315e-6, 3.15e-6);
  EXPECT_NEAR(slow.cycle.period, 0.312, 0.00312);
  EXPECT_NEAR(slow.cycle.travel / double_step(drive), 1.05, 0.0105);
  ASSERT_TRUE(fast.lasts);
  EXPECT_NEAR(fast.cycle.travel / double_step(drive), 2.5, 0.025);
  EXPECT_FALSE(at(3000.0).lasts);
  double before = 0.0;
  for (const double feed : {60.0, 300.0, 600.0, 1000.0, 1500.0}) {
    const double ratio = at(feed).cycle.travel / double_step(drive);
    EXPECT_GT(ratio, before) << feed;
    before = ratio;
  }
  figure("stick-slip feed: PI drive, printed damping, 60 mm/min",
         fmt::format("{:.1f} um, {:.4f} s (315, 0.312 within 1 %)", slow.cycle.travel * 1e6, slow.cycle.period));
  figure("stick-slip feed: PI drive, jump over 2 dF/c at 60 and 1500 mm/min",
         fmt::format("{:.3f}, {:.3f} (1.05, 2.5 within 1 %), none at 3000", slow.cycle.travel / double_step(drive),
                     fast.cycle.travel / double_step(drive)));
}

TEST(StickSlipFeed, PrintedDampingDampsNothing) {
  const double feed = feed_of(0.018, lathe());
  const double printed = jumping_at(lathe(), ideal, printed_damping, feed).cycle.travel;
  const double undamped = jumping_at(lathe(0.0), ideal, {}, feed).cycle.travel;
  EXPECT_NEAR(printed / undamped, 1.0, 1e-7);
  figure("stick-slip feed: jump with the printed damping over the undamped one",
         fmt::format("{:.8f} (1)", printed / undamped));
}

TEST(StickSlipFeed, PrintedStickConditionHoldsTheCarriageOnce) {
  const auto drive = lathe();
  const double feed = feed_of(0.018, drive), cutting = drive.cutting.constant_force;
  StickSlipFeed run(drive, ideal, printed_stick, feed);
  while (run.jumps().size() < 2) run.advance_to_standstill(run.time() + 0.01);
  EXPECT_NEAR(run.jumps()[0].break_away_force - cutting, drive.friction.at_rest(1e9), 0.01 * 3000.0);
  EXPECT_NEAR(run.jumps()[1].break_away_force - cutting, drive.friction.in_motion(0.0), 1e-6);
  EXPECT_FALSE(jumping_at(drive, ideal, printed_stick, feed).lasts);
  EXPECT_TRUE(jumping_at(drive, ideal, {}, feed).lasts);
}

TEST(StickSlipFeed, StaticFrictionGrowsWithTheDwell) {
  auto drive = lathe();
  drive.friction.static_short = 0.2;
  const double feed = feed_of(0.2, drive);
  StickSlipFeed run(drive, ideal, {}, feed);
  while (run.jumps().size() < 6) run.advance_to_standstill(run.time() + 1.0);
  for (std::size_t i = 1; i < 6; ++i) {
    const auto& jump = run.jumps()[i];
    const double expected = drive.friction.at_rest(jump.dwell) + drive.cutting.constant_force;
    EXPECT_NEAR(jump.break_away_force, expected, 1e-6 * expected);
    EXPECT_LT(jump.dwell, 10.0 * drive.friction.dwell_time);
  }
  EXPECT_LT(critical_feed_by_bisection(drive, ideal, 1e-3), 0.95 * critical_feed_of_ideal_drive(drive));
}

// Instants and travel come from roots, not from steps: a quarter of the step, a thousandth of the tolerance change
// nothing.
TEST(StickSlipFeed, SmallerStepsChangeNothing) {
  auto drive = lathe();
  drive.friction.static_short = 0.2;
  drive.friction.viscous = 200.0;
  drive.friction.stribeck_velocity = 2e-3;
  drive.cutting.coefficient = 5e4;
  for (const auto source : {ideal, FeedSource::pi_drive}) {
    const double feed = 5e-3;
    StickSlipFeed run(drive, source, {}, feed), finer(drive, source, {}, feed, {1e-13, 1.25e-4});
    run.advance_to(1.0);
    finer.advance_to(1.0);
    ASSERT_EQ(run.jumps().size(), finer.jumps().size());
    ASSERT_GE(run.jumps().size(), 5U);
    double worst = 0.0;
    for (std::size_t i = 0; i + 1 < run.jumps().size(); ++i) {
      const auto &a = run.jumps()[i], &b = finer.jumps()[i];
      for (const auto& [x, y] : {std::pair{a.start, b.start},
                                 {a.stop, b.stop},
                                 {a.travel(), b.travel()},
                                 {a.duration(), b.duration()},
                                 {a.break_away_force, b.break_away_force}})
        worst = std::max(worst, std::abs(x / y - 1.0));
    }
    for (const auto i : {feed_state::wind_up, feed_state::travel, feed_state::tool_x, feed_state::tool_z})
      EXPECT_NEAR(run.state()[i], finer.state()[i], 1e-6 * std::abs(finer.state()[feed_state::travel]));
    EXPECT_LT(worst, 1e-6);
    figure(fmt::format("stick-slip feed: a quarter of the step, {}", source == ideal ? "ideal drive" : "PI drive"),
           fmt::format("{:.1e} relative at most (bound 1e-6)", worst));
  }
}

TEST(StickSlipFeed, LoopsThatNeverComeToRestAreFound) {
  auto drive = lathe();
  EXPECT_TRUE(loops_are_stable(drive));
  drive.speed_controller.gain *= 10.0;  // the current loop's lag leaves no such margin
  EXPECT_FALSE(loops_are_stable(drive));
}

TEST(StickSlipFeed, ToolFollowsTheSpeedsPower) {
  // So slow that the tool is in equilibrium: steady sliding above the critical feed.
  const auto drive = lathe();
  const double feed = 1.5 * critical_feed_of_ideal_drive(drive);
  StickSlipFeed run(drive, ideal, {}, feed);
  run.advance_to(2.0);
  const auto& tool = drive.tool;
  const double ratio = feed / tool.reference_speed;
  EXPECT_NEAR(run.state()[feed_state::tool_x], tool.force_x * std::pow(ratio, 0.55) / tool.stiffness_x, 1e-8);
  EXPECT_NEAR(run.state()[feed_state::tool_z], tool.force_z * std::pow(ratio, 0.75) / tool.stiffness_z, 1e-8);
}

}  // namespace
}  // namespace stiction::sim
