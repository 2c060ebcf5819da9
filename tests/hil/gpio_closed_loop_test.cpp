// A whole axis over GPIO: the firmware's cascade moves the simulated machine behind the lines, with nothing between the
// two but the kernel. The programmes of both sides do the same in lines_test.py.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <thread>

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "firmware/machine/file/drive_file.hpp"
#include "firmware/stictiond/gpio_setup.hpp"
#include "hal/control_loop.hpp"
#include "hal/gpio/gpio_backend.hpp"
#include "host/plant/gpio_machine.hpp"
#include "host/plant/simulated_machine.hpp"
#include "sim/experiment/set_point.hpp"
#include "sim/machine_file.hpp"
#include "tests/hil/gpio_loop.hpp"

namespace stiction::test {
namespace {

using Signals = FixedSignals;

constexpr double increment = 5e-6;  // m
constexpr std::int64_t period_ns = 1'000'000;

sim::AxisSetPoint there_and_back(double t) {
  constexpr double way = 5e-3, omega = 2.0 * std::numbers::pi;
  return {.position = way / 2.0 * (1.0 - std::cos(omega * t)),
          .velocity = way / 2.0 * omega * std::sin(omega * t),
          .acceleration = way / 2.0 * omega * omega * std::cos(omega * t)};
}

TEST_F(GpioLoop, MovesACarriageOverLinesAndDutyCyclesAndStopsItAtTheFaultInput) {
  if (!simulated_time()) GTEST_SKIP() << "in user mode's real time the loop does not keep to its ticks";
  const PwmFolder pwm;
  const auto file = std::filesystem::path(STICTION_SOURCE_DIR) / "tests/hil/gpio_axis.toml";
  const machine::ReadOptions options{"", {"drive.gpio.pwm_chip=" + pwm.path().string()}};
  const auto machine = sim::read_machine(file, options);
  const auto setup = machine::read_drive_setup(file, machine, options);
  const std::vector start{0.0};
  const std::vector<hal::AxisMarks> marks(1);
  // Its power stage reports a fault in the middle of the second stroke.
  constexpr std::uint64_t fault_tick = 1250;
  const auto power_stage = std::find_if(host::plant_faults.begin(), host::plant_faults.end(),
                                        [](const auto& kind) { return kind.name == "power-stage"; });
  host::SimulatedMachine carriage(
      machine, {start, marks},
      host::FaultSchedule({{.kind = &*power_stage, .axis = 0, .from_tick = fault_tick, .ticks = 10'000}}));
  host::GpioMachine lines(host::gpio_machine_config(machine, setup, start, marks), carriage.under_bus(),
                          carriage.faults());
  hal::GpioBackend backend(drive::gpio_configuration(setup, machine), period_ns);
  const std::vector configs{machine::configure_axis<Signals>(machine.timing, machine.axes[0])};
  hal::ControlLoop loop(backend, std::span<const AxisConfig<Signals>>(configs), Ticker(period_ns, 1));
  const std::int64_t start_ns = loop.now_ns();

  std::atomic<bool> done = false;
  std::atomic<std::uint64_t> played = 0;
  std::thread player([&] {
    sleep_exactly();
    for (std::int64_t now_ns = start_ns + period_ns / 2; !done; now_ns += period_ns, ++played) lines.tick(now_ns);
  });
  double worst = 0.0;
  const auto tick = [&] {
    const double t = static_cast<double>(loop.now_ns() - start_ns) * 1e-9;
    const std::vector set{sim::to_set_point<Signals>(there_and_back(t))};
    loop.tick(set);
    worst = std::max(worst, std::abs(static_cast<double>(loop.signals()[0].e.raw()) * 0x1p-32));
  };
  for (int i = 0; i < 1000 && !loop.faulted(); ++i) tick();
  EXPECT_EQ(loop.axes()[0].fault(), Fault::none) << name_of(loop.axes()[0].fault());
  EXPECT_EQ(backend.encoder_fault(0), hal::QuadratureFault::none) << name_of(backend.encoder_fault(0));
  EXPECT_GE(lines.most_edges(), 3) << "the motion is one";
  EXPECT_NEAR(static_cast<double>(lines.count(0)), 0.0, 100.0);
  // Without velocity feedforward the axis follows its speed by v / Kv, 15.7 mm/s / 40 1/s = 393 um, and friction of
  // 23.1 N by F / (Kv k K_F), 40 1/s x 243 V s/m x 35 N/V: 68 um. Four increments for the encoder.
  EXPECT_NEAR(worst, 461e-6, 4 * increment);
  measured("following error over lines and duty cycles, 5 mm in 0.5 s", fmt::format("{:.0f} um", worst * 1e6));

  while (played < fault_tick - 2) tick();
  ASSERT_EQ(loop.axes()[0].fault(), Fault::none);
  EXPECT_GT(carriage.plant(0).velocity(), 0.01);
  int ticks = 0;
  for (; ticks < 10 && sim_->driven(wire::enable); ++ticks) tick();
  EXPECT_EQ(ticks, 2) << "the tick in progress, and the first that can see it";
  EXPECT_EQ(loop.axes()[0].fault(), Fault::drive_input);
  EXPECT_FALSE(sim_->driven(wire::brake));
  for (int i = 0; i < 200; ++i) tick();
  const auto rest = lines.count(0);
  for (int i = 0; i < 100; ++i) tick();
  EXPECT_EQ(lines.count(0), rest);
  EXPECT_FALSE(sim_->driven(wire::enable));
  done = true;
  player.join();
}

}  // namespace
}  // namespace stiction::test
