// A recorded speed in the place of a coarse position's derivative, and one that is not the position's. The truth is
// Newton's law of a mass on two sines, not the product's simulation.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "host/identify/identification.hpp"
#include "tests/host/identify/campaign.hpp"
#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

constexpr double mass = 180.0, viscous = 400.0, coulomb = 70.0;  // kg, N s/m, N
constexpr double increment = 1e-4;                               // m, of the encoder

struct Recorder {
  double late = 0.0;   // s
  double scale = 1.0;  // of the recorded speed
  bool speed = true;
};

host::Log recorded(const Recorder& recorder) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  const auto x = [](double t) { return 0.08 * std::sin(2.1 * t) + 0.01 * std::sin(17.0 * t); };
  const auto v = [](double t) { return 0.168 * std::cos(2.1 * t) + 0.17 * std::cos(17.0 * t); };
  const auto a = [](double t) { return -0.3528 * std::sin(2.1 * t) - 2.89 * std::sin(17.0 * t); };
  host::Log log;
  log.source = "two sines";
  log.period = 1e-3;
  auto& axis = log.axes.emplace_back();
  for (int k = 0; k < 30000; ++k) {
    const double t = k * 1e-3;
    log.t.push_back(t);
    axis.x.push_back(increment * std::round(x(t) / increment));
    if (recorder.speed) axis.v.push_back(recorder.scale * v(t - recorder.late) + 2e-4 * normal(random));
    axis.force.push_back(mass * a(t) + viscous * v(t) + std::copysign(coulomb, v(t)) + 2.0 * normal(random));
  }
  return log;
}

host::Identification identified(const Recorder& recorder) {
  const auto machine = bench_machine("coulomb_viscous");
  return host::identify_logs({recorded(recorder)}, machine.axes.front(),
                             {"coulomb_viscous", host::Amperes::amplitude, {}, true});
}

std::string notes_of(const host::Identification& result) {
  std::string all;
  for (const auto& note : result.notes) all += note + "\n";
  return all;
}

double width_of(const host::Identification& result, const char* name) {
  const auto* p = result.find(name);
  return p == nullptr ? 1e300 : p->ci95.high - p->ci95.low;
}

TEST(RecordedSpeed, NarrowsWhatACoarseEncoderLeavesOpen) {
  const auto with = identified({}), without = identified({.late = 0.0, .scale = 1.0, .speed = false});
  EXPECT_NE(notes_of(with).find("those of the recorded v"), std::string::npos) << notes_of(with);
  figure("identification, encoder of 0.1 mm: interval of the mass with a recorded speed over that without",
         fmt::format("{:.3f} (bound 1)", width_of(with, "mass_kg") / width_of(without, "mass_kg")));
  EXPECT_LT(width_of(with, "mass_kg"), width_of(without, "mass_kg"));
  for (const auto& [name, truth] :
       {std::pair{"mass_kg", mass}, std::pair{"viscous_N_s_per_m", viscous}, std::pair{"coulomb_N", coulomb}}) {
    const auto* p = with.find(name);
    ASSERT_NE(p, nullptr) << name;
    EXPECT_LE(p->ci95.low, truth) << name;
    EXPECT_GE(p->ci95.high, truth) << name;
  }
}

TEST(RecordedSpeed, ThatIsLateOrScaledIsNotUsedAndSaidSo) {
  const auto late = identified({.late = 5e-3, .scale = 1.0, .speed = true});
  EXPECT_NE(notes_of(late).find("ms after the position's"), std::string::npos) << notes_of(late);
  const auto scaled = identified({.late = 0.0, .scale = 1.03, .speed = true});
  EXPECT_NE(notes_of(scaled).find("not used: it is 1.03 +- "), std::string::npos) << notes_of(scaled);
}

}  // namespace
}  // namespace stiction::test
