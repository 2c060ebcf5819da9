// A backend with faults on command around any other: what a broken encoder, sensor, switch, power stage, bus or clock
// shows at the control's border. Frames are modelled as far as that border knows them: each tick brings one of a node,
// with a counter; what happens to it is told by FrameWatch as a wired backend tells it. The power stage behind it
// switches itself off when it gets no command for three ticks.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "firmware/machine/configuration/conversion.hpp"
#include "hal/backend.hpp"
#include "hal/frame_watch.hpp"
#include "stiction/control/delay_line.hpp"

namespace stiction::hal {

enum class FrameFault : std::uint8_t {
  none,
  lost,          // it never comes
  late,          // a tick later, before the next one
  out_of_order,  // a tick later, behind the next one
  twice,
  stale,    // an old one comes in its place
  damaged,  // its checksum is wrong
};

enum class SwitchFault : std::uint8_t { none, stuck_open, stuck_closed };

// What is wrong with an axis, held until changed. SI units.
struct AxisFaults {
  bool encoder_open = false;               // no position
  bool encoder_frozen = false;             // the last one again and again, as if it were new
  double encoder_shift = 0.0;              // m, on every position
  std::optional<int> flipped_bit;          // of the count of increments
  bool motor_reversed = false;             // all phases turned by half a period: force and current of the other sign
  std::array<double, 3> current_offset{};  // A, of the phases
  std::uint64_t late_commands = 0;         // ticks by which the power stage obeys late, at most 15
  bool power_stage = false;                // it reports a fault and is off
  FrameFault frame = FrameFault::none;
  std::uint64_t frame_period = 1;    // ticks from one frame with a fault to the next
  std::uint32_t foreign_frames = 0;  // with an unknown identifier, each tick
  bool bus_off = false;
  bool encoder_signal = false;  // the backend's watch over the encoder's edges: the position is lost
  SwitchFault negative_switch = SwitchFault::none, positive_switch = SwitchFault::none;
};

// Where the switches and the mark of an axis are, m. None: not there. The home switch is reached from there downwards.
struct AxisMarks {
  std::optional<double> limit_negative, limit_positive, home, index;
  double index_every = 0.0;  // from one mark to the next, as on a scale; 0: a single one
};

template <Backend B>
class FaultyBackend {
 public:
  using Signals = typename B::Signals;
  using S = Signals;

  static constexpr std::uint64_t silent_ticks_allowed = 2;  // of the power stage, without a command

  // `increment` (m): of the encoders, whose bits can flip. `inner`: must outlive this; `period_ns`: of the fast loop.
  FaultyBackend(B& inner, std::int64_t period_ns, double increment)
      : inner_(inner), increment_(increment), command_(inner.axis_count()) {
    for (std::size_t i = 0; i < inner.axis_count(); ++i) nodes_.push_back(Node{FrameWatch(period_ns)});
    feedback_.resize(inner.axis_count());
  }

  AxisFaults& faults(std::size_t axis) { return nodes_[axis].faults; }
  AxisMarks& marks(std::size_t axis) { return nodes_[axis].marks; }
  std::uint64_t disturbed(std::size_t axis) const { return nodes_[axis].disturbed; }  // frames since the start
  void miss_ticks(int count) { miss_ = count; }                                       // before the next one
  void jump_clock(std::int64_t ns) { clock_shift_ns_ += ns; }

  std::size_t axis_count() const { return inner_.axis_count(); }

  std::int64_t wait_for_tick() {
    std::int64_t now_ns = inner_.wait_for_tick();
    for (int i = 0; i < miss_; ++i) {
      ++silent_ticks_;
      if (silent_ticks_ > silent_ticks_allowed) send_nothing();
      now_ns = inner_.wait_for_tick();
    }
    miss_ = 0;
    ++tick_;
    return now_ns + clock_shift_ns_;
  }

  void read(std::span<Feedback<S>> feedback) {
    inner_.read(feedback_);
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      auto& node = nodes_[i];
      find_marks(node, feedback_[i]);
      Feedback<S> seen = feedback_[i];
      break_sensors(node, seen);
      feedback[i] = through_bus(node, seen);
      // The clock of the loop is not that of the bus: what is stamped on arrival is shifted with it.
      feedback[i].position_time_ns += clock_shift_ns_;
    }
  }

  void write(std::span<const Command<S>> command) {
    bool sent = true;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const auto& faults = nodes_[i].faults;
      sent = sent && !faults.bus_off;
      auto& queue = nodes_[i].commands;
      queue.push(command[i]);
      command_[i] = faults.power_stage ? Command<S>{} : queue.at(static_cast<std::uint32_t>(faults.late_commands));
      if (faults.motor_reversed)
        for (auto& u : command_[i].voltage) u = opposite(u);
    }
    silent_ticks_ = sent ? 0 : silent_ticks_ + 1;
    if (sent)
      inner_.write(command_);
    else if (silent_ticks_ > silent_ticks_allowed)
      send_nothing();
  }

  void read_inputs(std::span<DigitalInputs<S>> inputs) {
    for (std::size_t i = 0; i < nodes_.size(); ++i) inputs[i] = nodes_[i].inputs;
  }
  Fault fault(std::size_t axis) const { return nodes_[axis].seen; }

  void set_brake(std::size_t axis, bool released) { nodes_[axis].brake_released = released; }
  bool brake_released(std::size_t axis) const { return nodes_[axis].brake_released; }

 private:
  struct Node {
    FrameWatch watch;
    AxisFaults faults{};
    AxisMarks marks{};
    DigitalInputs<S> inputs{};
    Fault seen = Fault::none;
    std::uint64_t disturbed = 0;
    DelayLine<Command<S>, 16> commands{};
    bool known = false;    // a position came before
    Feedback<S> newest{};  // that came over the bus
    bool late = false;     // the frame of the tick before comes with this one
    bool frozen = false;
    typename S::Position frozen_at{};
    typename S::Position before{};  // the position of the tick before, undisturbed
    bool brake_released = false;
  };

  static bool shows(SwitchFault fault, bool reached) {
    return fault == SwitchFault::stuck_closed || (fault == SwitchFault::none && reached);
  }

  // The index mark that was passed on the way from one tick to the next; of several the last.
  static std::optional<double> mark_between(const AxisMarks& marks, double before, double x) {
    const double first = *marks.index, every = marks.index_every;
    if (every <= 0.0) return (before < first) != (x < first) ? std::optional(first) : std::nullopt;
    const double from = std::floor((before - first) / every), to = std::floor((x - first) / every);
    if (from == to) return std::nullopt;
    return first + every * (to > from ? to : to + 1.0);
  }

  void find_marks(Node& node, const Feedback<S>& f) {
    const double x = machine::to_si(f.position), before = node.known ? machine::to_si(node.before) : x;
    const auto& marks = node.marks;
    node.inputs.limit_negative = shows(node.faults.negative_switch, marks.limit_negative && x <= *marks.limit_negative);
    node.inputs.limit_positive = shows(node.faults.positive_switch, marks.limit_positive && x >= *marks.limit_positive);
    node.inputs.home = marks.home && x <= *marks.home;
    const auto passed = marks.index ? mark_between(marks, before, x) : std::nullopt;
    node.inputs.index = passed.has_value();
    if (passed) machine::convert(*passed, node.inputs.index_position);
    node.before = f.position;
    node.known = true;
  }

  void break_sensors(Node& node, Feedback<S>& f) const {
    const auto& faults = node.faults;
    if (faults.encoder_shift != 0.0) machine::convert(machine::to_si(f.position) + faults.encoder_shift, f.position);
    if (faults.flipped_bit) {
      const auto count = static_cast<std::int64_t>(std::llround(machine::to_si(f.position) / increment_));
      machine::convert(static_cast<double>(count ^ (std::int64_t{1} << *faults.flipped_bit)) * increment_, f.position);
    }
    if (faults.encoder_frozen && !node.frozen) node.frozen_at = f.position;
    node.frozen = faults.encoder_frozen;
    if (node.frozen) f.position = node.frozen_at;
    if (faults.encoder_open || faults.encoder_signal) f.position_valid = false;
    SaturationCounter meant;
    for (std::size_t k = 0; k < 3; ++k) {
      if (faults.motor_reversed) f.current[k] = opposite(f.current[k]);
      typename S::Current offset{};
      if (machine::convert(faults.current_offset[k], offset)) f.current[k] = saturated_sum(f.current[k], offset, meant);
    }
    f.fault |= faults.power_stage;
  }

  // The newest feedback that the bus gave. A frame that does not come leaves the one before, with its time.
  Feedback<S> through_bus(Node& node, const Feedback<S>& sent) {
    const auto& faults = node.faults;
    const bool hit = faults.frame != FrameFault::none && tick_ % faults.frame_period == 0;
    const FrameFault fault = hit ? faults.frame : FrameFault::none;
    FrameCounts counts;
    counts.bus_off = faults.bus_off;
    counts.foreign = faults.foreign_frames;
    counts.valid = !faults.bus_off && (fault == FrameFault::none || fault == FrameFault::twice);
    counts.disturbed = (fault == FrameFault::twice || fault == FrameFault::stale || fault == FrameFault::damaged) +
                       (node.late ? 1u : 0u);
    node.late = fault == FrameFault::late || fault == FrameFault::out_of_order;
    node.disturbed += counts.disturbed;
    node.seen = node.watch.step(counts);
    if (faults.encoder_signal) node.seen = Fault::encoder_signal;
    if (counts.valid) node.newest = sent;
    return node.newest;
  }

  void send_nothing() {
    for (auto& command : command_) command = {};
    inner_.write(command_);
  }

  B& inner_;
  double increment_;
  std::uint64_t tick_ = 0;
  std::int64_t clock_shift_ns_ = 0;
  int miss_ = 0;
  std::uint64_t silent_ticks_ = 0;
  std::vector<Node> nodes_;
  std::vector<Feedback<S>> feedback_;
  std::vector<Command<S>> command_;
};

}  // namespace stiction::hal
