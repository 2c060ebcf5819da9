// Position of an incremental encoder from the time-stamped edges of its lines, or the reason why it is not known.
//
// The lines' queues are read one after the other and an edge reaches its queue some time after its interrupt, so that
// edges of A and B come out of order; out of order they count backwards without any illegal step. They are therefore
// put in order by their time stamps once they are old enough that no older one can follow (`settle_ns`). Whatever
// would make the count wrong without a sign is a fault that stays: the position is then lost until a new reference.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "hal/gpio/edge_queue.hpp"
#include "hal/gpio/quadrature.hpp"

namespace stiction::hal {

enum class QuadratureFault : std::uint8_t {
  none,
  both_changed,  // A and B at once: noise, or an edge that was lost
  lost_edge,     // the same edge twice in a row, or a level that no edge announced
  too_fast,      // more edges than the stated rate, over eight of them
  queue_full,    // the kernel's queue was full: newer edges may have been dropped
  late_edge,     // an edge came later than its settling time, after newer ones had been counted
};
const char* name_of(QuadratureFault fault);

class QuadratureTracker {
 public:
  enum class Track : std::uint8_t { a, b, index };

  // `rate`: edges a second; 0: not watched. Times in ns.
  QuadratureTracker(double rate, std::int64_t settle_ns);

  // Starts at count 0 with these levels and no fault.
  void start(bool a, bool b);

  // An edge of a track, of each track in its order.
  void add(Track track, const Edge& edge);
  void trip(QuadratureFault fault);  // the first one stays

  // Counts the edges up to the settling time before `now_ns` and returns that time.
  std::int64_t advance(std::int64_t now_ns);

  std::int64_t count() const { return decoder_.count(); }
  std::int64_t last_edge_ns() const { return decoder_.last_edge_ns(); }
  QuadratureFault fault() const { return fault_; }
  std::uint64_t trips() const { return trips_; }  // causes seen, since the construction

  // The count at the first rising edge of the index since the last call.
  std::optional<std::int64_t> take_index();

 private:
  static constexpr std::size_t window = 8;  // edges: tracks that are not quite a quarter apart give uneven intervals

  EdgeQueue& queue(Track track) { return queues_[static_cast<std::size_t>(track)]; }
  const Edge* earliest(std::int64_t until_ns) const;
  void step(std::int64_t time_ns);
  void watch_rate(std::int64_t time_ns);

  std::int64_t settle_ns_;
  std::int64_t window_ns_;  // below which eight edges are too fast
  std::array<EdgeQueue, 3> queues_;
  QuadratureDecoder decoder_;
  QuadratureFault fault_ = QuadratureFault::none;
  std::uint64_t trips_ = 0;
  std::int64_t counted_until_ns_ = 0;
  std::array<std::int64_t, window> times_{};
  std::uint64_t edges_ = 0;
  std::optional<std::int64_t> index_;
};

}  // namespace stiction::hal
