#include "host/cli/diagnose_start.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <system_error>

#include "host/cli/temporaries.hpp"
#include "host/diagnose/record/record_rows.hpp"
#include "host/identify/friction_fit.hpp"
#include "host/identify/identification.hpp"
#include "host/identify/identified_machine.hpp"
#include "host/identify/standstill.hpp"
#include "sim/machine_file.hpp"
#include "sim/plant/friction/coulomb_viscous.hpp"
#include "sim/plant/friction/friction.hpp"
#include "sim/plant/friction/lugre.hpp"

namespace stiction::host {
namespace {

// As `stiction identify` chooses it.
std::string law_to_identify(const machine::AxisModel& axis) {
  if (sticks_rigidly(axis)) return std::string(sim::CoulombViscous<>::name);
  return has_contact_of_one_length(axis.friction) ? axis.friction.use : std::string(sim::LuGre<>::name);
}

}  // namespace

IntermediateFolder::IntermediateFolder() {
  auto name = (std::filesystem::temp_directory_path() / "stiction-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr)
    throw std::system_error(errno, std::generic_category(), "temporary folder " + name);
  path_ = name;
  register_temporary(path_);
}

IntermediateFolder::~IntermediateFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
  forget_temporary(path_);
}

std::vector<Log> training_logs(const DiagnoseInput& input) {
  if (!input.held_out.empty()) return input.logs;
  std::vector<Log> logs;
  for (const auto& log : input.logs) logs.push_back(part_of(log, 0, log.t.size() * 2 / 3));
  return logs;
}

std::vector<StartValue> start_from_identified(DiagnoseInput& input, DiagnosedFile& file,
                                              const IntermediateFolder& folder, const std::string& command) {
  const auto& axis = input.machine.axes[input.axis];
  const IdentifyOptions options{law_to_identify(axis), Amperes::amplitude, FitSettings{}, true};
  const auto result = identify_logs(training_logs(input), axis, options);
  const auto text = identified_machine(file.file, file.set, axis, result, command);
  const auto place = folder.path() / axis.name;
  std::filesystem::create_directories(place);
  const auto identified = place / file.file.filename();
  std::ofstream(identified) << text;
  input.machine = sim::read_machine(identified);
  file = {identified, {}};
  std::vector<StartValue> values;
  for (const auto& parameter : result.parameters)
    values.push_back({parameter.name, parameter.value, {parameter.ci95.low, parameter.ci95.high}});
  return values;
}

}  // namespace stiction::host
