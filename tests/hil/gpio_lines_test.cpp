// Lines on a real kernel's gpiochip: outputs, inputs with their time stamps, what is refused at the start, and edges
// that the kernel dropped.
#include <gmock/gmock.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "hal/gpio/inputs_outputs.hpp"
#include "tests/hil/gpio_loop.hpp"

namespace stiction::test {

bool simulated_time() {
  std::ifstream file("/proc/cmdline");
  std::string line;
  std::getline(file, line);
  return line.find("time-travel=inf-cpu") != std::string::npos;
}

namespace {

using hal::Bias;
using hal::Lines;
using ::testing::AllOf;
using ::testing::HasSubstr;

// What the start says when it refuses; "taken" when it does not.
std::string refusal(auto&& start) {
  try {
    start();
  } catch (const hal::GpioError& error) {
    return error.what();
  }
  return "taken";
}

std::string refused_chip(const std::string& name) {
  return refusal([&] { Lines lines(name, Bias::as_is); });
}

TEST_F(GpioLoop, FindsTheChipByPathNameAndLabel) {
  EXPECT_EQ(refused_chip("stiction-test"), "taken");
  EXPECT_EQ(refused_chip("gpiochip0"), "taken");
  EXPECT_EQ(refused_chip("/dev/gpiochip1"), "taken");
}

TEST_F(GpioLoop, RefusesAChipThatIsNotThereAndListsThoseThatAre) {
  for (const char* name : {"/dev/gpiochip7", "servo-lines", "/dev/null"})
    EXPECT_THAT(refused_chip(name),
                AllOf(HasSubstr(name), HasSubstr("\"stiction-test\" with 16 lines"), HasSubstr("Set drive.gpio.chip")));
}

TEST_F(GpioLoop, RefusesWithoutPermissionAndSaysHowToGetIt) {
  const pid_t child = ::fork();
  if (child == 0) {
    const bool dropped = ::setgid(65534) == 0 && ::setuid(65534) == 0;
    const std::string said = refused_chip("/dev/gpiochip0") + refused_chip("stiction-test");
    ::_exit(dropped && said.find("no permission") != said.rfind("no permission") &&
                    said.find("--udev") != std::string::npos
                ? 0
                : 1);
  }
  int status = -1;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

TEST_F(GpioLoop, RefusesALineInUseAndSaysByWhom) {
  Lines other(chip, Bias::as_is);
  other.add_output({wire::enable}, "another drive");
  other.add_input({wire::home}, "probe 3");
  const std::vector<hal::AxisLines> axes{axis_lines()};
  EXPECT_THAT(refusal([&] {
                Lines lines(chip, Bias::as_is);
                hal::GpioInputsOutputs io(lines, axes);
              }),
              AllOf(HasSubstr("axis X enable: line 7 of gpiochip0 \"stiction-test\" is in use by \"another drive\""),
                    HasSubstr("stop that programme or choose a different line")));
  Lines lines(chip, Bias::as_is);
  EXPECT_THAT(refusal([&] { lines.add_input({wire::home}, "home"); }), HasSubstr("in use by \"probe 3\""));
}

TEST_F(GpioLoop, RefusesALineThatTheChipDoesNotHaveAndOneNamedTwice) {
  Lines lines(chip, Bias::as_is);
  EXPECT_THAT(refusal([&] { lines.add_input({16}, "axis X home"); }), HasSubstr("the chip has the lines 0 to 15"));
  lines.add_input({wire::home}, "axis X home");
  EXPECT_THAT(refusal([&] { lines.add_output({wire::home}, "axis X brake"); }),
              HasSubstr("axis X brake: line 5 of gpiochip0 \"stiction-test\" is \"axis X home\" already"));
}

TEST_F(GpioLoop, DrivesOutputsWithTheirWiringAndLeavesThemOffAtTheEnd) {
  {
    Lines lines(chip, Bias::as_is);
    const auto enable = lines.add_output({wire::enable}, "enable");
    const auto brake = lines.add_output({wire::brake, true}, "brake");
    EXPECT_FALSE(sim_->driven(wire::enable));
    EXPECT_TRUE(sim_->driven(wire::brake)) << "inactive is high where low says yes";
    lines.set(enable, true);
    lines.set(brake, true);
    EXPECT_TRUE(sim_->driven(wire::enable));
    EXPECT_FALSE(sim_->driven(wire::brake));
    EXPECT_FALSE(lines.failed());
  }
  EXPECT_FALSE(sim_->driven(wire::enable));
}

TEST_F(GpioLoop, ReadsSwitchesWithTheirWiringAndTheLevelFromBeforeTheStart) {
  const std::vector<hal::AxisLines> axes{axis_lines()};
  sim_->set(wire::home, true);
  Lines lines(chip, Bias::as_is);
  const hal::GpioInputsOutputs io(lines, axes);
  DigitalInputs<FixedSignals> inputs;
  const auto look = [&] {
    lines.poll(monotonic_ns());
    io.read_inputs(0, inputs);
  };
  look();
  EXPECT_TRUE(inputs.home);
  EXPECT_FALSE(inputs.limit_positive) << "a contact that is closed to the supply";
  sim_->set(wire::limit_positive, false);
  sim_->set(wire::fault, true);
  look();
  EXPECT_TRUE(inputs.limit_positive) << "a contact that opens, or a wire that breaks";
  EXPECT_FALSE(inputs.limit_negative);
  EXPECT_TRUE(io.fault(0));
  sim_->set(wire::fault, false);
  look();
  EXPECT_FALSE(io.fault(0));
  EXPECT_EQ(io.lost_edges(0), 0u);
}

TEST_F(GpioLoop, ShowsASwitchThatWasReachedOnlyBetweenTwoTicksForOneTick) {
  const std::vector<hal::AxisLines> axes{axis_lines()};
  Lines lines(chip, Bias::as_is);
  const hal::GpioInputsOutputs io(lines, axes);
  DigitalInputs<FixedSignals> inputs;
  for (const bool high : {true, false}) {
    sim_->set(wire::home, high);
    sleep_until(monotonic_ns() + 20'000);
  }
  lines.poll(monotonic_ns());
  io.read_inputs(0, inputs);
  EXPECT_TRUE(inputs.home);
  lines.poll(monotonic_ns());
  io.read_inputs(0, inputs);
  EXPECT_FALSE(inputs.home);
}

TEST_F(GpioLoop, StampsEdgesWithTheTimeOfTheInterrupt) {
  Lines lines(chip, Bias::as_is);
  const auto home = lines.add_input({wire::home}, "home");
  std::int64_t latest = 0, tick_late = 0;
  for (int i = 0; i < 50; ++i) {
    const std::int64_t before = monotonic_ns();
    sim_->set(wire::home, i % 2 == 0);
    const std::int64_t after = monotonic_ns();
    sleep_until(after + 30'000);
    lines.poll(monotonic_ns());
    const auto edges = lines.edges(home);
    ASSERT_EQ(edges.size(), 1u) << i;
    EXPECT_EQ(edges[0].rising, i % 2 == 0);
    EXPECT_GE(edges[0].time_ns, before);
    EXPECT_LE(edges[0].time_ns, after);
    latest = std::max(latest, edges[0].time_ns - before);
    tick_late = std::max(tick_late, monotonic_ns() - edges[0].time_ns);
  }
  measured("stamp after the edge, largest of 50", fmt::format("{:.1f} us", static_cast<double>(latest) * 1e-3));
}

// The kernel keeps 16 edges of a line. By version 1 of the character device it drops the newest: an odd number of
// dropped ones shows in the next edge, which is of the same kind as the last one kept; an even number only in the full
// queue. By version 2 it drops the oldest, and the numbers of the others tell how many.
TEST_F(GpioLoop, NoticesEdgesThatTheKernelDropped) {
  for (const int toggles : {16, 17, 18}) {
    sim_->set(wire::home, false);
    Lines lines(chip, Bias::as_is);
    const auto home = lines.add_input({wire::home}, "home");
    bool high = false;
    const auto toggle = [&] {
      sim_->set(wire::home, high = !high);
      sleep_until(monotonic_ns() + 100'000);
    };
    for (int i = 0; i < toggles; ++i) toggle();
    lines.poll(monotonic_ns());
    EXPECT_TRUE(lines.queue_was_full(home));
    EXPECT_EQ(lines.edges(home).size(), 16u);
    toggle();
    lines.poll(monotonic_ns());
    EXPECT_FALSE(lines.queue_was_full(home));
    const auto dropped = static_cast<unsigned>(toggles - 16);
    EXPECT_EQ(lines.lost_edges(home), hal::gpiod::numbers_edges() ? dropped : dropped % 2) << toggles;
  }
}

// What a thread of higher priority than the interrupts' does in one go, they see afterwards.
void before_the_interrupts_thread(auto&& act) {
  const sched_param above{.sched_priority = 80}, ordinary{};
  ASSERT_EQ(::sched_setscheduler(0, SCHED_FIFO, &above), 0);
  act();
  ASSERT_EQ(::sched_setscheduler(0, SCHED_OTHER, &ordinary), 0);
}

// The thread of the interrupt reads the level when it runs: a pulse that is over by then comes as the edge that ended
// it, for the second time in a row.
TEST_F(GpioLoop, NoticesAPulseThatWasOverBeforeItsInterruptWasServed) {
  Lines lines(chip, Bias::as_is);
  const auto home = lines.add_input({wire::home}, "home");
  before_the_interrupts_thread([&] {
    sim_->set(wire::home, true);
    sim_->set(wire::home, false);
  });
  sleep_until(monotonic_ns() + 100'000);
  lines.poll(monotonic_ns());
  EXPECT_GE(lines.lost_edges(home), 1u);
  EXPECT_FALSE(lines.level(home));
}

// The last edges before a standstill are the dropped ones: no edge follows that could tell.
TEST_F(GpioLoop, NoticesALevelThatNoEdgeAnnounced) {
  Lines lines(chip, Bias::as_is);
  const auto home = lines.add_input({wire::home}, "home");
  for (int i = 0; i < 17; ++i) {
    sim_->set(wire::home, i % 2 == 0);
    sleep_until(monotonic_ns() + 100'000);
  }
  int ticks = 0;
  for (; ticks < 100 && lines.lost_edges(home) == 0; ++ticks) {
    lines.poll(monotonic_ns());
    sleep_until(monotonic_ns() + 62'500);
  }
  EXPECT_EQ(lines.lost_edges(home), 1u);
  EXPECT_TRUE(lines.level(home));
  measured("lost edge found by the level at standstill", fmt::format("{} ticks of 62.5 us", ticks));
}

}  // namespace
}  // namespace stiction::test
