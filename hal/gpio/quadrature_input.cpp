#include "hal/gpio/quadrature_input.hpp"

#include <fmt/format.h>

#include <cmath>

namespace stiction::hal {
namespace {

// The increment as 2^-60 m rounds to 1e-18 m, 1 nm in 10^9 edges, and leaves +-4 m below 2^62.
constexpr int increment_bits = 60;
constexpr int position_shift = increment_bits - FixedSignals::Position::fraction_bits;

const QuadratureConfig& checked(const QuadratureConfig& config, const std::string& axis_name) {
  if (!config.a.wired() || !config.b.wired())
    throw GpioError(fmt::format("axis {}: an encoder needs two lines; set quadrature_a and quadrature_b", axis_name));
  if (!(config.increment > 0.0) || config.increment > 1e-3)
    throw GpioError(fmt::format("axis {}: quadrature_increment is {} m; expected above 0, up to 1 mm", axis_name,
                                config.increment));
  return config;
}

}  // namespace

QuadratureInput::QuadratureInput(Lines& lines, const QuadratureConfig& config, const std::string& axis_name)
    : lines_(lines),
      a_(lines.add_input(checked(config, axis_name).a, "axis " + axis_name + " track A")),
      b_(lines.add_input(config.b, "axis " + axis_name + " track B")),
      increment_(std::llround(std::ldexp(config.increment, increment_bits))),
      tracker_(config.rate, config.settle_ns) {
  restart();
}

void QuadratureInput::restart() {
  tracker_.start(lines_.level(a_), lines_.level(b_));
  lost_before_ = lost_edges();
  trips_before_ = tracker_.trips();
}

void QuadratureInput::update(std::int64_t now_ns, std::span<const Edge> index, bool index_queue_was_full) {
  using Track = QuadratureTracker::Track;
  if (lost_edges() != lost_before_) tracker_.trip(QuadratureFault::lost_edge);
  lost_before_ = lost_edges();
  if (lines_.queue_was_full(a_) || lines_.queue_was_full(b_) || index_queue_was_full)
    tracker_.trip(QuadratureFault::queue_full);
  for (const auto& edge : lines_.edges(a_)) tracker_.add(Track::a, edge);
  for (const auto& edge : lines_.edges(b_)) tracker_.add(Track::b, edge);
  for (const auto& edge : index) tracker_.add(Track::index, edge);
  time_ns_ = tracker_.advance(now_ns);
  recover(now_ns);
  const auto position = position_of(tracker_.count());
  valid_ = position && tracker_.fault() == QuadratureFault::none && !lines_.failed();
  if (position) position_ = *position;
}

void QuadratureInput::recover(std::int64_t now_ns) {
  if (tracker_.fault() == QuadratureFault::none) return;
  last_fault_ = tracker_.fault();
  if (tracker_.trips() != trips_before_) tripped_ns_ = now_ns;
  trips_before_ = tracker_.trips();
  if (now_ns - tripped_ns_ >= calm_ns) restart();
}

std::optional<FixedSignals::Position> QuadratureInput::position_of(std::int64_t count) const {
  const std::int64_t most = (std::int64_t{1} << 62) / increment_;
  if (count < -most || count > most) return std::nullopt;
  const std::int64_t exact = count * increment_;
  constexpr std::int64_t half = std::int64_t{1} << (position_shift - 1);
  return FixedSignals::Position::from_raw((exact + half) >> position_shift);
}

std::optional<FixedSignals::Position> QuadratureInput::take_index() {
  const auto count = tracker_.take_index();
  return count ? position_of(*count) : std::nullopt;
}

}  // namespace stiction::hal
