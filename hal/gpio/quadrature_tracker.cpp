#include "hal/gpio/quadrature_tracker.hpp"

#include <cmath>
#include <utility>

namespace stiction::hal {

const char* name_of(QuadratureFault fault) {
  static constexpr std::array names{
      "none", "both tracks changed at once", "lost edge", "over-speed", "edge queue full", "late edge"};
  return names[static_cast<std::size_t>(fault)];
}

QuadratureTracker::QuadratureTracker(double rate, std::int64_t settle_ns)
    : settle_ns_(settle_ns), window_ns_(rate > 0.0 ? std::llround(window * 1e9 / rate) : 0) {}

void QuadratureTracker::start(bool a, bool b) {
  decoder_ = QuadratureDecoder(a, b);
  fault_ = QuadratureFault::none;
  for (auto& queue : queues_) queue.clear();
  counted_until_ns_ = 0;
  edges_ = 0;
  index_.reset();
}

void QuadratureTracker::add(Track track, const Edge& edge) {
  if (edge.time_ns <= counted_until_ns_) trip(QuadratureFault::late_edge);
  if (!queue(track).push(edge)) trip(QuadratureFault::queue_full);
}

void QuadratureTracker::trip(QuadratureFault fault) {
  ++trips_;
  if (fault_ == QuadratureFault::none) fault_ = fault;
}

const Edge* QuadratureTracker::earliest(std::int64_t until_ns) const {
  const Edge* found = nullptr;
  for (const auto& queue : queues_)
    if (!queue.empty() && queue.front().time_ns <= until_ns &&
        (found == nullptr || queue.front().time_ns < found->time_ns))
      found = &queue.front();
  return found;
}

std::int64_t QuadratureTracker::advance(std::int64_t now_ns) {
  const std::int64_t until_ns = now_ns - settle_ns_;
  while (const Edge* edge = earliest(until_ns)) step(edge->time_ns);
  if (until_ns > counted_until_ns_) counted_until_ns_ = until_ns;
  return until_ns;
}

// Everything that happened at `time_ns`: the tracks first, so that an index at the same time has the newer count.
void QuadratureTracker::step(std::int64_t time_ns) {
  std::array<bool, 2> level{decoder_.a(), decoder_.b()};
  for (std::size_t track = 0; track < 2; ++track)
    while (!queues_[track].empty() && queues_[track].front().time_ns == time_ns) {
      const bool rising = queues_[track].front().rising;
      if (rising == level[track]) trip(QuadratureFault::lost_edge);
      level[track] = rising;
      queues_[track].pop();
    }
  const auto step = decoder_.set(level[0], level[1], time_ns);
  if (step == QuadratureDecoder::Step::illegal) trip(QuadratureFault::both_changed);
  if (step != QuadratureDecoder::Step::none) watch_rate(time_ns);
  auto& index = queue(Track::index);
  while (!index.empty() && index.front().time_ns == time_ns) {
    if (index.front().rising && !index_) index_ = decoder_.count();
    index.pop();
  }
}

void QuadratureTracker::watch_rate(std::int64_t time_ns) {
  auto& oldest = times_[edges_ % window];
  if (edges_ >= window && time_ns - oldest < window_ns_) trip(QuadratureFault::too_fast);
  oldest = time_ns;
  ++edges_;
}

std::optional<std::int64_t> QuadratureTracker::take_index() { return std::exchange(index_, std::nullopt); }

}  // namespace stiction::hal
