// The firmware's cascade on the test rig of Dostrasil 2014, against that source's own model and the figures of an
// independent prototype.
#include "host/simulate/stand_run.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "firmware/machine/configuration/double_signals.hpp"
#include "firmware/machine/file/machine_file.hpp"
#include "sim/machine_file.hpp"
#include "stiction/number/fixed_signals.hpp"
#include "tests/sim/cam/stand/study.hpp"
#include "tests/support/figure.hpp"

namespace stiction::host {
namespace {

using sim::cam::degree;

machine::Machine stand(const char* current_feedforward = "0") {
  return sim::read_machine(
      machine::find_machine("cam-stand"),
      {.experiment = "", .set = {std::string("axis.L.feedforward.current=") + current_feedforward}});
}

const sim::cam::Motion& parabola() {
  static const auto motion = sim::cam::indexing("parabola", 30.0, 180.0);
  return motion;
}

constexpr double speed = 130.0 * sim::cam::turns_a_minute;

// How far the load is from the transfer function's, at each tick.
double distance_from_model(const StandRun& run) {
  const auto states = transfer_response(sim::cam::study_drive(), parabola(), {.master_speed = speed, .step = 62.5e-6});
  std::size_t k = 0;
  double largest = 0.0;
  for (const auto& load : run.load) {
    while (k + 2 < states.size() && states[k + 1].master <= load.master) ++k;
    const double share = (load.master - states[k].master) / (states[k + 1].master - states[k].master);
    const double model = states[k].position + share * (states[k + 1].position - states[k].position);
    largest = std::max(largest, std::fabs(load.position - model));
  }
  return largest;
}

TEST(CamStand, TheCascadeVibratesAsTheSimplifiedModel) {
  const auto run = run_stand<FixedSignals>(stand(), parabola(), {.master_speed = speed});
  const auto dwell = sim::cam::longest_dwell(parabola());
  const double peak_to_peak = dwell_figures(run.load, parabola(), *dwell).peak_to_peak / degree;
  // The prototype's; the position controller's millisecond and the dead time make it more than the model's 1.645.
  EXPECT_NEAR(peak_to_peak, 1.671, 0.02 * 1.671);
  const double off = distance_from_model(run) / degree;
  EXPECT_LE(off, 0.02);
  test::figure("cam stand: the cascade, peak to peak; from the transfer function at most",
               fmt::format("{:.3f} deg; {:.3f} deg", peak_to_peak, off));
}

TEST(CamStand, TorqueFeedforwardLeavesTheShaft) {
  const auto with = run_stand<FixedSignals>(stand("1"), parabola(), {.master_speed = speed});
  const auto without = run_stand<FixedSignals>(stand(), parabola(), {.master_speed = speed});
  const auto dwell = sim::cam::longest_dwell(parabola());
  const double peak_to_peak = dwell_figures(with.load, parabola(), *dwell).peak_to_peak / degree;
  EXPECT_NEAR(peak_to_peak, 1.339, 0.02 * 1.339);
  EXPECT_LE(with.motor_error / degree, 0.005);
  EXPECT_NEAR(without.motor_error / degree, 0.096, 0.005);
  test::figure("cam stand: torque feedforward, peak to peak; motor's following error",
               fmt::format("{:.3f} deg; {:.4f} deg", peak_to_peak, with.motor_error / degree));
}

TEST(CamStand, DoublesAndTheFirmwaresIntegersAgree) {
  const auto fixed = run_stand<FixedSignals>(stand(), parabola(), {.master_speed = speed});
  const auto doubles = run_stand<machine::DoubleSignals>(stand(), parabola(), {.master_speed = speed});
  ASSERT_EQ(fixed.load.size(), doubles.load.size());
  for (std::size_t k = 0; k < fixed.load.size(); ++k)
    ASSERT_NEAR(fixed.load[k].position, doubles.load[k].position, 1e-4 * degree);
}

TEST(CamStand, TheSecondEncoderIsLate) {
  const auto run = run_stand<FixedSignals>(stand(), parabola(), {.master_speed = speed});
  ASSERT_EQ(run.measured.size(), run.load.size());
  // 3.3629 ms are 53.8 ticks; 0.015 degrees and a noise of 0.003.
  for (std::size_t k = 100; k < run.load.size(); ++k) {
    const double late = run.load[k - 54].position + 0.1936 * (run.load[k - 53].position - run.load[k - 54].position);
    ASSERT_NEAR(run.measured[k].position / degree, late / degree, 0.0075 + 5.5 * 0.003);
  }
}

TEST(CamStand, AMotionThatMovesAtTheStartIsRefused) {
  sim::cam::Cam cam{.name = "moving"};
  cam.segments = {{.length = 3.0, .stroke = 1.0, .law = "linear"}, {.length = 3.0, .stroke = -1.0, .law = "linear"}};
  EXPECT_THROW(run_stand<FixedSignals>(stand(), sim::cam::compose(cam), {.master_speed = 1.0}), sim::cam::StandError);
}

}  // namespace
}  // namespace stiction::host
