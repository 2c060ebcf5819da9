#include "tests/host/identify/campaign.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sim/machine_file.hpp"
#include "sim/plant/friction/friction.hpp"
#include "sim/plant/friction/lugre.hpp"
#include "sim/plant/friction/parameters.hpp"

namespace stiction::test {

machine::Machine bench_machine(const std::string& friction) {
  auto machine = sim::read_machine(std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/mcfv5050ln.toml", {});
  machine.axes.resize(1);
  auto& axis = machine.axes.front();
  axis.friction.use = friction;
  // One motor constant on both sides of the record: of the three-phase motor the currents' amplitude is 94/94.2 of the
  // force.
  axis.motor.model = machine::MotorModel::dc;
  return machine;
}

std::vector<Truth> truths_of(const machine::AxisModel& axis) {
  std::vector<Truth> truths{{"mass_kg", axis.mass}, {"constant_force_N", 0.0}};
  const auto add = [&](const char* name, double value) { truths.push_back({name, value}); };
  // In sliding, beyond where a law has a break velocity: the straight line taken back to standstill.
  const auto steady = sim::steady_friction(axis.friction);
  const double viscous = (steady(1.0, 1.0) - steady(0.5, 1.0)) / 0.5;
  add("coulomb_N", steady(1.0, 1.0) - viscous);
  add("viscous_N_s_per_m", viscous);
  if (axis.friction.use == sim::LuGre<>::name) {
    const auto lugre = sim::parameters_of<sim::LuGre<>>(axis.friction);
    add("stiffness_N_per_m", lugre.stiffness);
    add("damping_ratio", lugre.damping_ratio);
  }
  return truths;
}

std::vector<ParameterRecord> campaign(const machine::Machine& machine, int runs, std::uint64_t first_seed) {
  std::vector<host::Log> clean;
  for (const auto& trajectory : commissioning()) clean.push_back(simulated(machine, trajectory));
  std::vector<ParameterRecord> records;
  for (const auto& truth : truths_of(machine.axes.front())) records.push_back({truth.name, truth.value});
  for (int run = 0; run < runs; ++run) {
    std::vector<host::Log> logs;
    for (std::size_t k = 0; k < clean.size(); ++k)
      logs.push_back(with_noise(clean[k], {}, (first_seed + static_cast<std::uint64_t>(run)) * 8 + k));
    host::IdentifyOptions options{"lugre", host::Amperes::amplitude, {}};
    options.fit.seed = first_seed + static_cast<std::uint64_t>(run);
    const auto result = host::identify_logs(logs, machine.axes.front(), options);
    for (auto& record : records) {
      const auto* found = result.find(record.name);
      if (found == nullptr) continue;
      ++record.determined;
      record.covered += found->ci95.low <= record.truth && record.truth <= found->ci95.high;
      record.mean += (found->value - record.mean) / record.determined;
      record.largest_error = std::max(record.largest_error, std::abs(found->value - record.truth));
    }
  }
  return records;
}

}  // namespace stiction::test
