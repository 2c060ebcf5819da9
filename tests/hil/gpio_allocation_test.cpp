// That a tick over GPIO takes no memory from the heap and touches no new page, libgpiod included.
#include "hal/gpio/gpio_backend.hpp"
#include "tests/hil/gpio_loop.hpp"
#include "tests/support/loop_cost.hpp"

namespace stiction::test {
namespace {

TEST_F(GpioLoop, AllocatesNothingAndTouchesNoNewPageInAThousandTicks) {
#ifdef STICTION_SANITIZED
  GTEST_SKIP() << "the sanitizer's allocator";
#endif
  constexpr std::int64_t period_ns = 250'000;
  const PwmFolder pwm;
  plant::EncoderLines encoder(*sim_, {wire::a, wire::b});
  hal::GpioBackend backend(
      {.chip = chip,
       .axes = {{.lines = axis_lines(),
                 .encoder = {.a = {wire::a}, .b = {wire::b}, .increment = 5e-6},
                 .pwm = {.chip = pwm.path().string(), .half_bridges = 2, .period_ns = 62'500, .dc_link = 48.0}}}},
      period_ns);
  Feedback<FixedSignals> feedback;
  DigitalInputs<FixedSignals> inputs;
  // Edges, voltages and the enable line all change.
  const auto tick = [&](int i) {
    backend.wait_for_tick();
    backend.read({&feedback, 1});
    backend.read_inputs({&inputs, 1});
    Command<FixedSignals> command{.enable = i % 50 != 0};
    command.voltage[0] = FixedSignals::Voltage::from_raw(i * 3000);
    backend.write({&command, 1});
    encoder.step(true);
  };
  for (int i = 0; i < 10; ++i) tick(i);
  const auto cost = memory_cost([&] {
    for (int i = 0; i < 1000; ++i) tick(i);
  });
  EXPECT_EQ(cost.allocator_calls, 0u);
  measured("in 1000 ticks over GPIO",
           fmt::format("{} allocations, {} page faults", cost.allocator_calls, cost.minor_faults + cost.major_faults));
  if (simulated_time()) {
    EXPECT_EQ(cost.minor_faults + cost.major_faults, 0);
    EXPECT_TRUE(feedback.position_valid) << "every edge counted meanwhile";
  }
}

}  // namespace
}  // namespace stiction::test
