// Every lift law of the table: boundary values, symmetry, integration, and the figures of independent prototypes.
#include "sim/cam/laws.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "sim/cam/characteristics.hpp"
#include "sim/cam/quadrature.hpp"
#include "tests/sim/cam/published_figures.hpp"

namespace stiction::sim::cam {
namespace {

// The two laws with free coefficients have no defaults: 3-4-5 by its coefficients, 4-5-6-7 by its powers.
LawValues with_free_values(const Law& law) {
  LawValues values = default_values(law);
  if (law.name == "polynomial") values["coefficients"] = {0.0, 0.0, 10.0, -15.0, 6.0};
  if (law.name == "power_polynomial") values["powers"] = {4.0, 5.0, 6.0, 7.0};
  return values;
}

Curve curve_of(const Law& law) { return unit_curve(law, with_free_values(law)); }

// A figure printed with as many digits as this has: half of its last one, and a tenth for the printing.
void expect_printed(double value, double printed, int digits, const Law& law, const char* what) {
  const double unit = printed == 0.0 ? 1e-9 : std::pow(10.0, std::floor(std::log10(std::fabs(printed))) + 1 - digits);
  EXPECT_NEAR(value, printed, 0.55 * unit) << law.name << " " << what;
}

TEST(CamLaws, TheTableHasEachNumberAndNameOnce) {
  std::set<int> numbers;
  std::set<std::string_view> names;
  for (const Law& law : laws()) {
    numbers.insert(law.number);
    names.insert(law.name);
    EXPECT_EQ(find_law(law.name), &law);
    EXPECT_FALSE(law.formula.empty() || law.source.empty() || law.german.empty()) << law.name;
  }
  EXPECT_EQ(numbers.size(), 86u);  // 84 with figures or boundary values, and two with coefficients of one's own
  EXPECT_EQ(names.size(), 86u);
  EXPECT_EQ(*numbers.rbegin(), 86);
}

TEST(CamLaws, AreFoundByEnglishAndGermanNames) {
  EXPECT_EQ(find_law("Modified Sine")->number, 8);
  EXPECT_EQ(find_law("modifizierte Sinuslinie")->number, 8);
  EXPECT_EQ(find_law("Bestehorn-Sinuslinie")->number, 6);
  EXPECT_EQ(find_law("3-4-5")->number, 22);
  EXPECT_EQ(find_law("no such law"), nullptr);
}

TEST(CamLaws, BeginAtZeroAndEndAtOne) {
  for (const Law& law : laws()) {
    const Curve curve = curve_of(law);
    EXPECT_NEAR(curve(0.0), 0.0, 1e-12) << law.name;
    EXPECT_NEAR(curve(1.0), law.kind == LawKind::rise ? 1.0 : 0.0, 1e-12) << law.name;
  }
}

// Position, speed and acceleration follow from the ends by integrals of the next derivative.
TEST(CamLaws, AreTheIntegralsOfTheirDerivatives) {
  for (const Law& law : laws()) {
    const Curve curve = curve_of(law);
    std::array<double, 3> sum{curve(0.0), curve.derivative(0.0, 1), 0.0};
    for (const Piece& piece : curve.pieces()) {
      sum[2] = piece.derivative(piece.begin, 2);  // it may jump
      for (int k = 0; k < 200; ++k) {
        const double begin = piece.begin + piece.length() * k / 200, end = piece.begin + piece.length() * (k + 1) / 200;
        // Twice integrated: y(end) = y + h y' + integral of (end - x) y''.
        sum[0] +=
            (end - begin) * sum[1] + integral([&](double x) { return (end - x) * piece.derivative(x, 2); }, begin, end);
        sum[1] += integral([&](double x) { return piece.derivative(x, 2); }, begin, end);
        sum[2] += integral([&](double x) { return piece.derivative(x, 3); }, begin, end);
        ASSERT_NEAR(sum[0], piece.derivative(end, 0), 1e-10) << law.name << " at " << end;
        ASSERT_NEAR(sum[1], piece.derivative(end, 1), 1e-10) << law.name << " at " << end;
        ASSERT_NEAR(sum[2], piece.derivative(end, 2), 1e-9) << law.name << " at " << end;
      }
    }
  }
}

TEST(CamLaws, AreSymmetricWhereTheirFormulaIs) {
  int checked = 0;
  for (const Law& law : laws()) {
    const bool modified = law.ends == EndValues::slopes;
    const LawValues values = default_values(law);
    if (modified && (value(values, "lambda") != 0.5 || law.number == 68)) continue;
    if (law.kind == LawKind::rise && !modified && law.number != 1) continue;
    if (law.number == 82) continue;
    const Curve curve = curve_of(law);
    ++checked;
    for (int k = 0; k <= 1000; ++k) {
      const double x = k / 1000.0, other = curve(1.0 - x);
      ASSERT_NEAR(curve(x), law.kind == LawKind::rise ? 1.0 - other : other, 1e-12) << law.name << " at " << x;
    }
  }
  EXPECT_EQ(checked, 45);
}

TEST(CamLaws, HaveThePublishedCharacteristicValues) {
  for (const auto& row : published_figures) {
    const Law& law = laws()[static_cast<std::size_t>(row.number - 1)];
    ASSERT_EQ(law.number, row.number);
    const auto c = characteristics(law, default_values(law), curve_of(law));
    // The published figures of law 82 are those before the division by its peak.
    const double peak = row.number == 82 ? 1.0362 : 1.0;
    const int digits = row.number == 82 ? 3 : 4;
    expect_printed(c.speed * peak, row.speed, digits, law, "Cv");
    expect_printed(c.acceleration * peak, row.acceleration, digits, law, "Ca+");
    expect_printed(c.deceleration * peak, row.deceleration, digits, law, "Ca-");
    expect_printed(c.jerk * peak, row.jerk, digits, law, "Cj");
    expect_printed(c.torque * peak * peak, row.torque, digits, law, "C_M");
    EXPECT_EQ(c.jerks_without_bound(), row.jumps) << law.name;
  }
}

TEST(CamLaws, HaveTheCharacteristicValuesOfClosedForms) {
  constexpr double pi = std::numbers::pi;
  struct Exact {
    const char* law;
    double speed, acceleration, jerk, torque;
  };
  const Exact rows[] = {
      {"parabola", 2.0, 4.0, 0.0, 8.0},
      {"cubic", 1.5, 6.0, 12.0, 2.0 * std::sqrt(3.0)},
      {"simple_sine", pi / 2, pi * pi / 2, pi * pi * pi / 2, pi * pi * pi / 8},
      {"sloping_sine", 2.0, 2 * pi, 4 * pi * pi, 3 * std::sqrt(3.0) * pi / 2},
      {"polynomial_3_4_5", 1.875, 10 / std::sqrt(3.0), 60.0, 0.0},
      {"polynomial_4_5_6_7", 2.1875, 84 * std::sqrt(5.0) / 25, 52.5, 0.0},
      {"modified_sine", 4 * pi / (pi + 4), 4 * pi * pi / (pi + 4), 16 * pi * pi * pi / (pi + 4), 0.0},
      {"modified_trapezoid", 2.0, 8 * pi / (pi + 2), 32 * pi * pi / (pi + 2), 0.0},
      {"trapezoid_8", 2.0, 16.0 / 3.0, 128.0 / 3.0, 80.0 / 9.0},
      {"trapezoid_6", 2.0, 6.0, 36.0, 9.0},
      {"triangular_acceleration", 2.0, 8.0, 32.0, 0.0},
  };
  for (const auto& row : rows) {
    const Law& law = *find_law(row.law);
    const auto c = characteristics(law, default_values(law), curve_of(law));
    EXPECT_NEAR(c.speed, row.speed, 1e-9) << law.name;
    EXPECT_NEAR(c.acceleration, row.acceleration, 1e-9) << law.name;
    EXPECT_NEAR(c.jerk, row.jerk, 1e-9 * std::fmax(row.jerk, 1.0)) << law.name;
    if (row.torque > 0.0) {
      EXPECT_NEAR(c.torque, row.torque, 1e-9) << law.name;
    }
  }
}

TEST(CamLaws, HermitePolynomialsHaveEveryBoundaryValue) {
  const std::array<const char*, 6> keys{"start_slope", "start_acceleration", "start_jerk",
                                        "end_slope",   "end_acceleration",   "end_jerk"};
  const std::array<double, 6> wanted{0.7, -3.0, 11.0, -1.3, 5.0, -17.0};
  for (int number = 48; number <= 63; ++number) {
    const Law& law = laws()[static_cast<std::size_t>(number - 1)];
    LawValues values;
    std::array<double, 6> expected{};
    for (const auto& key : law.parameters)
      for (std::size_t k = 0; k < keys.size(); ++k)
        if (key.key == keys[k]) values[keys[k]] = {expected[k] = wanted[k]};
    EXPECT_EQ(values.size(), law.parameters.size()) << law.name;
    const Curve curve = unit_curve(law, values);
    const int orders = number == 63 ? 3 : 2;
    for (int order = 1; order <= orders; ++order) {
      const auto k = static_cast<std::size_t>(order - 1);
      EXPECT_NEAR(curve.derivative(0.0, order), expected[k], 1e-12) << law.name;
      EXPECT_NEAR(curve.derivative(1.0, order), expected[k + 3], 1e-12) << law.name;
    }
    EXPECT_NEAR(curve(0.0), 0.0, 1e-12) << law.name;
    EXPECT_NEAR(curve(1.0), 1.0, 1e-12) << law.name;
  }
}

// Of the peaks, found as zeros of the next derivative, against the largest of a million samples: between two of them a
// peak is higher by at most (1e-6)^2 / 8 of its curvature, below 1e-9.
TEST(CamLaws, HermitePolynomialsHaveThePeaksOfAMillionPoints) {
  for (int number = 48; number <= 63; ++number) {
    const Law& law = laws()[static_cast<std::size_t>(number - 1)];
    const Curve curve = curve_of(law);
    const auto found = characteristics(law, default_values(law), curve);
    Characteristics scan;
    for (int k = 0; k <= 1'000'000; ++k) {
      const double x = k / 1e6, v = curve.derivative(x, 1), a = curve.derivative(x, 2);
      scan.speed = std::fmax(scan.speed, std::fabs(v));
      scan.acceleration = std::fmax(scan.acceleration, a);
      scan.deceleration = std::fmin(scan.deceleration, a);
      scan.torque = std::fmax(scan.torque, std::fabs(v * a));
    }
    EXPECT_NEAR(found.speed, scan.speed, 1e-9) << law.name;
    EXPECT_NEAR(found.acceleration, scan.acceleration, 1e-9) << law.name;
    EXPECT_NEAR(found.deceleration, scan.deceleration, 1e-9) << law.name;
    EXPECT_NEAR(found.torque, scan.torque, 1e-9) << law.name;
  }
}

TEST(CamLaws, HaveThePublishedResidualAmplitudes) {
  for (const auto& row : published_residuals) {
    const Law& law = *find_law(row.law);
    const Curve curve = curve_of(law);
    for (std::size_t k = 0; k < std::size(row.amplitude); ++k)
      expect_printed(residual_amplitude(curve, published_periods[k]), row.amplitude[k], 3, law, "A(r)");
  }
}

TEST(CamLaws, HaveTheResidualAmplitudesOfClosedForms) {
  constexpr double pi = std::numbers::pi;
  const Curve parabola = curve_of(*find_law("parabola")), sine = curve_of(*find_law("sloping_sine"));
  for (double r = 0.3; r < 12.0; r += 0.37) {
    EXPECT_NEAR(residual_amplitude(parabola, r), 4 * std::pow(std::sin(pi * r / 2), 2) / std::pow(pi * r, 2), 1e-9);
    EXPECT_NEAR(residual_amplitude(sine, r), std::fabs(std::sin(pi * r)) / (pi * r * std::fabs(r * r - 1)), 1e-9);
  }
  EXPECT_NEAR(residual_amplitude(sine, 1.0), 0.5, 1e-9);
}

TEST(CamLaws, FreePolynomialsAreTheNamedOnesOfTheirCoefficients) {
  const Curve three = curve_of(*find_law("polynomial_3_4_5")), four = curve_of(*find_law("polynomial_4_5_6_7"));
  const Curve by_coefficients = curve_of(*find_law("polynomial")), by_powers = curve_of(*find_law("power_polynomial"));
  for (double x = 0.0; x <= 1.0; x += 0.01) {
    EXPECT_NEAR(by_coefficients(x), three(x), 1e-13);
    EXPECT_NEAR(by_powers(x), four(x), 1e-12);
  }
}

TEST(CamLaws, RefuseParametersOutOfRange) {
  const Law& sine = *find_law("modified_sine");
  for (const double lambda : {0.0, 1.0, -0.1, std::nan("")})
    EXPECT_THROW(unit_curve(sine, {{"lambda", {lambda}}}), machine::ValueError) << lambda;
  for (const double c : {0.0, 1.5, std::nan("")})
    EXPECT_THROW(unit_curve(sine, {{"c", {c}}}), machine::ValueError) << c;
  EXPECT_THROW(unit_curve(sine, {{"slope", {1.0}}}), machine::ValueError);
  EXPECT_THROW(unit_curve(*find_law("parabola"), {{"k", {1.0}}}), machine::ValueError);
  EXPECT_THROW(unit_curve(*find_law("polynomial"), {{"coefficients", {1.0, 1.0}}}), CamError);
  EXPECT_THROW(unit_curve(*find_law("polynomial")), machine::ValueError);
  EXPECT_THROW(unit_curve(*find_law("power_polynomial"), {{"powers", {4.0, 3.0}}}), CamError);
  EXPECT_THROW(unit_curve(*find_law("scca"), {{"sine", {0.6}}, {"constant", {0.6}}}), CamError);
}

}  // namespace
}  // namespace stiction::sim::cam
