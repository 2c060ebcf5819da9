#include "sim/machine_file.hpp"

#include "sim/effects/effects.hpp"
#include "sim/plant/friction/friction.hpp"

namespace stiction::sim {
namespace {

void check_effects(const machine::AxisModel& axis) {
  plant_axis(axis);
  drive_axis(axis);
}

}  // namespace

const machine::Vocabulary& vocabulary() {
  static const machine::Vocabulary all{friction_tables(), effect_tables(), check_effects};
  return all;
}

machine::Machine read_machine(const std::filesystem::path& file, const machine::ReadOptions& options) {
  return machine::read_machine(file, vocabulary(), options);
}

machine::Machine parse_machine(const std::string& file, const std::string& text, const machine::ReadOptions& options) {
  return machine::parse_machine(file, text, vocabulary(), options);
}

std::string effect_table(const std::string& axis, const machine::Effect& effect, bool force_motor,
                         const machine::Coordinate& coordinate) {
  return machine::effect_table(vocabulary(), axis, effect, force_motor, coordinate);
}

std::string extended_machine(const std::filesystem::path& file, const std::vector<std::string>& set,
                             std::span<const machine::AxisEffects> additions, std::span<const std::string> comment) {
  return machine::extended_machine(file, vocabulary(), set, additions, comment);
}

const std::vector<machine::TableDescription>& machine_file_description() {
  static const auto description = machine::machine_file_description(vocabulary());
  return description;
}

std::string reference_page() { return machine::reference_page(vocabulary()); }

}  // namespace stiction::sim
