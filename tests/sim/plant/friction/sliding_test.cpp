// The friction models in steady sliding against their characteristic curves (Mendricky 2006, ch. 4), and the balance of
// forces over one step.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <ostream>
#include <vector>

#include "sim/plant/friction/laws.hpp"
#include "tests/firmware/number/exact.hpp"

namespace stiction::sim {
namespace {

constexpr Body body{225.0, 15.625e-6};

struct Case {
  const char* name;
  machine::FrictionParameters parameters;
  std::function<double(double)> force;  // N at a speed v > 0
};

void PrintTo(const Case& curve, std::ostream* out) { *out << curve.name; }

// X of the cross table (Mendricky 2006, Tab 6.1 and 6.3).
const std::vector<Case> curves{
    {"D", acting<CoulombViscous<>>({115.0, 430.0}), [](double v) { return 115.0 + 430.0 * v; }},
    {"A", acting<Classical<>>({115.0, 1.1, 430.0}), [](double v) { return 115.0 + 430.0 * v; }},
    {"B1", acting<LinearRamp<>>({110.0, 12000.0, 430.0}),
     [](double v) { return v <= 110.0 / 12000.0 ? 12000.0 * v : 110.0 + (v - 110.0 / 12000.0) * 430.0; }},
    {"B2", acting<Parabolic<>>({300.0, 4.0}), [](double v) { return 300.0 * std::pow(v, 0.25); }},
    {"C", acting<LuGre<>>({115.0, 1.5, 430.0, 1e-3, 1e7, 0.1}),
     [](double v) { return 115.0 * (1.0 + 0.5 * std::exp(-v * v / 1e-6)) + 430.0 * v; }},
    {"Maxwell", acting<MaxwellSlip<>>({{1e7, 1e6}, {60.0, 55.0}, 430.0}), [](double v) { return 115.0 + 430.0 * v; }},
};

double advance(FrictionModel& model, double velocity, double force) {
  return std::visit([&](auto& m) { return m.advance(velocity, force); }, model);
}

class Sliding : public ::testing::TestWithParam<Case> {};

TEST_P(Sliding, KeepsItsSpeedUnderTheForceOfItsCurveInBothDirections) {
  for (const double speed : {1e-3, 3e-3, 9e-3, 0.02, 0.4, 1.3})
    for (const double direction : {1.0, -1.0}) {
      auto model = make_friction(GetParam().parameters, body);
      const double v = direction * speed;
      const double force = direction * GetParam().force(speed);
      // Held at speed until contact deflections have settled: g / v of C at 1 mm/s is 17 ms, these are 0.8 s.
      for (int i = 0; i < 50000; ++i) advance(model, v, force);
      // B2 is solved to 1e-13 of |v|^(1/4), 4e-13 of v; the others to a rounding.
      EXPECT_NEAR(advance(model, v, force), v, 5e-13 * speed) << GetParam().name << " at " << v << " m/s";
      EXPECT_GT(direction * advance(model, v, force + direction), speed) << "one newton more accelerates";
    }
}

TEST_P(Sliding, OneNewtonBesideItsCurveChangesTheSpeedByTheMassAlone) {
  // In one step the friction itself hardly moves: dv = h dF / m, less the slope of the curve (B1: 12000 N s/m, B2 at
  // 20 mm/s: 1400 N s/m) times h / m.
  auto model = make_friction(GetParam().parameters, body);
  const double v = 0.02;
  const double force = GetParam().force(v);
  for (int i = 0; i < 100000; ++i) advance(model, v, force);
  const double expected = body.step / body.mass;
  EXPECT_NEAR(advance(model, v, force + 1.0) - v, expected, 1e-3 * expected);
}

INSTANTIATE_TEST_SUITE_P(Models, Sliding, ::testing::ValuesIn(curves),
                         [](const auto& curve) { return curve.param.name; });

// m (v' - v) / h = F - friction, with the friction at the speed at which each model evaluates it.
RC_GTEST_PROP(Friction, EveryStepBalancesForces, ()) {
  const double v = 1e-6 * static_cast<double>(test::drawn_between(-1500000, 1500000));
  const double force = 1e-2 * static_cast<double>(test::drawn_between(-600000, 600000));
  const double h = 1e-7 * static_cast<double>(test::drawn_between(1, 5000));
  const double mass = static_cast<double>(test::drawn_between(1, 1000));
  const Body drawn{mass, h};
  const auto remaining = [&](double next, double friction) { return mass * (next - v) / h - (force - friction); };
  // A difference of speeds of 1.5 m/s is rounded by 3e-16 m/s: times m / h.
  const double tolerance = 1e-15 * (1.5 + h * 6000.0 / mass) * mass / h + 1e-9;

  const double ramp = LinearRamp<>({110.0, 12000.0, 430.0}, drawn).advance(v, force);
  const double size = std::abs(ramp), v_0 = 110.0 / 12000.0;
  const double ramp_force = size <= v_0 ? 12000.0 * size : 110.0 + (size - v_0) * 430.0;
  RC_ASSERT(std::abs(remaining(ramp, std::copysign(ramp_force, ramp))) <= tolerance + 1e-12 * 12000.0);

  const double root = Parabolic<>({300.0, 4.0}, drawn).advance(v, force);
  // Solved to 1e-13 of |v|^(1/4), 4e-13 of v.
  RC_ASSERT(std::abs(remaining(root, std::copysign(300.0 * std::pow(std::abs(root), 0.25), root))) <=
            tolerance + 5e-13 * std::abs(root) * mass / h);

  const double coulomb = CoulombViscous<>({115.0, 430.0}, drawn).advance(v, force);
  const double sign = v > 0.0 ? 1.0 : v < 0.0 ? -1.0 : 0.0;
  RC_ASSERT(std::abs(remaining(coulomb, 115.0 * sign + 430.0 * coulomb)) <= tolerance);

  LuGre<> lugre({115.0, 1.5, 430.0, 1e-3, 1e7, 0.1}, drawn), contact = lugre;
  const double next = lugre.advance(v, force);
  RC_ASSERT(std::abs(remaining(next, contact.move_contact(v) + 430.0 * next)) <= tolerance + 1e-12 * 1e6);
}

// Without a force the passive models only slow down, and never turn around.
RC_GTEST_PROP(Friction, WithoutForceSpeedFallsAndKeepsItsSign, ()) {
  const double v = std::pow(10.0, 1e-3 * static_cast<double>(test::drawn_between(-9000, 1000)));
  const double sign = *rc::gen::element(1.0, -1.0);
  const double h = 1e-7 * static_cast<double>(test::drawn_between(1, 50000));
  const Body drawn{static_cast<double>(test::drawn_between(1, 1000)), h};
  for (const double next : {Classical<>({115.0, 1.1, 430.0}, drawn).advance(sign * v, 0.0),
                            LinearRamp<>({110.0, 12000.0, 430.0}, drawn).advance(sign * v, 0.0),
                            Parabolic<>({300.0, 4.0}, drawn).advance(sign * v, 0.0)}) {
    RC_ASSERT(next * sign >= 0.0);
    RC_ASSERT(std::abs(next) < v);
  }
}

TEST(Friction, WithoutForceNothingStartsToMove) {
  for (const auto& curve : curves) {
    auto model = make_friction(curve.parameters, body);
    for (int i = 0; i < 10; ++i) EXPECT_EQ(advance(model, 0.0, 0.0), 0.0) << curve.name;
  }
}

TEST(Friction, ModelsAreOdd) {
  for (const auto& curve : curves) {
    auto up = make_friction(curve.parameters, body), down = up;
    double v = 0.0, w = 0.0;
    for (int i = 0; i < 5000; ++i) {
      const double force = 300.0 * std::sin(0.01 * i);
      v = advance(up, v, force);
      w = advance(down, w, -force);
      ASSERT_EQ(v, -w) << curve.name << " step " << i;
    }
  }
}

}  // namespace
}  // namespace stiction::sim
