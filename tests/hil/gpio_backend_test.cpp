// The GPIO backend as the control loop sees it, and the lines beside another backend: index latch, limit switch, fault
// input, brake and enable, with a plant thread at the other end of the lines and a folder in the PWM class' place.
#include "hal/gpio/gpio_backend.hpp"

#include <gmock/gmock.h>

#include <array>
#include <atomic>
#include <thread>

#include "hal/gpio/beside_lines.hpp"
#include "tests/hil/gpio_loop.hpp"

namespace stiction::test {
namespace {

using Signals = FixedSignals;

constexpr std::int64_t period_ns = 62'500;
constexpr double increment = 5e-6;  // m

class GpioBackendLoop : public GpioLoop {
 protected:
  hal::GpioBackendConfig config() const {
    return {
        .chip = chip,
        .axes = {{.lines = axis_lines(),
                  .encoder = {.a = {wire::a}, .b = {wire::b}, .increment = increment},
                  .pwm = {.chip = pwm_.path().string(), .half_bridges = 2, .period_ns = period_ns, .dc_link = 48.0}}}};
  }
  PwmFolder pwm_;
};

// One tick of a backend with one axis, as the control loop makes it.
template <class B>
struct Tick {
  explicit Tick(B& b) : backend(b) {}
  void wait() {
    now_ns = backend.wait_for_tick();
    backend.read({&feedback, 1});
    backend.read_inputs({&inputs, 1});
  }
  void write(bool enable, double volts = 0.0) {
    Command<Signals> command{.enable = enable};
    command.voltage[0] = Signals::Voltage::from_raw(static_cast<std::int32_t>(volts * (1 << 18)));
    backend.write({&command, 1});
  }
  double position() const { return static_cast<double>(feedback.position.raw()) * 0x1p-40; }

  B& backend;
  std::int64_t now_ns = 0;
  Feedback<Signals> feedback;
  DigitalInputs<Signals> inputs;
};

TEST_F(GpioBackendLoop, EnablesNothingBeforeItIsToldAndTurnsAllOffAtTheEnd) {
  {
    hal::GpioBackend backend(config(), period_ns);
    Tick tick(backend);
    tick.wait();
    EXPECT_TRUE(tick.feedback.position_valid);
    EXPECT_FALSE(tick.feedback.fault);
    EXPECT_FALSE(sim_->driven(wire::enable));
    EXPECT_FALSE(sim_->driven(wire::brake));
    EXPECT_EQ(pwm_.duty_ns(0), period_ns / 2);
    tick.write(true, 6.0);
    EXPECT_TRUE(sim_->driven(wire::enable));
    EXPECT_TRUE(sim_->driven(wire::brake));
    EXPECT_EQ(pwm_.duty_ns(0), 35'156);
    EXPECT_EQ(pwm_.duty_ns(1), 27'344);
    tick.write(false, 6.0);
    EXPECT_FALSE(sim_->driven(wire::enable));
    EXPECT_EQ(pwm_.duty_ns(0), period_ns / 2);
    tick.write(true, 0.0);
  }
  EXPECT_FALSE(sim_->driven(wire::enable));
  EXPECT_FALSE(sim_->driven(wire::brake));
}

TEST_F(GpioBackendLoop, RefusesAPowerStageThatNothingCouldTurnOff) {
  auto without = config();
  without.axes[0].lines.enable = {};
  try {
    hal::GpioBackend backend(without, period_ns);
    FAIL();
  } catch (const hal::GpioError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("axis X: no enable line"));
  }
}

TEST_F(GpioBackendLoop, StaysValidAtStandstillAndStampsPositionsWithTheirAge) {
  hal::GpioBackend backend(config(), period_ns);
  Tick tick(backend);
  std::int64_t before = 0;
  for (int i = 0; i < 100; ++i) {
    tick.wait();
    ASSERT_TRUE(tick.feedback.position_valid);
    ASSERT_EQ(tick.now_ns - tick.feedback.position_time_ns, 50'000);
    ASSERT_GT(tick.feedback.position_time_ns, before);
    before = tick.feedback.position_time_ns;
  }
}

TEST_F(GpioBackendLoop, LatchesTheIndexAtItsCountInBothDirections) {
  if (!simulated_time()) GTEST_SKIP() << "in user mode's real time the loop does not keep to its ticks";
  plant::EncoderLines encoder(*sim_, {.a = wire::a, .b = wire::b, .index = wire::index, .marks = {.every = 100}}, 50);
  hal::GpioBackend backend(config(), period_ns);
  Tick tick(backend);
  std::vector<std::int64_t> marks;
  std::atomic<bool> done = false;
  std::thread player([&] {
    sleep_exactly();
    std::int64_t next = monotonic_ns() + 1'000'000;
    for (const std::int64_t end : {350, -250})
      while (encoder.count() != end) {
        sleep_until(next += 200'000);
        encoder.step(end > encoder.count());
      }
    done = true;
  });
  for (int after = 0; after < 3; after += done ? 1 : 0) {
    tick.wait();
    if (!tick.inputs.index) continue;
    // Counts from 50 on, where it stood.
    marks.push_back(std::llround(static_cast<double>(tick.inputs.index_position.raw()) * 0x1p-40 / increment) + 50);
  }
  player.join();
  EXPECT_EQ(backend.encoder_fault(0), hal::QuadratureFault::none) << name_of(backend.encoder_fault(0));
  EXPECT_THAT(marks, ::testing::ElementsAre(100, 200, 300, 300, 200, 100, 0, -100, -200));
  EXPECT_NEAR(tick.position(), -300 * increment, 1e-12);
}

// The axis runs against its switch; the loop turns it off in the tick that shows the switch.
TEST_F(GpioBackendLoop, StopsAtALimitSwitchInTheTickThatShowsIt) {
  if (!simulated_time()) GTEST_SKIP() << "in user mode's real time the loop does not keep to its ticks";
  plant::EncoderLines encoder(*sim_, {.a = wire::a, .b = wire::b});
  const plant::SwitchLine limit{.line = wire::limit_positive, .at = 300, .upwards = true, .active_low = true};
  hal::GpioBackend backend(config(), period_ns);
  Tick tick(backend);
  std::atomic<std::int64_t> reached_ns = 0, off_ns = 0;
  // Moves while the power stage is on, 5000 edges a second.
  std::thread machine([&] {
    sleep_exactly();
    std::int64_t next = monotonic_ns();
    while (!sim_->driven(wire::enable)) sleep_until(next += 10'000);
    while (sim_->driven(wire::enable) && encoder.count() < 1000) {
      sleep_until(next += 200'000);
      if (!sim_->driven(wire::enable)) break;
      encoder.step(true);
      limit.update(*sim_, encoder.count());
      if (encoder.count() == limit.at) reached_ns = monotonic_ns();
    }
  });
  for (int i = 0; i < 3000; ++i) {
    tick.wait();
    const bool run = off_ns == 0 && !tick.inputs.limit_positive && !tick.feedback.fault;
    tick.write(run, 6.0);
    if (!run && off_ns == 0) off_ns = monotonic_ns();
  }
  machine.join();
  ASSERT_NE(reached_ns, 0);
  ASSERT_NE(off_ns, 0);
  EXPECT_FALSE(sim_->driven(wire::enable));
  EXPECT_EQ(pwm_.duty_ns(0), period_ns / 2);
  const std::int64_t latency = off_ns - reached_ns;
  measured("limit switch to power stage off",
           fmt::format("{:.1f} us, {} edges past it", static_cast<double>(latency) * 1e-3, encoder.count() - 300));
  if (simulated_time()) {
    EXPECT_LE(latency, period_ns + 5'000) << "a tick, and the reads of the clock in this test";
    EXPECT_LE(encoder.count() - 300, 1);
  }
}

TEST_F(GpioBackendLoop, TellsSafeTorqueOffAndHallSignalsAsTheirLinesAre) {
  hal::GpioBackend backend(config(), period_ns);
  EXPECT_EQ(backend.motor_signals(0), (MotorSignalSet{.hall = true, .torque_off = true}));
  Tick tick(backend);
  ProtectionInputs<Signals> protection;
  const auto seen = [&] {
    tick.wait();
    backend.read_protection({&protection, 1});
  };
  constexpr std::array halls{wire::hall_a, wire::hall_b, wire::hall_c};
  for (unsigned code = 0; code < 8; ++code) {
    for (unsigned k = 0; k < 3; ++k) sim_->set(halls[k], (code >> k & 1u) != 0);
    sim_->set(wire::torque_off_a, (code & 1u) != 0);
    sim_->set(wire::torque_off_b, (code & 2u) != 0);
    seen();
    seen();  // a channel that was open since the poll before counts as open
    EXPECT_EQ(tick.inputs.hall, code);
    EXPECT_EQ(protection.torque_off_a, (code & 1u) != 0);
    EXPECT_EQ(protection.torque_off_b, (code & 2u) != 0);
  }
}

TEST_F(GpioBackendLoop, HasNoHallSignalsAndNoSafeTorqueOffWhereALineOfThemIsNotWired) {
  auto without = config();
  without.axes[0].lines.hall_b = without.axes[0].lines.torque_off_b = {};
  hal::GpioBackend backend(without, period_ns);
  EXPECT_EQ(backend.motor_signals(0), MotorSignalSet{});
  Tick tick(backend);
  for (const int line : {wire::hall_a, wire::hall_c}) sim_->set(line, true);
  tick.wait();
  EXPECT_EQ(tick.inputs.hall, 0);
}

TEST_F(GpioBackendLoop, ReportsEdgesThatTheKernelDroppedInTheTickThatReadsTheRestAndIsWellAgainInTheCalm) {
  plant::EncoderLines encoder(*sim_, {.a = wire::a, .b = wire::b});
  hal::GpioBackend backend(config(), period_ns);
  Tick tick(backend);
  tick.wait();
  for (int i = 0; i < 3; ++i) tick.wait();
  for (int i = 0; i < 64; ++i) encoder.step(true);
  int ticks = 0;
  do {
    tick.wait();
    ++ticks;
  } while (backend.fault(0) == Fault::none && ticks < 10);
  EXPECT_EQ(ticks, 1);
  EXPECT_EQ(backend.fault(0), Fault::encoder_signal);
  EXPECT_FALSE(tick.feedback.fault) << "the power stage has none";
  EXPECT_FALSE(tick.feedback.position_valid);
  EXPECT_EQ(backend.encoder_fault(0), dropped_edges());
  constexpr int calm_ticks = hal::QuadratureInput::calm_ns / period_ns;
  for (int i = 0; i < calm_ticks / 2; ++i) tick.wait();
  EXPECT_EQ(backend.fault(0), Fault::encoder_signal) << "stays";
  for (int i = 0; i < 32; ++i) encoder.step(true);
  for (int i = 0; i < calm_ticks - 10; ++i) tick.wait();
  EXPECT_EQ(backend.fault(0), Fault::encoder_signal) << "a new cause, a new wait";
  for (int i = 0; i < 20; ++i) tick.wait();
  EXPECT_EQ(backend.fault(0), Fault::none);
  EXPECT_EQ(backend.last_encoder_fault(0), dropped_edges()) << "on record";
  EXPECT_TRUE(tick.feedback.position_valid);
  EXPECT_EQ(tick.feedback.position.raw(), 0) << "another place";
}

// The drive closes its brake while the power still holds the axis.
TEST_F(GpioBackendLoop, EngagesTheBrakeBeforeThePowerGoesWhereItIsAsked) {
  hal::GpioBackend backend(config(), period_ns);
  Tick tick(backend);
  tick.wait();
  backend.set_brake(0, true);
  EXPECT_FALSE(sim_->driven(wire::brake)) << "not without power";
  tick.write(true);
  EXPECT_TRUE(sim_->driven(wire::brake));
  backend.set_brake(0, false);
  tick.write(true);
  EXPECT_FALSE(sim_->driven(wire::brake));
  EXPECT_TRUE(sim_->driven(wire::enable));
}

// Power stage and encoder on another bus: a carriage that moves at 0.2 m/s, sampled at each tick.
class MovingCarriage {
 public:
  using Signals = FixedSignals;
  std::size_t axis_count() const { return 1; }
  std::int64_t wait_for_tick() { return now_ns_ = clock_.wait(); }
  void read(std::span<Feedback<Signals>> feedback) const {
    feedback[0] = {
        .position = Signals::Position::from_raw(raw_at(now_ns_)), .position_time_ns = now_ns_, .position_valid = true};
  }
  void write(std::span<const Command<Signals>> command) { enabled = command[0].enable; }
  void read_inputs(std::span<DigitalInputs<Signals>> inputs) const { inputs[0] = {.home = true, .index = true}; }
  Fault fault(std::size_t) const { return Fault::none; }
  std::int64_t raw_at(std::int64_t time_ns) const { return (time_ns - start_ns_) * 220; }  // 0.2 m/s, 40 bits

  bool enabled = false;

 private:
  std::int64_t start_ns_ = monotonic_ns();
  std::int64_t now_ns_ = 0;
  hal::TickClock clock_{period_ns};
};

TEST_F(GpioLoop, StandsBesideABackendWhosePowerStagesAreOnAnotherBus) {
  MovingCarriage carriage;
  const std::vector<hal::AxisLines> axes{axis_lines()};
  hal::BesideLines<MovingCarriage> both(carriage, chip, hal::Bias::as_is, axes);
  static_assert(hal::WiredBackend<hal::BesideLines<MovingCarriage>>);
  Tick tick(both);
  for (int i = 0; i < 4; ++i) tick.wait();
  EXPECT_FALSE(tick.inputs.home) << "the wired switch in the place of the other bus'";
  EXPECT_FALSE(tick.inputs.index);
  EXPECT_FALSE(tick.feedback.fault);
  tick.write(true);
  EXPECT_TRUE(carriage.enabled);
  EXPECT_TRUE(sim_->driven(wire::enable));

  sleep_until(tick.now_ns + 20'000);
  const std::int64_t before = monotonic_ns();
  sim_->set(wire::index, true);
  const std::int64_t after = monotonic_ns();
  tick.wait();
  EXPECT_TRUE(tick.inputs.index);
  EXPECT_GE(tick.inputs.index_position.raw(), carriage.raw_at(before));
  EXPECT_LE(tick.inputs.index_position.raw(), carriage.raw_at(after));
  tick.wait();
  EXPECT_FALSE(tick.inputs.index);

  EXPECT_EQ(both.motor_signals(0), (MotorSignalSet{.hall = true, .torque_off = true}));
  sim_->set(wire::torque_off_b, true);
  ProtectionInputs<Signals> protection;
  tick.wait();
  both.read_protection({&protection, 1});
  EXPECT_FALSE(protection.torque_off_a);
  EXPECT_TRUE(protection.torque_off_b);

  sim_->set(wire::fault, true);
  tick.wait();
  EXPECT_TRUE(tick.feedback.fault);
  tick.write(false);
  EXPECT_FALSE(carriage.enabled);
  EXPECT_FALSE(sim_->driven(wire::enable));
}

}  // namespace
}  // namespace stiction::test
