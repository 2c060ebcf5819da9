#include "firmware/drive/modbus_publisher.hpp"

#include <fmt/format.h>

#include <exception>

#include "firmware/drive/modbus_setup.hpp"

namespace stiction::drive {
namespace {

constexpr std::array<const char*, 2> motion_names{"controlword", "mode of operation"};

}  // namespace

ModbusPublisher::ModbusPublisher(const sim::Machine& machine, const sim::DriveSetup& setup, ModbusStore store,
                                 Beside beside)
    : registers_(machine, setup),
      store_(std::move(store)),
      beside_(std::move(beside)),
      server_(registers_.map(), modbus_server_config(setup), [this](std::span<double> values) {
        PublishedState state = snapshot_.latest();
        if (beside_) beside_(state);
        registers_.put_values(state, values);
      }) {
  for (const sim::Axis& axis : machine.axes) axis_names_.push_back(axis.name);
  if (store_.begun) registers_.set_written(*store_.begun);
}

std::optional<MotionWrite> ModbusPublisher::take_motion() {
  const auto write = motion_.take();
  if (!write) return {};
  return std::get<MotionWrite>(registers_.meaning_of(*write));
}

std::vector<std::string> ModbusPublisher::serve() {
  std::vector<std::string> lines;
  while (const auto write = server_.take_write()) {
    const DriveWrite meaning = registers_.meaning_of(*write);
    if (const auto* parameter = std::get_if<ParameterWrite>(&meaning)) {
      registers_.remember(*parameter);
      lines.push_back(
          fmt::format("Modbus: {} = {}, from the next start on if it is stored", parameter->key, parameter->value));
    } else if (const auto* motion = std::get_if<MotionWrite>(&meaning)) {
      const bool taken = motion_.push(std::span(&*write, 1));
      lines.push_back(describe(*motion) + (taken ? "" : ": dropped, the loop has not taken the commands before"));
    } else {
      lines.push_back(describe_store());
    }
  }
  return lines;
}

std::string ModbusPublisher::describe(const MotionWrite& write) const {
  return fmt::format("Modbus: axis {}: {} {}", axis_names_[write.axis],
                     motion_names[static_cast<std::size_t>(write.what)], write.value);
}

std::string ModbusPublisher::describe_store() {
  if (store_.file.empty()) return "Modbus: parameters are not stored: the drive was started without a place for them";
  try {
    registers_.store(store_.file, store_.machine_file, store_.options);
  } catch (const std::exception& error) {
    return fmt::format("Modbus: parameters are not stored: {}", error.what());
  }
  return fmt::format("Modbus: parameters stored in {}", store_.file.string());
}

}  // namespace stiction::drive
