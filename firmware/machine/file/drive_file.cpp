#include "firmware/machine/file/drive_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "firmware/machine/file/document.hpp"
#include "firmware/machine/file/drive_parameters.hpp"
#include "firmware/machine/file/table_reader.hpp"

namespace stiction::machine {
namespace {

// What is no jump of the encoder (m): between samples a time T apart an acceleration a leaves up to a T^2 beside the
// displacement that the speed predicts. Twice that of the motor's largest force, for friction that changes its sign and
// stamps that are not exact. 0.1 um at 62.5 us on the cross table, where 5 um hold; 0.7 mm at 10 ms on the EMPS.
double encoder_jump_of(const AxisModel& axis, const Timing& timing) {
  constexpr double least = 5e-6;
  const double amplitude = axis.motor.model == MotorModel::force ? axis.inverter.voltage_limit
                                                                 : axis.inverter.current_limit * axis.motor.count;
  const double acceleration = amplitude * axis.motor.force_constant / axis.mass;
  return std::max(least, 2.0 * acceleration * timing.fast_period * timing.fast_period);
}

DriveAxisSetup with_defaults(DriveAxisSetup setup, const AxisModel& axis, const Timing& timing) {
  const double limit = axis.inverter.current_limit * axis.motor.count;
  if (!setup.encoder_jump) setup.encoder_jump = encoder_jump_of(axis, timing);
  if (!setup.current_sum) setup.current_sum = limit / 20.0;
  if (!setup.runaway_current) setup.runaway_current = limit / 5.0;
  if (!setup.negative_end) setup.negative_end = -axis.travel / 2.0;
  if (!setup.positive_end) setup.positive_end = axis.travel / 2.0;
  return setup;
}

}  // namespace

DriveSetup drive_setup_of(const Document& document, const Machine& machine) {
  const TableReader reader(document, false);
  const auto reader_of = [&](const AxisModel& axis) {
    return TableReader(document, false, nullptr, {axis.coordinate, axis.motor_coordinate});
  };
  const std::string path = "drive";
  DriveSetup setup;
  const toml::table* axes = nullptr;
  if (const toml::node* node = document.root().get(path)) {
    const toml::table& table = reader.as_table(*node, path, Table<DriveSetup>::text);
    setup = reader.read<DriveSetup>(table, path);
    if (const toml::node* listed = table.get("axis")) axes = &reader.as_table(*listed, "drive.axis", "axes by name");
  }
  std::vector<std::string_view> names;
  for (const AxisModel& axis : machine.axes) names.push_back(axis.name);
  if (axes != nullptr)
    for (auto&& [name, node] : *axes) {
      const std::string key = join_key("drive.axis", name.str());
      const auto axis = std::find(names.begin(), names.end(), name.str());
      if (axis == names.end()) document.fail_unknown(name.source(), key, names);
      const AxisModel& model = machine.axes[static_cast<std::size_t>(axis - names.begin())];
      setup.axes[model.name] =
          reader_of(model).read<DriveAxisSetup>(reader.as_table(node, key, Table<DriveAxisSetup>::text), key);
    }
  for (const AxisModel& axis : machine.axes)
    if (!setup.axes.contains(axis.name))
      setup.axes[axis.name] = reader_of(axis).read<DriveAxisSetup>(toml::table{}, join_key("drive.axis", axis.name));
  for (const AxisModel& axis : machine.axes)
    setup.axes[axis.name] = with_defaults(setup.axes[axis.name], axis, machine.timing);
  return setup;
}

DriveSetup read_drive_setup(const std::filesystem::path& file, const Machine& machine, const ReadOptions& options) {
  Document document(file.string(), content_of(file));
  document.apply_experiment(options.experiment);
  for (const std::string& assignment : options.set) document.apply_set(assignment);
  return drive_setup_of(document, machine);
}

}  // namespace stiction::machine
