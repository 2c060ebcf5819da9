// What every law of the table promises (sim/plant/friction/law.hpp), each with the parameters that the cross table's
// file gives it. A law that is added to the table and to the file is tested without a change here.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "sim/machine_file.hpp"
#include "sim/plant/friction/friction.hpp"
#include "sim/plant/friction/laws.hpp"

namespace stiction::sim {
namespace {

constexpr double step = 15.625e-6;  // s

const machine::AxisModel& axis_x() {
  static const machine::Machine machine =
      read_machine(std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/mcfv5050ln.toml");
  return machine.axes.front();
}

// visit.operator()<Law>(parameters) for each law with the file's parameters.
template <class Visit>
void for_each_law(Visit&& visit) {
  for_each_friction_model([&]<class Law>() {
    SCOPED_TRACE(std::string(Law::name));
    ASSERT_TRUE(axis_x().friction.models.contains(std::string(Law::name))) << "the file shows every law";
    visit.template operator()<Law>(parameters_of<Law>(axis_x().friction));
  });
}

// The force (N) that keeps `law` at `velocity`: m (v - v') / h of a free step.
template <class Law>
double braking(Law& law, double velocity) {
  return (velocity - law.advance(velocity, 0.0)) * axis_x().mass / step;
}

TEST(FrictionLaw, AtConstantSpeedItsForceBecomesTheSteadyOne) {
  for_each_law([]<class Law>(const typename Law::Parameters& p) {
    for (const double speed : {1e-3, 0.02, 0.4})
      for (const double sign : {1.0, -1.0}) {
        Law law(p, {axis_x().mass, step});
        const double wanted = law.steady_force(sign * speed, sign);
        // Ten times the contact's distance; laws that follow the speed alone are there at once.
        const double way = law.contact() ? 10.0 * law.contact()->distance : 10.0 * step * speed;
        double force = 0.0;
        for (double x = 0.0; x < way; x += speed * step) force = braking(law, sign * speed);
        // A free step is braked by viscous friction and the root at its end: less than 1e-3 of the force here.
        EXPECT_NEAR(force, wanted, 2e-3 * std::abs(wanted)) << sign * speed << " m/s";
      }
  });
}

TEST(FrictionLaw, TakesEnergyFromAnyClosedMotion) {
  for_each_law([]<class Law>(const typename Law::Parameters& p) {
    for (const double amplitude : {1e-6, 30e-6, 1e-3, 30e-3}) {
      Law law(p, {axis_x().mass, step});
      double first = 0.0, later = 0.0;
      constexpr int laps = 3, steps = 20000;
      for (int i = 0; i < laps * steps; ++i) {
        const double phase = 2.0 * 3.141592653589793 * (i + 0.5) / steps;
        const double v = amplitude / step * (2.0 * 3.141592653589793 / steps) * std::cos(phase);
        (i < steps ? first : later) += braking(law, v) * v * step;
      }
      const double scale = 1e-9 * amplitude * (1.0 + std::abs(law.steady_force(1e-3, 1.0)));
      EXPECT_GE(first, -scale) << amplitude << " m, with the first loading";
      EXPECT_GE(later, -scale) << amplitude << " m";
    }
  });
}

TEST(FrictionLaw, ContactIsItsStiffnessInSmallLoopsAndItsLevelAfterItsDistance) {
  int with_contact = 0;
  for_each_law([&]<class Law>(const typename Law::Parameters& p) {
    const auto contact = Law(p, {axis_x().mass, step}).contact();
    EXPECT_EQ(contact.has_value(), ContactLaw<Law>);
    if constexpr (ContactLaw<Law>) {
      ++with_contact;
      Law law(Law::rate_independent(p), {axis_x().mass, step});
      const double small = 1e-4 * contact->distance;
      EXPECT_NEAR(law.move_contact(small / step) / small, contact->stiffness, 1e-2 * contact->stiffness);
      EXPECT_NEAR(law.move_contact(-small / step), 0.0, 2e-2 * contact->stiffness * small);
      Law loaded(Law::rate_independent(p), {axis_x().mass, step});
      double force = 0.0;
      for (int i = 0; i < 10000; ++i) force = loaded.move_contact(1e-4 * contact->distance / step);
      EXPECT_NEAR(force, 0.9 * contact->level, 1e-3 * contact->level);
      auto longer = p;
      Law::stretch(longer, 2.0);
      EXPECT_NEAR(Law(longer, {axis_x().mass, step}).contact()->distance, 2.0 * contact->distance,
                  1e-9 * contact->distance);
    }
  });
  EXPECT_GE(with_contact, 4);
}

TEST(FrictionLaw, CoulombAndViscousAreReadAsTheyWereSetAndMoveTheSteadyForceByIt) {
  for_each_law([]<class Law>(const typename Law::Parameters& p) {
    const Body body{axis_x().mass, step};
    constexpr double fast = 0.4;
    auto changed = p;
    Law::set_coulomb(changed, Law::coulomb(p) + 10.0);
    EXPECT_NEAR(Law::coulomb(changed), Law::coulomb(p) + 10.0, 1e-9);
    // The linear ramp breaks off later then, where its slope above the break costs mu_v / mu_0 of the 10 N.
    EXPECT_NEAR(Law(changed, body).steady_force(fast, 1.0) - Law(p, body).steady_force(fast, 1.0), 10.0, 0.5);
    changed = p;
    Law::set_viscous(changed, Law::viscous(p) + 100.0);
    EXPECT_NEAR(Law::viscous(changed), Law::viscous(p) + 100.0, 1e-9);
    EXPECT_NEAR(Law(changed, body).steady_force(fast, 1.0) - Law(p, body).steady_force(fast, 1.0), 100.0 * fast, 1.0);
  });
}

TEST(FrictionLaw, SurvivesTheWayThroughAMachineFile) {
  for_each_law([]<class Law>(const typename Law::Parameters& p) {
    const auto values = values_of<Law>(p);
    const auto again = parameters_of<Law>(values);
    EXPECT_EQ(values_of<Law>(again), values);
    EXPECT_NO_THROW(machine::check_values(*vocabulary().find_friction_model(Law::name), values));
  });
}

}  // namespace
}  // namespace stiction::sim
