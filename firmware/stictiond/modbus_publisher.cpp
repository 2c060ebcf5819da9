#include "firmware/stictiond/modbus_publisher.hpp"

#include <fmt/format.h>

#include <exception>

#include "firmware/stictiond/modbus_setup.hpp"

namespace stiction::drive {
namespace {

constexpr std::array<const char*, 6> motion_names{"controlword",      "mode of operation",    "target position",
                                                  "profile velocity", "profile acceleration", "profile deceleration"};

}  // namespace

ModbusPublisher::ModbusPublisher(const machine::Machine& machine, const machine::DriveSetup& setup, ModbusStore store,
                                 Beside beside)
    : registers_(machine, setup),
      store_(std::move(store)),
      beside_(std::move(beside)),
      server_(registers_.map(), modbus_server_config(setup), [this](std::span<double> values) {
        PublishedState state = snapshot_.latest();
        if (beside_) beside_(state);
        registers_.put_values(state, values);
      }) {
  for (const machine::AxisModel& axis : machine.axes) axis_names_.push_back(axis.name);
  if (store_.begun) registers_.set_written(*store_.begun);
}

std::optional<MotionWrite> ModbusPublisher::take_motion() {
  const auto write = motion_.take();
  if (!write) return {};
  return std::get<MotionWrite>(registers_.meaning_of(*write));
}

std::vector<std::string> ModbusPublisher::serve() {
  std::vector<std::string> lines;
  // All at once: a target and the bit that it is taken by may come in one request.
  std::vector<hal::RegisterWrite> motions;
  while (const auto write = server_.take_write()) {
    const DriveWrite meaning = registers_.meaning_of(*write);
    if (const auto* parameter = std::get_if<ParameterWrite>(&meaning)) {
      registers_.remember(*parameter);
      lines.push_back(fmt::format("Modbus: {} = {}, which takes effect at the next start if it is stored",
                                  parameter->key, parameter->value));
    } else if (const auto* motion = std::get_if<MotionWrite>(&meaning)) {
      motions.push_back(*write);
      lines.push_back(describe(*motion));
    } else {
      lines.push_back(describe_store());
    }
  }
  if (!motion_.push(motions)) lines.push_back("Modbus: command dropped: the loop has not yet taken the previous ones");
  return lines;
}

std::string ModbusPublisher::describe(const MotionWrite& write) const {
  return fmt::format("Modbus: axis {}: {} {}", axis_names_[write.axis],
                     motion_names[static_cast<std::size_t>(write.what)], write.value);
}

std::string ModbusPublisher::describe_store() {
  if (store_.file.empty()) return "Modbus: parameters are not stored: the drive was started without --parameters";
  try {
    registers_.store(store_.file, store_.machine_file, store_.options);
  } catch (const std::exception& error) {
    return fmt::format("Modbus: parameters are not stored: {}", error.what());
  }
  return fmt::format("Modbus: parameters stored in {}", store_.file.string());
}

}  // namespace stiction::drive
