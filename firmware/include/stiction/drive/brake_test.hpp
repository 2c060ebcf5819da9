// The test of a holding brake before it opens: the motor pushes against the closed brake, forwards and backwards, with
// a current that comes and goes slowly, and the axis must not go further than the brake yields.
#pragma once

#include <cstdint>

#include "stiction/control/limit.hpp"
#include "stiction/number/fixed.hpp"

namespace stiction {

template <class S>
struct BrakeTestConfig {
  typename S::Current current{};  // amplitude; 0: no test
  typename S::Position way{};     // that the brake may yield
  std::uint32_t ticks = 0;        // in which the current comes, is held, and goes, each
};

template <class S>
class BrakeTest {
 public:
  using Position = typename S::Position;
  using Current = typename S::Current;

  explicit constexpr BrakeTest(const BrakeTestConfig<S>& config) : config_(config) {}

  constexpr bool used() const { return config_.current != Current{}; }
  constexpr bool testing() const { return testing_; }
  constexpr bool slipped() const { return slipped_; }
  constexpr void forget() { slipped_ = false; }
  constexpr std::int64_t way() const { return farthest_; }  // of the last test, raw

  // The power has come on, `measured` is where the axis is. Nothing without a test.
  constexpr void begin(Position measured) {
    if (!used()) return;
    testing_ = true;
    tick_ = 0;
    farthest_ = 0;
    from_ = measured;
  }
  constexpr void stop() { testing_ = false; }

  // The current of a tick of the test, with the brake closed. `measured`: position.
  constexpr Current step(Position measured) {
    const std::int64_t gone = measured.raw() - from_.raw(), distance = gone < 0 ? -gone : gone;
    farthest_ = distance > farthest_ ? distance : farthest_;
    if (distance > config_.way.raw()) {
      slipped_ = true;
      testing_ = false;
      return {};
    }
    const std::uint32_t part = config_.ticks, of_push = tick_ % (3 * part);
    const std::uint32_t share = of_push < part ? of_push : of_push < 2 * part ? part : 3 * part - of_push;
    const std::int64_t raw = std::int64_t{config_.current.raw()} * share / part;
    const bool backwards = tick_ >= 3 * part;
    if (++tick_ == 6 * part) testing_ = false;
    return Current::from_bounded_raw(backwards ? -raw : raw);
  }

 private:
  BrakeTestConfig<S> config_;
  bool testing_ = false, slipped_ = false;
  std::uint32_t tick_ = 0;
  Position from_{};
  std::int64_t farthest_ = 0;
};

}  // namespace stiction
