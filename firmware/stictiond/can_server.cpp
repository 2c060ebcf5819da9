#include "firmware/stictiond/can_server.hpp"

#include <linux/can.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "firmware/machine/configuration/conversion.hpp"
#include "hal/tick_clock.hpp"

namespace stiction::drive {
namespace {

using hal::can::CobId;
using hal::can::Pdo;
using hal::can::PdoVerdict;
using S = FixedSignals;

constexpr double velocity_increments = 1000.0;  // of position a second in a unit of velocity
constexpr double torque_units = 1000.0;         // in the current limit
constexpr std::uint16_t most_torque = 1000;     // in torque units
constexpr std::int64_t second_ns = 1'000'000'000;

std::vector<hal::can::Filter> filters(const CanServerConfig& config) {
  std::vector<hal::can::Filter> wanted;
  for (const int node : config.nodes)
    for (const auto& row : hal::can::pdo_table)
      if (row.received && row.exchanged_at(config.frames))
        wanted.push_back({row.id() + static_cast<std::uint32_t>(node), CAN_SFF_MASK});
  wanted.push_back({base_of(CobId::network), CAN_SFF_MASK});
  // Of every node: which one is watched may be written (1016h).
  wanted.push_back({base_of(CobId::heartbeat), CAN_SFF_MASK & ~unsigned{hal::can::highest_node}});
  if (config.follows_sync) wanted.push_back({hal::can::sync_id, CAN_SFF_MASK});
  return wanted;
}

std::int32_t to_units(double value, double unit) {
  constexpr double most = std::numeric_limits<std::int32_t>::max();
  return static_cast<std::int32_t>(std::lround(std::clamp(value / unit, -most, most)));
}

std::int16_t to_thousandths(double share) {
  constexpr double most = std::numeric_limits<std::int16_t>::max();
  return static_cast<std::int16_t>(std::lround(std::clamp(share * torque_units, -most, most)));
}

}  // namespace

CanServer::CanServer(const CanServerConfig& config, LogRing& log)
    : frames_(config, log), socket_(config.interface, config.format, filters(config), false) {}

bool CanServer::receive(std::int64_t now_ns, std::span<RemoteAxis> axes) {
  now_ns_ = now_ns;
  const bool begins = slow_ticks_ == 0;
  slow_ticks_ = slow_ticks_ + 1 == frames_.config().cycle_ticks ? 0 : slow_ticks_ + 1;
  if (!begins) return false;
  hal::can::Received received;
  sync_age_ns_.reset();
  std::uint32_t taken = 0;
  for (; taken < most_taken && socket_.receive(received, 0); ++taken) {
    if (received.frame.id == hal::can::sync_id)
      sync_age_ns_ = hal::MonotonicTime().now_ns() - received.received_ns;
    else
      frames_.take(now_ns, received.frame, axes);
  }
  // A controller that is silent for a second has stopped its axes by the watch over it, or commands none.
  if (taken > 0) {
    look_again_ns_ = now_ns + second_ns;
  } else if (now_ns >= look_again_ns_) {
    look_again_ns_ = now_ns + second_ns;
    socket_.find_again();
  }
  frames_.begin_cycle(now_ns, axes);
  for (auto& axis : axes) axis.begin_cycle();
  return true;
}

ControllerFrames::ControllerFrames(const CanServerConfig& config, LogRing& log) : config_(config), log_(log) {
  for (std::size_t i = 0; i < config.nodes.size(); ++i)
    nodes_.push_back({.canopen = CanopenNode(config.nodes[i], links_->at(i))});
}

void ControllerFrames::begin_cycle(std::int64_t now_ns, std::span<RemoteAxis> axes) {
  for (std::size_t i = 0; i < nodes_.size(); ++i) nodes_[i].canopen.watch(now_ns, axes[i]);
}

void ControllerFrames::take(std::int64_t now_ns, const hal::can::Frame& frame, std::span<RemoteAxis> axes) {
  if (take_heartbeat(now_ns, frame, axes)) return;
  if (const auto order = hal::can::network_order_of(frame)) return take_order(now_ns, *order, axes);
  const auto address = hal::can::pdo_address_of(frame);
  const auto found = std::find(config_.nodes.begin(), config_.nodes.end(), address.node);
  if (address.verdict == PdoVerdict::unknown || found == config_.nodes.end()) return;
  const auto axis = static_cast<std::size_t>(found - config_.nodes.begin());
  if (address.verdict == PdoVerdict::good)
    return ask(now_ns, axis, address.pdo, decode_pdo(address.pdo, frame), axes[axis]);
  ++counts_.wrong_size;
  // One a second and axis: a controller repeats its mistake each cycle.
  auto& said = nodes_[axis].said_ns;
  if (said != INT64_MIN && now_ns - said < second_ns) return;
  said = now_ns;
  log_.push(now_ns, LogLevel::warning, "CAN: axis {}: found a frame {:#x} of {} bytes; expected {}; it is refused",
            {axis, frame.id, frame.size, description_of(address.pdo).size});
}

void ControllerFrames::ask(std::int64_t now_ns, std::size_t axis, Pdo pdo, const hal::can::ControllerData& data,
                           RemoteAxis& remote) {
  if (!config_.motion_allowed) {
    ++counts_.refused;
    if (pdo != Pdo::offsets) say_refused(now_ns, axis, data.controlword);
    return;
  }
  if (!nodes_[axis].canopen.exchanges()) {
    ++counts_.refused;
    return;
  }
  const bool owned = !remote.owner().accepts(CommandSource::can);
  if ((pdo == Pdo::offsets && owned) || (pdo == Pdo::mode && !is_supported(data.mode))) {
    ++counts_.refused;
    return;
  }
  if (pdo == Pdo::offsets) {
    ++counts_.taken;
    remote.hear(CommandSource::can);
    return ask_offsets(axis, data, remote);
  }
  if (!remote.ask(data.controlword, CommandSource::can)) {
    ++counts_.refused;
    return say_owned(now_ns, axis, data.controlword, remote);
  }
  ++counts_.taken;
  if (owned) return;  // a stop alone
  if (pdo == Pdo::mode) remote.ask(static_cast<OperationMode>(data.mode));
  if (pdo == Pdo::speed) {
    const auto speed = machine::to_signal<S::Velocity>(data.speed * velocity_increments * config_.increment);
    const bool valid = data.speed != std::numeric_limits<std::int32_t>::min() && speed.has_value();
    return remote.offer_speed(speed.value_or(S::Velocity{}), valid);
  }
  if (pdo == Pdo::torque) {
    const double unit = config_.current_limit[axis] / torque_units;
    remote.ask_most_torque(machine::to_signal<S::Current>(std::min(data.most_torque, most_torque) * unit).value());
    return remote.offer_torque(
        machine::to_signal<S::Current>(std::clamp<int>(data.torque, -most_torque, most_torque) * unit).value());
  }
  if (pdo != Pdo::target) return;
  const auto target = machine::to_signal<S::Position>(data.target * config_.increment);
  const bool number = data.target != std::numeric_limits<std::int32_t>::min() && target.has_value();
  remote.ask_target(target.value_or(S::Position{}), number);
  remote.offer(target.value_or(S::Position{}), number);
}

void ControllerFrames::ask_offsets(std::size_t axis, const hal::can::ControllerData& data, RemoteAxis& remote) const {
  const double limit = config_.current_limit[axis];
  const auto velocity = machine::to_signal<S::Velocity>(data.velocity_offset * velocity_increments * config_.increment);
  const auto current = machine::to_signal<S::Current>(std::clamp(data.torque_offset / torque_units, -1.0, 1.0) * limit);
  // One that no format holds adds nothing.
  remote.ask_offsets(velocity.value_or(S::Velocity{}), current.value_or(S::Current{}));
}

bool ControllerFrames::take_heartbeat(std::int64_t now_ns, const hal::can::Frame& frame, std::span<RemoteAxis> axes) {
  const int node = static_cast<int>(frame.id - base_of(CobId::heartbeat));
  if (node < 1 || node > hal::can::highest_node || frame.size != 1) return false;
  for (auto& each : nodes_) each.canopen.hear(node, now_ns);
  if (node == config_.heartbeat_node)
    for (auto& axis : axes) axis.hear(CommandSource::can);
  return true;
}

// One line a second and axis.
void ControllerFrames::take_order(std::int64_t now_ns, const hal::can::NetworkOrder& order,
                                  std::span<RemoteAxis> axes) {
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    auto& node = nodes_[i];
    if (!node.canopen.take(order, axes[i])) continue;
    if (node.state_said_ns != INT64_MIN && now_ns - node.state_said_ns < second_ns) continue;
    node.state_said_ns = now_ns;
    log_.push(now_ns, LogLevel::notice, "CAN: axis {}: the master of the network sets its node {}",
              {i, name_of(node.canopen.state())});
  }
}

// One a second and axis.
void ControllerFrames::say_owned(std::int64_t now_ns, std::size_t axis, std::uint16_t controlword,
                                 const RemoteAxis& remote) {
  auto& said = nodes_[axis].owned_said_ns;
  if (said != INT64_MIN && now_ns - said < second_ns) return;
  said = now_ns;
  log_.push(now_ns, LogLevel::warning,
            "CAN: axis {}: found controlword {:#06x}, but its commander is {} and a stop of {} holds it; expected "
            "shutdown (6) first, after both have given it up; it is refused",
            {axis, controlword, name_of(remote.owner().owner()), name_of(remote.owner().held_by())});
}

void ControllerFrames::say_refused(std::int64_t now_ns, std::size_t axis, std::uint16_t controlword) {
  if (controlword == nodes_[axis].refused_word) return;
  nodes_[axis].refused_word = controlword;
  log_.push(now_ns, LogLevel::warning,
            "CAN: axis {}: found controlword {:#06x}; expected none without drive.can_server.motion = \"allowed\"; it "
            "is refused",
            {axis, controlword});
}

void CanServer::send(std::span<const ShownAxis> axes) {
  const auto& config = frames_.config();
  if (config.sends_sync) send(hal::can::plain_sync);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto& axis = axes[i];
    const double unit = config.increment;
    frames_.node(i).step(now_ns_, axis.fault, [this](const hal::can::Frame& frame) { send_classical(frame); });
    if (!frames_.node(i).exchanges()) continue;
    const auto position = to_units(axis.position, unit);
    if (hal::can::description_of(Pdo::position).exchanged_at(config.frames))
      send(hal::can::encode_position(config.nodes[i], axis.statusword, position));
    else
      send(hal::can::encode_position(config.nodes[i], axis.statusword, position,
                                     to_thousandths(axis.current / config.current_limit[i])));
    if (hal::can::description_of(Pdo::motion).exchanged_at(config.frames))
      send(hal::can::encode_motion(config.nodes[i], to_units(axis.velocity, unit * velocity_increments),
                                   to_units(axis.following_error, unit)));
  }
}

// As every node of CANopen has them, on a bus with CAN FD as well.
void CanServer::send_classical(const hal::can::Frame& frame) {
  if (!socket_.send(frame, hal::can::Format::classical)) ++send_failed_;
}

void CanServer::send(const hal::can::Frame& frame) {
  if (!socket_.send(frame)) ++send_failed_;
}

}  // namespace stiction::drive
