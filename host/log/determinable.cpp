#include "host/log/determinable.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "sim/effects/effects.hpp"

namespace stiction::host {
namespace {

constexpr double separable = 20.0;      // variance inflation up to which two regressors count as told apart
constexpr double well_known = 0.1;      // standard error over value
constexpr double one_direction = 0.05;  // part of the moving samples that counts as going that way at all
constexpr double slow = 5e-3;           // m/s: a Stribeck velocity is of this size or below
constexpr double presliding = 20e-6;    // m behind a reversal in which friction builds up again
constexpr double long_enough = 300.0;   // s, for a drift with temperature
constexpr double some_seconds = 3.0;    // s, of which a spectrum has lines
constexpr double some_way = 1e-3;       // m

double mm_s(double speed) { return speed * 1e3; }

bool both_directions(const AxisInspection& out) {
  return out.forward > one_direction && out.forward < 1.0 - one_direction;
}

// Whether a log has what something needs.
struct Had {
  bool possible = false;
  std::string reason;  // in this log's numbers
  std::string remedy;  // what to record instead; empty when it is possible
};

// A parameter of the rigid fit.
Had rigid(const AxisInspection& out, std::size_t which, const char* confused, const char* remedy) {
  Had d{false, "", remedy};
  if (out.effort == nullptr || !out.fit) {
    d.reason = "the axis hardly moves";
    return d;
  }
  const auto& fit = *out.fit;
  // A constant force may well be none: it is known where its error is small beside the friction.
  const double size =
      which == 3 ? std::max(std::abs(fit.value[3]), std::abs(fit.value[2])) : std::abs(fit.value[which]);
  const double relative = size > 0.0 ? fit.error[which] / size : 1e9;
  if (fit.inflation[which] > separable) {
    d.reason = fmt::format("this motion does not separate it from {}", confused);
  } else if (relative > well_known) {
    d.reason = fmt::format(
        "its part of the {} is too small compared with the residual ({:.2g} {} rms): standard error {:.0f} %",
        out.effort->text, fit.residual, out.effort->unit, std::min(999.0, 100.0 * relative));
  } else {
    d.possible = true;
    d.reason =
        fmt::format("the standard error is about {:.2g} %{}", 100.0 * relative, which == 3 ? " of the friction" : "");
    d.remedy.clear();
  }
  return d;
}

Had directions(const AxisInspection& out) {
  if (both_directions(out)) return {true, fmt::format("{:.0f} % of the motion goes in +x", 100.0 * out.forward), ""};
  return {false, "the axis moves in one direction only", "the same segment in both directions"};
}

// Mean number of samples in which the axis moves by no more than `presliding` behind a reversal.
double samples_behind_reversals(const AxisLog& axis, const FittedMotion& motion) {
  std::size_t samples = 0, reversals = 0;
  double last = 0.0;
  for (std::size_t k = 0; k < axis.x.size(); ++k) {
    const double v = motion.v[k];
    if (v * last < 0.0) {
      ++reversals;
      for (std::size_t m = k; m < axis.x.size() && std::abs(axis.x[m] - axis.x[k]) < presliding; ++m) ++samples;
    }
    if (v != 0.0) last = v;
  }
  return reversals == 0 ? 0.0 : static_cast<double>(samples) / static_cast<double>(reversals);
}

// The least distance between two different positions: no finer than that the encoder tells.
double finest_step(const std::vector<double>& x) {
  double least = 0.0;
  for (std::size_t k = 1; k < x.size(); ++k)
    if (const double step = std::abs(x[k] - x[k - 1]); step > 0.0 && (least == 0.0 || step < least)) least = step;
  return least;
}

Had small_reversals(const AxisLog& axis, const FittedMotion& motion, const AxisInspection& out) {
  Had d{false, "",
        "slow reversals: a sine of 10 to 100 um, or a feed of some mm/s that reverses, at 1 kHz or faster and with "
        "an encoder of 0.1 um or finer"};
  const double samples = samples_behind_reversals(axis, motion);
  const double step = finest_step(axis.x);
  if (out.reversals < 2)
    d.reason = fmt::format("{} reversal{}", out.reversals, out.reversals == 1 ? "" : "s");
  else if (samples < 10.0)
    d.reason = fmt::format("{:.1f} samples in the first {:.0f} um after a reversal", samples, presliding * 1e6);
  else if (step > 1e-6)
    d.reason = fmt::format("the position has steps of {:.2g} um", step * 1e6);
  else
    d = {true,
         fmt::format("{} reversals, {:.0f} samples each in the first {:.0f} um", out.reversals, samples,
                     presliding * 1e6),
         ""};
  return d;
}

Had slow_speeds(const AxisInspection& out) {
  const auto slow_ones = std::ranges::count_if(out.plateaus, [](const auto& p) { return std::abs(p.speed) <= slow; });
  if (slow_ones >= 2) return {true, fmt::format("{} constant speeds up to {:.0f} mm/s", slow_ones, mm_s(slow)), ""};
  return {false, fmt::format("{} constant speed{} up to {:.0f} mm/s", slow_ones, slow_ones == 1 ? "" : "s", mm_s(slow)),
          "constant speeds of 0.1, 0.3, 1 and 3 mm/s in both directions, a second each"};
}

Had many_speeds(const AxisInspection& out) {
  double slowest = 0.0, fastest = 0.0;
  for (const auto& p : out.plateaus) {
    const double speed = std::abs(p.speed);
    if (slowest == 0.0 || speed < slowest) slowest = speed;
    fastest = std::max(fastest, speed);
  }
  const auto count = out.plateaus.size();
  Had d{false, "", "at least five constant speeds over a range of 10 to 1, in both directions"};
  if (count >= 8 && fastest > 5.0 * slowest)
    d = {true, fmt::format("{} constant speeds from {:.3g} to {:.3g} mm/s", count, mm_s(slowest), mm_s(fastest)), ""};
  else if (count == 0)
    d.reason = "no segment of constant speed";
  else
    d.reason = fmt::format("{} constant speed{} from {:.3g} to {:.3g} mm/s", count, count == 1 ? "" : "s",
                           mm_s(slowest), mm_s(fastest));
  return d;
}

Had steady_stroke(const KnownAxis& known, const AxisInspection& out) {
  const double wanted = known.pole_pair_pitch ? 2.0 * *known.pole_pair_pitch : 0.0;
  const bool steady = !out.plateaus.empty();
  Had d{steady && out.stroke > std::max(wanted, some_way), "",
        "a constant speed, slow enough to resolve the ripple, over at least two pole-pair pitches"};
  if (!steady)
    d.reason = "no segment of constant speed";
  else if (known.pole_pair_pitch)
    d.reason = fmt::format("the stroke of {:.4g} mm covers {:.1f} pole-pair pitches", out.stroke * 1e3,
                           out.stroke / *known.pole_pair_pitch);
  else
    d.reason = fmt::format("pitches up to {:.3g} mm, half the stroke", out.stroke * 500.0);
  if (d.possible) d.remedy.clear();
  return d;
}

Determinable frequency_response(const AxisLog& axis) {
  if (!axis.i_inject.empty() || !axis.u_inject.empty())
    return {"Frequency response", true, "a test signal is recorded", ""};
  return {"Frequency response", false, "no test signal is recorded",
          "i_inject or u_inject: a multisine or stepped sine at a speed that does not cross zero"};
}

Had long_record(const Log& log, const AxisLog& axis) {
  const double duration = log.t.back() - log.t.front();
  if (duration >= long_enough)
    return {true, fmt::format("{:.0f} s{}", duration, axis.temperature.empty() ? "" : " with the temperature"), ""};
  return {false, fmt::format("{:.3g} s", duration),
          fmt::format("the same motion repeated over {:.0f} s or more, with the temperature", long_enough)};
}

Had recorded_seconds(const Log& log) {
  const double duration = log.t.back() - log.t.front();
  return {duration >= some_seconds, fmt::format("{:.3g} s", duration), "more seconds, some of them at standstill"};
}

Had stroke(const AxisInspection& out) {
  return {out.stroke > some_way, fmt::format("a stroke of {:.4g} mm", 1e3 * out.stroke),
          "the whole travel at a constant speed, both ways"};
}

Had current(const AxisLog& axis) {
  if (!axis.i.empty()) return {true, "the motor's current is recorded", ""};
  if (!axis.u.empty()) return {true, "the motor's voltage is recorded", ""};
  return {false, "the motor's current is not recorded", "i, the motor's current"};
}

Had set_points(const AxisLog& axis) {
  return {!axis.x_set.empty(), axis.x_set.empty() ? "no set-points are recorded" : "set-points are recorded",
          "x_set, the set position"};
}

Had other_axis(const Log& log) {
  const bool there = log.axes.size() > 1;
  return {there, there ? "the other axis is recorded" : "one axis alone is recorded", "the other axis in the same log"};
}

struct Inspected {
  const Log& log;
  const AxisLog& axis;
  const KnownAxis& known;
  const FittedMotion& motion;
  const AxisInspection& out;
};

Had judged(sim::Need need, const Inspected& in) {
  switch (need) {
    case sim::Need::friction_level:
      return rigid(in.out, 2, "a constant force, or from viscous friction", "both directions, and at least two speeds");
    case sim::Need::speeds:
      return rigid(in.out, 1, "Coulomb friction, because the speed hardly changes",
                   "speeds over a range of 5 to 1, in both directions");
    case sim::Need::acceleration:
      return rigid(in.out, 0, "friction, because acceleration and speed go together",
                   "accelerations well above friction: half the maximum of the machine, with both signs at each "
                   "speed");
    case sim::Need::offset:
      return rigid(in.out, 3, "Coulomb friction, because the axis moves in one direction",
                   "the same speeds in both directions");
    case sim::Need::both_directions:
      return directions(in.out);
    case sim::Need::many_speeds:
      return many_speeds(in.out);
    case sim::Need::slow_speeds:
      return slow_speeds(in.out);
    case sim::Need::small_reversals:
      return small_reversals(in.axis, in.motion, in.out);
    case sim::Need::reversals:
      return {in.out.reversals >= 2, fmt::format("{} reversal{}", in.out.reversals, in.out.reversals == 1 ? "" : "s"),
              "several reversals"};
    case sim::Need::steady_stroke:
      return steady_stroke(in.known, in.out);
    case sim::Need::stroke:
      return stroke(in.out);
    case sim::Need::seconds:
      return recorded_seconds(in.log);
    case sim::Need::current:
      return current(in.axis);
    case sim::Need::set_points:
      return set_points(in.axis);
    case sim::Need::other_axis:
      return other_axis(in.log);
    case sim::Need::master:
      return {!in.axis.master.empty(), in.axis.master.empty() ? "no master" : "the master's position",
              "a slave with its master: the channel master"};
    case sim::Need::second_encoder:
      return {!in.axis.x_load.empty(), in.axis.x_load.empty() ? "no second encoder" : "the second encoder's position",
              "the encoder on the other side of the shaft: the channel x_load"};
    case sim::Need::long_record:
      return long_record(in.log, in.axis);
  }
  return {};
}

// What is missing, or where nothing is, what is there.
Determinable determinable(const sim::EffectDescriptor& effect, const Inspected& in) {
  std::vector<std::string> had, missing, remedies;
  for (const sim::Need need : effect.needs) {
    const Had each = judged(need, in);
    (each.possible ? had : missing).push_back(each.reason);
    if (!each.possible) remedies.push_back(each.remedy);
  }
  return {std::string(effect.title), missing.empty(),
          fmt::format("{}", fmt::join(missing.empty() ? had : missing, "; ")),
          fmt::format("{}", fmt::join(remedies, "; and "))};
}

}  // namespace

void add_suspicions(const Log&, const AxisLog& axis, const KnownAxis& known, AxisInspection& out) {
  for (const auto& s : out.saturation)
    out.suspicions.push_back(
        fmt::format("{} is at its greatest value of {:.4g} for {:.2g} % of the samples: it is saturated there; record "
                    "with less acceleration or speed",
                    s.channel, s.level, 100.0 * s.part));
  if (known.effort_limit && out.effort != nullptr && std::string_view(out.effort->name) != "F") {
    double most = 0.0;
    for (const double value : axis.*out.effort->values) most = std::max(most, std::abs(value));
    if (most >= 0.98 * *known.effort_limit)
      out.suspicions.push_back(
          fmt::format("{} reaches {:.4g} {}, the limit of {:.4g} in the machine file, which distorts the motion",
                      out.effort->name, most, out.effort->unit, *known.effort_limit));
  }
  // A weight that turns with a rotary axis is in no fit of these, and takes the sign of friction and mass.
  if (!out.fit || axis.rotary) return;
  const auto& fit = *out.fit;
  const auto negative = [&](std::size_t k) { return fit.value[k] < -3.0 * fit.error[k]; };
  const bool mass = fit.inflation[0] < separable, friction = fit.inflation[2] < separable;
  const bool sign_is_asked =
      std::ranges::any_of(out.questions, [](const auto& q) { return q.about == Question::About::sign; });
  // A negative mass beside friction that opposes the motion is a contact that yields in small oscillations
  // (questions.cpp); of a current that is late a question tells.
  if (sign_is_asked)
    ;  // the question says it
  else if (mass && negative(0) && (!friction || negative(2)))
    out.suspicions.push_back(
        fmt::format("{} falls when the axis accelerates: its sign, or that of the position, is swapped; reverse one of "
                    "them (reverse = true in a mapping)",
                    out.effort->name));
  else if (friction && negative(2))
    out.suspicions.push_back(
        fmt::format("{} is smaller in the direction of motion than against it, which would be negative friction; the "
                    "sign may be swapped",
                    out.effort->name));
  if (out.delay && *out.delay < -1e-3)
    out.suspicions.push_back(fmt::format(
        "the position is {:.3g} ms ahead of its set-point: the channels may be swapped", -*out.delay * 1e3));
  if (axis.x_set.empty())
    out.suspicions.push_back("no x_set: the motion cannot be replayed in closed loop; record the set position");
}

void add_determinable(const Log& log, const AxisLog& axis, const KnownAxis& known, const FittedMotion& motion,
                      AxisInspection& out) {
  const Inspected in{log, axis, known, motion, out};
  std::vector<Determinable> judgements;
  for (const sim::EffectId effect : sim::all_effects()) judgements.push_back(determinable(*effect, in));
  judgements.push_back(frequency_response(axis));
  out.determinable = std::move(judgements);
}

}  // namespace stiction::host
