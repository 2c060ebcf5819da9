// The modifications of VDI 2143: with any c, lambda and slopes the stroke is 1 and speed and acceleration are
// continuous.
#include "sim/cam/modification.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "sim/cam/characteristics.hpp"
#include "sim/cam/laws.hpp"

namespace stiction::sim::cam {
namespace {

double between(double low, double high) { return low + (high - low) * (*rc::gen::inRange(0, 1'000'001)) / 1e6; }

// The laws that take modifications and have no acceleration at 1/2, as they are without any.
std::vector<Curve> smooth_laws() {
  std::vector<Curve> curves;
  for (const Law& law : laws())
    if (law.ends == EndValues::slopes && law.number <= 30 && law.number != 2)
      curves.push_back(unit_curve(law, {{"c", {1.0}}}));
  return curves;
}

struct Modified {
  Modification how;
  Curve curve;
};

Modified any_modified() {
  static const std::vector<Curve> bases = smooth_laws();
  const auto which = *rc::gen::inRange<std::size_t>(0, bases.size());
  const Modification how{between(0.05, 1.0), between(0.05, 0.95), between(-1.0, 1.0), between(-1.0, 1.0)};
  return {how, modified(bases[which], how)};
}

// A hundred cases by default, ten laws in each: 1000.
RC_GTEST_PROP(CamModification, KeepsStrokeSlopesAndContinuity, ()) {
  for (int round = 0; round < 10; ++round) {
    const auto [how, curve] = any_modified();
    RC_ASSERT(std::fabs(curve(0.0)) <= 1e-14);
    RC_ASSERT(std::fabs(curve.derivative(1.0, 0, Side::left) - 1.0) <= 1e-14);
    RC_ASSERT(std::fabs(curve.derivative(0.0, 1) - how.start_slope) <= 1e-12);
    RC_ASSERT(std::fabs(curve.derivative(1.0, 1) - how.end_slope) <= 1e-12);
    const double peak = extremes(curve, 2).magnitude();
    for (const Piece& piece : curve.pieces()) {
      if (piece.end == curve.end()) break;
      for (int order = 0; order <= 2; ++order) {
        const double step = curve.derivative(piece.end, order) - curve.derivative(piece.end, order, Side::left);
        RC_ASSERT(std::fabs(step) <= 1e-12 * (order == 2 ? peak : 1.0));
      }
    }
  }
}

TEST(CamModification, WithoutAnyIsTheLawItself) {
  const Law& law = *find_law("modified_sine");
  const Curve plain = law.make({});
  const Curve same = modified(plain, {});
  for (double x = 0.0; x <= 1.0; x += 0.001) EXPECT_EQ(plain(x), same(x));
}

TEST(CamModification, WithCReachesTheSpeedOfTheLine) {
  // Lenze's meaning of c: 1 - c of the interval is at constant speed.
  const Curve curve = unit_curve(*find_law("polynomial_3_4_5"), {{"c", {0.6}}});
  const double line = 1.0 / (0.6 / 1.875 + 0.4);
  for (const double x : {0.31, 0.5, 0.69}) {
    EXPECT_NEAR(curve.derivative(x, 1), line, 1e-13);
    EXPECT_EQ(curve.derivative(x, 2), 0.0);
  }
  EXPECT_LT(curve.derivative(0.29, 1), line - 1e-4);
}

TEST(CamModification, OfAParabolaKeepsItsJump) {
  const Law& law = *find_law("parabola");
  const auto c = characteristics(law, default_values(law), unit_curve(law, {{"lambda", {0.4}}}));
  EXPECT_TRUE(c.jerks_without_bound());
}

}  // namespace
}  // namespace stiction::sim::cam
