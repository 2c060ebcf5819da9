// The bus budget against the table of frame times that the drive's design was made from (computed from ISO 11898-1, the
// worst case of 135 bits for 8 bytes is published).
#include "hal/bus_budget.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

using hal::CanIdentifier;
using hal::CyclicFrame;

struct FrameRow {
  const char* name;
  CanIdentifier identifier;
  int bytes;
  double data_rate;  // Mbit/s; 0: classical
  int best, worst;   // us
  int per_ms, per_tick;
};
constexpr FrameRow frame_rows[] = {
    {"CAN 0 B", CanIdentifier::standard, 0, 0, 47, 55, 18, 1},
    {"CAN 6 B", CanIdentifier::standard, 6, 0, 95, 115, 8, 0},
    {"CAN 8 B", CanIdentifier::standard, 8, 0, 111, 135, 7, 0},
    {"CAN 8 B, 29-bit", CanIdentifier::extended, 8, 0, 131, 160, 6, 0},
    {"FD 1/5, 16 B", CanIdentifier::standard, 16, 5, 62, 73, 13, 0},
    {"FD 1/5, 64 B", CanIdentifier::standard, 64, 5, 140, 170, 5, 0},
    {"FD 1/8, 16 B", CanIdentifier::standard, 16, 8, 50, 58, 17, 1},
    {"FD 1/8, 64 B", CanIdentifier::standard, 64, 8, 99, 119, 8, 0},
};

hal::FrameTime time_of(const FrameRow& row) {
  return row.data_rate == 0 ? hal::can_frame_time(row.identifier, row.bytes, 1e6)
                            : hal::can_fd_frame_time(row.identifier, row.bytes, 1e6, row.data_rate * 1e6);
}

// The table is rounded to whole microseconds.
TEST(BusBudget, ReproducesTheTableOfFrameTimes) {
  double largest = 0.0;
  for (const FrameRow& row : frame_rows) {
    const auto time = time_of(row);
    EXPECT_NEAR(time.best * 1e6, row.best, 0.5) << row.name;
    EXPECT_NEAR(time.worst * 1e6, row.worst, 0.5) << row.name;
    EXPECT_EQ(std::floor(1e-3 / time.worst), row.per_ms) << row.name;
    EXPECT_EQ(std::floor(62.5e-6 / time.worst), row.per_tick) << row.name;
    largest = std::max({largest, std::abs(time.best * 1e6 - row.best), std::abs(time.worst * 1e6 - row.worst)});
  }
  figure("bus budget: CAN frame times against the table",
         fmt::format("{} frames, largest difference {:.2f} us (bound 0.5 us, its rounding)", std::size(frame_rows),
                     largest));
}

struct AxesRow {
  const char* name;
  double data_rate;       // Mbit/s; 0: classical
  int command, feedback;  // bytes; 0: none
  int axes[3];            // at 1 ms, 500 us, 250 us
};
constexpr AxesRow axes_rows[] = {
    {"CAN 8 B + 8 B", 0, 8, 8, {2, 1, 0}},         {"CAN 6 B + 6 B", 0, 6, 6, {3, 1, 0}},
    {"FD 1/5, 16 B + 24 B", 5, 16, 24, {4, 2, 0}}, {"FD 1/8, 16 B + 24 B", 8, 16, 24, {5, 2, 1}},
    {"CAN encoders only", 0, 0, 6, {6, 3, 1}},
};

// The most axes that the budget carries: SYNC once, command and feedback of each.
int axes_carried(const AxesRow& row, double period) {
  for (int axes = 1;; ++axes) {
    std::vector<CyclicFrame> frames{{"sync", CanIdentifier::standard, 0, false, 1, period}};
    const bool fd = row.data_rate != 0;
    if (row.command > 0) frames.push_back({"command", CanIdentifier::standard, row.command, fd, axes, period});
    frames.push_back({"feedback", CanIdentifier::standard, row.feedback, fd, axes, period});
    hal::CanRates rates;
    if (fd) rates.data = row.data_rate * 1e6;
    if (!hal::can_budget("can0", rates, frames, false).rejection_reasons.empty()) return axes - 1;
  }
}

TEST(BusBudget, CarriesAsManyAxesAsTheTableSays) {
  constexpr double periods[] = {1e-3, 500e-6, 250e-6};
  for (const AxesRow& row : axes_rows)
    for (int i = 0; i < 3; ++i) EXPECT_EQ(axes_carried(row, periods[i]), row.axes[i]) << row.name << ' ' << periods[i];
}

// Read 10 registers, and function 23 with 4 written and 10 read, at 115200 8E1: 6.7 and 7.9 ms.
TEST(BusBudget, ReproducesTheTimesOfModbusRtu) {
  EXPECT_NEAR(hal::modbus_rtu_exchange_time({"read", 0, 10}, 115200) * 1e3, 6.7, 0.05);
  EXPECT_NEAR(hal::modbus_rtu_exchange_time({"both", 4, 10}, 115200) * 1e3, 7.9, 0.05);
  EXPECT_DOUBLE_EQ(hal::modbus_rtu_silence(115200), 1.75e-3);
  EXPECT_NEAR(hal::modbus_rtu_silence(9600), 4.01e-3, 0.01e-3);  // 3.5 characters of 11 bits
}

std::vector<CyclicFrame> drive_frames(int axes, bool fd, double period) {
  return {{"sync", CanIdentifier::standard, 8, fd, 1, period},
          {"feedback", CanIdentifier::standard, 48, fd, axes, period},
          {"command", CanIdentifier::standard, 24, fd, axes, period}};
}

std::string refusal_of(const hal::BusBudget& budget) {
  try {
    hal::check(budget);
  } catch (const hal::BusBudgetError& error) {
    return error.what();
  }
  return "carried";
}

TEST(BusBudget, RefusesEveryTickOfTheFastLoopOnARealBusWithTheNumbers) {
  const auto budget = hal::can_budget("can0", {1e6, 8e6}, drive_frames(2, true, 62.5e-6), false);
  EXPECT_EQ(refusal_of(budget),
            "bus can0, 1 Mbit/s, data 8 Mbit/s: found a load of 613 % at worst; expected at most 80 %, "
            "which these frames have from a period of 478.9 us on, not 62.5 us");
  EXPECT_EQ(refusal_of(hal::can_budget("can0", {1e6, 8e6}, drive_frames(2, true, 0.5e-3), false)), "carried");
}

TEST(BusBudget, ExemptsAVirtualBusAndSaysSo) {
  const auto budget = hal::can_budget("vcan0", {1e6, 8e6}, drive_frames(2, true, 62.5e-6), true);
  EXPECT_EQ(refusal_of(budget), "carried");
  EXPECT_NE(hal::budget_table(budget).find("vcan0 is a virtual bus"), std::string::npos);
}

TEST(BusBudget, RefusesFramesThatTheBusCannotHaveEvenIfVirtual) {
  EXPECT_EQ(refusal_of(hal::can_budget("vcan0", {1e6, {}}, drive_frames(1, false, 1e-3), true)),
            "bus vcan0, 1 Mbit/s: feedback: found 48 bytes; expected 0 to 8 in a classical frame: command: found 24 "
            "bytes; expected 0 to 8 in a classical frame");
  EXPECT_EQ(
      refusal_of(hal::can_budget("can0", {1e6, {}}, {{"sync", CanIdentifier::standard, 8, true, 1, 1e-3}}, false)),
      "bus can0, 1 Mbit/s: sync: found an FD frame on a bus without data_bit_rate; expected classical frames");
}

// 93 us of short frames within 250 us, behind one of 170 us that has just begun.
TEST(BusBudget, RefusesAShortPeriodBehindALongFrameOfAnother) {
  const std::vector<CyclicFrame> frames{{"feedback", CanIdentifier::standard, 24, true, 1, 250e-6},
                                        {"parameters", CanIdentifier::standard, 64, true, 1, 10e-3}};
  EXPECT_EQ(refusal_of(hal::can_budget("can0", {1e6, 5e6}, frames, false)),
            "bus can0, 1 Mbit/s, data 5 Mbit/s: found frames of the period 250 us that take 89.6 us behind one of "
            "169.6 us that has begun; expected at most 250 us");
}

TEST(BusBudget, RefusesAModbusSlaveThatIsAskedTooOften) {
  EXPECT_EQ(refusal_of(hal::modbus_budget("/dev/ttyS0", 115200, {{"exchange", 6, 12, 1, 10e-3}})),
            "bus /dev/ttyS0, Modbus RTU, 115200 bit/s, 8E1: found a load of 87 % at worst; expected at "
            "most 80 %, which these frames have from a period of 10.82 ms on, not 10 ms");
  EXPECT_EQ(refusal_of(hal::modbus_budget("10.0.0.2:502", 0, {{"exchange", 6, 12, 2, 10e-3}})),
            "bus 10.0.0.2:502, Modbus TCP: found 200 exchanges a second; expected at most 150, a period of 6.667 ms "
            "each");
  EXPECT_EQ(refusal_of(hal::modbus_budget("10.0.0.2:502", 0, {{"exchange", 6, 12, 1, 10e-3}})), "carried");
}

TEST(BusBudget, IsPrintedAsATable) {
  EXPECT_EQ(hal::budget_table(hal::can_budget("can0", {1e6, 5e6}, drive_frames(1, true, 1e-3), false)),
            "can0, 1 Mbit/s, data 5 Mbit/s\n"
            "frame                format                 count     period   time, best to worst            load\n"
            "sync                 FD 8 B                     1       1 ms    49.2 us to 56.6 us    4.9 to 5.7 %\n"
            "feedback             FD 48 B                    1       1 ms  114.2 us to 137.6 us  11.4 to 13.8 %\n"
            "command              FD 24 B                    1       1 ms    75.8 us to 89.6 us    7.6 to 9.0 %\n"
            "all (allowed: 80 %)                                                                 23.9 to 28.4 %\n"
            "carried\n");
}

}  // namespace
}  // namespace stiction::test
