#include "tests/host/identify/campaign.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sim/machine_file.hpp"
#include "sim/plant/friction/friction.hpp"

namespace stiction::test {

machine::Machine bench_machine(const std::string& friction) {
  auto machine = sim::read_machine(std::string(STICTION_SOURCE_DIR) + "/sim/machine/shipped/mcfv5050ln.toml", {});
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
  const auto& parameters = axis.friction.models.at(axis.friction.use);
  if (const auto* lugre = std::get_if<sim::LuGreParameters>(&parameters)) {
    add("coulomb_N", lugre->coulomb);
    add("viscous_N_s_per_m", lugre->viscous);
    add("stiffness_N_per_m", lugre->stiffness);
    add("damping_ratio", lugre->damping_ratio);
  } else if (const auto* slip = std::get_if<sim::MaxwellSlipParameters>(&parameters)) {
    add("coulomb_N", std::accumulate(slip->level.begin(), slip->level.end(), 0.0));
    add("viscous_N_s_per_m", slip->viscous);
  } else if (const auto* ramp = std::get_if<sim::LinearRampParameters>(&parameters)) {
    // Beyond its break velocity: the straight line taken back to standstill.
    add("coulomb_N", ramp->coulomb - ramp->coulomb / ramp->slope * ramp->viscous);
    add("viscous_N_s_per_m", ramp->viscous);
  } else if (const auto* classical = std::get_if<sim::ClassicalParameters>(&parameters)) {
    add("coulomb_N", classical->coulomb);
    add("viscous_N_s_per_m", classical->viscous);
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
