// Logs of an electronic cam: a motion that repeats, begins in the middle of itself, and shares the encoder's places
// with the simulation of its machine file.
#include <gtest/gtest.h>

#include <filesystem>
#include <numbers>
#include <string>

#include "host/diagnose/diagnose.hpp"
#include "host/diagnose/verdict/verdict_json.hpp"
#include "host/simulate/cam_run.hpp"
#include "sim/cam/motion.hpp"
#include "sim/cam/motion_file.hpp"
#include "sim/machine_file.hpp"

namespace stiction::host {
namespace {

const std::filesystem::path source = STICTION_SOURCE_DIR;

// Every fourth tick of `cycles` that are measured, at `turns` of the master in a minute.
Log cam_log(const machine::Machine& joint, double turns, int cycles) {
  const auto cam = sim::cam::read_motion_file(source / "examples/cams/indexing.toml").front();
  CamRunSettings settings;
  settings.master_speed = turns * 2.0 * std::numbers::pi / 60.0;
  settings.cycles = cycles;
  const auto run = run_cam<FixedSignals>(joint, sim::cam::compose(cam), settings);
  constexpr std::size_t every = 4;
  Log log = run.log;
  log.source = std::to_string(static_cast<int>(turns)) + " in a minute";
  log.period *= every;
  const auto thin = [&](std::vector<double>& values) {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < values.size(); k += every) values[kept++] = values[k];
    values.resize(kept);
  };
  thin(log.t);
  for (auto& axis : log.axes)
    for (const auto& channel : log_channels) thin(axis.*channel.values);
  return log;
}

// The simulation begins with the record and hunts as it does for a while: columns of that motion had a part of the
// record's own hunting, which looked like an elastic mode.
TEST(CamLog, OfAMachineAsItsFileSaysNamesNothing) {
  DiagnoseInput input;
  input.machine = sim::read_machine((source / "firmware/machine/shipped/servo-joint.toml").string(), {});
  input.next_measurement = false;
  input.logs.push_back(cam_log(input.machine, 20.0, 4));
  input.held_out.push_back(cam_log(input.machine, 26.0, 2));
  const auto verdict = diagnose(input);
  EXPECT_TRUE(verdict.findings.empty()) << verdict_text(verdict);
}

}  // namespace
}  // namespace stiction::host
