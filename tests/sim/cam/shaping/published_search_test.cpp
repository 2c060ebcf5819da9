// The search that Dostrasil 2014 has for place and amplitude of a pulse (6.4): the simplexes of Nelder and Mead over
// the quality number of a cycle, which `tune-cam` offers so that its own cycles have a comparison.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "sim/cam/shaping/lift.hpp"
#include "sim/cam/shaping/number_search.hpp"
#include "sim/cam/shaping/pulses.hpp"
#include "tests/sim/cam/stand/study.hpp"
#include "tests/support/figure.hpp"

namespace stiction::sim::cam {
namespace {

constexpr double search_speed = 130.0 * turns_a_minute;
using Place = std::array<double, 2>;  // position and amplitude of the pulse, degrees

// Cycles of the machine: the transfer function, seen by the encoder of the test rig.
class Machine {
 public:
  explicit Machine(std::uint64_t seed)
      : task_(shaping_task(indexing("parabola", 30.0, 180.0), study_drive(), search_speed, 0.2, {})), random_(seed) {}

  const ShapingTask& task() const { return task_; }
  // The area of the deviation in the dwell as it is measured, deg^2.
  double quality(const Place& at) {
    const double position = std::clamp(at[0], 0.0, 130.0);
    return quality(compose(with_lift(
        task_.motion.cam, with_pulse(task_, {position * degree, at[1] * degree}, "polynomial_3_4_5", 50.0 * degree))));
  }
  double quality(const Motion& motion) {
    const auto states = transfer_response(study_drive(), motion, {.master_speed = search_speed, .step = 1e-3});
    // The delay of 3.3629 ms is known and taken out, as a parameter of the source's table 2.
    constexpr double resolution = 0.015;
    double sum = 0.0, last = std::numbers::pi;
    for (std::size_t k = 0; k < states.size(); ++k) {
      if (states[k].master < std::numbers::pi) continue;
      const double shown = resolution * std::round((states[k].position / degree + noise_(random_)) / resolution);
      sum += std::fabs(shown - 30.0) * (states[k].master - last) / degree;
      last = states[k].master;
    }
    return sum;
  }

 private:
  ShapingTask task_;
  std::mt19937_64 random_;
  std::normal_distribution<double> noise_{0.0, 0.003};
};

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

TEST(PublishedSearch, FourteenStepsReachThePublishedQualityIn29Cycles) {
  std::mt19937_64 random(20140915);
  std::uniform_real_distribution<double> position(100.0, 130.0), amplitude(-1.0, 0.0), side(-8.0, 8.0),
      height(-0.4, 0.4);
  std::vector<double> qualities, cycles;
  while (qualities.size() < 60) {
    Machine machine(random());
    Simplex simplex;
    const Place first{position(random), amplitude(random)};
    bool usable = true;
    for (std::size_t k = 0; k < 3 && usable; ++k) {
      simplex[k] = k == 0 ? first : Place{first[0] + side(random), first[1] + height(random)};
      const double quality = machine.quality(simplex[k]);
      usable = quality >= 50.0 && quality <= 70.0;
    }
    const double area = (simplex[1][0] - first[0]) * (simplex[2][1] - first[1]) -
                        (simplex[2][0] - first[0]) * (simplex[1][1] - first[1]);
    if (!usable || std::fabs(area) < 0.2) continue;  // no collinear ones
    for (Place& place : simplex) place = {place[0] * degree, place[1] * degree};
    const auto found = search_by_simplex(machine.task(), 50.0 * degree, simplex, 14,
                                         [&](const Cam& cam) { return machine.quality(compose(cam)); });
    qualities.push_back(found.least.quality);
    cycles.push_back(static_cast<double>(found.trials.size()));
  }
  EXPECT_GE(median(qualities), 1.3);
  EXPECT_LE(median(qualities), 1.9);
  EXPECT_GE(median(cycles), 27.0);
  EXPECT_LE(median(cycles), 31.0);
  test::figure("cam tuning: search of Nelder and Mead, 60 simplexes, 14 steps: J, cycles, medians",
               fmt::format("{:.2f} deg^2, {:.0f}", median(qualities), median(cycles)));
}

}  // namespace
}  // namespace stiction::sim::cam
