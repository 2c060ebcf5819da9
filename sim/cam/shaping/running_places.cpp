#include "sim/cam/shaping/running_places.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "sim/cam/shaping/lift.hpp"
#include "sim/cam/stand/response.hpp"

namespace stiction::sim::cam {
namespace {

using Complex = std::complex<double>;
// An eighth of a period; the drive's own mode lasts for about that long.
constexpr double places_grid = 0.125;
// Between two samples of a response: a hundredth of the load's period and less, which a line follows to 0.05 %.
constexpr double response_step = 0.5e-3;  // s

// What a lift of the amplitude one makes: of the load and of the drive's force at samples from the rise's beginning on,
// and of the load's mode with the identified frequency and with those at the ends of its interval.
struct LiftResponse {
  std::vector<double> load, force;
  std::array<Complex, 3> residual{};

  LiftResponse& add(const LiftResponse& other, double gain) {
    for (std::size_t k = 0; k < load.size(); ++k) {
      load[k] += gain * other.load[k];
      force[k] += gain * other.force[k];
    }
    for (std::size_t k = 0; k < residual.size(); ++k) residual[k] += gain * other.residual[k];
    return *this;
  }
};

class RunningRise {
 public:
  RunningRise(const ShapingTask& task, const RunningResidual& wanted)
      : task_(task), wanted_(wanted), mode_(task.mode()), own_(made_by(own_rise(task, 1.0), task.start)) {}

  // None where the pulses have no room, or ask for more force than there is.
  std::optional<double> area(const PulsePlaces& places) {
    const double period = task_.period_length(), length = places.length * period;
    const double second = task_.end() - places.before * period - length, first = second - places.apart * period;
    if (first < task_.begin) return std::nullopt;
    const LiftResponse &u = of_pulse(first, length), &v = of_pulse(second, length);
    double largest = 0.0;
    for (const auto& [target, carried] :
         {std::pair{wanted_.all, wanted_.carried}, std::pair{wanted_.all - wanted_.carried, Complex{}}}) {
      const Complex by_first = u.residual[0] - own_.residual[0], by_second = v.residual[0] - own_.residual[0];
      const double determinant = by_first.real() * by_second.imag() - by_first.imag() * by_second.real();
      const double a = (-target.real() * by_second.imag() + target.imag() * by_second.real()) / determinant;
      const double b = (-target.imag() * by_first.real() + target.real() * by_first.imag()) / determinant;
      LiftResponse all = own_;
      all.add(own_, task_.stroke - a - b - 1.0).add(u, a).add(v, b);
      // What is carried over pushes too.
      const double vibration = 2.0 * std::abs(carried) * std::norm(mode_.pole) * task_.drive.load_inertia;
      for (const double force : all.force)
        if (std::fabs(force) + vibration > wanted_.largest_force) return std::nullopt;
      // With a different frequency the pulses leave what they make there more or less than here.
      const Complex here = a * by_first + b * by_second;
      largest = std::max(largest, in_dwell(all, carried));
      for (const std::size_t end : {1u, 2u}) {
        const Complex there = a * (u.residual[end] - own_.residual[end]) + b * (v.residual[end] - own_.residual[end]);
        largest = std::max(largest, in_dwell(all, carried + there - here));
      }
    }
    return largest;
  }

 private:
  double in_dwell(const LiftResponse& all, Complex vibration) const {
    double sum = 0.0;
    for (std::size_t k = first_of_dwell(); k < all.load.size(); ++k) {
      const double time = response_step * static_cast<double>(k) - task_.rise_time();
      sum += std::fabs(all.load[k] - task_.stroke + 2.0 * (vibration * std::exp(mode_.pole * time)).real());
    }
    return sum * response_step * task_.master_speed;
  }
  std::size_t first_of_dwell() const { return static_cast<std::size_t>(std::ceil(task_.rise_time() / response_step)); }

  const LiftResponse& of_pulse(double position, double length) {
    auto& made = pulses_[{position, length}];
    if (made.load.empty()) {
      Lift lift;
      lift.add(law_curve("polynomial_3_4_5", position, length, 1.0));
      made = made_by(lift.sampled(task_.begin, task_.end()), 0.0);
    }
    return made;
  }

  // Of a `lift` from `rest` by one.
  LiftResponse made_by(const Curve& lift, double rest) const {
    std::vector<Piece> pieces = lift.pieces();
    const double end = std::min(task_.dwell.end(), task_.motion.curve.length());
    pieces.push_back(polynomial_piece(lift.end(), end, {lift.derivative(lift.end(), 0, Side::left)}));
    const Motion motion{.cam = {}, .curve = Curve(std::move(pieces)), .segments = {}};
    const ResponseSettings settings{.master_speed = task_.master_speed, .step = response_step};
    const auto states = transfer_response(task_.drive, motion, settings);
    const auto forces = transfer_forces(task_.drive, motion, settings);
    LiftResponse made;
    std::size_t k = 1;
    for (double at = task_.begin; at <= end; at += response_step * task_.master_speed) {
      while (k + 1 < states.size() && states[k].master < at) ++k;
      const double share = (at - states[k - 1].master) / (states[k].master - states[k - 1].master);
      made.load.push_back(states[k - 1].position + share * (states[k].position - states[k - 1].position) - rest);
      made.force.push_back(forces[k - 1] + share * (forces[k] - forces[k - 1]));
    }
    constexpr double normal_95 = 1.96;
    const double off = normal_95 * wanted_.frequency_error;
    const std::array factors{1.0, 1.0 - off, 1.0 + off};
    for (std::size_t i = 0; i < factors.size(); ++i) {
      ShapingTask there = task_;
      there.drive = task_.drive.with_load_frequency(factors[i]);
      made.residual[i] = residual_of(there, lift, task_.end());
    }
    return made;
  }

  const ShapingTask& task_;
  RunningResidual wanted_;
  Mode mode_;
  LiftResponse own_;
  std::map<std::pair<double, double>, LiftResponse> pulses_;
};

}  // namespace

std::vector<PulsePlaces> running_places(const ShapingTask& task, const RunningResidual& residual) {
  RunningRise rise(task, residual);
  std::vector<std::pair<double, PulsePlaces>> found;
  const double room = task.periods();
  for (double length = 0.5; length <= std::min(room, 1.25); length += places_grid)
    for (double apart = places_grid; apart <= std::min(room, 0.875); apart += places_grid)
      for (double before = 0.0; before <= std::min(room, 1.0); before += places_grid)
        if (const auto area = rise.area({length, apart, before})) found.push_back({*area, {length, apart, before}});
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<PulsePlaces> places;
  for (const auto& each : found) places.push_back(each.second);
  return places;
}

}  // namespace stiction::sim::cam
