#include "host/tune/pulse_tuning.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "host/simulate/quadrant_run.hpp"
#include "host/tune/lap_errors.hpp"

namespace stiction::host {
namespace {

// Amplitude in mm/s, delay and duration in ms.
using Point = std::array<double, 3>;
constexpr Point least_point{0.0, 0.0, 0.2}, most_point{5.0, 60.0, 120.0};

struct Trial {
  Point point{};
  double error = std::numeric_limits<double>::infinity();  // m
};
bool better(const Trial& a, const Trial& b) { return a.error < b.error; }

constexpr std::array amplitudes{0.2, 0.6, 1.8, 4.0}, durations{5.0, 15.0, 30.0, 60.0};
constexpr std::array delays{3.0, 10.0};
constexpr std::size_t trials_of_a_round = 16;  // lanes of the widest vectors
constexpr std::size_t simplices = 4;           // that share a round: each tries four points
constexpr int stages = 3;                      // of the simplices: they become flat and are begun afresh

Point between(const Point& from, const Point& to, double share) {
  Point point;
  for (std::size_t i = 0; i < point.size(); ++i)
    point[i] = std::clamp(from[i] + share * (to[i] - from[i]), least_point[i], most_point[i]);
  return point;
}

// Nelder and Mead's, with all points that an iteration may ask for tried at once: the best of them takes the place of
// the worst corner, and where none is better than it, the corners draw near the best one.
class Simplex {
 public:
  // A corner at `start`, and one away from it by each of `steps`.
  Simplex(const Point& start, const Point& steps) {
    asked_.push_back(start);
    for (std::size_t i = 0; i < start.size(); ++i) {
      auto corner = start;
      corner[i] = std::clamp(corner[i] + steps[i], least_point[i], most_point[i]);
      asked_.push_back(corner);
    }
  }

  const std::vector<Point>& asked() const { return asked_; }
  const Trial& best() const { return corners_.front(); }

  // A trial for each of asked().
  void answer(std::span<const Trial> trials) {
    if (corners_.size() < corner_count) {
      corners_.insert(corners_.end(), trials.begin(), trials.end());
    } else {
      const auto& best = *std::min_element(trials.begin(), trials.end(), better);
      if (!better(best, corners_.back())) {
        asked_.clear();
        for (std::size_t k = 1; k < corner_count; ++k)
          asked_.push_back(between(corners_[k].point, corners_.front().point, 0.5));
        corners_.resize(1);
        return;
      }
      corners_.back() = best;
    }
    std::sort(corners_.begin(), corners_.end(), better);
    Point centre{};
    for (std::size_t k = 0; k + 1 < corner_count; ++k)
      for (std::size_t i = 0; i < centre.size(); ++i) centre[i] += corners_[k].point[i] / 3.0;
    asked_.clear();
    for (const double share : {2.0, 3.0, 1.5, 0.5}) asked_.push_back(between(corners_.back().point, centre, share));
  }

 private:
  static constexpr std::size_t corner_count = 4;  // corners in three dimensions

  std::vector<Trial> corners_;  // the best first
  std::vector<Point> asked_;
};

Simplex about(const Point& start, double size) {
  return {start, {0.4 * size * start[0], 2.0 * size, 0.3 * size * start[2]}};
}

// Simplices to all sides of the best point, smaller from stage to stage.
std::vector<Simplex> afresh(const Point& best, int stage) {
  std::vector<Simplex> all;
  for (const double size : {0.5, -0.5, 0.15, -0.15}) all.push_back(about(best, size / stage));
  return all;
}

class Search {
 public:
  Search(const machine::Machine& machine, std::size_t axis, const sim::CircleSettings& circle, int laps)
      : machine_(machine), axis_(axis), circle_(circle), laps_(laps) {}

  machine::PulseCompensationParameters pulse(const Point& point) const {
    machine::PulseCompensationParameters pulse;
    pulse.amplitude = point[0] * 1e-3;
    pulse.final_amplitude = pulse.amplitude;
    pulse.rise_until = 1e-3;  // below every acceleration that matters
    pulse.flat_until = machine_.axes[axis_].max_acceleration;
    pulse.fall_until = 2.0 * pulse.flat_until;
    pulse.delay = point[1] * 1e-3;
    pulse.duration = point[2] * 1e-3;
    return pulse;
  }

  machine::Machine with(const Point& point) const {
    auto machine = machine_;
    machine.axes[axis_].friction_compensation = {CompensationKind::pulse, pulse(point), {}, {}, {}};
    return machine;
  }

  std::vector<Trial> tried(std::span<const Point> points) {
    std::vector<Trial> trials;
    for (std::size_t begin = 0; begin < points.size(); begin += trials_of_a_round) {
      const auto round = points.subspan(begin, std::min(trials_of_a_round, points.size() - begin));
      std::vector<machine::Machine> machines;
      for (const auto& point : round) machines.push_back(with(point));
      const auto errors = last_lap_errors(machines, axis_, circle_, laps_);
      for (std::size_t k = 0; k < round.size(); ++k) {
        trials.push_back({round[k], errors[k]});
        best_ = std::min(best_, trials.back(), better);
      }
    }
    count_ += static_cast<int>(points.size());
    return trials;
  }

  // Each simplex tries what it asks for.
  void round(std::vector<Simplex>& all) {
    std::vector<Point> points;
    for (const auto& simplex : all) points.insert(points.end(), simplex.asked().begin(), simplex.asked().end());
    const auto trials = tried(points);
    std::size_t begin = 0;
    for (auto& simplex : all) {
      const std::size_t asked = simplex.asked().size();
      simplex.answer(std::span(trials).subspan(begin, asked));
      begin += asked;
    }
  }

  const Trial& best() const { return best_; }
  int count() const { return count_; }

 private:
  const machine::Machine& machine_;
  std::size_t axis_;
  sim::CircleSettings circle_;
  int laps_;
  Trial best_;
  int count_ = 0;
};

std::vector<Point> grid() {
  std::vector<Point> points;
  for (const double delay : delays)
    for (const double duration : durations)
      for (const double amplitude : amplitudes) points.push_back({amplitude, delay, duration});
  return points;
}

}  // namespace

PulseTuning tune_pulse(const machine::Machine& given, std::size_t axis, const sim::CircleSettings& circle,
                       int evaluations) {
  constexpr int laps = 2;
  auto machine = given;
  machine.axes[axis].friction_compensation.reset();
  PulseTuning tuning;
  tuning.error_off = run_quadrants(machine, axis, circle, laps).peak_error.back();
  Search search(machine, axis, circle, laps);

  // From several starts, as the error has more than one valley: short strong pulses and long weak ones.
  auto starts = search.tried(grid());
  std::stable_sort(starts.begin(), starts.end(), better);
  std::vector<Simplex> all;
  for (std::size_t k = 0; k < simplices; ++k) all.push_back(about(starts[k].point, 1.0));
  const int rest = evaluations - search.count();
  for (int stage = 1; stage <= stages; ++stage) {
    const int until = evaluations - rest * (stages - stage) / stages;
    do search.round(all);
    while (search.count() + static_cast<int>(trials_of_a_round) <= until);
    if (stage < stages) all = afresh(search.best().point, stage);
  }
  // The firmware's signals round, which decides between points that are as good in double precision.
  tuning.error = std::numeric_limits<double>::infinity();
  std::vector<Trial> ends{search.best()};
  for (const auto& simplex : all) ends.push_back(simplex.best());
  for (const auto& end : ends) {
    const double error = run_quadrants(search.with(end.point), axis, circle, laps).peak_error.back();
    if (error >= tuning.error) continue;
    tuning.error = error;
    tuning.pulse = search.pulse(end.point);
  }
  tuning.evaluations = search.count();
  return tuning;
}

}  // namespace stiction::host
