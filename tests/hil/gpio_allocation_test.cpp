// That a tick over GPIO takes no memory from the heap and touches no new page, libgpiod included.
#include <sys/resource.h>

#include <atomic>
#include <cstdlib>

#include "hal/gpio/gpio_backend.hpp"
#include "tests/hil/gpio_loop.hpp"
#include "tests/support/sanitizer.hpp"

namespace {
std::atomic<long> allocations = 0;
}

#if !STICTION_ADDRESS_SANITIZER  // which has an allocator of its own
// glibc's own names; what the program and its libraries call comes here first.
extern "C" {
void* __libc_malloc(std::size_t size);                     // NOLINT(readability-identifier-naming)
void* __libc_calloc(std::size_t count, std::size_t size);  // NOLINT(readability-identifier-naming)
void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {  // NOLINT(readability-inconsistent-declaration-parameter-name)
  ++allocations;
  return __libc_calloc(count, size);
}
}
#endif

namespace stiction::test {
namespace {

TEST_F(GpioLoop, AllocatesNothingAndTouchesNoNewPageInAThousandTicks) {
#if STICTION_ADDRESS_SANITIZER
  GTEST_SKIP() << "the sanitizers' allocator is not counted";
#endif
  constexpr std::int64_t period_ns = 250'000;
  const PwmFolder pwm;
  plant::EncoderLines encoder(*sim_, {wire::a, wire::b});
  hal::GpioBackend backend(
      {.chip = chip,
       .axes = {{.lines = axis_lines(),
                 .encoder = {.a = {wire::a}, .b = {wire::b}, .increment = 5e-6},
                 .pwm = {.chip = pwm.path(), .half_bridges = 2, .period_ns = 62'500, .dc_link = 48.0}}}},
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
  const long allocated = allocations;
  rusage before{}, after{};
  ::getrusage(RUSAGE_SELF, &before);
  for (int i = 0; i < 1000; ++i) tick(i);
  ::getrusage(RUSAGE_SELF, &after);
  EXPECT_EQ(allocations - allocated, 0);
  EXPECT_GT(allocated, 0) << "the counter counts";
  measured("in 1000 ticks over GPIO",
           fmt::format("{} allocations, {} page faults", allocations - allocated,
                       after.ru_minflt - before.ru_minflt + after.ru_majflt - before.ru_majflt));
  if (simulated_time()) {
    EXPECT_EQ(after.ru_minflt + after.ru_majflt, before.ru_minflt + before.ru_majflt);
    EXPECT_TRUE(feedback.position_valid) << "every edge counted meanwhile";
  }
}

}  // namespace
}  // namespace stiction::test
