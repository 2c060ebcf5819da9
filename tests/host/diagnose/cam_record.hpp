// Records of a slave behind its master, as `simulate cam` makes them.
#pragma once

#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>

#include "host/log/log.hpp"
#include "host/simulate/cam_run.hpp"
#include "sim/cam/motion.hpp"
#include "sim/cam/motion_file.hpp"
#include "sim/machine_file.hpp"

namespace stiction::host {

// Every so many ticks of `cycles` that are measured, at `turns` of the master in a minute.
inline Log cam_log(const machine::Machine& machine, double turns, int cycles, std::size_t every = 4) {
  const auto cam =
      sim::cam::read_motion_file(std::filesystem::path(STICTION_SOURCE_DIR) / "examples/cams/indexing.toml").front();
  CamRunSettings settings;
  settings.master_speed = turns * 2.0 * std::numbers::pi / 60.0;
  settings.cycles = cycles;
  const auto run = run_cam<FixedSignals>(machine, sim::cam::compose(cam), settings);
  Log log = run.log;
  log.source = std::to_string(static_cast<int>(turns)) + " in a minute";
  log.period *= static_cast<double>(every);
  // From a tick of the position controller on, as a replay begins.
  const double slow = machine.timing.slow_period;
  std::size_t first = 0;
  while (std::abs(log.t[first] / slow - std::round(log.t[first] / slow)) > 1e-6) ++first;
  const auto thin = [&](std::vector<double>& values) {
    std::size_t kept = 0;
    for (std::size_t k = first; k < values.size(); k += every) values[kept++] = values[k];
    values.resize(kept);
  };
  thin(log.t);
  for (auto& axis : log.axes)
    for (const auto& channel : log_channels) thin(axis.*channel.values);
  return log;
}

inline machine::Machine cam_stand() {
  return sim::read_machine(
      (std::filesystem::path(STICTION_SOURCE_DIR) / "firmware/machine/shipped/cam-stand.toml").string(), {});
}

}  // namespace stiction::host
