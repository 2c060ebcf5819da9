// Duty cycles against a folder of the shape of /sys/class/pwm/pwmchipN: no simulated PWM chip exists in the kernel.
#include "hal/gpio/pwm.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <fstream>
#include <string>
#include <thread>

#include "hal/gpio/lines.hpp"

namespace stiction::test {
namespace {

namespace fs = std::filesystem;
using Voltage = FixedSignals::Voltage;
using Voltages = std::array<Voltage, 3>;

Voltage volts(double value) {
  return Voltage::from_raw(static_cast<std::int32_t>(std::lround(std::ldexp(value, Voltage::fraction_bits))));
}

class PwmFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    chip_ = fs::temp_directory_path() / ("stiction_pwm_" + std::to_string(::getpid()));
    fs::remove_all(chip_);
    fs::create_directory(chip_);
    put("npwm", "4");
    put("export", "");
    put("unexport", "");
  }
  void TearDown() override { fs::remove_all(chip_); }

  void put(const std::string& file, const std::string& text) const { std::ofstream(chip_ / file) << text << "\n"; }
  void add_channel(int channel, const std::string& enabled = "0") const {
    const std::string folder = "pwm" + std::to_string(channel);
    fs::create_directory(chip_ / folder);
    put(folder + "/duty_cycle", "999999999");  // longer than what follows, as an old value may be
    put(folder + "/period", "0");
    put(folder + "/enable", enabled);
  }
  // The first line, as the kernel takes one write.
  std::string get(const std::string& file) const {
    std::ifstream stream(chip_ / file);
    std::string line;
    std::getline(stream, line);
    return line;
  }
  hal::PwmConfig config(int half_bridges, int first = 0) const {
    return {.chip = chip_.string(),
            .first_channel = first,
            .half_bridges = half_bridges,
            .period_ns = 62'500,
            .dc_link = 600.0};
  }
  std::string refusal(const hal::PwmConfig& asked) const {
    try {
      hal::PwmBridge bridge(asked);
    } catch (const hal::GpioError& error) {
      return error.what();
    }
    return "taken";
  }

  fs::path chip_;
};

TEST(DutyMap, PutsAVoltageOfZeroAtHalfThePeriodAndTheRailsAtItsEnds) {
  const hal::DutyMap three({.chip = "", .half_bridges = 3, .period_ns = 62'500, .dc_link = 600.0});
  const Voltages u{volts(0.0), volts(300.0), volts(-300.0)};
  EXPECT_EQ(three.duty_ns(0, u), 31'250);
  EXPECT_EQ(three.duty_ns(1, u), 62'500);
  EXPECT_EQ(three.duty_ns(2, u), 0);
  const Voltages beyond{volts(5000.0), volts(-5000.0), volts(60.0)};
  EXPECT_EQ(three.duty_ns(0, beyond), 62'500);
  EXPECT_EQ(three.duty_ns(1, beyond), 0);
  EXPECT_EQ(three.duty_ns(2, beyond), 37'500);
}

TEST(DutyMap, SplitsOneVoltageOverTheTwoSidesOfAFullBridge) {
  const hal::DutyMap bridge({.chip = "", .half_bridges = 2, .period_ns = 50'000, .dc_link = 24.0});
  const Voltages u{volts(6.0), volts(11.0), volts(11.0)};
  EXPECT_EQ(bridge.duty_ns(0, u), 31'250);
  EXPECT_EQ(bridge.duty_ns(1, u), 18'750);
  const Voltages all{volts(-24.0), {}, {}};
  EXPECT_EQ(bridge.duty_ns(0, all), 0);
  EXPECT_EQ(bridge.duty_ns(1, all), 50'000);
}

// Half a nanosecond is the rounding to the kernel's unit.
TEST(DutyMap, IsWithinHalfANanosecondOfTheRealLawOverTheWholeRange) {
  for (const double dc_link : {1.0, 12.0, 600.0, 1500.0})
    for (const std::int64_t period : {1'001, 62'500, 10'000'000}) {
      const hal::DutyMap map({.chip = "", .half_bridges = 3, .period_ns = period, .dc_link = dc_link});
      for (int i = -100; i <= 100; ++i) {
        const auto u = volts(dc_link * i / 200.0);
        const double exact =
            static_cast<double>(period) * (0.5 + std::ldexp(u.raw(), -Voltage::fraction_bits) / dc_link);
        ASSERT_NEAR(static_cast<double>(map.duty_ns(0, Voltages{u, {}, {}})), exact, 0.501)
            << dc_link << " V, " << period << " ns, " << i;
      }
    }
}

TEST_F(PwmFolder, SetsPeriodAndHalfDutyBeforeItStartsTheChannels) {
  for (const int channel : {1, 2, 3}) add_channel(channel);
  hal::PwmBridge bridge(config(3, 1));
  for (const int channel : {1, 2, 3}) {
    const std::string folder = "pwm" + std::to_string(channel);
    EXPECT_EQ(get(folder + "/period"), "62500");
    EXPECT_EQ(get(folder + "/duty_cycle"), "31250");
    EXPECT_EQ(get(folder + "/enable"), "1");
  }
}

TEST_F(PwmFolder, WritesTheDutiesOfATickAndOnlyThoseThatChanged) {
  for (const int channel : {0, 1, 2}) add_channel(channel);
  hal::PwmBridge bridge(config(3));
  bridge.write(Voltages{volts(150.0), volts(-150.0), volts(0.0)});
  EXPECT_EQ(get("pwm0/duty_cycle"), "46875");
  EXPECT_EQ(get("pwm1/duty_cycle"), "15625");
  EXPECT_EQ(get("pwm2/duty_cycle"), "31250");
  put("pwm2/duty_cycle", "untouched");
  bridge.write(Voltages{volts(-300.0), volts(-150.0), volts(0.0)});
  EXPECT_EQ(get("pwm0/duty_cycle"), "0") << "a number shorter than the one before";
  EXPECT_EQ(get("pwm2/duty_cycle"), "untouched");
  EXPECT_FALSE(bridge.failed());
}

TEST_F(PwmFolder, StopsTheChannelsWhenItEnds) {
  for (const int channel : {0, 1}) add_channel(channel);
  { hal::PwmBridge bridge(config(2)); }
  EXPECT_EQ(get("pwm0/enable"), "0");
  EXPECT_EQ(get("pwm1/enable"), "0");
  EXPECT_EQ(get("unexport"), "") << "what was exported before stays so";
}

TEST_F(PwmFolder, ExportsAChannelAndWaitsUntilItsFilesAreThere) {
  add_channel(0);
  std::atomic<bool> stop = false;
  // The kernel's part.
  std::thread kernel([&] {
    while (!stop && get("export") != "1") std::this_thread::sleep_for(std::chrono::milliseconds(1));
    if (!stop) add_channel(1);
  });
  {
    hal::PwmBridge bridge(config(2));
    EXPECT_EQ(get("pwm1/enable"), "1");
  }
  stop = true;
  kernel.join();
  EXPECT_EQ(get("pwm1/enable"), "0");
  EXPECT_EQ(get("unexport"), "1");
}

TEST_F(PwmFolder, GivesBackAChannelThatItExportedButCannotSetUp) {
  add_channel(0);
  std::thread kernel([&] {
    while (get("export") != "1") std::this_thread::sleep_for(std::chrono::milliseconds(1));
    fs::create_directory(chip_ / "pwm1");
    put("pwm1/enable", "0");
  });
  EXPECT_THAT(refusal(config(2)), ::testing::HasSubstr("pwm1/duty_cycle: writing 0: No such file"));
  kernel.join();
  EXPECT_EQ(get("unexport"), "1");
  EXPECT_EQ(get("pwm0/enable"), "0");
}

TEST_F(PwmFolder, RefusesAChannelThatRunsAlreadyAndLeavesItRunning) {
  add_channel(0);
  add_channel(1, "1");
  EXPECT_THAT(refusal(config(2)), ::testing::HasSubstr("pwm1: the channel is already running; stop the programme"));
  EXPECT_EQ(get("pwm0/enable"), "0");
  EXPECT_EQ(get("pwm1/enable"), "1");
}

TEST_F(PwmFolder, TakesAChannelOverThatAKilledRunLeftRunning) {
  add_channel(0);
  add_channel(1, "1");
  auto recovering = config(2);
  recovering.takes_over = true;
  { const hal::PwmBridge bridge(recovering); }
  EXPECT_EQ(get("pwm1/enable"), "0");
}

TEST_F(PwmFolder, SaysWhatIsWrongWithAConfigurationAndWhatToDo) {
  using ::testing::HasSubstr;
  auto other = config(2);
  other.chip = (chip_ / "none").string();
  EXPECT_THAT(refusal(other), HasSubstr("there is no such folder; set drive.gpio.pwm_chip"));
  EXPECT_THAT(refusal(config(3, 2)), HasSubstr("it has 4 channels; expected 3 from channel 2 on"));
  EXPECT_THAT(refusal(config(2, -1)), HasSubstr("set pwm_channel"));
  other = config(2);
  other.dc_link = 0.0;
  EXPECT_THAT(refusal(other), HasSubstr("set drive.gpio.dc_link"));
  other = config(2);
  other.period_ns = 10;
  EXPECT_THAT(refusal(other), HasSubstr("a period of 10 ns; expected 1 us to 10 ms"));
  EXPECT_THAT(refusal(config(4)), HasSubstr("4 half bridges; expected 2 or 3"));
}

}  // namespace
}  // namespace stiction::test
