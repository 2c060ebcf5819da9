// `stiction cam shape`, `tune-cam` and the models of `simulate cam` as their users call them.
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <sstream>

#include "tests/host/cli/program.hpp"
#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

class CamVibrationCli : public Cli {
 protected:
  static std::string stand() {
    return "'" + (fs::path(STICTION_SOURCE_DIR) / "examples/cams/stand.toml").string() + "'";
  }
  static std::string on_stand(const std::string& command) { return command + " --machine cam-stand --speed '130 rpm'"; }
  // Next to the folder in which the command runs, so that a refused one has written nothing there.
  std::string written(const std::string& name, const std::string& text) {
    std::ofstream(work().parent_path() / name) << text;
    return "../" + name;
  }
  // The log `from`, with `change` made of the numbers of each line, into a file of this `name` next to it. `change`:
  // takes time, current, load and master, by their places below, and says whether the line stays.
  enum Channel { time, current, load, master, channels };
  std::string changed(const std::string& from, const std::string& name,
                      const std::function<bool(std::array<double, channels>&)>& change) {
    const char* const names[] = {"t[", "L.i[", "L.x_load[", "L.master["};
    std::ifstream in(work() / from);
    std::string text, line;
    std::array<std::size_t, channels> places{};
    bool head = true;
    while (std::getline(in, line)) {
      if (line.starts_with('#') || line.empty()) {
        text += line + '\n';
        continue;
      }
      std::vector<std::string> cells;
      std::istringstream split(line);
      for (std::string cell; std::getline(split, cell, ',');) cells.push_back(cell);
      if (head) {
        for (std::size_t c = 0; c < channels; ++c)
          for (std::size_t k = 0; k < cells.size(); ++k)
            if (cells[k].starts_with(names[c])) places[c] = k;
        head = false;
      } else {
        std::array<double, channels> values{};
        for (std::size_t c = 0; c < channels; ++c) values[c] = std::stod(cells[places[c]]);
        if (!change(values)) continue;
        for (std::size_t c = 0; c < channels; ++c) cells[places[c]] = fmt::format("{}", values[c]);
      }
      for (std::size_t k = 0; k < cells.size(); ++k) text += (k > 0 ? "," : "") + cells[k];
      text += '\n';
    }
    return written(name, text);
  }
};

// A rise that the drive follows, whose acceleration does not jump.
constexpr const char* smooth_rise = R"(schema = "stiction.cam/1"
[cam.smooth]
cycle = "360 deg"
slave = "rotary"
modulo = "30 deg"
[[cam.smooth.segment]]
length = "180 deg"
stroke = "30 deg"
law = "polynomial_3_4_5"
[[cam.smooth.segment]]
end = "360 deg"
)";

constexpr const char* short_rise = R"(schema = "stiction.cam/1"
[cam.short]
cycle = "360 deg"
modulo = "30 deg"
[[cam.short.segment]]
length = "120 deg"
stroke = "30 deg"
law = "parabola"
[[cam.short.segment]]
end = "360 deg"
)";

TEST_F(CamVibrationCli, ShapesAMotionByTheMethodsThatWereNamed) {
  const auto done = stiction(on_stand("cam shape " + stand() + " --method zvd,none --out ../shapes --json"));
  ASSERT_EQ(done.code, 0) << done.error;
  const auto results = nlohmann::json::parse(done.out)["results"];
  EXPECT_NEAR(results["residual_at_100_percent_none_deg"].get<double>(), 1.645, 0.01);
  EXPECT_NEAR(results["residual_at_80_percent_zvd_deg"].get<double>(), 0.063, 0.003);
  EXPECT_FALSE(results.contains("residual_worst_pulse_deg"));
  EXPECT_EQ(stiction("cam check ../shapes/zvd.toml --machine cam-stand --speed '130 rpm'").code, 0);
}

TEST_F(CamVibrationCli, SaysBeforehandThatNoTuningCanHelp) {
  const auto done = stiction(on_stand("cam shape " + written("short.toml", short_rise) + " --method none"));
  ASSERT_EQ(done.code, 0) << done.error;
  EXPECT_NE(done.out.find("0.03 ° is impossible; the shortest rise that makes it possible takes"), std::string::npos)
      << done.out;
}

TEST_F(CamVibrationCli, RefusesWhatCannotBeShaped) {
  expect_refused(on_stand("cam shape " + stand() + " --method zvx"), "--method: found 'zvx'; expected a method: none");
  expect_refused(on_stand("cam shape " + stand() + " --band '80 %'"), "--band: found '80 %'; expected more than 0");
  expect_refused("cam shape " + stand() + " --machine servo-joint --speed '20 rpm'",
                 "found no transmission.stiffness; expected it");
}

// The drive follows no parabola; what it would do along one is asked of the model.
TEST_F(CamVibrationCli, SaysHowAMotionThatTheDriveRefusesIsSimulated) {
  const auto simulate = on_stand("simulate cam --cam " + stand());
  expect_refused(simulate, "`stiction cam check` shows their places, and --model cascade simulates");
  EXPECT_EQ(stiction(simulate + " --model cascade --cycles 1").code, 0);
}

TEST_F(CamVibrationCli, VerifiesTheStudysCaseAndSaysWhatItsPrintLacks) {
  const auto done = stiction("simulate cam --machine cam-stand --verification --json");
  ASSERT_EQ(done.code, 0) << done.error;
  const auto document = nlohmann::json::parse(done.out);
  for (const char* model : {"transfer_function", "lagrange"}) {
    const auto figure = [&](const std::string& name, const std::string& unit) {
      return document["results"][name + "_" + model + "_" + unit].get<double>();
    };
    EXPECT_NEAR(figure("highest", "deg"), 69.0698, 0.07);
    EXPECT_NEAR(figure("highest_at", "deg"), 93.79, 0.1);
    EXPECT_NEAR(figure("peak_to_peak", "deg"), 1.7484, 0.0018);
    EXPECT_NEAR(figure("highest_speed", "deg_per_s"), 456.95, 0.46);
    EXPECT_NEAR(figure("lowest_acceleration", "deg_per_s2"), -10304.5, 10.4);
  }
  EXPECT_NE(done.out.find("lacks the gear's 1/33"), std::string::npos);
  expect_refused("simulate cam --machine cam-stand", "--cam");
  expect_refused(on_stand("simulate cam --verification"), "--verification: found it with --cam or --speed");
}

TEST_F(CamVibrationCli, TunesFromLogsAsFromSimulatedCycles) {
  ASSERT_EQ(stiction(on_stand("simulate cam --cam " + stand() + " --model cascade --cycles 1 --log ../one.csv")).code,
            0);
  const auto first = stiction(on_stand("tune-cam ../one.csv --cam " + stand() + " --out ../tuned --json"));
  ASSERT_EQ(first.code, 0) << first.error;
  const auto results = nlohmann::json::parse(first.out)["results"];
  EXPECT_NEAR(results["frequency_Hz"].get<double>(), 14.48, 0.03);
  // The delay of the shipped encoder.
  EXPECT_NEAR(results["delay_ms"].get<double>(), 3.363, 0.3);
  const auto second = stiction(on_stand("simulate cam --cam ../tuned/tuned.toml --model cascade --cycles 1 --json"));
  ASSERT_EQ(second.code, 0) << second.error;
  EXPECT_LE(nlohmann::json::parse(second.out)["results"]["quality_cascade_deg_deg"].get<double>(), 1.56);
}

TEST_F(CamVibrationCli, TunesFromQualityNumbersAlone) {
  const auto tune = on_stand("tune-cam --cam " + stand() + " --feedback number");
  const auto simulated = stiction(tune + " --json");
  ASSERT_EQ(simulated.code, 0) << simulated.error;
  const auto results = nlohmann::json::parse(simulated.out)["results"];
  EXPECT_FALSE(results.contains("quality_cycle_8_deg_deg"));
  EXPECT_LE(results["quality_cycle_7_deg_deg"].get<double>(), 2.0);
  // Of a real machine each call has one number more, and writes the motion of the next cycle.
  const auto asked = stiction(tune + " --number 84.5 --out ../next");
  ASSERT_EQ(asked.code, 0) << asked.error;
  EXPECT_NE(asked.out.find("its number is wanted next"), std::string::npos);
  EXPECT_EQ(stiction("cam check ../next/tuned.toml --machine cam-stand --speed '130 rpm'").code, 0);
  const auto simplex = stiction(tune + " --search nelder-mead --json");
  ASSERT_EQ(simplex.code, 0) << simplex.error;
  EXPECT_TRUE(nlohmann::json::parse(simplex.out)["results"].contains("pulse_1_at_deg"));
}

TEST_F(CamVibrationCli, TunesAMachineThatRunsOn) {
  const auto tune = on_stand("tune-cam --cam " + stand() + " --running");
  const auto done = stiction(tune + " --out ../running --json");
  ASSERT_EQ(done.code, 0) << done.error;
  const auto results = nlohmann::json::parse(done.out)["results"];
  EXPECT_GE(results["quality_cycle_1_deg_deg"].get<double>(), 30.0);
  EXPECT_LE(results["quality_cycle_2_deg_deg"].get<double>(), 1.0);
  EXPECT_EQ(stiction("cam check ../running/steady.toml --machine cam-stand --speed '130 rpm'").code, 0);
  expect_refused(tune + " --feedback number", "--running: found it with --feedback number");
}

TEST_F(CamVibrationCli, RefusesFeedbackThatDoesNotFit) {
  const auto tune = on_stand("tune-cam --cam " + stand());
  expect_refused(tune + " --number 84.5", "--number: found it with --feedback record");
  expect_refused(tune + " --search halving", "--search: found it with --feedback record");
  expect_refused(tune + " --feedback number --number=-1", "--number: found -1; expected an area, 0 or more");
}

TEST_F(CamVibrationCli, RefusesLogsThatCannotBeTunedFrom) {
  ASSERT_EQ(stiction(on_stand("simulate cam --cam " + stand() + " --model cascade --cycles 1 --log ../one.csv")).code,
            0);
  const auto other = written("short.toml", short_rise);
  expect_refused(on_stand("tune-cam ../one.csv --cam " + other), "expected a log of this motion");
  expect_refused("tune-cam --machine servo-joint --speed '20 rpm' --cam " + stand(),
                 "found axis J without a second encoder on the load");
}

TEST_F(CamVibrationCli, SaysWhatALogLacksThatCannotBeTunedFrom) {
  ASSERT_EQ(stiction(on_stand("simulate cam --cam " + stand() + " --model cascade --cycles 1 --log ../one.csv")).code,
            0);
  using Values = std::array<double, channels>;
  const auto tune = [&](const std::string& log) { return on_stand("tune-cam " + log + " --cam " + stand()); };
  constexpr double rise = 0.5 * 60.0 / 130.0;  // s
  const auto refused = [&](const std::string& name, const std::string& reason, const auto& change) {
    const std::string log = changed("../one.csv", name, change);
    expect_refused(tune(log), name + ": found " + reason);
  };
  refused("short.csv", "a dwell of 0.0 ms behind the drive's lag; expected a period of the load or more",
          [](Values& at) { return at[time] < 1.05 * rise; });
  refused("moving.csv", "a load that still moves by", [](Values& at) { return at[load] += 0.3 * at[time], true; });
  refused("near.csv", "two modes at about 14.48 and 18.01 Hz, which a dwell of 167 ms does not tell apart",
          [](Values& at) {
            const double t = at[time] - rise;
            if (t > 0.0) at[load] += 0.008 * std::exp(-1.2 * t) * std::sin(2.0 * std::numbers::pi * 18.0 * t);
            return true;
          });
  // Nearer, where even that there are two is not seen but by their beat, while it rises.
  refused("beat.csv", "a vibration at about 14.38 Hz that grows in the dwell", [](Values& at) {
    const double t = at[time] - rise;
    if (t > 0.0) at[load] -= 0.008 * std::exp(-1.2 * t) * std::cos(2.0 * std::numbers::pi * 16.2 * t);
    return true;
  });
  refused("stopped.csv", "a master that stops at", [](Values& at) {
    // For 100 ms from the first third on.
    const double stop = 0.6 * rise, turned = at[master] / at[time];
    if (at[time] > stop) at[master] = turned * std::max(stop, at[time] - 0.1);
    return true;
  });
  refused("end.csv", "an encoder at the load that stays where it is",
          [](Values& at) { return at[load] = std::min(at[load], 0.25), true; });
  refused("cut.csv", "an encoder at the load that goes no further than",
          [](Values& at) { return at[load] = std::min(at[load], 0.5235), true; });
  refused("torque.csv", "a current of", [](Values& at) { return at[current] *= 100.0, true; });
  // The master's speed is what frequencies are counted by.
  expect_refused("tune-cam ../one.csv --machine cam-stand --speed '100 rpm' --cam " + stand(),
                 "found a master that turns at 780 °/s; expected the 600 °/s of --speed");
  expect_refused("tune-cam ../one.csv --machine cam-stand --speed '600 rpm' --cam " + stand(),
                 "found a rise of 0.72 periods of the load; expected 0.75 or more");
}

// Logs of the test rig that runs along a cam, with one cause each that the machine file does not know.
TEST_F(CamVibrationCli, FindsInertiaAndDelayBehindTheMasterInLogsOfACam) {
  const std::string cam = written("smooth.toml", smooth_rise);
  std::ifstream in(fs::path(STICTION_SOURCE_DIR) / "firmware/machine/shipped/cam-stand.toml");
  const std::string shipped{std::istreambuf_iterator<char>(in), {}};
  const std::string late =
      written("late.toml", shipped + "\n  [[axis.L.effect]]\n  name = \"master_delay\"\n  delay = \"300 us\"\n");
  // The value behind `key` of the only finding.
  const auto found = [&](const std::string& machine, const std::string& cause, const std::string& key) {
    const auto run = stiction("simulate cam --machine " + machine + " --cam " + cam +
                              " --speed '130 rpm' --cycles 12 --log ../cause.csv");
    EXPECT_EQ(run.code, 0) << run.error;
    const auto said = stiction("diagnose ../cause.csv --machine cam-stand");
    EXPECT_NE(said.out.find("\n1. " + cause + ", axis L"), std::string::npos) << said.out << said.error;
    EXPECT_EQ(said.out.find("\n2. "), std::string::npos) << said.out;
    const std::size_t at = said.out.find(key + " = ");
    return at == std::string::npos ? 0.0 : std::stod(said.out.substr(at + key.size() + 3));
  };
  const double delay = found(late, "master_delay", "delay_s");
  EXPECT_NEAR(delay, 300e-6, 20e-6);
  // A tenth more at the motor: 33 times 33 of it and the flywheel are at the output.
  constexpr double motor = 0.00882844, whole = 33.0 * 33.0 * motor + 0.1035711;
  const double inertia = found(fmt::format("cam-stand --set 'axis.L.transmission.motor_inertia={} kg m^2'", motor),
                               "mass_mismatch", "mass_kg_m2");
  EXPECT_NEAR(inertia, whole, 0.03 * whole);
  fmt::print(
      "cam-stand, logs of a cam: delay behind the master {:.2f} us off (bound 20 us), inertia {:.3f} % (bound 3 %)\n",
      1e6 * std::fabs(delay - 300e-6), 100.0 * std::fabs(inertia / whole - 1.0));
}

}  // namespace
}  // namespace stiction::test
