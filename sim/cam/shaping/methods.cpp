#include "sim/cam/shaping/methods.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/cam/characteristics.hpp"
#include "sim/cam/laws.hpp"
#include "sim/cam/shaping/band_optimal.hpp"
#include "sim/cam/shaping/input_shapers.hpp"
#include "sim/cam/shaping/inverse_dynamics.hpp"
#include "sim/cam/shaping/lift.hpp"
#include "sim/cam/shaping/pulses.hpp"
#include "sim/cam/shaping/wave_lift.hpp"

namespace stiction::sim::cam {
namespace {

using MaybeCurve = std::optional<Curve>;

constexpr std::string_view pulse_law = "polynomial_3_4_5";
// The 50 degrees of Dostrasil 2014 at 130/min, in periods of its load.
constexpr double pulse_periods = 0.93;

MaybeCurve as_it_is(const ShapingTask& task) {
  std::vector<Piece> pieces;
  for (const Piece& piece : task.motion.curve.pieces())
    if (piece.begin >= task.begin - 1e-12 && piece.end <= task.end() + 1e-9) pieces.push_back(piece);
  return Curve(std::move(pieces));
}

MaybeCurve dwell_pulse(const ShapingTask& task) {
  const double length = task.period_length();
  const auto pulse = tuned_dwell_pulse(task, length);
  return pulse ? MaybeCurve(with_dwell_pulse(task, *pulse, length)) : std::nullopt;
}

MaybeCurve pulse(const ShapingTask& task) {
  const double length = pulse_periods * task.period_length();
  const auto found = tuned_pulse(task, pulse_law, length);
  return found ? MaybeCurve(with_pulse(task, *found, pulse_law, length)) : std::nullopt;
}

MaybeCurve two_pulses(const ShapingTask& task) {
  const auto own = as_it_is(task);
  const auto pulses = pulse_pair(task, residual_of(task, *own, task.end()));
  return pulses ? MaybeCurve(with_pulses(task, *pulses)) : std::nullopt;
}

// A 3-4-5 polynomial through a shaper, within the rise.
template <std::size_t k>
MaybeCurve through_shaper(const ShapingTask& task) {
  const auto impulses = input_shapers()[k].impulses(task.mode().damping_ratio());
  const double period = task.period_length(), length = task.length() - impulses.back().time * period;
  if (length <= 0.0) return std::nullopt;
  Lift lift;
  lift.add(task.start);
  for (const Impulse& impulse : impulses)
    lift.add(law_curve("polynomial_3_4_5", task.begin + impulse.time * period, length, impulse.share * task.stroke));
  return lift.sampled(task.begin, task.end());
}

// y + y''/w^2 of a 4-5-6-7 polynomial (Dudley 1948): what an undamped load on a stiff drive needs.
MaybeCurve polydyne(const ShapingTask& task) {
  const double w = task.mode().frequency() / task.master_speed;
  const auto law = law_curve("polynomial_4_5_6_7", task.begin, task.length(), task.stroke);
  Lift lift;
  lift.add(task.start);
  lift.add(law);
  lift.add(law, 1.0 / (w * w), 2);
  return lift.sampled(task.begin, task.end());
}

MaybeCurve inverse_dynamics(const ShapingTask& task) { return inverse_lift(task, "polynomial_5_9"); }

MaybeCurve wave_based(const ShapingTask& task) { return wave_lift(task); }

MaybeCurve band_optimal(const ShapingTask& task) {
  const auto found = band_optimal_lift(task);
  return found ? MaybeCurve(found->lift) : std::nullopt;
}

// Of the laws from rest to rest that keep the limits and do not jump, the one that leaves least over the band.
MaybeCurve best_law(const ShapingTask& task) {
  MaybeCurve best;
  double least = 0.0;
  for (const Law& law : laws()) {
    if (law.kind != LawKind::rise || task_of(law) != "R-R" || law.ends == EndValues::second ||
        law.ends == EndValues::third)
      continue;
    MaybeCurve curve;
    try {
      curve = law_curve(law.name, task.begin, task.length(), task.stroke);
    } catch (const CamError&) {
      continue;  // one that has no defaults
    }
    const double unit = std::fabs(task.stroke) / (task.length() * task.length());
    const auto jumps = inner_jumps(*curve);
    const bool jumping = std::any_of(jumps.begin(), jumps.end(), [](const Jump& jump) { return jump.order <= 2; }) ||
                         std::fabs(curve->derivative(curve->begin(), 2)) > 1e-6 * unit ||
                         std::fabs(curve->derivative(curve->end(), 2, Side::left)) > 1e-6 * unit;
    if (jumping || extremes(*curve, 2).magnitude() > task.limits.acceleration * unit) continue;
    Lift lift;
    lift.add(task.start);
    lift.add(*curve);
    const Motion motion = compose(with_lift(task.motion.cam, lift.sampled(task.begin, task.end())));
    const double worst = band_figures(task, motion, 5).worst;
    if (best && worst >= least) continue;
    best = lift.sampled(task.begin, task.end());
    least = worst;
  }
  return best;
}

constexpr std::array<ShapingMethod, 14> methods{{
    {"none", "the motion as it is", "nothing", as_it_is},
    {"dwell-pulse", "pulse in the dwell, as first published", "frequency", dwell_pulse},
    {"pulse", "pulse in the rise, as extended", "place and amplitude, from trials or a model", pulse},
    {"two-pulses", "two pulses in the rise", "the residual of one cycle, frequency and damping", two_pulses},
    {"zv", "input shaper ZV on a 3-4-5 polynomial", "frequency and damping", through_shaper<0>},
    {"mzv", "input shaper MZV on a 3-4-5 polynomial", "frequency and damping", through_shaper<1>},
    {"zvd", "input shaper ZVD on a 3-4-5 polynomial", "frequency and damping, roughly", through_shaper<2>},
    {"ei", "input shaper EI on a 3-4-5 polynomial", "frequency and damping, roughly", through_shaper<3>},
    {"two-hump-ei", "input shaper EI with two humps on a 3-4-5 polynomial", "a band of frequencies", through_shaper<4>},
    {"polydyne", "polydyne of a 4-5-6-7 polynomial", "frequency", polydyne},
    {"inverse-dynamics", "inverse dynamics of a 5-9 polynomial", "the whole model of the drive", inverse_dynamics},
    {"wave-based", "half of the way sent off, what comes back taken up", "inertia of the load, stiffness of its shaft",
     wave_based},
    {"band-optimal", "band-optimal lift", "a band of frequencies, and the drive", band_optimal},
    {"best-law", "best law of the library", "a band of frequencies", best_law},
}};

// Cycles after which the residual that is carried over has settled: 0.56^24 of the first is 1e-6.
constexpr int running_cycles = 24;

}  // namespace

std::span<const ShapingMethod> shaping_methods() { return methods; }

const ShapingMethod* find_shaping_method(std::string_view name) {
  const auto all = shaping_methods();
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& method) { return method.name == name; });
  return found == all.end() ? nullptr : &*found;
}

std::optional<ShapedMotion> shaped(const ShapingTask& task, const ShapingMethod& method) {
  const auto lift = method.lift(task);
  if (!lift) return std::nullopt;
  ShapedMotion result;
  result.method = &method;
  result.cam = &method == &shaping_methods().front() ? task.motion.cam : with_lift(task.motion.cam, *lift);
  result.motion = compose(result.cam);
  constexpr int frequencies = 5;
  result.from_rest = band_figures(task, result.motion, frequencies);
  result.running = band_figures(task, result.motion, frequencies, running_cycles);
  const double w = task.master_speed;
  result.speed = extremes(*lift, 1).magnitude() * w;
  result.acceleration = extremes(*lift, 2).magnitude() * w * w;
  result.jerk = extremes(*lift, 3).magnitude() * w * w * w;
  const double time = task.rise_time();
  result.acceleration_ratio = result.acceleration / (4.0 * std::fabs(task.stroke) / (time * time));
  result.rise = lift->length();
  return result;
}

}  // namespace stiction::sim::cam
