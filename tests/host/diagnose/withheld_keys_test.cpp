// Which keys of what was found are not written, because the machine would follow worse with them.
#include "host/diagnose/judge/withheld_keys.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "sim/effects/effect_values.hpp"
#include "sim/effects/effects.hpp"
#include "sim/effects/mass_mismatch/mass_mismatch.hpp"
#include "sim/effects/viscous_mismatch/viscous_mismatch.hpp"
#include "tests/host/diagnose/dwelling_record.hpp"

namespace stiction::host {
namespace {

template <class Effect>
Finding found(const typename Effect::Parameters& keys) {
  const auto effect = sim::effect_of<Effect>(keys);
  Finding finding(sim::id_of<Effect>());
  finding.axis = "X";
  finding.values = effect.values;
  return finding;
}

// White noise of 1 N rms, in rows of 4 ms.
Disturbance noise() {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  const Eigen::VectorXd residual = Eigen::VectorXd::NullaryExpr(1500, [&] { return normal(random); });
  const std::array<std::size_t, 1> logs{0};
  return {residual, logs, 4e-3};
}

// Held-out strokes of a machine that is 3 % heavier than its file says, under a draw of the noise.
struct HeavierMachine {
  HeavierMachine() {
    const Finding heavier = found<sim::MassMismatch>({.mass = mass});
    measured = *positions_under(noise(), extended_setup(setup, {heavier}), 77);
  }

  const machine::Machine file = test::rigid_machine();
  const ReplaySetup setup = replay_setup_of(file, 0, {test::dwelling("strokes", 0.2, 0.5)});
  const double mass = 1.03 * file.axes.front().mass;
  Positions measured;
};

TEST(WithheldKeys, NoneOfACauseThatIsThere) {
  const HeavierMachine heavier;
  std::vector<Finding> findings{found<sim::MassMismatch>({.mass = heavier.mass})};
  withhold_what_follows_worse(findings, heavier.setup, heavier.measured, noise());
  EXPECT_EQ(findings[0].withheld, "");
}

TEST(WithheldKeys, ThoseOfACauseThatIsNotThereAndNoOthers) {
  const HeavierMachine heavier;
  const double viscous = sim::viscous_of(heavier.file.axes.front().friction);
  std::vector<Finding> findings{found<sim::MassMismatch>({.mass = heavier.mass}),
                                found<sim::ViscousMismatch>({.viscous = 3.0 * viscous})};
  withhold_what_follows_worse(findings, heavier.setup, heavier.measured, noise());
  EXPECT_EQ(findings[0].withheld, "");
  EXPECT_NE(findings[1].withheld.find("times as far off the held-out positions as without them"), std::string::npos)
      << findings[1].withheld;
}

// The other way than the machine is off, by as much: twice the error.
TEST(WithheldKeys, ThoseOfACauseOfTheWrongSign) {
  const HeavierMachine heavier;
  std::vector<Finding> findings{found<sim::MassMismatch>({.mass = 0.97 * heavier.file.axes.front().mass})};
  withhold_what_follows_worse(findings, heavier.setup, heavier.measured, noise());
  EXPECT_NE(findings[0].withheld.find("as the file's"), std::string::npos) << findings[0].withheld;
}

TEST(WithheldKeys, NoneOfACauseThatIsTooSmallToMatter) {
  const HeavierMachine heavier;
  std::vector<Finding> findings{found<sim::MassMismatch>({.mass = 0.9999 * heavier.file.axes.front().mass})};
  withhold_what_follows_worse(findings, heavier.setup, heavier.measured, noise());
  EXPECT_EQ(findings[0].withheld, "");
}

}  // namespace
}  // namespace stiction::host
