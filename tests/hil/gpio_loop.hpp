// What the tests on simulated lines share: the chip that tests/hil/gpio_guest.sh makes, who is wired where, and
// threads that keep to the clock.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <memory>
#include <string>

#include "hal/gpio/config.hpp"
#include "hal/gpio/lines.hpp"
#include "hal/gpio/quadrature_tracker.hpp"
#include "host/plant/gpio_sim.hpp"
#include "host/plant/pwm_folder.hpp"

namespace stiction::test {

inline constexpr const char* chip = "stiction-test";

// Line numbers.
namespace wire {
inline constexpr int a = 0, b = 1, index = 2, limit_negative = 3, limit_positive = 4, home = 5, fault = 6, enable = 7,
                     brake = 8, spare = 9, torque_off_a = 10, torque_off_b = 11, hall_a = 12, hall_b = 13, hall_c = 14;
}

inline std::int64_t monotonic_ns() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * std::int64_t{1'000'000'000} + now.tv_nsec;
}

inline void sleep_until(std::int64_t time_ns) {
  const timespec until{time_ns / 1'000'000'000, time_ns % 1'000'000'000};
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

// Sleeps of this thread end on time and not up to 50 us later, as the kernel otherwise allows itself.
inline void sleep_exactly() { ::prctl(PR_SET_TIMERSLACK, 1ul, 0ul, 0ul, 0ul); }

// Whether time is simulated (time-travel=inf-cpu): then waiting costs nothing and work takes no time. Told by the
// kernel's command line.
bool simulated_time();

// What a full queue of the kernel is to an encoder: where edges are numbered it is seen that some are missing,
// otherwise they may be.
inline hal::QuadratureFault dropped_edges() {
  return hal::gpiod::numbers_edges() ? hal::QuadratureFault::lost_edge : hal::QuadratureFault::queue_full;
}

// A line of the figures that toolchain/test prints; the guest's root is read-only, so that it goes to the output alone.
inline void measured(const std::string& name, const std::string& text) { fmt::print("{:<64} {}\n", name, text); }

inline hal::AxisLines axis_lines() {
  return {.name = "X",
          .enable = {wire::enable},
          .brake = {wire::brake},
          .fault = {wire::fault},
          .limit_negative = {wire::limit_negative, true},
          .limit_positive = {wire::limit_positive, true},
          .home = {wire::home},
          .index = {wire::index},
          .torque_off_a = {wire::torque_off_a},
          .torque_off_b = {wire::torque_off_b},
          .hall_a = {wire::hall_a},
          .hall_b = {wire::hall_b},
          .hall_c = {wire::hall_c}};
}

// The PWM of two half bridges.
class PwmFolder : public plant::PwmFolder {
 public:
  PwmFolder() : plant::PwmFolder(fresh(), 2) {}

 private:
  static std::filesystem::path fresh() {
    auto path = std::filesystem::temp_directory_path() / ("stiction_gpio_" + std::to_string(::getpid()));
    std::filesystem::remove_all(path);
    return path;
  }
};

class GpioLoop : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto folder = plant::GpioSim::find(chip);
    if (!folder) GTEST_SKIP() << "no simulated gpiochip; run: toolchain/hil/run tests/hil/gpio_guest.sh " << program();
    sleep_exactly();
    sim_ = std::make_unique<plant::GpioSim>(*folder);
    for (int line = 0; line < 16; ++line) sim_->set(line, line == wire::limit_negative || line == wire::limit_positive);
  }
  static std::string program() { return ::testing::internal::GetArgvs().front(); }

  std::unique_ptr<plant::GpioSim> sim_;
};

}  // namespace stiction::test
