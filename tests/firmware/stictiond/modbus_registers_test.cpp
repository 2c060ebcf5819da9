// The drive's own registers: made from the parameters' descriptions, and their page is current.
#include "firmware/stictiond/modbus_registers.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <set>

#include "firmware/machine/file/drive_file.hpp"
#include "tests/support/shipped_machine.hpp"

namespace stiction::test {
namespace {

const std::string machine_file = std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/mcfv5050ln.toml";

drive::ModbusRegisters registers_of_cross_table() {
  const auto machine = cross_table();
  return {machine, machine::read_drive_setup(machine_file, machine)};
}

struct Read {
  std::vector<double> values;
  std::vector<std::uint16_t> input, holding;
};
Read read_all(const drive::ModbusRegisters& registers, const drive::PublishedState& state) {
  const auto& map = registers.map();
  Read read{std::vector<double>(map.registers().size(), -1.0),
            std::vector<std::uint16_t>(map.size(hal::RegisterTable::input)),
            std::vector<std::uint16_t>(map.size(hal::RegisterTable::holding))};
  registers.put_values(state, read.values);
  map.encode(read.values, read.input, read.holding);
  return read;
}

std::size_t index_of(const drive::ModbusRegisters& registers, const std::string& name) {
  const auto all = registers.map().registers();
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].name == name) return i;
  ADD_FAILURE() << "no register " << name;
  return 0;
}

TEST(DriveParameters, AreThoseOfTheMachineFileWithItsValues) {
  const auto machine = cross_table();
  const auto parameters = drive::drive_parameters(machine, machine::read_drive_setup(machine_file, machine));
  std::set<std::string> keys;
  for (const auto& p : parameters) keys.insert(p.key);
  EXPECT_EQ(keys.size(), parameters.size());
  EXPECT_EQ(parameters.size() % machine.axes.size(), 0U);
  const auto value = [&](const std::string& key) {
    for (const auto& p : parameters)
      if (p.key == key) return p.value;
    ADD_FAILURE() << key;
    return std::optional<double>{};
  };
  EXPECT_EQ(value("axis.X.velocity_controller.gain"), 600.0);
  EXPECT_EQ(value("axis.Y.notch.frequency"), machine.axes[1].notch->frequency);
  EXPECT_EQ(value("axis.X.supervision.following_error"), std::nullopt);
  EXPECT_EQ(value("drive.axis.X.quick_stop_deceleration"), 10.0);
  EXPECT_EQ(value("drive.axis.Y.homing.search_speed"), 0.02);
}

// Every one of them, set to the value it has, is taken by the reader of machine files.
TEST(DriveParameters, AreTakenBackByTheMachineFile) {
  const auto machine = cross_table();
  const auto parameters = drive::drive_parameters(machine, machine::read_drive_setup(machine_file, machine));
  drive::ParameterSet set{machine.id, {}};
  for (const auto& p : parameters)
    if (p.value && std::isfinite(*p.value)) set.values[p.key] = *p.value;
  set.values["axis.X.position_controller.gain"] = 70.0;
  machine::ReadOptions options{{}, drive::assignments_of(set, machine.id, parameters)};
  const auto changed = sim::read_machine(machine_file, options);
  EXPECT_EQ(changed.axes[0].position_controller.gain, 70.0);
  EXPECT_EQ(changed.axes[1].position_controller.gain, machine.axes[1].position_controller.gain);
}

TEST(DriveParameters, OfAnotherMachineOrWithoutAKeyAreRefused) {
  const auto machine = cross_table();
  const auto parameters = drive::drive_parameters(machine, {});
  EXPECT_THROW(drive::assignments_of({"emps", {}}, machine.id, parameters), std::runtime_error);
  EXPECT_THROW(drive::assignments_of({machine.id, {{"axis.X.mass", 1.0}}}, machine.id, parameters), std::runtime_error);
}

TEST(ModbusRegisters, ShowTheStateOfEveryAxis) {
  const auto registers = registers_of_cross_table();
  drive::PublishedState state;
  state.missed_deadlines = 70000;
  state.axes[1].statusword = 0x1237;
  state.axes[1].position = -0.2;
  state.axes[1].fault = Fault::limit_switch;
  state.axes[1].limit_positive = true;
  const Read read = read_all(registers, state);
  EXPECT_EQ(read.input[0], 0x5344);
  EXPECT_EQ(read.input[2], 2);
  EXPECT_EQ(read.input[6], 1);  // 70000 = 1 * 65536 + 4464
  EXPECT_EQ(read.input[7], 4464);
  EXPECT_EQ(read.input[200], 0x1237);
  EXPECT_EQ(read.input[202], 20);
  EXPECT_EQ(read.input[203], 2);
  EXPECT_EQ(hal::number_in(hal::RegisterType::int32, std::span(read.input).subspan(204)), -2e7);  // 10 nm
}

TEST(ModbusRegisters, ShowParametersAndWhatWasWrittenToThem) {
  auto registers = registers_of_cross_table();
  const std::size_t gain = index_of(registers, "axis.X.velocity_controller.gain");
  EXPECT_EQ(read_all(registers, {}).values[gain], 600.0);
  const auto meaning = registers.meaning_of({gain, 550.0});
  const auto* write = std::get_if<drive::ParameterWrite>(&meaning);
  ASSERT_NE(write, nullptr);
  EXPECT_EQ(write->key, "axis.X.velocity_controller.gain");
  registers.remember(*write);
  EXPECT_EQ(read_all(registers, {}).values[gain], 550.0);
  EXPECT_EQ(registers.written().values.size(), 1U);
  EXPECT_TRUE(std::isnan(read_all(registers, {}).values[index_of(registers, "axis.X.supervision.following_error")]));
}

TEST(ModbusRegisters, TellMotionFromParameters) {
  const auto registers = registers_of_cross_table();
  const auto of = [&](const char* name, double value) {
    return registers.meaning_of({index_of(registers, name), value});
  };
  const auto move = of("Y.mode_of_operation", 6);
  ASSERT_TRUE(std::holds_alternative<drive::MotionWrite>(move));
  EXPECT_EQ(std::get<drive::MotionWrite>(move).axis, 1U);
  EXPECT_EQ(std::get<drive::MotionWrite>(move).what, drive::MotionWrite::What::mode);
  EXPECT_TRUE(std::holds_alternative<drive::MotionWrite>(of("X.controlword", 15)));
  EXPECT_TRUE(std::holds_alternative<drive::StoreParameters>(of("store_parameters", 21332)));
  for (const auto& r : registers.map().registers()) {
    const bool motion = r.access == hal::RegisterAccess::motion;
    EXPECT_EQ(motion, r.table == hal::RegisterTable::holding && r.address >= 100 && r.address < 1000) << r.name;
  }
}

TEST(ModbusRegisters, TakeBackWhatWasWrittenSinceTheLastSet) {
  auto registers = registers_of_cross_table();
  const auto gain = index_of(registers, "axis.X.velocity_controller.gain");
  const auto frequency = index_of(registers, "axis.X.notch.frequency");
  const drive::ParameterSet kept{registers.written().machine, {{"axis.X.velocity_controller.gain", 550.0}}};
  registers.remember({"axis.X.velocity_controller.gain", 520.0});
  registers.remember({"axis.X.notch.frequency", 9000.0});
  registers.take_back(kept);
  EXPECT_EQ(registers.written(), kept);
  EXPECT_EQ(read_all(registers, {}).values[gain], 550.0);
  EXPECT_NE(read_all(registers, {}).values[frequency], 9000.0);
  registers.take_back({});
  EXPECT_TRUE(registers.written().values.empty());
  EXPECT_EQ(read_all(registers, {}).values[gain], 600.0);
}

// Each limit, a little to both sides of what is in force.
TEST(DriveParameters, OfLimitsAreOnlyMadeTighterOverABus) {
  const auto machine = cross_table({"axis.X.supervision.following_error=2 mm", "axis.X.supervision.over_current=80 A",
                                    "axis.X.supervision.over_speed=1.5 m/s"});
  auto setup = machine::read_drive_setup(machine_file, machine);
  setup.axes.at("X").slow_down_deceleration = 5.0;
  setup.axes.at("X").brake_time = 0.1;
  setup.axes.at("X").following_error_timeout = 0.02;
  setup.axes.at("X").max_motor_speed = 1.0;
  setup.axes.at("X").torque_slope = 500.0;
  int tried = 0;
  for (const auto& p : drive::drive_parameters(machine, setup)) {
    if (p.key.find(".X.") == std::string::npos || !p.value) continue;
    const auto limit = std::find_if(drive::limit_parameters.begin(), drive::limit_parameters.end(),
                                    [&](const auto& row) { return p.key.ends_with("." + std::string(row.key)); });
    const double more = *p.value + std::abs(*p.value) * 0.01, less = *p.value - std::abs(*p.value) * 0.01;
    EXPECT_EQ(drive::rejection_of(p, *p.value), "");
    if (limit == drive::limit_parameters.end()) {
      EXPECT_EQ(drive::rejection_of(p, more) + drive::rejection_of(p, less), "");
      continue;
    }
    const bool down = limit->tightens == drive::Tightens::down;
    EXPECT_EQ(drive::rejection_of(p, down ? less : more), "") << p.key;
    const auto said = drive::rejection_of(p, down ? more : less);
    EXPECT_NE(said.find(p.key), std::string::npos) << said;
    EXPECT_NE(said.find(down ? "expected at most" : "expected at least"), std::string::npos) << said;
    ++tried;
  }
  EXPECT_EQ(tried, static_cast<int>(drive::limit_parameters.size()));
}

TEST(DriveParameters, OfALimitThatTheFileLeavesOutAreRefused) {
  drive::DriveParameter p;
  p.key = "axis.X.supervision.over_speed";
  p.unit = "m/s";
  const auto said = drive::rejection_of(p, 1.0);
  EXPECT_NE(said.find("expected a value in the machine file first"), std::string::npos) << said;
}

// Printed by modbus_register_page(); what it should be lies beside the figures after a failure.
TEST(ModbusRegisters, TheirPageIsCurrent) {
  std::ifstream stream(std::string(STICTION_SOURCE_DIR) + "/docs/modbus_registers.md");
  const std::string page{std::istreambuf_iterator<char>(stream), {}};
  const std::string current = drive::modbus_register_page();
  if (page != current) {
    std::filesystem::create_directories(STICTION_FIGURES_DIR "/..");
    std::ofstream(STICTION_FIGURES_DIR "/../modbus_registers.md") << current;
  }
  EXPECT_TRUE(page == current) << "docs/modbus_registers.md is another one; the current page is in "
                                  "build/release/modbus_registers.md";
}

}  // namespace
}  // namespace stiction::test
