#include "hal/can/can_backend.hpp"

#include <linux/can.h>
#include <linux/can/error.h>

#include <algorithm>
#include <set>

namespace stiction::hal::can {
namespace {

// Read of the nodes' frames in a tick: a node that repeats itself without end does not hold the loop either.
constexpr std::uint32_t most_taken = 64;

// Read of the others' frames in a tick, so that a babbling node does not hold the loop: one more than is borne in
// sixteen.
constexpr std::uint32_t most_watched = FrameWatch::foreign_allowed + 1;

// How often an adapter that may have been unplugged is looked for.
constexpr std::int64_t look_round_ns = 100'000'000;

// The nodes' own identifiers.
std::vector<Filter> own_frames(const CanBackendConfig& config) {
  std::vector<Filter> filters;
  for (const int node : config.nodes) {
    filters.push_back({position_id + static_cast<std::uint32_t>(node), CAN_SFF_MASK});
    if (config.format == Format::classical)
      filters.push_back({current_id + static_cast<std::uint32_t>(node), CAN_SFF_MASK});
  }
  return filters;
}

std::vector<Filter> all_others(const CanBackendConfig& config) {
  auto filters = own_frames(config);
  for (const auto id : config.others) filters.push_back({id, CAN_SFF_MASK});
  for (auto& filter : filters) filter.inverted = true;
  return filters;
}

const CanBackendConfig& checked(const CanBackendConfig& config) {
  std::set<int> seen;
  for (const int node : config.nodes) {
    if (node < 1 || node > highest_node)
      throw CanError("can: found node " + std::to_string(node) + "; expected 1 to 127 for every axis");
    if (!seen.insert(node).second)
      throw CanError("can: found node " + std::to_string(node) + " twice; expected one node an axis");
  }
  if (config.nodes.empty()) throw CanError("can: found no node; expected one an axis");
  return config;
}

}  // namespace

CanBackend::CanBackend(const CanBackendConfig& config, TickClock& clock)
    : format_(checked(config).format),
      clock_(clock),
      answer_ns_(static_cast<std::int64_t>(config.answer_share * static_cast<double>(clock.period_ns()))),
      nodes_socket_(config.interface, config.format, own_frames(config), true),
      watch_socket_(config.interface, config.format, all_others(config), false) {
  const auto format = properties(format_);
  for (const int id : config.nodes)
    nodes_.push_back({id, AnswerCheck(format.feedback_frames, format.counter_mask), FrameWatch(clock.period_ns())});
}

std::int64_t CanBackend::wait_for_tick() {
  now_ns_ = clock_.wait();
  // The nodes follow the number, so that a tick that was missed here passes there as well.
  tick_ += started_ ? 1 + static_cast<std::uint32_t>(clock_.missed_before()) : 0;
  started_ = true;
  for (auto& node : nodes_) node.check.begin(tick_, now_ns_);
  send(encode_sync(tick_));
  return now_ns_;
}

// Through the socket that hears all others: a socket does not hear itself, and what another one sends under the drive's
// own identifiers is of nobody.
void CanBackend::send(const Frame& frame) {
  if (!watch_socket_.send(frame)) ++bus_.send_failed;
}

bool CanBackend::complete() const {
  return std::all_of(nodes_.begin(), nodes_.end(), [](const Node& node) { return node.check.complete(); });
}

void CanBackend::read(std::span<Feedback<Signals>> feedback) {
  Received received;
  unknown_id_now_ = 0;
  bus_off_now_ = false;
  // From when the tick really began: a late tick waits as long for its answers as any other.
  const std::int64_t deadline = now_ns_ + clock_.lateness_ns() + answer_ns_;
  std::uint32_t left = most_taken;
  while (left > 0 && !complete() && nodes_socket_.receive(received, deadline)) take(received), --left;
  // What is in the queue beyond the answers belongs to no tick to come.
  while (left > 0 && nodes_socket_.receive(received, 0)) take(received), --left;
  watch_bus();
  look_for_adapter();
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    auto& node = nodes_[i];
    node.check.end();
    node.fault = node.watch.step({.valid = node.check.complete(),
                                  .disturbed = node.check.bad_in_tick(),
                                  .foreign = unknown_id_now_,
                                  .bus_off = bus_off_ || bus_off_now_});
    if (node.check.complete()) {
      node.state = node.arriving;
      node.state.feedback.position_time_ns += now_ns_;
      feedback[i] = node.state.feedback;
    } else {
      feedback[i] = node.state.feedback;
      feedback[i].position_valid = false;
    }
  }
}

void CanBackend::take(const Received& received) {
  if (received.error) {
    ++bus_.error_frames;
    if ((received.frame.id & CAN_ERR_BUSOFF) != 0) bus_off_ = bus_off_now_ = true;
    if ((received.frame.id & CAN_ERR_RESTARTED) != 0) bus_off_ = false;
    return;
  }
  const Address address = address_of(received.frame, format_);
  const auto node =
      std::find_if(nodes_.begin(), nodes_.end(), [&](const Node& each) { return each.id == address.node; });
  if (node == nodes_.end() || (address.kind != Kind::position && address.kind != Kind::current)) {
    ++bus_.unknown_id;  // a node's identifier with another format's size
    ++unknown_id_now_;
    return;
  }
  std::uint32_t counter = 0;
  NodeFeedback state = node->arriving;
  if (!decode_feedback(format_, address.kind, received.frame, counter, state)) {
    node->check.take_damaged();
    return;
  }
  // Who hears a node is on the bus: a link that was taken down and up again reports no restart.
  bus_off_ = false;
  if (node->check.take(address.kind == Kind::current ? 1 : 0, counter, received.received_ns)) node->arriving = state;
}

void CanBackend::watch_bus() {
  Received received;
  for (std::uint32_t i = 0; i < most_watched && watch_socket_.receive(received, 0); ++i) {
    ++bus_.unknown_id;
    ++unknown_id_now_;
  }
}

// While the frames of every node are lost, or the controller is off the bus, which has switched the axes off.
void CanBackend::look_for_adapter() {
  const bool all_lost = std::all_of(nodes_.begin(), nodes_.end(), [](const Node& node) {
    return node.fault == Fault::frames_lost || node.fault == Fault::bus_off;
  });
  if (!all_lost || now_ns_ < look_again_ns_) return;
  look_again_ns_ = now_ns_ + look_round_ns;
  nodes_socket_.find_again();
  watch_socket_.find_again();
}

void CanBackend::read_inputs(std::span<DigitalInputs<Signals>> inputs) const {
  for (std::size_t i = 0; i < nodes_.size(); ++i) inputs[i] = nodes_[i].state.inputs;
}

void CanBackend::read_protection(std::span<ProtectionInputs<Signals>> inputs) const {
  for (std::size_t i = 0; i < nodes_.size(); ++i) inputs[i] = nodes_[i].state.protection;
}

void CanBackend::write(std::span<const Command<Signals>> command) {
  for (std::size_t i = 0; i < nodes_.size(); ++i) send(encode_command(format_, nodes_[i].id, tick_, command[i]));
}

void CanBackend::cut_power() noexcept {
  for (const Node& node : nodes_) nodes_socket_.send(encode_command(format_, node.id, tick_, {}));
}

bool CanBackend::find_nodes(int ticks, std::vector<int>& silent) {
  std::vector<Feedback<Signals>> feedback(nodes_.size());
  for (int i = 0; i < ticks; ++i) {
    wait_for_tick();
    read(feedback);
    silent.clear();
    for (const auto& node : nodes_)
      if (!node.check.complete()) silent.push_back(node.id);
    if (silent.empty()) return true;
  }
  return false;
}

BusCounts CanBackend::bus_counts() const {
  BusCounts counts = bus_;
  counts.lost_in_kernel = nodes_socket_.lost_in_kernel() + watch_socket_.lost_in_kernel();
  return counts;
}

}  // namespace stiction::hal::can
