// Places of pulses on a machine that does not stop, simulated again by the response that they were not ranked by: two
// lifts in one motion, and what the first one leaves is what the second one has to carry.
#include "sim/cam/shaping/running_places.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/cam/shaping/lift.hpp"
#include "sim/cam/shaping/record_tuner.hpp"
#include "sim/cam/stand/dwell.hpp"
#include "sim/cam/stand/response.hpp"
#include "tests/sim/cam/stand/study.hpp"

namespace stiction::sim::cam {
namespace {

constexpr double master_speed_of_rig = 130.0 * turns_a_minute;

// The short rise with a stiff load, which vibrates most.
ShapingTask hard_task() {
  return shaping_task(indexing("parabola", 30.0, 120.0), study_drive().with_load_frequency(1.2), master_speed_of_rig,
                      0.2, {});
}

// Of a machine that runs steadily.
RunningResidual steady(const ShapingTask& task) {
  const std::complex<double> own = residual_of(task, own_rise(task, task.stroke), task.end());
  const auto turn = std::exp(task.mode().pole * (task.motion.curve.length() / task.master_speed));
  const auto all = own / (1.0 - turn);
  return {.all = all, .carried = all * turn, .largest_force = std::numeric_limits<double>::infinity()};
}

// The area in the dwell of a cycle with pulses at `places` behind many of the untuned motion, deg^2.
double area_behind_untuned(const ShapingTask& task, const RunningResidual& residual, const PulsePlaces& places) {
  const auto pulses = pulse_pair(task, residual.all, places);
  Cam all = task.motion.cam;
  all.periodic = false;
  all.segments.clear();
  constexpr int untuned = 12;
  for (int k = 0; k < untuned; ++k)
    all.segments.insert(all.segments.end(), task.motion.cam.segments.begin(), task.motion.cam.segments.end());
  const Cam last = with_lift(task.motion.cam, with_pulses(task, *pulses));
  all.segments.insert(all.segments.end(), last.segments.begin(), last.segments.end());
  const auto states = transfer_response(task.drive, compose(all), {.master_speed = task.master_speed});
  const double begin = untuned * task.motion.curve.length() + task.end(), rest = (untuned + 1) * task.stroke;
  double area = 0.0;
  for (std::size_t k = 1; k < states.size(); ++k)
    if (states[k - 1].master >= begin)
      area += std::fabs(states[k].position - rest) * (states[k].master - states[k - 1].master);
  return area / (degree * degree);
}

TEST(RunningPlaces, LeaveLessInTheDwellThanTheEndOfTheRiseDoes) {
  const auto task = hard_task();
  const auto residual = steady(task);
  const auto places = running_places(task, residual);
  ASSERT_FALSE(places.empty());
  const double best = area_behind_untuned(task, residual, places.front()),
               at_end = area_behind_untuned(task, residual, {}),
               worst = area_behind_untuned(task, residual, places.back());
  EXPECT_LT(best, 0.7 * at_end);
  EXPECT_LT(best, worst);
  EXPECT_LT(best, 0.4);
  // And what is left where the motor has no more torque than that of the test rig.
  auto limited = residual;
  limited.largest_force = usable_share * 33.0 * 50.0;
  const auto within = running_places(task, limited);
  ASSERT_FALSE(within.empty());
  const double least = area_behind_untuned(task, residual, within.front());
  EXPECT_LT(least, 0.6);
  fmt::print(
      "least J behind the untuned motion, 120 % of the frequency, 120 degrees, by the model: {:.3f} deg^2 with any "
      "torque, {:.3f} within 0.9 of the rig's, {:.3f} at the end of the rise\n",
      best, least, at_end);
}

// A frequency that is known badly forbids large pulses against each other, which cancel at that one alone.
TEST(RunningPlaces, OfAnUncertainFrequencyArePulsesThatAreSmaller) {
  const auto task = hard_task();
  auto residual = steady(task);
  const auto size = [&](const PulsePlaces& places) {
    const auto pulses = pulse_pair(task, residual.all, places);
    return std::fabs(pulses->first.amplitude) + std::fabs(pulses->second.amplitude);
  };
  const double sure = size(running_places(task, residual).front());
  residual.frequency_error = 0.005;
  EXPECT_LT(size(running_places(task, residual).front()), sure);
}

TEST(RunningPlaces, KeepTheForceOfTheDrive) {
  const auto task = hard_task();
  auto residual = steady(task);
  const auto all = running_places(task, residual);
  residual.largest_force = 33.0 * 50.0;
  const auto within = running_places(task, residual);
  ASSERT_FALSE(within.empty());
  EXPECT_LT(within.size(), all.size());
  const auto motion =
      compose(with_lift(task.motion.cam, with_pulses(task, *pulse_pair(task, residual.all, within[0]))));
  for (const double force : transfer_forces(task.drive, motion, {.master_speed = master_speed_of_rig}))
    EXPECT_LE(std::fabs(force), residual.largest_force);
  residual.largest_force = 1.0;
  EXPECT_TRUE(running_places(task, residual).empty());
}

// What the drive pushes is all the momentum that there is: over a motion from rest to rest none, and the momentum's
// integral is both inertias times the way.
TEST(TransferForces, MoveBothInertiasByTheWay) {
  const auto drive = study_drive();
  Cam cam{.name = "once"};
  cam.modulo = 30.0 * degree;
  // Behind the rise four seconds, in which the load comes to rest.
  cam.segments = {{.length = 180.0 * degree, .stroke = 30.0 * degree, .law = "parabola"},
                  {.length = 4.0 * master_speed_of_rig}};
  const Motion motion = compose(cam);
  const ResponseSettings settings{.master_speed = master_speed_of_rig, .step = 0.1e-3};
  const auto states = transfer_response(drive, motion, settings);
  const auto forces = transfer_forces(drive, motion, settings);
  ASSERT_EQ(forces.size(), states.size());
  double momentum = 0.0, moved = 0.0, largest = 0.0;
  for (std::size_t k = 1; k < forces.size(); ++k) {
    const double time = (states[k].master - states[k - 1].master) / master_speed_of_rig;
    const double before = momentum;
    momentum += 0.5 * time * (forces[k] + forces[k - 1]);
    moved += 0.5 * time * (momentum + before);
    largest = std::max(largest, std::fabs(momentum));
  }
  const double inertia = drive.load_inertia + drive.rotor_inertia;
  EXPECT_NEAR(momentum, 0.0, 1e-4 * largest);
  EXPECT_NEAR(moved, inertia * 30.0 * degree, 1e-4 * inertia * 30.0 * degree);
}

}  // namespace
}  // namespace stiction::sim::cam
