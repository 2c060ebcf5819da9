// An incremental encoder on two lines, and its index mark if that is wired.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "hal/gpio/lines.hpp"
#include "hal/gpio/quadrature_tracker.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::hal {

class QuadratureInput {
 public:
  // `lines` must outlive this. Throws GpioError.
  QuadratureInput(Lines& lines, const QuadratureConfig& config, const std::string& axis_name);

  // Counts what the last Lines::poll brought. `index`: edges of the index line of the same poll.
  void update(std::int64_t now_ns, std::span<const Edge> index, bool index_queue_was_full);

  // Known at time_ns(), unless there is a fault or the position is beyond +-4 m.
  bool valid() const { return valid_; }
  FixedSignals::Position position() const { return position_; }
  std::int64_t time_ns() const { return time_ns_; }
  std::int64_t count() const { return tracker_.count(); }
  std::int64_t last_edge_ns() const { return tracker_.last_edge_ns(); }
  QuadratureFault fault() const { return tracker_.fault(); }
  std::uint64_t lost_edges() const { return lines_.lost_edges(a_) + lines_.lost_edges(b_); }
  std::optional<FixedSignals::Position> take_index();

  // Forgets a fault and counts again from 0: the position is then another one and wants homing.
  void restart();

 private:
  std::optional<FixedSignals::Position> position_of(std::int64_t count) const;

  Lines& lines_;
  std::size_t a_, b_;
  std::int64_t increment_;  // 2^-60 m
  QuadratureTracker tracker_;
  std::uint64_t lost_before_ = 0;
  FixedSignals::Position position_{};
  std::int64_t time_ns_ = 0;
  bool valid_ = false;
};

}  // namespace stiction::hal
