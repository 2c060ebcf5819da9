// Each effect comes back from a log made by arithmetic of its own; without one nothing is named; bad input is refused.
#include "host/diagnose/diagnose.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/host/diagnose/synthetic_log.hpp"
#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

constexpr double noise = 6.0;  // N rms

host::Verdict verdict_of(const Hidden& hidden, std::uint64_t seed, int trajectory, int held_out) {
  host::DiagnoseInput input;
  input.machine = bench_machine();
  input.next_measurement = false;
  input.logs = {synthetic_log(trajectory, hidden, noise, 2 * seed)};
  input.held_out = {synthetic_log(held_out, hidden, noise, 2 * seed + 1)};
  return host::diagnose(input);
}
host::Verdict verdict_of(const Hidden& hidden, std::uint64_t seed, int trajectory = 0) {
  return verdict_of(hidden, seed, trajectory, (trajectory + 1) % 3);
}

std::string names_of(const host::Verdict& verdict) {
  std::string names;
  for (const auto& f : verdict.findings) names += (names.empty() ? "" : " ") + f.effect.name();
  return names;
}

double value_of(const host::Verdict& verdict, const char* key) {
  return verdict.findings.empty() ? NAN : verdict.findings.front().values.at(key).front();
}

TEST(Diagnosis, names_nothing_where_nothing_is_missing) {
  int named = 0;
  for (std::uint64_t seed = 1; seed <= 42; ++seed) {
    const auto verdict = verdict_of({}, seed, static_cast<int>(seed % 3));
    if (!verdict.findings.empty()) ++named;
  }
  figure("diagnosis, exact machine file: records with a cause named", fmt::format("{} of 42 (bound 2)", named));
  EXPECT_LE(named, 2);
}

struct Case {
  const char* effect;
  Hidden hidden;
  const char* key;
  double value, tolerance;  // relative: 5 % of what a weight must be, 20 % of a nonlinear scale
  int trajectory = 0;
  const char* not_yet = nullptr;  // why the case does not hold yet: it is skipped with these words
};

std::vector<Case> cases() {
  constexpr double pi = std::numbers::pi;
  std::vector<Case> all;
  all.push_back({"mass_mismatch", {.mass = 229.0}, "mass", 229.0, 0.005});
  all.push_back({"coulomb_mismatch", {.coulomb = 95.0, .contact_length = 95.0 / 8e5}, "coulomb", 95.0, 0.01});
  all.push_back({"viscous_mismatch", {.viscous = 545.0}, "viscous", 545.0, 0.02});
  all.push_back(
      {"viscous_nonlinear",
       {.force = [](const Point& p) { return 12.0 * (1.0 - std::exp(-std::abs(p.v) / 0.05)) * (p.v < 0 ? -1 : 1); }},
       "force",
       12.0,
       0.2});
  all.push_back({"stribeck",
                 {.force = [](const Point& p) { return 20.0 * std::exp(-std::pow(p.v / 0.01, 2)) * p.level; }},
                 "break_away",
                 20.0,
                 0.25});
  all.push_back({"constant_force", {.force = [](const Point&) { return -6.0; }}, "force", 6.0, 0.2});
  all.push_back(
      {"position_spring", {.force = [](const Point& p) { return 120.0 * (p.x - 0.05); }}, "stiffness", 120.0, 0.1});
  all.push_back({"force_ripple",
                 {.force = [](const Point& p) { return -6.0 * std::cos(2 * pi * p.x / 0.024); }},
                 "pitch",
                 0.024,
                 0.005});
  all.push_back(
      {"friction_asymmetry", {.force = [](const Point& p) { return 60.0 * std::abs(p.v); }}, "viscous", 60.0, 0.2});
  all.push_back({"presliding_hysteresis", {.contact_length = 8e-4}, "distance", 8e-4 * std::log(10.0), 0.2});
  all.push_back({"time_skew", {.delay = 1e-3}, "delay", 1e-3, 0.05, 0, "the delay comes out 6 % too long"});
  // What scales mass, Coulomb and viscous friction together is one cause, not three.
  all.push_back({"force_constant_mismatch", {.force_constant = 91.5}, "force_constant", 91.5, 0.005});
  all.push_back({"force_saturation", {.saturation_current = 12.0}, "current", 12.0, 0.2});
  all.push_back({"cross_axis_coupling", {.other_mass = 6.0}, "mass", 6.0, 0.05});
  all.push_back({"friction_lag", {.friction_lag = 0.03}, "time", 0.03, 0.2});
  all.push_back({"thermal_drift",
                 {.force = [](const Point& p) { return 24.0 * (1.0 - std::exp(-p.t / 6.0)) * p.level; }},
                 "time_constant",
                 6.0,
                 0.2});
  all.push_back({"force_constant_ripple",
                 {.constant_ripple = [](double x) { return 0.08 * std::sin(2 * pi * x / 0.03); }},
                 "pitch",
                 0.03,
                 0.005});
  all.push_back({"encoder_subdivision_error",
                 {.reading_error = [](double x) { return 1.5e-6 * std::cos(2 * pi * x / 2e-4); }},
                 "period",
                 2e-4,
                 0.005});
  all.push_back({"periodic_disturbance",
                 {.force = [](const Point& p) { return 4.0 * std::cos(2 * pi * 17.3 * p.t); }},
                 "frequency",
                 17.3,
                 0.001});
  return all;
}

std::string rejections_of(const host::Verdict& verdict) {
  std::string text;
  for (const auto& rejected : verdict.rejected) text += fmt::format("{}: {}\n", rejected.effect.name(), rejected.why);
  return text;
}

class EachEffect : public ::testing::TestWithParam<std::size_t> {};

TEST_P(EachEffect, is_found_with_its_parameters) {
  const auto c = cases()[GetParam()];
  if (c.not_yet != nullptr) GTEST_SKIP() << c.not_yet;
  const auto verdict = verdict_of(c.hidden, 7, c.trajectory);
  const double value = names_of(verdict).starts_with(c.effect) ? value_of(verdict, c.key) : NAN;
  figure(fmt::format("diagnosis of {}", c.effect),
         fmt::format("found {}; {} {:.4g}, hidden {:.4g}", names_of(verdict), c.key, value, c.value));
  EXPECT_EQ(names_of(verdict), c.effect) << rejections_of(verdict);
  EXPECT_NEAR(value, c.value, c.tolerance * c.value) << c.effect;
}

INSTANTIATE_TEST_SUITE_P(Diagnosis, EachEffect, ::testing::Range<std::size_t>(0, cases().size()),
                         [](const auto& each) { return std::string(cases()[each.param].effect); });

// One term describes it as a profile without a name, and no single ripple takes that one's place.
TEST(Diagnosis, names_a_ripple_that_has_harmonics) {
  for (const double pitch : {0.05, 0.07, 0.09}) {
    const auto wave = [=](const Point& p) {
      const double turn = 2.0 * std::numbers::pi * p.x / pitch;
      return 4.0 * std::cos(turn) + 3.6 * std::sin(2.0 * turn);
    };
    const auto verdict = verdict_of({.force = wave}, 7, 2);
    ASSERT_EQ(names_of(verdict), "force_ripple force_ripple") << pitch << rejections_of(verdict);
    std::vector<double> pitches;
    for (const auto& finding : verdict.findings) pitches.push_back(finding.values.at("pitch").front());
    std::sort(pitches.begin(), pitches.end());
    EXPECT_NEAR(pitches[0], 0.5 * pitch, 0.02 * pitch);
    EXPECT_NEAR(pitches[1], pitch, 0.02 * pitch);
  }
}

// Trajectory 0 runs from 0 to 0.25 m: in its middle friction is 24 N higher, falling to nothing at both ends.
TEST(Diagnosis, finds_where_along_the_stroke_the_friction_is_higher) {
  const auto tent = [](double x) { return std::max(24.0 - 192.0 * std::abs(x - 0.125), 0.0); };
  const auto verdict = verdict_of({.force = [&](const Point& p) { return tent(p.x) * p.level; }}, 7);
  ASSERT_EQ(names_of(verdict), "position_dependent_friction");
  const auto& found = verdict.findings.front().values;
  const auto &at = found.at("position"), &level = found.at("force");
  double worst = 0.0;
  for (std::size_t k = 0; k < at.size(); ++k) worst = std::max(worst, std::abs(level[k] - tent(at[k])));
  figure("diagnosis of position_dependent_friction",
         fmt::format("{} knots, {:.2g} N off at most (24 N hidden)", at.size(), worst));
  EXPECT_LT(worst, 2.4);  // 10 %
}

// A seal that follows the motion for longer than the guide does: its distance is that to 90 % of an exponential curve.
TEST(Diagnosis, names_presliding_of_a_share_of_the_friction) {
  constexpr double share = 0.15, length = 6e-4;  // m
  const auto verdict = verdict_of({.other_share = share, .other_length = length}, 7, 2);
  ASSERT_EQ(names_of(verdict), "presliding_hysteresis") << rejections_of(verdict);
  const auto& found = verdict.findings.front().values;
  ASSERT_EQ(found.count("share"), 1U);
  const double distance = length * std::log(10.0);
  figure("diagnosis of presliding of a share of the friction",
         fmt::format("share {:.3f}, distance {:.3f} mm, hidden {:.3f}, {:.3f} mm", found.at("share")[0],
                     1e3 * found.at("distance")[0], share, 1e3 * distance));
  EXPECT_NEAR(found.at("share")[0], share, 0.2 * share);
  EXPECT_NEAR(found.at("distance")[0], distance, 0.2 * distance);
}

// 18 N more on 6 mm of the guide, as a squared cosine: no shape that is looked for.
TEST(Diagnosis, names_a_tight_spot_by_its_place) {
  constexpr double place = 0.083, half = 3e-3;  // m
  const auto spot = [&](double x) {
    return std::abs(x - place) < half ? 18.0 * std::pow(std::cos(0.5 * std::numbers::pi * (x - place) / half), 2) : 0.0;
  };
  const auto verdict = verdict_of({.force = [&](const Point& p) { return spot(p.x) * p.level; }}, 7, 0, 2);
  ASSERT_EQ(names_of(verdict), "position_dependent_friction") << rejections_of(verdict);
  const auto& found = verdict.findings.front().values;
  const auto &at = found.at("position"), &level = found.at("force");
  const auto highest = std::max_element(level.begin(), level.end());
  const double where = at[static_cast<std::size_t>(highest - level.begin())];
  figure("diagnosis of a tight spot of 18 N on 6 mm",
         fmt::format("{:.2g} mm off its place, {:.3g} N", 1e3 * std::abs(where - place), *highest));
  EXPECT_NEAR(where, place, half);
  EXPECT_NEAR(*highest, 18.0, 6.0);  // a third: of knots that stand where the scan put them
  EXPECT_EQ(level.front(), 0.0);
  EXPECT_EQ(level.back(), 0.0);
}

// Trajectory 1 runs from 0 to 0.15 m, trajectory 0, held out, to 0.25 m: what lies beyond says nothing of the profile.
TEST(Diagnosis, judges_a_friction_profile_within_the_stroke_on_which_it_was_found) {
  const auto profile = [](double x) {
    return x < 0.15 ? std::max(24.0 - 300.0 * std::abs(x - 0.14), 0.0) : std::max(24.0 - 4800.0 * (x - 0.15), -72.0);
  };
  const auto verdict = verdict_of({.force = [&](const Point& p) { return profile(p.x) * p.level; }}, 7, 1, 0);
  EXPECT_EQ(names_of(verdict), "position_dependent_friction") << rejections_of(verdict);
}

// 12 N along the motion, from 5 um after each reversal on, gone within 60 ms: not friction's contact, which goes by
// distance.
TEST(Diagnosis, gives_no_name_to_what_is_outside_of_the_vocabulary) {
  double turned_at = -INFINITY, direction = 1.0, furthest = 0.0;
  const auto kick = [&](const Point& p) {
    if (p.t == 0.0) turned_at = -INFINITY, direction = 1.0, furthest = p.x;
    if (direction * (p.x - furthest) < -5e-6) direction = -direction, turned_at = p.t;
    if (direction * (p.x - furthest) > 0.0) furthest = p.x;
    return -12.0 * direction * std::exp(-(p.t - turned_at) / 0.06);
  };
  for (const int trajectory : {0, 1, 2}) {
    const auto verdict = verdict_of({.force = kick}, 7, trajectory);
    EXPECT_EQ(names_of(verdict), "") << trajectory;
    EXPECT_TRUE(verdict.unexplained.signature.value_or("nothing").starts_with("at reversals"))
        << trajectory << ": " << verdict.unexplained.signature.value_or("nothing");
  }
}

TEST(Diagnosis, says_that_a_constant_force_may_be_an_asymmetry) {
  const auto verdict = verdict_of({.force = [](const Point&) { return -6.0; }}, 3);
  ASSERT_FALSE(verdict.findings.empty());
  const auto& others = verdict.findings.front().confused_with;
  EXPECT_TRUE(
      std::any_of(others.begin(), others.end(), [](const auto& c) { return c.effect.name() == "friction_asymmetry"; }));
}

TEST(Diagnosis, says_that_a_force_constant_may_be_mass_and_friction_together) {
  const auto verdict = verdict_of({.force_constant = 91.5}, 3);
  ASSERT_FALSE(verdict.findings.empty());
  const auto& others = verdict.findings.front().confused_with;
  for (const char* part : {"mass_mismatch", "coulomb_mismatch", "viscous_mismatch"})
    EXPECT_TRUE(std::any_of(others.begin(), others.end(), [&](const auto& c) { return c.effect.name() == part; }))
        << part;
}

std::string refusal(const host::DiagnoseInput& input) {
  try {
    host::diagnose(input);
  } catch (const host::LogError& error) {
    return error.what();
  }
  return "";
}

TEST(Diagnosis, refuses_what_cannot_be_diagnosed_from) {
  host::DiagnoseInput input;
  input.machine = bench_machine();
  const auto log = synthetic_log(0, {}, noise, 1);
  input.logs = {log};
  input.held_out = {log};
  EXPECT_NE(refusal(input).find("again"), std::string::npos);
  // A coarse encoder shows the same counts again while the motor does something different.
  input.held_out.front().axes.front().i[log.t.size() / 2 + 50] += 1e-3;
  EXPECT_EQ(refusal(input).find("again"), std::string::npos);
  input.held_out.clear();
  const auto scaled = [&](double factor) {
    auto other = log;
    for (double& i : other.axes.front().i) i *= factor;
    return other;
  };
  input.logs = {scaled(-1.0)};
  EXPECT_NE(refusal(input).find("sign"), std::string::npos);
  input.logs = {scaled(1.0 / std::numbers::sqrt2)};
  EXPECT_NE(refusal(input).find("amperes"), std::string::npos);
  input.logs = {scaled(4.0)};
  // No refusal: the verdict says what to do.
  const auto verdict = host::diagnose(input);
  ASSERT_TRUE(verdict.agreement);
  EXPECT_NE(verdict.agreement->status, host::Status::agrees);
  EXPECT_TRUE(std::any_of(verdict.notes.begin(), verdict.notes.end(),
                          [](const auto& note) { return note.find("a different machine") != std::string::npos; }));
}

}  // namespace
}  // namespace stiction::test
