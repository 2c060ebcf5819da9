// The stick-slip feed in time: sticks, breaks away, slides, sticks again. The instants of the change are roots of the
// event's function inside a step, not ends of steps; between them the method of Dormand and Prince holds its error
// estimate below a tolerance. The carriage of the source moves forwards only, and so does this one: at standstill
// friction takes whatever pushes it back.
#pragma once

#include <limits>
#include <vector>

#include "sim/plant/feed/dormand_prince.hpp"
#include "sim/plant/feed/equations.hpp"

namespace stiction::sim {

// Of the integration; the defaults are what the product runs with.
struct FeedAccuracy {
  double tolerance = 1e-10;    // of a step, relative to the largest value that a state has had
  double largest_step = 5e-4;  // s; a quarter of the period of the fastest carriage in the source's range (365 rad/s)
};

// One jump of the carriage; stop is NaN while it goes on.
struct FeedJump {
  double start = 0.0, stop = std::numeric_limits<double>::quiet_NaN();  // s
  double start_travel = 0.0, stop_travel = 0.0;                         // m
  double break_away_force = 0.0;                                        // N, of spring and damper at the start
  double dwell = 0.0;                                                   // s of standstill before; infinite at first
  double peak_speed = 0.0;                                              // m/s, at the ends of the steps

  double travel() const { return stop_travel - start_travel; }
  double duration() const { return stop - start; }
};

class StickSlipFeed {
 public:
  // From standstill of all states, after a long standstill of the carriage; the set-point stands at `feed` (m/s).
  // `drive`: parameters; `source`: ideal or controlled motor; `equations`: as printed or corrected; `accuracy`:
  // tolerance and largest step.
  StickSlipFeed(const machine::FeedDrive& drive, FeedSource source, FeedEquations equations, double feed,
                FeedAccuracy accuracy = {});

  // Goes on until `time` (s).
  void advance_to(double time);
  // Goes on until the next standstill or until `time`. True: it stands.
  bool advance_to_standstill(double time);

  double time() const { return time_; }
  bool sliding() const { return sliding_; }
  const FeedState& state() const { return state_; }
  const FeedSystem& system() const { return system_; }
  const std::vector<FeedJump>& jumps() const { return jumps_; }
  // The force of spring and damper, N, at which the standing carriage would break away now. In motion: what friction
  // and cutting take.
  double threshold() const;

 private:
  using Step = DormandPrinceStep<feed_state::count>;

  Step step(double h) const;
  // Its sign changes when the mode ends: the distance from break-away at standstill (N), the negative speed in motion.
  double event(const FeedState& state, double time) const;
  double event_slope(const FeedState& state, const FeedState& derivative, double time) const;
  void take_step(double limit);
  bool accept(const Step& trial, double& h);
  double first_event(const Step& whole, double h) const;
  void move(const Step& step, double h);
  void change_mode();

  FeedSystem system_;
  FeedAccuracy accuracy_;
  FeedState state_{}, derivative_{}, scale_{};
  double time_ = 0.0;
  double next_step_ = 1e-5;
  bool sliding_ = false;
  double stopped_at_ = -std::numeric_limits<double>::infinity();
  std::vector<FeedJump> jumps_;
};

}  // namespace stiction::sim
