// What happens to the adapter and the computer of a drive over CAN while its axis is held: the stated fault, and after
// a fault reset the axis is enabled again. On a kernel with CAN and with `stiction-plant` at the other end; the
// environment says how the adapter is taken out and put in:
//   ADAPTER   interface of the drive
//   UNPLUG, PLUG, DOWN, UP   commands of the shell
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "firmware/stictiond/configuration.hpp"
#include "firmware/stictiond/loop_watchdog.hpp"
#include "hal/can/can_backend.hpp"
#include "hal/drive_loop.hpp"

namespace stiction::test {
namespace {

using Loop = hal::DriveLoop<hal::can::CanBackend>;
constexpr int second = 1000;  // ticks

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

drive::DriveConfiguration configuration() {
  drive::DriveOptions options;
  options.machine = "emps";
  options.set = {"drive.can.interface=" + variable("ADAPTER"), "drive.axis.X.node=1"};
  return drive::read_configuration(options);
}

// A command of the shell beside the loop, as a person would type it.
class Command {
 public:
  explicit Command(const std::string& text) : thread_([this, text] { status_ = std::system(text.c_str()); }) {}
  ~Command() {
    thread_.join();
    EXPECT_EQ(status_, 0);
  }
  Command(const Command&) = delete;
  Command& operator=(const Command&) = delete;

 private:
  int status_ = -1;
  std::thread thread_;
};

class HeldOverCan : public ::testing::Test {
 protected:
  void SetUp() override {
    if (variable("ADAPTER").empty()) GTEST_SKIP() << "found no interface in $ADAPTER; toolchain/test --rt names one";
    std::vector<int> silent;
    ASSERT_TRUE(backend_.find_nodes(2 * second, silent));
    loop_.emplace(backend_, c_.axes, c_.drives, c_.ticker);
    loop_->begin();
    ASSERT_TRUE(enables()) << name_of(loop_->fault(0));
  }

  // As firmware/stictiond/run.hpp does it.
  void tick(std::uint16_t word) {
    std::array<SetPoint<FixedSignals>, 1> set{};
    set[0].position = loop_->drive(0).set_position();
    loop_->set_controlword(0, word);
    struct Programme {
      Loop& loop;
      std::span<const SetPoint<FixedSignals>> set;
      void tick(bool) { loop.tick(set); }
    } programme{*loop_, set};
    drive::tick_under_watch(programme, *loop_, cut_, false, clock_.was_suspended());
  }

  bool enables() {
    for (int i = 0; i < second; ++i) {
      tick(controlword_to_enable(loop_->state(0), i % 2 == 0));
      if (loop_->state(0) == DriveState::operation_enabled) return true;
    }
    return false;
  }

  // The fault that a command of the shell leads to while the axis is held, within `ticks`; none: it is held to the end.
  Fault fault_of(const std::string& text, int ticks) {
    const Command command(text);
    for (int i = 0; i < ticks; ++i) {
      tick(controlword::enable_operation);
      if (loop_->fault(0) != Fault::none) {
        EXPECT_FALSE(loop_->drive(0).powered());
        return loop_->fault(0);
      }
    }
    return Fault::none;
  }

  // Nothing is enabled without a reset, and no reset is taken while the cause is there.
  void stays_off(int ticks, std::uint16_t word) {
    for (int i = 0; i < ticks; ++i) {
      tick(word);
      ASSERT_FALSE(loop_->drive(0).powered()) << "tick " << i;
    }
  }

  const drive::DriveConfiguration c_ = configuration();
  hal::TickClock clock_{c_.period_ns};
  hal::can::CanBackend backend_{drive::can_config(c_), clock_};
  hal::PowerCut cut_;
  std::optional<Loop> loop_;
};

TEST_F(HeldOverCan, AnAdapterThatIsUnpluggedAndPluggedInAgainIsFound) {
  ASSERT_EQ(fault_of(variable("UNPLUG"), 2 * second), Fault::frames_lost);
  stays_off(second / 2, controlword::enable_operation);
  {
    const Command command(variable("PLUG"));
    stays_off(second, controlword::enable_operation);
  }
  ASSERT_TRUE(enables()) << name_of(loop_->fault(0));
}

TEST_F(HeldOverCan, ALinkThatGoesDownAndUpIsUsedAgain) {
  ASSERT_EQ(fault_of(variable("DOWN"), 2 * second), Fault::frames_lost);
  {
    const Command command(variable("UP"));
    stays_off(second, controlword::enable_operation);
  }
  ASSERT_TRUE(enables()) << name_of(loop_->fault(0));
}

// The loop keeps the monotonic clock; frames are stamped with the time of day.
TEST_F(HeldOverCan, ATimeOfDayThatIsSetIsNoFault) {
  for (const char* text : {"date -s '2031-05-05 05:05:05' >/dev/null", "date -s '2024-01-01 00:00:00' >/dev/null"})
    EXPECT_EQ(fault_of(text, second), Fault::none) << name_of(loop_->fault(0));
}

TEST_F(HeldOverCan, AComputerThatWasSuspendedStopsTheAxis) {
  const std::string suspend = variable("SUSPEND");
  if (suspend.empty()) GTEST_SKIP() << "found no command in $SUSPEND";
  ASSERT_EQ(fault_of(suspend, 4 * second), Fault::clock_jump);
  stays_off(second / 2, controlword::enable_operation);
  ASSERT_TRUE(enables()) << name_of(loop_->fault(0));
}

}  // namespace
}  // namespace stiction::test
