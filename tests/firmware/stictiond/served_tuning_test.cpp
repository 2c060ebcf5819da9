// The tuner of the drive in the loop, on a machine that runs on and on, and a PLC that starts it and looks on over
// Modbus and over CAN. What counts is the load itself, which neither the drive nor the PLC sees.
#include <algorithm>
#include <cmath>

#include "tests/firmware/stictiond/tuned_stand.hpp"
#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

constexpr double load_increment = 26e-6;  // m, of the encoder

enum TuningCommand { tune = 1, watch_it = 2, stop_it = 3, restore = 4 };
enum TuningState { idle = 1, tuning = 2, settling = 3, watching = 4 };

class TunedCam : public ServedCam {
 protected:
  explicit TunedCam(double frequency = load_frequency, const std::vector<std::string>& more = {},
                    const sim::cam::Cam& cam = stand_cam())
      : ServedCam(stand_arguments(cam), tuning_settings(frequency, more)) {
    table.before_tick = [this] {
      watch_speed();
      look();
    };
  }

  // From tick to tick: the set-point goes where its speed leads, whatever table it comes from.
  void watch_speed() {
    const double x = table.set_position(0), v = machine::to_si(table.loop.drive(0).set_velocity());
    constexpr double tick = 62.5e-6, most = 60.0;
    if (table.powered(0) && was_powered) {
      EXPECT_NEAR(x - last_x, 0.5 * (v + last_v) * tick, most * tick * tick / 12.0);
    }
    was_powered = table.powered(0);
    last_x = x;
    last_v = v;
  }
  // The load in the rest, between 145 and 255 degrees.
  void look() {
    const auto& at = table.cam->master().reading().point.position;
    const double place = std::ldexp(static_cast<double>(at.phase), -64);
    const double load = table.simulated.plant(0).position();
    if (place > 145.0 / 360.0 && place < 255.0 / 360.0) {
      lowest = std::min(lowest, load);
      highest = std::max(highest, load);
    } else if (highest > lowest) {
      peak_to_peak = highest - lowest;
      largest = std::max(largest, peak_to_peak);
      lowest = 1.0, highest = -1.0;
    }
  }
  // Cycles at 100 turns a minute, with the thread beside the loop.
  void cycles_of_master(int count) { run(600 * count); }
  void run(int ms) {
    for (int k = 0; k < ms; ++k) {
      step();
      if (k % 20 == 0) beside();
    }
  }
  void beside() {
    table.cam->tuning()->round([this](drive::LogLevel, std::string_view text) { events += std::string(text) + "\n"; });
  }
  void begin(double turns_a_minute = 100.0) {
    ASSERT_TRUE(enable_in(-1));
    ASSERT_TRUE(command(engage));
    run_until([&] { return shows(active | in_sync); });
    ASSERT_TRUE(write("master_speed", turns_a_minute / 60.0));
    run(6000);
  }
  void stop_and_start() {
    ASSERT_TRUE(write("master_speed", 0.0));
    run(3000);
    change_load();
    ASSERT_TRUE(write("master_speed", 100.0 / 60.0));
    run(6000);
  }
  // A gearbox that is warm: the stiffness is 15 % less, while the axis rests.
  void change_load() {
    auto axis = table.configuration.machine.axes[0];
    axis.transmission->stiffness = *axis.transmission->stiffness * stiffness;
    table.simulated.plant(0) = sim::AxisPlant(table.configuration.machine.timing, axis, table.position(0), 77);
  }
  bool tuned(TuningCommand command) { return write("cam_tuning_command", command); }
  double state() { return read("cam_tuning_state"); }
  double refusal() { return read("cam_tuning_refusal"); }
  double quality() { return read("cam_tuning_quality"); }

  double lowest = 1.0, highest = -1.0, peak_to_peak = 0.0, largest = 0.0, stiffness = 1.0;
  std::string events;
};

#define STICTION_OVER_BOTH(Fixture)                         \
  INSTANTIATE_TEST_SUITE_P(Bus, Fixture, ::testing::Bool(), \
                           [](const auto& bus) { return std::string(bus.param ? "CANopen" : "Modbus"); })

STICTION_OVER_BOTH(TunedCam);

TEST_P(TunedCam, TakesTheVibrationOutWhileTheMachineRuns) {
  begin();
  const double before = peak_to_peak, quality_before = quality();
  EXPECT_EQ(state(), idle);
  EXPECT_GT(before, 1.5e-3);
  cycles_of_master(5);
  EXPECT_NEAR(peak_to_peak, before, 0.02 * before) << "nothing is tuned that nobody asked for";
  ASSERT_TRUE(tuned(tune));
  run(100);
  EXPECT_EQ(state(), tuning);
  cycles_of_master(12);
  EXPECT_EQ(state(), idle);
  EXPECT_EQ(refusal(), 0.0);
  EXPECT_LT(peak_to_peak, load_increment);
  EXPECT_LT(quality(), 0.05 * quality_before);
  EXPECT_NEAR(read("cam_tuning_before"), quality_before, 0.05 * quality_before);
  EXPECT_NEAR(read("cam_tuning_frequency"), load_frequency, 0.01 * load_frequency);
  EXPECT_EQ(read("cam_followed"), 1.0) << "for a client the table is the one it asked for";
  EXPECT_NE(events.find("axis X: begins"), std::string::npos);
  EXPECT_NE(events.find("axis X: ends after"), std::string::npos) << events;
  figure(
      fmt::format("cam tuning in the loop, {}: peak to peak before, after; tables", over_can() ? "CANopen" : "Modbus"),
      fmt::format("{:.3f} mm, {:.3f} mm; {:g}", 1e3 * before, 1e3 * peak_to_peak, read("cam_tuning_tables")));
}

TEST_P(TunedCam, WhatIsEngagedAgainHasThePulsesUntilTheTableIsRestored) {
  begin();
  const double before = peak_to_peak;
  ASSERT_TRUE(tuned(tune));
  cycles_of_master(12);
  ASSERT_TRUE(command(leave));
  run_until([&] { return !shows(busy); });
  ASSERT_TRUE(command(engage));
  cycles_of_master(12);
  EXPECT_TRUE(shows(in_sync));
  EXPECT_LT(peak_to_peak, 2.0 * load_increment);
  ASSERT_TRUE(tuned(restore));
  cycles_of_master(10);
  EXPECT_NEAR(peak_to_peak, before, 0.02 * before);
  EXPECT_EQ(state(), idle);
}

TEST_P(TunedCam, ChangesNothingByItselfWithoutALimit) {
  begin();
  ASSERT_TRUE(tuned(tune));
  cycles_of_master(12);
  ASSERT_TRUE(tuned(watch_it));
  stiffness = 0.85;
  stop_and_start();
  const double grown = peak_to_peak;
  EXPECT_GT(grown, 10.0 * load_increment);
  // Without a limit there is nothing to compare with.
  EXPECT_EQ(state(), watching);
  cycles_of_master(5);
  EXPECT_NEAR(peak_to_peak, grown, 0.05 * grown);
  ASSERT_TRUE(tuned(tune));
  cycles_of_master(40);
  EXPECT_EQ(state(), watching);
  EXPECT_LT(peak_to_peak, 2.0 * load_increment);
}

class RetunedCam : public TunedCam {
 protected:
  RetunedCam()
      : TunedCam(load_frequency, {"drive.cam_tuning.quality_limit=15 um", "drive.cam_tuning.start=by-itself",
                                  "drive.cam_tuning.pause=10"}) {}
};
STICTION_OVER_BOTH(RetunedCam);

TEST_P(RetunedCam, TunesItselfAgainWhenTheVibrationGrows) {
  begin();
  ASSERT_TRUE(tuned(watch_it));
  cycles_of_master(16);
  EXPECT_EQ(state(), watching);
  EXPECT_LT(peak_to_peak, load_increment) << "the first time by itself too";
  EXPECT_LT(quality(), 15e-6);
  stiffness = 0.85;
  stop_and_start();
  const double grown = peak_to_peak;
  cycles_of_master(40);
  EXPECT_EQ(state(), watching);
  EXPECT_EQ(refusal(), 0.0);
  EXPECT_LT(peak_to_peak, 2.0 * load_increment);
  EXPECT_LT(quality(), 15e-6);
  // The load's mode is that of the stiffness but for 1 %, by which the rotor moves with it.
  EXPECT_NEAR(read("cam_tuning_frequency"), load_frequency * std::sqrt(0.85), 0.01 * load_frequency);
  EXPECT_NE(events.find("the quality number has grown to"), std::string::npos) << events;
  figure(fmt::format("cam tuning in the loop, {}: 15 % of stiffness lost: peak to peak grown, tuned again",
                     over_can() ? "CANopen" : "Modbus"),
         fmt::format("{:.3f} mm, {:.3f} mm", 1e3 * grown, 1e3 * peak_to_peak));
}

class WronglyTunedCam : public TunedCam {
 protected:
  explicit WronglyTunedCam(double factor = 1.05) : TunedCam(factor * load_frequency) {}
};
STICTION_OVER_BOTH(WronglyTunedCam);

TEST_P(WronglyTunedCam, TakesTheFrequencyFromTheRecord) {
  begin();
  EXPECT_NEAR(read("cam_tuning_frequency"), 1.05 * load_frequency, 0.01);
  ASSERT_TRUE(tuned(tune));
  cycles_of_master(16);
  EXPECT_EQ(state(), idle);
  EXPECT_LT(peak_to_peak, load_increment);
  EXPECT_NEAR(read("cam_tuning_frequency"), load_frequency, 0.005 * load_frequency);
}

TEST_P(TunedCam, IsRefusedForAMasterAtAnotherSpeedAndChangesNothing) {
  begin(80.0);
  const double before = peak_to_peak;
  ASSERT_TRUE(tuned(tune));
  cycles_of_master(12);
  EXPECT_EQ(refusal(), static_cast<double>(CamTuningRefusal::speed));
  EXPECT_EQ(state(), idle);
  EXPECT_EQ(read("cam_tuning_tables"), 0.0);
  EXPECT_NEAR(peak_to_peak, before, 0.02 * before);
}

TEST_P(TunedCam, IsRefusedForACurveThatIsNotItsTable) {
  ASSERT_TRUE(write("cam_slave_scale", 0.9));
  begin();
  ASSERT_TRUE(tuned(tune));
  cycles_of_master(8);
  EXPECT_EQ(refusal(), static_cast<double>(CamTuningRefusal::relative));
  EXPECT_EQ(read("cam_tuning_tables"), 0.0);
}

TEST_P(TunedCam, DoesNotBeginForAnAxisThatFollowsNothing) {
  ASSERT_TRUE(enable_in(-1));
  ASSERT_TRUE(tuned(tune));
  run(100);
  EXPECT_EQ(state(), idle);
  EXPECT_EQ(refusal(), static_cast<double>(CamTuningRefusal::no_table));
  EXPECT_NE(events.find("it does not begin"), std::string::npos);
}

TEST_P(TunedCam, LeavesOutARestInWhichTheAxisIsMoved) {
  begin();
  ASSERT_TRUE(tuned(tune));
  // A superposed move goes on over several cycles.
  ASSERT_TRUE(write("cam_superposed", 40e-3));
  ASSERT_TRUE(command(5));
  run(400);
  cycles_of_master(1);
  EXPECT_EQ(refusal(), static_cast<double>(CamTuningRefusal::moving));
  EXPECT_EQ(read("cam_tuning_tables"), 0.0);
  cycles_of_master(16);
  EXPECT_EQ(refusal(), 0.0) << "then it goes on";
  EXPECT_LT(peak_to_peak, load_increment);
}

TEST_P(TunedCam, StopsWhenAskedAndKeepsTheBest) {
  begin();
  ASSERT_TRUE(tuned(tune));
  cycles_of_master(3);
  ASSERT_TRUE(tuned(stop_it));
  cycles_of_master(12);
  EXPECT_EQ(state(), idle);
  EXPECT_TRUE(shows(in_sync));
}

class BoundedCam : public TunedCam {
 protected:
  BoundedCam() : TunedCam(load_frequency, {"drive.cam_tuning.amplitude=0.5 mm"}) {}
};
STICTION_OVER_BOTH(BoundedCam);

TEST_P(BoundedCam, TriesNoPulseAboveItsAmplitude) {
  begin();
  const double before = peak_to_peak;
  ASSERT_TRUE(tuned(tune));
  cycles_of_master(12);
  EXPECT_EQ(refusal(), static_cast<double>(CamTuningRefusal::amplitude));
  EXPECT_EQ(read("cam_tuning_tables"), 0.0);
  EXPECT_NEAR(peak_to_peak, before, 0.02 * before);
}

// A shorter rise, whose accelerations are the largest of the cycle: what pulses add to them is more than the axis has.
class LimitedCam : public TunedCam {
 protected:
  LimitedCam()
      : TunedCam(load_frequency, {"axis.X.max_acceleration=34.5 m/s^2", "drive.cam_tuning.amplitude=20 mm"},
                 stand_cam(50e-3, 110.0, 90.0)) {}
};
STICTION_OVER_BOTH(LimitedCam);

TEST_P(LimitedCam, TakesNoTableBeyondTheLimitsOfTheAxis) {
  begin();
  const double before = quality();
  EXPECT_GT(before, 10e-6);
  ASSERT_TRUE(tuned(tune));
  cycles_of_master(12);
  EXPECT_EQ(refusal(), static_cast<double>(CamTuningRefusal::axis_limits)) << events;
  EXPECT_NEAR(quality(), before, 0.05 * before);
  EXPECT_TRUE(shows(in_sync));
}

// An encoder that is half a period later than the drive believes: the first pulses double the vibration.
class MisledCam : public TunedCam {
 protected:
  explicit MisledCam(const std::vector<std::string>& more = {})
      : TunedCam(load_frequency, joined({"drive.cam_tuning.delay=37.9 ms"}, more)) {}
  static std::vector<std::string> joined(std::vector<std::string> a, const std::vector<std::string>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
  }
};
STICTION_OVER_BOTH(MisledCam);

TEST_P(MisledCam, LearnsFromATableThatWasWorse) {
  begin();
  ASSERT_TRUE(tuned(tune));
  cycles_of_master(30);
  EXPECT_EQ(state(), idle);
  EXPECT_EQ(refusal(), 0.0) << events;
  // The window begins 38 ms late, so that it tells less.
  EXPECT_LT(peak_to_peak, 2.0 * load_increment) << events;
}

class MisledOnce : public MisledCam {
 protected:
  MisledOnce() : MisledCam({"drive.cam_tuning.steps=1"}) {}
};
STICTION_OVER_BOTH(MisledOnce);

TEST_P(MisledOnce, KeepsTheLastBetterTable) {
  begin();
  const double before = peak_to_peak;
  ASSERT_TRUE(tuned(tune));
  cycles_of_master(24);
  EXPECT_GT(largest, 1.3 * before) << "what was tried";
  EXPECT_EQ(state(), idle);
  EXPECT_EQ(refusal(), static_cast<double>(CamTuningRefusal::worse));
  EXPECT_EQ(read("cam_tuning_tables"), 1.0);
  EXPECT_NEAR(peak_to_peak, before, 0.02 * before);
}

std::string start_refusal(const std::vector<std::string>& more, const sim::cam::Cam& cam = stand_cam()) {
  try {
    const ServedTable table(tuning_settings(load_frequency, more), true, stand_arguments(cam));
  } catch (const drive::StartRefused& refused) {
    return refused.what();
  }
  return "none";
}

TEST(CamTuningSetup, RefusesWhatCannotBeTuned) {
  const auto finds = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
  EXPECT_EQ(start_refusal({}), "none");
  EXPECT_PRED2(finds, start_refusal({"drive.cam_tuning.table=2"}), "found table 2; expected one of the 1 of --cam");
  EXPECT_PRED2(finds, start_refusal({"drive.cam_tuning.axis=Z"}), "found axis Z; expected one that follows");
  EXPECT_PRED2(finds, start_refusal({"axis.X.second_encoder.on=motor"}), "without an encoder at the load");
  EXPECT_PRED2(finds, start_refusal({}, stand_cam(50e-3, 40.0)), "found a rest of");
  EXPECT_PRED2(finds, start_refusal({"drive.cam_tuning.speed=0.5 1/s"}), "none");
  EXPECT_PRED2(finds, start_refusal({"drive.cam_tuning.frequency=3 Hz"}), "periods of the load; expected 0.75");
}

}  // namespace
}  // namespace stiction::test
