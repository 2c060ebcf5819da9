// Splines through points, and tables of points as laws.
#include "sim/cam/spline.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/cam/characteristics.hpp"
#include "sim/cam/points.hpp"

namespace stiction::sim::cam {
namespace {

std::vector<SplineNode> sine_nodes(int count) {
  std::vector<SplineNode> nodes;
  for (int k = 0; k <= count; ++k) {
    // Uneven nodes, so that no symmetry hides a wrong coefficient.
    const double x = 2.0 * std::numbers::pi * (k + 0.2 * std::sin(3.0 * k) * (k > 0 && k < count)) / count;
    nodes.push_back({x, k == count ? 0.0 : std::sin(x)});
  }
  return nodes;
}

// The largest step at inner nodes of the derivative of `order`.
double largest_step(const Curve& curve, int order) {
  double largest = 0.0;
  for (const Piece& piece : curve.pieces())
    if (piece.end < curve.end())
      largest = std::fmax(
          largest, std::fabs(curve.derivative(piece.end, order) - curve.derivative(piece.end, order, Side::left)));
  return largest;
}

double error_of(const Curve& curve) {
  double error = 0.0;
  for (int k = 0; k <= 1000; ++k) {
    const double x = curve.end() * k / 1000;
    error = std::fmax(error, std::fabs(curve(x) - std::sin(x)));
  }
  return error;
}

TEST(CamSpline, GoesThroughItsPointsWithContinuousDerivatives) {
  const auto nodes = sine_nodes(12);
  for (const auto ends : {SplineEnds::natural, SplineEnds::clamped, SplineEnds::periodic})
    for (const auto degree : {SplineDegree::cubic, SplineDegree::quintic}) {
      const Curve curve = spline(nodes, degree, ends, {0.0, 1.0, 0.0, 0.0}, {0.0, 1.0, 0.0, 0.0});
      for (const auto& [x, y] : nodes) EXPECT_NEAR(curve(x), y, 1e-13);
      for (int order = 0; order <= (degree == SplineDegree::cubic ? 2 : 4); ++order)
        EXPECT_LE(largest_step(curve, order), 1e-9) << order;
    }
}

TEST(CamSpline, HasTheEndsThatItIsAskedFor) {
  const auto nodes = sine_nodes(9);
  const Curve natural = spline(nodes, SplineDegree::cubic, SplineEnds::natural);
  EXPECT_NEAR(natural.derivative(0.0, 2), 0.0, 1e-12);
  EXPECT_NEAR(natural.derivative(natural.end(), 2, Side::left), 0.0, 1e-12);
  const Curve free = spline(nodes, SplineDegree::quintic, SplineEnds::natural);
  for (const int order : {3, 4}) {
    EXPECT_NEAR(free.derivative(0.0, order), 0.0, 1e-9);
    EXPECT_NEAR(free.derivative(free.end(), order, Side::left), 0.0, 1e-9);
  }
  const Curve clamped =
      spline(nodes, SplineDegree::quintic, SplineEnds::clamped, {0.0, 0.3, -2.0, 0.0}, {0.0, 4.0, 5.0, 0.0});
  EXPECT_NEAR(clamped.derivative(0.0, 1), 0.3, 1e-12);
  EXPECT_NEAR(clamped.derivative(0.0, 2), -2.0, 1e-11);
  EXPECT_NEAR(clamped.derivative(clamped.end(), 1, Side::left), 4.0, 1e-11);
  EXPECT_NEAR(clamped.derivative(clamped.end(), 2, Side::left), 5.0, 1e-10);
  for (const auto degree : {SplineDegree::cubic, SplineDegree::quintic}) {
    const Curve ring = spline(nodes, degree, SplineEnds::periodic);
    for (int order = 1; order <= (degree == SplineDegree::cubic ? 2 : 4); ++order)
      EXPECT_NEAR(ring.derivative(0.0, order), ring.derivative(ring.end(), order, Side::left), 1e-9) << order;
  }
}

// Of a sine by n intervals the error falls with the fourth power of n, and with the sixth.
TEST(CamSpline, ConvergesWithTheOrderOfItsDegree) {
  const auto ratio = [](SplineDegree degree) {
    return error_of(spline(sine_nodes(16), degree, SplineEnds::periodic)) /
           error_of(spline(sine_nodes(64), degree, SplineEnds::periodic));
  };
  EXPECT_GT(ratio(SplineDegree::cubic), 100.0);
  EXPECT_GT(ratio(SplineDegree::quintic), 1500.0);
}

TEST(CamSpline, OfAQuinticPolynomialIsThePolynomial) {
  const auto y = [](double x) { return ((((0.3 * x - 1.0) * x + 2.0) * x - 0.5) * x + 1.0) * x - 2.0; };
  const auto v = [](double x) { return (((1.5 * x - 4.0) * x + 6.0) * x - 1.0) * x + 1.0; };
  const auto a = [](double x) { return ((6.0 * x - 12.0) * x + 12.0) * x - 1.0; };
  std::vector<SplineNode> nodes;
  for (const double x : {0.0, 0.3, 0.5, 1.1, 1.2, 2.0}) nodes.push_back({x, y(x)});
  const Curve curve =
      spline(nodes, SplineDegree::quintic, SplineEnds::clamped, {0.0, v(0.0), a(0.0), 0.0}, {0.0, v(2.0), a(2.0), 0.0});
  for (double x = 0.0; x < 2.0; x += 0.01) EXPECT_NEAR(curve(x), y(x), 1e-12);
}

PointTable good_table() {
  PointTable table;
  for (int k = 0; k <= 20; ++k) {
    const double x = k / 20.0;
    table.master.push_back(x);
    table.slave.push_back(x * x * x);
    table.speed.push_back(3 * x * x);
    table.acceleration.push_back(6 * x);
  }
  return table;
}

TEST(CamPoints, WithTrueDerivativesAreHermitePolynomials) {
  const Curve curve = curve_of(good_table());
  EXPECT_NEAR(curve(0.512), 0.512 * 0.512 * 0.512, 1e-14);
  EXPECT_NEAR(curve.derivative(0.512, 3), 6.0, 1e-9);
}

TEST(CamPoints, RefuseColumnsThatAreNoDerivatives) {
  auto table = good_table();
  for (double& v : table.speed) v *= std::numbers::pi / 180.0;  // over degrees, not over radians
  EXPECT_NE(problem_of(table).find("speeds that sum up"), std::string::npos);
  EXPECT_NE(problem_of(table).find("same units"), std::string::npos);
  table = good_table();
  std::swap(table.acceleration.front(), table.acceleration.back());
  for (double& a : table.acceleration) a = -a;
  EXPECT_NE(problem_of(table).find("accelerations"), std::string::npos);
}

TEST(CamPoints, RefuseWhatIsNoTable) {
  const auto with = [](auto&& change) {
    auto table = good_table();
    change(table);
    return problem_of(table);
  };
  EXPECT_EQ(with([](auto&) {}), "");
  EXPECT_NE(with([](auto& t) { t.master[5] = t.master[4]; }), "");
  EXPECT_NE(with([](auto& t) { t.master[5] = 0.1; }), "");
  EXPECT_NE(with([](auto& t) { t.slave[5] = std::nan(""); }), "");
  EXPECT_NE(with([](auto& t) { t.speed.pop_back(); }), "");
  EXPECT_NE(with([](auto& t) { t.speed.clear(); }), "");
  EXPECT_NE(with([](auto& t) { t.splits = {0.051}; }), "");
  EXPECT_NE(problem_of(PointTable{.master = {0.0}, .slave = {0.0}}), "");
  EXPECT_NE(problem_of(PointTable{}), "");
  EXPECT_THROW(curve_of(PointTable{}), CamError);
}

TEST(CamPoints, SplitWhereTheirDerivativesJump) {
  PointTable table;
  for (int k = 0; k <= 20; ++k) table.master.push_back(k / 20.0), table.slave.push_back(std::fabs(k / 20.0 - 0.5));
  const double smooth = curve_of(table)(0.475);
  table.splits = {0.5};
  const Curve curve = curve_of(table);
  EXPECT_NEAR(curve(0.475), 0.025, 1e-14);
  EXPECT_GT(std::fabs(smooth - 0.025), 1e-4);
  const auto jumps = inner_jumps(curve);
  ASSERT_EQ(jumps.size(), 1u);
  EXPECT_EQ(jumps[0].order, 1);
  EXPECT_NEAR(jumps[0].height, 2.0, 1e-12);
}

}  // namespace
}  // namespace stiction::sim::cam
