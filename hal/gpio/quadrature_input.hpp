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
  // `lines` must outlive this. Throws GpioError. `config`: lines, increment and limits; `axis_name`: for messages.
  QuadratureInput(Lines& lines, const QuadratureConfig& config, const std::string& axis_name);

  // Counts what the last Lines::poll brought. `index`: edges of the index line of the same poll. `now_ns`: time of the
  // tick; `index_queue_was_full`: edges of it may be missing.
  void update(std::int64_t now_ns, std::span<const Edge> index, bool index_queue_was_full);

  // Known at time_ns(), unless there is a fault or the position is beyond +-4 m.
  bool valid() const { return valid_; }
  FixedSignals::Position position() const { return position_; }
  std::int64_t time_ns() const { return time_ns_; }
  std::int64_t count() const { return tracker_.count(); }
  std::int64_t last_edge_ns() const { return tracker_.last_edge_ns(); }
  // Holds as long as its cause and calm_ns longer; then the count begins again at 0, which is another position and
  // wants homing.
  QuadratureFault fault() const { return tracker_.fault(); }
  QuadratureFault last_fault() const { return last_fault_; }  // since the start; none: there was none
  std::uint64_t lost_edges() const { return lines_.lost_edges(a_) + lines_.lost_edges(b_); }
  std::optional<FixedSignals::Position> take_index();

  // Begins at 0 with the levels of the last poll and no fault.
  void restart();

  // Without a new cause for so long: longer than a contact bounces or a burst of noise pauses.
  static constexpr std::int64_t calm_ns = 100'000'000;

 private:
  std::optional<FixedSignals::Position> position_of(std::int64_t count) const;
  void recover(std::int64_t now_ns);

  Lines& lines_;
  std::size_t a_, b_;
  std::int64_t increment_;  // 2^-60 m
  QuadratureTracker tracker_;
  std::uint64_t lost_before_ = 0;
  std::uint64_t trips_before_ = 0;
  std::int64_t tripped_ns_ = 0;  // when the last cause was seen
  QuadratureFault last_fault_ = QuadratureFault::none;
  FixedSignals::Position position_{};
  std::int64_t time_ns_ = 0;
  bool valid_ = false;
};

}  // namespace stiction::hal
