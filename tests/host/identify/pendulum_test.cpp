// The measured pendulum servo (Rhoban/bam; shared/data/xl330), where its records are: inertia and moment of gravity
// against the published values, and the simulated position of records that took no part. The file is that of
// `machine new` from its data sheet, with the weight and the controller that are published with it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "firmware/machine/configuration/double_signals.hpp"
#include "host/identify/identification.hpp"
#include "host/identify/identified_machine.hpp"
#include "host/identify/own_identification.hpp"
#include "host/log/read_log.hpp"
#include "host/log/stretches.hpp"
#include "host/sheet/machine_text.hpp"
#include "host/simulate/replay.hpp"
#include "sim/machine_file.hpp"
#include "tests/support/figure.hpp"

namespace stiction::host {
namespace {

const std::filesystem::path folder = std::filesystem::path(STICTION_SOURCE_DIR) / ".." / "shared" / "data" / "xl330";
constexpr double constant = 0.3867 / 4.017;  // N m/V
constexpr double published_inertia = 0.49 * 0.1 * 0.1 + 0.001814, published_gravity = 0.49 * 9.80665 * 0.1;
constexpr double published_coulomb = 0.0128, published_viscous = 0.3867 * 0.3867 / 4.017 + 0.00366;

std::vector<Log> records(int gain) {
  std::vector<Log> logs;
  for (const char* motion : {"sin_sin", "up_and_down", "sin_time_square", "lift_and_drop"})
    for (auto& stretch : stretches_of(read_log(folder / fmt::format("k{}_{}.csv", gain, motion))))
      logs.push_back(std::move(stretch));
  return logs;
}

// The file of `machine new`, of its flags; the controller of a servo at this gain in its own units.
std::string machine_of(int gain) {
  const SheetAnswers answers{{"name", "Pendulum servo"},
                             {"axis", "J"},
                             {"kind", "rotary"},
                             {"motor", "force"},
                             {"transmission", "direct"},
                             {"load", "0.0049 kg m^2"},
                             {"travel", "360 deg"},
                             {"max-velocity", "20 rad/s"},
                             {"max-acceleration", "500 rad/s^2"},
                             {"torque-constant", fmt::format("{:.6g} N m/V", constant)},
                             {"supply", "7.4 V"},
                             {"counts", "4096"}};
  LogMarks marks;
  marks.moment = MarkedValue{published_gravity, "0.49 kg at 0.1 m"};
  auto text = machine_text(answers, "machine new", marks);
  const std::string unknown = "structure = \"unknown\"";
  const auto at = text.find(unknown);
  EXPECT_NE(at, std::string::npos) << text;
  const double volts = gain * 651.9 / (256.0 * 885.0) * 7.4;
  text.replace(at, unknown.size(),
               fmt::format("structure = \"p-voltage\"\n  gain = \"{:.6g} V/rad\"\n  supply = \"7.4 V\"", volts));
  return text;
}

struct Trained {
  Identification result;
  std::filesystem::path file;  // identified.toml
};

Trained train(const std::vector<Log>& logs, const std::string& name) {
  const auto place = std::filesystem::path(testing::TempDir()) / name;
  std::filesystem::create_directories(place);
  const auto file = place / "machine.toml";
  std::ofstream(file) << machine_of(100);
  const auto axis = sim::read_machine(file).axes.at(0);
  const IdentifyOptions options{"coulomb_viscous", Amperes::amplitude, FitSettings{}, true, {}};
  const auto linear = identify_logs(linear_logs(logs, axis), axis, options);
  std::ofstream(place / "identified.toml") << identified_machine(file, {}, axis, linear, "identify");
  return {in_own_units(linear, axis), place / "identified.toml"};
}

double off(const Identification& result, const char* name, double published) {
  const auto* found = result.find(name);
  EXPECT_NE(found, nullptr) << name;
  return found == nullptr ? NAN : found->value / published - 1.0;
}

void print(const Trained& trained) {
  for (const auto& [name, published] : {std::pair{"inertia_kg_m2", published_inertia},
                                        {"gravity_moment_N_m", published_gravity},
                                        {"viscous_N_m_s_per_rad", published_viscous},
                                        {"coulomb_N_m", published_coulomb}})
    if (const auto* found = trained.result.find(name))
      fmt::print("  {} {:.4g} (95 % {:.4g} to {:.4g}), published {:.4g}: {:+.1f} %\n", name, found->value,
                 found->ci95.low, found->ci95.high, published, 100.0 * (found->value / published - 1.0));
  if (const auto* found = trained.result.find("load_coefficient"))
    fmt::print("  load_coefficient {:.3g} (95 % {:.3g} to {:.3g})\n", found->value, found->ci95.low, found->ci95.high);
  fmt::print("  residual {:.4g} of {:.4g} N m, band {:g} Hz\n", trained.result.residual_rms, trained.result.force_rms,
             trained.result.band->best().cutoff);
  for (const auto& open : trained.result.not_determined) fmt::print("  {}: {}\n", open.name, open.why);
  for (const auto& note : trained.result.notes) fmt::print("  {}\n", note);
}

// Prints how far off a value is, and holds it to `bound`.
void expect_near(const Trained& trained, const char* gains, const char* name, const char* key, double published,
                 double bound) {
  const double share = off(trained.result, key, published);
  test::figure(fmt::format("pendulum servo, gain {}: {}", gains, name),
               fmt::format("{:+.1f} % of the published (bound {:.0f} %)", 100.0 * share, 100.0 * bound));
  EXPECT_LT(std::abs(share), bound);
}

class Pendulum : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not here";
  }
};

TEST_F(Pendulum, GainsOf100And200GiveInertiaAndGravity) {
  auto logs = records(100);
  for (auto& log : records(200)) logs.push_back(std::move(log));
  const auto trained = train(logs, "gains-100-200");
  print(trained);
  expect_near(trained, "100 and 200", "inertia", "inertia_kg_m2", published_inertia, 0.10);
  expect_near(trained, "100 and 200", "moment of gravity", "gravity_moment_N_m", published_gravity, 0.06);
}

TEST_F(Pendulum, Gain800GivesThemRoughlyAndSaysWhatSpoilsThem) {
  const auto trained = train(records(800), "gain-800");
  print(trained);
  expect_near(trained, "800", "inertia", "inertia_kg_m2", published_inertia, 0.20);
  expect_near(trained, "800", "moment of gravity", "gravity_moment_N_m", published_gravity, 0.20);
  std::string notes;
  for (const auto& note : trained.result.notes) notes += note + "\n";
  EXPECT_NE(notes.find("the voltage is at its limit"), std::string::npos) << notes;
  EXPECT_NE(notes.find("rises with the load"), std::string::npos) << notes;
}

// Trained on gain 200 alone: no record of gain 100 is in it.
TEST_F(Pendulum, ASimulationFromGain200FollowsThoseOfGain100) {
  const auto trained = train(records(200), "gain-200");
  print(trained);
  const auto machine = sim::read_machine(trained.file);
  double sum = 0.0;
  std::size_t count = 0;
  for (const auto& log : records(100)) {
    if (log.source.ends_with("segment 2 of 2")) continue;  // the drive is off
    const auto simulated = replay<machine::DoubleSignals>(machine, log);
    double square = 0.0;
    for (std::size_t k = 0; k < log.t.size(); ++k)
      square += std::pow(simulated.axes.at(0).x[k] - log.axes.at(0).x[k], 2);
    fmt::print("  {}: {:.1f} mrad rms\n", std::filesystem::path(log.source).filename().string(),
               1e3 * std::sqrt(square / static_cast<double>(log.t.size())));
    sum += square;
    count += log.t.size();
  }
  const double together = std::sqrt(sum / static_cast<double>(count));
  test::figure("pendulum servo, gain 100 simulated from gain 200: position",
               fmt::format("{:.1f} mrad rms (published, Coulomb and viscous: 34.8; bound 38)", 1e3 * together));
  EXPECT_LE(together, 38e-3);
}

}  // namespace
}  // namespace stiction::host
