// A table with pulses against the motion with the same pulses that the desk makes (with_pulses() of sim/cam/shaping),
// in double precision.
#include "firmware/stictiond/tuned_table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "firmware/machine/file/machine_file.hpp"
#include "sim/cam/segment_table.hpp"
#include "sim/cam/shaping/lift.hpp"
#include "sim/cam/shaping/pulses.hpp"
#include "sim/machine_file.hpp"
#include "stiction/motion/cam_curve.hpp"
#include "tests/sim/cam/stand/study.hpp"

namespace stiction::drive {
namespace {

using sim::cam::degree;
constexpr double table_speed = 130.0 * sim::cam::turns_a_minute;

struct Made {
  sim::cam::Motion motion;
  sim::cam::ShapingTask task;
  std::vector<std::uint8_t> bytes;
  CamTable table;

  explicit Made(const sim::cam::Motion& of)
      : motion(of), task(shaping_task(motion, sim::cam::study_drive(), table_speed, 0.2, {})) {
    bytes = sim::cam::table_within(motion, sim::cam::table_tolerance(motion)).bytes;
    EXPECT_EQ(CamTable::read(bytes, table), CamTableProblem::none);
  }
  machine::CamTuningDesign design() const {
    return machine::CamTuningDesign(
        {.table = &table,
         .mode = {task.mode().frequency() / (2.0 * std::numbers::pi), task.mode().damping_ratio(), 0.0},
         .speed = table_speed / (2.0 * std::numbers::pi),
         .period = 62.5e-6});
  }
};

TEST(TunedTable, IsTheMotionWithTheDesksPulses) {
  for (const char* law : {"3-4-5", "modified_sine", "sloping_sine"}) {
    const Made made(sim::cam::indexing(law, 30.0, 180.0));
    const auto design = made.design();
    auto pulses = *pulse_pair(made.task, {});
    pulses.first.amplitude = -0.7 * degree;
    pulses.second.amplitude = 1.1 * degree;
    const auto wanted = sim::cam::compose(with_lift(made.motion.cam, sim::cam::with_pulses(made.task, pulses)));
    const auto bytes =
        with_pulses(made.table, made.bytes, design.rise(), design.places(), {-0.7 * degree, 1.1 * degree});
    CamTable table;
    ASSERT_EQ(CamTable::read(bytes, table), CamTableProblem::none) << law;
    CamCurve curve;
    ASSERT_EQ(CamCurve::prepare({.table = &table}, curve), CamRefusal::none) << law;
    const double turn = 2.0 * std::numbers::pi;
    for (int k = 0; k < 20000; ++k) {
      const double x = (k + 0.5) / 20000.0;
      const auto slopes = curve.slopes({0, static_cast<std::uint64_t>(x * 0x1p64)});
      const double position = std::ldexp(static_cast<double>(slopes.position), -40);
      // Places of pulses are phases of 2^-32 cycles; the desk's lift is made of 240 parts.
      ASSERT_NEAR(position, wanted.curve(x * turn), 2e-9) << law << " at " << x;
      ASSERT_NEAR(std::ldexp(static_cast<double>(slopes.slope), -40), wanted.curve.derivative(x * turn, 1) * turn,
                  1e-6);
    }
  }
}

// But for the rounding of 32-bit coefficients.
TEST(TunedTable, WithoutPulsesIsTheTable) {
  const Made made(sim::cam::indexing("parabola", 30.0, 180.0));
  const auto design = made.design();
  const auto bytes = with_pulses(made.table, made.bytes, design.rise(), design.places(), {});
  CamTable table;
  ASSERT_EQ(CamTable::read(bytes, table), CamTableProblem::none);
  for (std::uint32_t k = 0; k < 4096; ++k)
    EXPECT_NEAR(machine::table_point(table, std::uint64_t{k} << 20).position,
                machine::table_point(made.table, std::uint64_t{k} << 20).position, 3e-10);
}

TEST(TunedRise, IsTheMotionBeforeTheLongestRest) {
  const Made made(sim::cam::indexing("parabola", 30.0, 120.0));
  const auto rise = machine::tuned_rise(made.table);
  ASSERT_TRUE(rise);
  EXPECT_EQ(rise->begin, 0u);
  EXPECT_NEAR(std::ldexp(rise->length, -32), 120.0 / 360.0, 1e-9);
  EXPECT_NEAR(std::ldexp(rise->rest, -32), 240.0 / 360.0, 1e-9);
  EXPECT_NEAR(rise->stroke, 30.0 * degree, 1e-9);
}

TEST(CamTuningDesign, KnowsTheVibrationOfItsRiseAndOfItsPulses) {
  const Made made(sim::cam::indexing("parabola", 30.0, 180.0));
  // Of the model with the same drive; the axis is that of the shipped machine.
  const auto machine = sim::read_machine(machine::find_machine("cam-stand"), {.experiment = "", .set = {}});
  auto given = machine::CamTuningDesign::Given{
      .table = &made.table,
      .axis = &machine.axes.front(),
      .mode = {made.task.mode().frequency() / (2.0 * std::numbers::pi), made.task.mode().damping_ratio(), 0.0},
      .speed = table_speed / (2.0 * std::numbers::pi),
      .period = 62.5e-6};
  const machine::CamTuningDesign design(given);
  const auto expected = 2.0 * modal_residual(made.task.drive, made.motion, table_speed, made.task.end());
  EXPECT_NEAR(std::abs(design.own() - expected), 0.0, 1e-4 * std::abs(expected));
  auto pulses = *pulse_pair(made.task, {});
  pulses.first.amplitude = 0.2 * degree;
  pulses.second.amplitude = -0.1 * degree;
  const auto with = sim::cam::compose(with_lift(made.motion.cam, sim::cam::with_pulses(made.task, pulses)));
  const auto added = 2.0 * modal_residual(made.task.drive, with, table_speed, made.task.end()) - expected;
  EXPECT_NEAR(std::abs(design.vibration(0.2 * degree, -0.1 * degree) - added), 0.0, 1e-3 * std::abs(added));
}

TEST(CamTuningDesign, RefusesWhatCannotBeTuned) {
  const auto refusal = [](const sim::cam::Motion& motion, double speed, double delay = 0.0) -> std::string {
    const auto bytes = sim::cam::table_within(motion, sim::cam::table_tolerance(motion)).bytes;
    CamTable table;
    EXPECT_EQ(CamTable::read(bytes, table), CamTableProblem::none);
    try {
      machine::CamTuningDesign({.table = &table, .mode = {14.481, 0.01367, delay}, .speed = speed, .period = 62.5e-6});
    } catch (const machine::CamTuningError& error) {
      return error.what();
    }
    return "none";
  };
  const auto motion = sim::cam::indexing("parabola", 30.0, 180.0);
  EXPECT_EQ(refusal(motion, 2.0), "none");
  EXPECT_NE(refusal(motion, 8.0).find("found a rest of 62.5 ms behind the drive's lag"), std::string::npos);
  EXPECT_NE(refusal(motion, 12.0).find("found a rise of 0.60 periods"), std::string::npos);
  EXPECT_NE(refusal(motion, 6.0, 20e-3).find("found a rest of 63.3 ms"), std::string::npos);
  sim::cam::Cam endless{.name = "endless"};
  endless.modulo = 30.0 * degree;
  endless.segments = {{.length = 360.0 * degree, .stroke = 30.0 * degree, .law = "3-4-5"}};
  EXPECT_NE(refusal(sim::cam::compose(endless), 2.0).find("without a rest"), std::string::npos);
}

}  // namespace
}  // namespace stiction::drive
