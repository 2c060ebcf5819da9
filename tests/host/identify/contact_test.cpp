// The contact's regressors against the friction models that the plant is simulated with.
#include "host/identify/contact.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/plant/friction/lugre.hpp"
#include "sim/plant/friction/maxwell_slip.hpp"

namespace stiction::host {
namespace {

// A swing that grows from 2 um to 1 mm, at 1 kHz.
Motion swings() {
  Motion motion;
  motion.period = 1e-3;
  for (int k = 0; k < 8000; ++k) {
    const double t = k * motion.period;
    motion.t.push_back(t);
    motion.x.push_back(2e-6 * std::exp(0.78 * t) * (1.0 - std::cos(2.0 * std::numbers::pi * t)));
  }
  motion.v = central_difference(motion.x, motion.period);
  motion.a = central_difference(motion.v, motion.period);
  return motion;
}

TEST(Contact, level_is_that_of_the_lugre_model) {
  const auto motion = swings();
  constexpr double coulomb = 90.0, stiffness = 8e5;
  for (const double ratio : {1.0, 1.5}) {
    const auto contact = contact_of(motion, {stiffness / coulomb, ratio, 1e-3});
    sim::LuGre<> model({coulomb, ratio, 0.0, 1e-3, stiffness, 0.0}, {225.0, motion.period});
    double worst = 0.0;
    for (std::size_t k = 1; k < motion.x.size(); ++k) {
      const double force = model.move_contact((motion.x[k] - motion.x[k - 1]) / motion.period);
      worst = std::max(worst, std::abs(coulomb * contact.level[k] - force));
    }
    // The model's exponential is a series good to 2e-8 a step.
    EXPECT_LT(worst, 1e-4) << ratio;
  }
}

TEST(Contact, memory_is_what_an_unknown_start_leaves) {
  auto motion = swings();
  const ContactShape shape{8e5 / 90.0, 1.0, 1e-3};
  const auto whole = contact_of(motion, shape);
  // The same motion recorded from its 3000th sample on.
  constexpr std::size_t cut = 3000;
  motion.x.erase(motion.x.begin(), motion.x.begin() + cut);
  const auto rest = contact_of(motion, shape);
  for (std::size_t k = 0; k < motion.x.size(); ++k)
    EXPECT_NEAR(rest.level[k] + whole.level[cut] * rest.memory[k], whole.level[cut + k], 1e-9);
}

TEST(Contact, stop_operators_are_maxwell_slip_elements) {
  const auto motion = swings();
  constexpr double stiffness = 2e6, level = 30.0;
  const auto column = stop_operator(motion, level / stiffness);
  double force = 0.0;
  for (std::size_t k = 1; k < motion.x.size(); ++k) {
    force = std::clamp(force + stiffness * (motion.x[k] - motion.x[k - 1]), -level, level);
    ASSERT_NEAR(stiffness * column[k], force, 1e-6);
  }
}

}  // namespace
}  // namespace stiction::host
