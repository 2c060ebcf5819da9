// Every protection of motor and power stage, injected on a shipped machine under power: seen within its time by its row
// of the fault table, answered as the row says, no reset while its cause is there, in order again behind it.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "firmware/machine/configuration/motor_configuration.hpp"
#include "sim/experiment/set_point.hpp"
#include "stiction/drive/protection.hpp"
#include "tests/support/figure.hpp"
#include "tests/support/motor_bench.hpp"

namespace stiction::test {
namespace {

struct Injection {
  Fault fault;
  const char* name;
  std::vector<std::string> settings;  // of the axis X
  std::function<void(hal::MotorSignals&)> inject;
};

std::vector<Injection> injections() {
  const auto key = [](const char* text) { return std::string("drive.axis.X.protection.") + text; };
  return {
      {Fault::dc_link_high, "900 V", {key("dc_link_high=800 V")}, [](auto& s) { s.dc_link = 900.0; }},
      {Fault::dc_link_low, "300 V", {key("dc_link_low=400 V")}, [](auto& s) { s.dc_link = 300.0; }},
      {Fault::motor_temperature,
       "131 degrees",
       {key("motor_temperature=403.15 K")},
       [](auto& s) { s.motor_temperature = 131.0; }},
      {Fault::stage_temperature,
       "91 degrees",
       {key("stage_temperature=363.15 K")},
       [](auto& s) { s.stage_temperature = 91.0; }},
      {Fault::temperature_sensor,
       "broken wire",
       {key("motor_temperature=403.15 K")},
       [](auto& s) { s.motor_temperature = 850.0; }},
      {Fault::temperature_sensor,
       "short circuit",
       {key("stage_temperature=363.15 K")},
       [](auto& s) { s.stage_temperature = -200.0; }},
      {Fault::torque_off_in_motion,
       "both channels",
       {key("torque_off=two-channels")},
       [](auto& s) { s.torque_off_a = s.torque_off_b = true; }},
  };
}

class ProtectionOf : public ::testing::TestWithParam<std::size_t> {};

TEST_P(ProtectionOf, IsSeenInItsTimeAnsweredAndReset) {
  const auto c = injections()[GetParam()];
  const auto& row = *description_of(c.fault);
  auto settings = c.settings;
  settings.emplace_back("axis.X.inverter.dc_link=600 V");
  MotorBench bench("screw-motor-encoder", settings);
  ASSERT_TRUE(bench.enable());
  // In motion at 0.1 m/s.
  const double period = bench.period(), from = machine::to_si(bench.loop.drive(0).set_position());
  int k = 0;
  bench.before_tick = [&] {
    const double t = ++k * period, ramp = 0.02, a = 5.0, v = a * std::min(t, ramp);
    const double x = t < ramp ? 0.5 * a * t * t : 0.5 * a * ramp * ramp + v * (t - ramp);
    bench.set(0) = sim::to_set_point<FixedSignals>({from + x, v, t < ramp ? a : 0.0});
  };
  bench.run(800);
  ASSERT_FALSE(bench.loop.faulted());
  c.inject(bench.backend.signals(0));
  int ticks = 0;
  while (!bench.loop.faulted() && ticks < 10000) {
    bench.tick();
    ++ticks;
  }
  EXPECT_EQ(bench.loop.fault(0), c.fault) << name_of(bench.loop.fault(0));
  EXPECT_LE(ticks, row.detection_ticks);
  const bool stops = row.reaction == Reaction::quick_stop;
  EXPECT_EQ(bench.loop.drive(0).powered(), stops);
  int stopping = 0;
  while (bench.loop.drive(0).powered() && stopping < 10000) {
    bench.tick();
    ++stopping;
  }
  // 0.1 m/s at 10 m/s^2 are 10 ms, and the rest of a stop at most 0.1 s.
  EXPECT_LE(stopping * period, 0.12);
  bench.before_tick = nullptr;
  bench.run(8000);
  EXPECT_FALSE(bench.loop.drive(0).powered());
  // No reset as long as the cause is there; an under-voltage without power is none.
  if (c.fault != Fault::dc_link_low) {
    EXPECT_FALSE(bench.reset());
  }
  bench.backend.signals(0) = {};
  bench.run(32);
  EXPECT_TRUE(bench.reset());
  EXPECT_TRUE(bench.enable());
  figure(fmt::format("protection, {}, {}", row.name, c.name),
         fmt::format("{} ticks to the fault (bound {})", ticks, row.detection_ticks));
}

// Beside those above: the tests of their names, here and in commutation_test.cpp.
TEST(ProtectionTable, HasAnInjectionForEachOfItsRows) {
  std::set<Fault> injected{Fault::commutation_not_found, Fault::commutation_offset,  Fault::motor_overload,
                           Fault::stage_overload,        Fault::torque_off_channels, Fault::brake_slips};
  for (const auto& c : injections()) injected.insert(c.fault);
  int rows = 0;
  for (const auto& row : fault_table) {
    if (row.detector != Detector::protection) continue;
    ++rows;
    EXPECT_TRUE(injected.contains(row.fault)) << row.name;
    EXPECT_GE(static_cast<int>(row.fault), 80);
  }
  EXPECT_EQ(rows, 12);
}

INSTANTIATE_TEST_SUITE_P(Injected, ProtectionOf, ::testing::Range(std::size_t{0}, injections().size()));

TEST(SafeTorqueOff, HoldsADriveThatIsOffAndShowsItsOwnBit) {
  MotorBench bench("screw-motor-encoder", {"drive.axis.X.protection.torque_off=two-channels"});
  auto& signals = bench.backend.signals(0);
  signals.torque_off_a = signals.torque_off_b = true;
  EXPECT_FALSE(bench.enable(1600));
  EXPECT_EQ(bench.loop.fault(0), Fault::none);
  EXPECT_EQ(bench.loop.state(0), DriveState::switch_on_disabled);
  EXPECT_NE(bench.loop.statusword(0) & statusword::torque_off_bit, 0);
  signals.torque_off_a = signals.torque_off_b = false;
  EXPECT_TRUE(bench.enable());
  EXPECT_EQ(bench.loop.statusword(0) & statusword::torque_off_bit, 0);
}

TEST(SafeTorqueOff, ChannelsThatDifferAreAFaultAfterTheirTime) {
  MotorBench bench("screw-motor-encoder", {"drive.axis.X.protection.torque_off=two-channels"});
  bench.run(200);
  bench.backend.signals(0).torque_off_b = true;
  bench.run(3199);
  EXPECT_EQ(bench.loop.fault(0), Fault::none);
  bench.run(1);
  EXPECT_EQ(bench.loop.fault(0), Fault::torque_off_channels);
  EXPECT_FALSE(bench.reset());
  bench.backend.signals(0).torque_off_b = false;
  bench.run(2);
  EXPECT_TRUE(bench.reset());
}

// Braking 509 kg at 8 m/s^2 from 0.4 m/s gives back up to 41 J, less friction: into 100 uF at 600 V they lift the link
// beyond 900 V.
TEST(DcLink, ABrakingMotorLiftsItAndThePowerGoes) {
  MotorBench bench("screw-motor-encoder",
                   {"axis.X.inverter.dc_link=600 V", "axis.X.inverter.dc_link_capacitance=100 uF",
                    "drive.axis.X.protection.dc_link_high=800 V"});
  ASSERT_TRUE(bench.enable());
  const double period = bench.period(), from = machine::to_si(bench.loop.drive(0).set_position());
  double x = 0.0, v = 0.0, highest = 0.0;
  for (int k = 0; k < 1600 && !bench.loop.faulted(); ++k) {
    const double a = k < 800 ? 8.0 : -8.0;
    x += (v + 0.5 * a * period) * period;
    v += a * period;
    bench.set(0) = sim::to_set_point<FixedSignals>({from + x, v, a});
    bench.tick();
    highest = std::max(highest, machine::to_si(bench.loop.protection(0).inputs().dc_link));
  }
  EXPECT_EQ(bench.loop.fault(0), Fault::dc_link_high) << name_of(bench.loop.fault(0)) << " " << highest;
}

// The plant's own winding: 1.5 R i^2 through its thermal resistance.
TEST(Temperature, OfThePlantsWindingStopsTheAxis) {
  MotorBench bench("vertical-axis", {"axis.Z.motor.thermal_resistance=50 K/W", "axis.Z.motor.thermal_time_constant=1 s",
                                     "drive.axis.Z.protection.motor_temperature=373.15 K"});
  ASSERT_TRUE(bench.enable());
  bench.hold_here();
  // Holding 749 to 1409 N takes 1.3 to 2.4 A, 2 to 5 W: the winding goes to 140 to 270 degrees and passes 100.
  int k = 0;
  while (!bench.loop.faulted() && k < 160000) {
    bench.tick();
    ++k;
  }
  EXPECT_EQ(bench.loop.fault(0), Fault::motor_temperature) << name_of(bench.loop.fault(0));
}

TEST(BrakeTest, ABrakeThatHoldsLetsTheAxisGoAndOneThatSlipsIsAFault) {
  const std::vector<std::string> settings{"drive.axis.Z.brake_test.current=10 A", "drive.axis.Z.brake_time=50 ms"};
  {
    MotorBench bench("vertical-axis", settings);
    EXPECT_TRUE(bench.enable());
    figure("brake test, a brake that holds",
           fmt::format("{:.1f} um moved under 10 A (bound 100 um)",
                       0x1p-40 * 1e6 * static_cast<double>(bench.loop.drive(0).brake_test().way())));
  }
  // 10 A are 5.86 kN; with the unbalanced weight of 1.08 kN and against 0.33 kN of friction a brake of 5 kN slips.
  auto weak = settings;
  weak.emplace_back("axis.Z.brake.holding_force=5 kN");
  MotorBench bench("vertical-axis", weak);
  EXPECT_FALSE(bench.enable());
  EXPECT_EQ(bench.loop.fault(0), Fault::brake_slips) << name_of(bench.loop.fault(0));
  EXPECT_FALSE(bench.loop.drive(0).powered());
  const double before = bench.x(0);
  bench.run(16000);
  const double after = bench.x(0);
  bench.run(1600);
  EXPECT_NEAR(bench.x(0), after, 1e-6);  // the brake bears the weight
  figure("brake test, a brake that slips",
         fmt::format("{:.2f} mm moved to the fault, {:.2f} mm in all (bound 100 um at the fault)", -1e3 * before,
                     -1e3 * after));
}

// The equation of a body of one time constant in double precision, exact over a step of constant current.
class TextbookBody {
 public:
  TextbookBody(double current, double time_constant) : current_(current), time_constant_(time_constant) {}
  void step(double i, double time) {
    const double end = i * i / (current_ * current_);
    state_ = end + (state_ - end) * std::exp(-time / time_constant_);
  }
  double state() const { return state_; }

 private:
  double current_, time_constant_, state_ = 0.0;
};

TEST(I2t, TripsBetween100And105PercentOfTheTextbooksModelInRandomCycles) {
  std::mt19937_64 random(28);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  double least = 10.0, most = 0.0, highest_without = 0.0;
  int tripped = 0;
  constexpr double tick = 62.5e-6;
  for (int cycle = 0; cycle < 100; ++cycle) {
    const double rated = std::pow(10.0, -1.0 + 3.0 * unit(random));  // 0.1 to 100 A
    const double time_constant = 0.5 + 4.5 * unit(random);           // s
    const double step = tick * Protection<FixedSignals>::ticks_a_step;
    ProtectionConfig<FixedSignals> config;
    config.used = config.three_phase = true;
    config.motor = machine::thermal_model(rated, time_constant, step);
    Protection<FixedSignals> protection(config);
    TextbookBody body(rated, time_constant);
    double angle = 0.0, amplitude = 0.0, speed = 0.0;
    bool seen = false;
    for (int k = 0; k < 160000 && !seen; ++k) {
      if (k % 800 == 0) {  // each 50 ms a new load, up to three times the rated current
        amplitude = rated * 3.0 * unit(random) * (cycle % 2 == 0 ? 1.0 : 0.45);
        speed = 200.0 * unit(random);
      }
      angle += speed * tick;
      Feedback<FixedSignals> feedback;
      double square = 0.0;
      for (int j = 0; j < 3; ++j) {
        const double i = amplitude * std::sin(angle + j * 2.0 * std::numbers::pi / 3.0);
        ASSERT_TRUE(machine::convert(i, feedback.current[static_cast<std::size_t>(j)]));
        square += i * i;
      }
      body.step(std::sqrt(2.0 / 3.0 * square), tick);
      seen = protection.step(feedback, {}, true) == Fault::motor_overload;
    }
    if (seen) {
      ++tripped;
      least = std::min(least, body.state());
      most = std::max(most, body.state());
    } else {
      highest_without = std::max(highest_without, body.state());
    }
  }
  EXPECT_GE(tripped, 40);
  EXPECT_GE(least, 1.0);
  EXPECT_LE(most, 1.05);
  EXPECT_LE(highest_without, 1.05);
  figure("I2t against the thermal model, 100 random cycles",
         fmt::format("{} trips at {:.2f} to {:.2f} % (bounds 100, 105 %)", tripped, 100.0 * least, 100.0 * most));
}

// A motor that pushes against an obstacle: the vertical axis holds, the drive's models are near to their ends.
TEST(I2t, AnOverloadedMotorAndPowerStageStopTheAxis) {
  for (const bool motor : {true, false}) {
    const std::string body = motor ? "motor" : "stage";
    MotorBench bench("vertical-axis", {"drive.axis.Z.protection." + body + "_current=0.6 A",
                                       "drive.axis.Z.protection." + body + "_time_constant=1 s"});
    ASSERT_TRUE(bench.enable());
    bench.hold_here();
    int k = 0;
    while (!bench.loop.faulted() && k < 160000) {
      bench.tick();
      ++k;
    }
    EXPECT_EQ(bench.loop.fault(0), motor ? Fault::motor_overload : Fault::stage_overload);
    bench.run(4000);
    EXPECT_FALSE(bench.loop.drive(0).powered());
    EXPECT_TRUE(bench.reset() || bench.loop.protection(0).motor_percent() >= 100);
    bench.want_on = false;
    bench.run(48000);  // three time constants
    EXPECT_TRUE(bench.reset());
  }
}

}  // namespace
}  // namespace stiction::test
