// A whole axis over GPIO: the firmware's cascade moves a simulated carriage whose encoder is played onto lines and
// whose motor's voltage is read from the PWM's duty cycles, with nothing between the two but the kernel.
#include <atomic>
#include <cmath>
#include <numbers>
#include <thread>

#include "firmware/drive/gpio_setup.hpp"
#include "hal/control_loop.hpp"
#include "hal/gpio/gpio_backend.hpp"
#include "sim/control/axis_configuration.hpp"
#include "sim/experiment/set_point.hpp"
#include "sim/machine/drive_file.hpp"
#include "sim/machine/machine_file.hpp"
#include "sim/plant/axis_plant.hpp"
#include "tests/hil/gpio_loop.hpp"

namespace stiction::test {
namespace {

using Signals = FixedSignals;

constexpr double increment = 5e-6;  // m
constexpr std::int64_t period_ns = 1'000'000;

// The measured axis of the EMPS with a coarser encoder: 20 mm/s are then 4000 edges a second.
constexpr const char* machine_text = R"(schema = "stiction.machine/1"
name = "axis over GPIO"
[timing]
fast_period = "1 ms"
slow_period = "1 ms"
[axis.X]
mass = "95 kg"
travel = "250 mm"
max_velocity = "0.04 m/s"
max_acceleration = "1 m/s^2"
[axis.X.motor]
model = "force"
force_constant = "35 N/V"
[axis.X.inverter]
dead_time = "0 us"
voltage_limit = "10 V"
[axis.X.encoder]
increment = "5 um"
velocity = "mean-difference"
[axis.X.position_controller]
gain = "40 1/s"
[axis.X.velocity_controller]
gain = "243 V s/m"
[axis.X.friction]
use = "coulomb_viscous"
[axis.X.friction.coulomb_viscous]
coulomb = "20 N"
viscous = "200 N s/m"
[drive.gpio]
chip = "stiction-test"
dc_link = "24 V"
pwm_chip = "PWM"
[drive.axis.X.line]
quadrature_a = 0
quadrature_b = 1
limit_negative = 3
limit_positive = 4
limit_active = "low"
fault = 6
enable = 7
brake = 8
pwm_channel = 0
)";

struct Configured {
  sim::Machine machine;
  sim::DriveSetup setup;
};

Configured configured(const std::string& pwm_folder) {
  const auto file = std::filesystem::path(pwm_folder) / "machine.toml";
  std::string text(machine_text);
  text.replace(text.find("PWM\""), 3, pwm_folder);
  std::ofstream(file) << text;
  Configured result;
  result.machine = sim::read_machine(file);
  result.setup = sim::read_drive_setup(file, result.machine);
  return result;
}

// The carriage behind the lines, half a tick after the drive's ticks, its edges spread over the tick.
class CarriageOnLines {
 public:
  CarriageOnLines(plant::GpioSim& sim, const PwmFolder& pwm, const sim::Machine& machine)
      : sim_(sim), pwm_(pwm), plant_(machine.timing, machine.axes[0], 0.0, 1), encoder_(sim, {wire::a, wire::b}) {}

  // Lets a tick pass that begins at `time_ns`.
  void tick(std::int64_t time_ns) {
    sleep_until(time_ns);
    const double duty = static_cast<double>(pwm_.duty_ns(0) - pwm_.duty_ns(1)) / 62'500.0;
    plant_.command({24.0 * duty, 0.0, 0.0}, sim_.driven(wire::enable));
    plant_.advance_tick();
    const std::int64_t end = std::llround(plant_.read_encoder() / increment);
    const std::int64_t edges = std::abs(end - encoder_.count());
    for (std::int64_t i = 0; i < edges; ++i) {
      sleep_until(time_ns + (2 * i + 1) * period_ns / (2 * edges));
      encoder_.step(end > encoder_.count());
    }
    most_edges_ = std::max(most_edges_, edges);
  }

  std::int64_t count() const { return encoder_.count(); }
  std::int64_t most_edges() const { return most_edges_; }  // in a tick
  double velocity() const { return plant_.velocity(); }

 private:
  plant::GpioSim& sim_;
  const PwmFolder& pwm_;
  sim::AxisPlant plant_;
  plant::EncoderLines encoder_;
  std::int64_t most_edges_ = 0;
};

sim::AxisSetPoint there_and_back(double t) {
  constexpr double way = 5e-3, omega = 2.0 * std::numbers::pi;
  return {.position = way / 2.0 * (1.0 - std::cos(omega * t)),
          .velocity = way / 2.0 * omega * std::sin(omega * t),
          .acceleration = way / 2.0 * omega * omega * std::cos(omega * t)};
}

TEST_F(GpioLoop, MovesACarriageOverLinesAndDutyCyclesAndStopsItAtTheFaultInput) {
  if (!simulated_time()) GTEST_SKIP() << "in user mode's real time the loop does not keep to its ticks";
  const PwmFolder pwm;
  const auto [machine, setup] = configured(pwm.path());
  CarriageOnLines carriage(*sim_, pwm, machine);
  hal::GpioBackend backend(drive::gpio_configuration(setup, machine), period_ns);
  const std::vector configs{sim::configure_axis<Signals>(machine.timing, machine.axes[0])};
  hal::ControlLoop loop(backend, std::span<const AxisConfig<Signals>>(configs), Ticker(period_ns, 1));
  const std::int64_t start_ns = loop.now_ns();

  std::atomic<bool> done = false;
  std::thread player([&] {
    sleep_exactly();
    for (std::int64_t now_ns = start_ns + period_ns / 2; !done; now_ns += period_ns) carriage.tick(now_ns);
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
  EXPECT_GE(carriage.most_edges(), 3) << "the motion is one";
  EXPECT_NEAR(static_cast<double>(carriage.count()), 0.0, 100.0);
  // Without velocity feedforward the axis follows its speed by v / Kv, 15.7 mm/s / 40 1/s = 393 um, and friction of
  // 23.1 N by F / (Kv k K_F), 40 1/s x 243 V s/m x 35 N/V: 68 um. Four increments for the encoder.
  EXPECT_NEAR(worst, 461e-6, 4 * increment);
  measured("following error over lines and duty cycles, 5 mm in 0.5 s", fmt::format("{:.0f} um", worst * 1e6));

  // In the middle of the next stroke.
  for (int i = 0; i < 250; ++i) tick();
  ASSERT_EQ(loop.axes()[0].fault(), Fault::none);
  EXPECT_GT(carriage.velocity(), 0.01);
  sim_->set(wire::fault, true);
  int ticks = 0;
  for (; ticks < 10 && sim_->driven(wire::enable); ++ticks) tick();
  EXPECT_EQ(ticks, 2) << "the tick in progress, and the first that can see it";
  EXPECT_EQ(loop.axes()[0].fault(), Fault::drive_input);
  EXPECT_FALSE(sim_->driven(wire::brake));
  for (int i = 0; i < 200; ++i) tick();
  const auto rest = carriage.count();
  for (int i = 0; i < 100; ++i) tick();
  EXPECT_EQ(carriage.count(), rest);
  EXPECT_FALSE(sim_->driven(wire::enable));
  done = true;
  player.join();
}

}  // namespace
}  // namespace stiction::test
