#include "host/log/questions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/log/inspection.hpp"
#include "host/log/resolution.hpp"

namespace stiction::host {
namespace {

using Values = std::vector<double>;
using About = Question::About;

constexpr double mass_known = 0.15;     // of the machine file's mass
constexpr double channel_known = 0.03;  // of a ratio of two channels that should be one
constexpr double model_error = 0.008;   // of r: what the equation of motion lacks, alike in all parts of a record
constexpr double alike = 0.15;          // of what is unexplained, which may go with the acceleration everywhere
constexpr double prior_odds = 0.1;      // of one hypothesis over a sound record: one record in ten
constexpr double other_odds = 0.03;     // that anything else is wrong
constexpr double determined = 4.0;      // standard errors from 0 from which a mass counts as one
constexpr double explained = 0.5;       // of the effort's variance, for a delay
constexpr double late_enough = 3.5e-3;  // s: half way between a sound loop (2 ms) and the 5 ms that must be asked
constexpr double less_rest = 1.3;       // unexplained variance without the delay over that with it
constexpr double widest = 13.8;         // natural logarithm of 1e6: how far off anything else may be

struct Hypothesis {
  About about;
  double factor;  // of the ratio
};

double normal_part(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

// Likelihood of ln r, `off` from that of the hypothesis, whose own ratio is uniform from 1 - `within` to 1 + `within`.
double likelihood(double off, double within, double error) {
  const double low = std::log1p(-within), high = std::log1p(within);
  return (normal_part((off - low) / error) - normal_part((off - high) / error)) / (high - low);
}

struct Choice {
  std::optional<Hypothesis> hypothesis;  // none: sound
  double probability = 0.0;
};

Choice most_likely(double ratio, double error, double known_within, const std::vector<Hypothesis>& hypotheses) {
  const double relative = std::hypot(error / std::abs(ratio), model_error);
  const auto of = [&](double factor) {
    return ratio * factor > 0.0 ? likelihood(std::log(ratio / factor), known_within, relative) : 0.0;
  };
  const double sound = of(1.0);
  double sum = sound + other_odds * 0.5 / widest, best = sound;
  Choice choice;
  for (const auto& h : hypotheses) {
    const double weight = prior_odds * of(h.factor);
    sum += weight;
    if (weight > best) best = weight, choice.hypothesis = h;
  }
  if (other_odds * 0.5 / widest > best) best = other_odds * 0.5 / widest, choice.hypothesis = {About::scale, 0.0};
  choice.probability = best / sum;
  return choice;
}

std::vector<Hypothesis> on_force(const AxisLog& axis, bool current) {
  std::vector<Hypothesis> all{{About::length, 1e-3}, {About::length, 1e3}, {About::sign, -1.0}};
  if (axis.rotary) {
    all = {{About::angle, std::numbers::pi / 180.0}, {About::angle, 180.0 / std::numbers::pi}, {About::sign, -1.0}};
  }
  if (current) {
    all.push_back({About::amperes, 1.0 / std::numbers::sqrt2});
    all.push_back({About::amperes, std::numbers::sqrt2});
  }
  return all;
}

struct Effort {
  const Values* values = nullptr;
  const char* name = "";
  const char* unit = "";
  double constant = 0.0;  // N per unit; 0: not known
};

Effort effort_of(const AxisLog& axis, const KnownAxis& known) {
  if (!axis.i.empty()) return {&axis.i, "i", "A", known.force_constant.value_or(0.0)};
  if (!axis.force.empty()) return {&axis.force, axis.rotary ? "T" : "F", axis.rotary ? "N m" : "N", 1.0};
  return {&axis.u, "u", "V", known.force_constant.value_or(0.0)};
}

// The effort less what holds a known weight, which would pass for friction or mass.
Values without_weight(const AxisLog& axis, const KnownAxis& known, const Effort& effort) {
  Values values = *effort.values;
  if (!known.weight || !axis.rotary || effort.constant == 0.0) return values;
  for (std::size_t k = 0; k < values.size(); ++k)
    values[k] -= known.weight->moment / effort.constant * std::sin(axis.x[k] - known.weight->zero);
  return values;
}

std::string force_text(const Effort& effort, const Hypothesis& h, double ratio, double error, bool rotary) {
  const char* mass = rotary ? "inertia" : "mass";
  const auto found = fmt::format("the accelerations in it require {:.4g} ± {:.2g} times the {} of the machine file",
                                 ratio, 1.96 * error, mass);
  switch (h.about) {
    case About::amperes:
      if (h.factor < 1.0)
        return fmt::format(
            "Are the amperes of i rms values? Taken as amplitudes, {}; times √2 the ratio is {:.3g}. If so, convert "
            "the "
            "record with amperes = \"rms\".",
            found, ratio * std::numbers::sqrt2);
      return fmt::format(
          "Is the force constant of the machine file given per rms ampere? With amperes as amplitudes, {}; over √2 the "
          "ratio is {:.3g}.",
          found, ratio / std::numbers::sqrt2);
    case About::length:
      return fmt::format("Is the length x given in {}? As it is labelled, {}. If so, correct the unit in the header.",
                         h.factor < 1.0 ? "a unit a thousand times smaller than its label (mm labelled as m)"
                                        : "a unit a thousand times larger than its label (m labelled as mm)",
                         found);
    case About::angle:
      return fmt::format("Is the angle x given in {}? As it is labelled, {}. If so, correct the unit in the header.",
                         h.factor < 1.0 ? "degrees (labelled as radians)" : "radians (labelled as degrees)", found);
    case About::sign:
      return fmt::format(
          "Is the sign of {} or of x swapped? As recorded, {}. If so, reverse one of them (reverse = true in a "
          "mapping).",
          effort.name, found);
    default:
      return fmt::format(
          "Do the mass, the force constant and the units of {} and x belong to this record? Together {}.", effort.name,
          found);
  }
}

void ask_force(const AxisLog& axis, const KnownAxis& known, const Effort& effort, const RigidMotion& motion,
               std::vector<Question>& questions) {
  if (std::abs(motion.mass) < determined * motion.mass_error || motion.mass_error <= 0.0) return;
  // A channel of the wrong sign makes both negative. Friction that takes power beside a negative mass is a contact that
  // yields: in small oscillations a spring is a negative mass.
  if (motion.mass < 0.0 && motion.friction_power > determined * motion.friction_power_error) return;
  if (known.mass && effort.constant != 0.0) {
    const double per = effort.constant / *known.mass, ratio = motion.mass * per;
    const double error = std::hypot(motion.mass_error, alike * motion.mass_by_rest) * per;
    const auto choice = most_likely(ratio, error, mass_known, on_force(axis, std::string_view(effort.name) == "i"));
    if (!choice.hypothesis) return;
    questions.push_back({choice.hypothesis->about, force_text(effort, *choice.hypothesis, ratio, error, axis.rotary),
                         ratio, ratio - 1.96 * error, ratio + 1.96 * error, choice.probability});
    return;
  }
  if (motion.mass < 0.0)
    questions.push_back({About::sign,
                         fmt::format("Is the sign of {} or of x swapped? {} falls where the axis accelerates. If so, "
                                     "reverse one of them (reverse = true in a mapping).",
                                     effort.name, effort.name),
                         -1.0, -1.0, -1.0, 1.0});
}

void ask_delay(const Effort& effort, const RigidMotion& motion, std::vector<Question>& questions) {
  if (motion.explained < explained || std::abs(motion.delay) > 0.95 * longest_delay) return;
  if (std::abs(motion.delay) < std::max(late_enough, 3.0 * motion.delay_error)) return;
  if (motion.rest_ratio < less_rest) return;
  const bool late = motion.delay > 0.0;
  questions.push_back(
      {About::shift,
       fmt::format("Is {} recorded {:.1f} ± {:.1f} ms {} than x? Shifted so, it agrees best with the motion. If so, "
                   "record both channels at the same time, or shift one of them.",
                   effort.name, 1e3 * std::abs(motion.delay), 1.96e3 * motion.delay_error, late ? "later" : "earlier"),
       motion.delay, motion.delay - 1.96 * motion.delay_error, motion.delay + 1.96 * motion.delay_error, 1.0});
}

// Slope of `a` over `b` about their means with its error; 0 and 1e9 where they do not go together.
std::pair<double, double> slope_about_means(const Values& a, const Values& b) {
  double ma = 0.0, mb = 0.0;
  const double n = static_cast<double>(a.size());
  for (std::size_t k = 0; k < a.size(); ++k) ma += a[k] / n, mb += b[k] / n;
  double ab = 0.0, bb = 0.0, aa = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    ab += (a[k] - ma) * (b[k] - mb);
    bb += (b[k] - mb) * (b[k] - mb);
    aa += (a[k] - ma) * (a[k] - ma);
  }
  if (bb <= 0.0 || aa <= 0.0 || ab * ab < 0.9 * aa * bb) return {0.0, 1e9};
  const double value = ab / bb;
  // One independent sample in twenty: what is alike in neighbours counts once.
  return {value, std::sqrt(std::max(0.0, aa / bb - value * value) / std::max(2.0, n / 20.0))};
}

void ask_channels(const char* a_name, const Values& a, const char* b_name, const Values& b, double noise, bool current,
                  bool rotary, std::vector<Question>& questions) {
  if (a.empty() || a.size() != b.size()) return;
  const auto [least, most] = std::ranges::minmax(b);
  if (most - least < 20.0 * noise) return;
  const auto [ratio, error] = slope_about_means(a, b);
  if (ratio == 0.0 || std::abs(ratio) < determined * error) return;
  std::vector<Hypothesis> all{{About::sign, -1.0}};
  if (current) {
    all.push_back({About::amperes, 1.0 / std::numbers::sqrt2});
    all.push_back({About::amperes, std::numbers::sqrt2});
  } else if (rotary) {
    all.push_back({About::angle, std::numbers::pi / 180.0});
    all.push_back({About::angle, 180.0 / std::numbers::pi});
  } else {
    all.push_back({About::length, 1e-3});
    all.push_back({About::length, 1e3});
  }
  // A channel may follow the other loosely: only a ratio at one of the hypotheses is asked about.
  const auto choice = most_likely(ratio, error, channel_known, all);
  if (!choice.hypothesis || choice.hypothesis->about == About::scale) return;
  const char* what = choice.hypothesis->about == About::sign      ? "Is the sign of one of them swapped?"
                     : choice.hypothesis->about == About::amperes ? "Is one of them an rms value?"
                                                                  : "Has one of them a different unit than its label?";
  questions.push_back({choice.hypothesis->about,
                       fmt::format("{} is {:.4g} ± {:.2g} times {}. {}", a_name, ratio, 1.96 * error, b_name, what),
                       ratio, ratio - 1.96 * error, ratio + 1.96 * error, choice.probability});
}

}  // namespace

std::vector<Question> questions_of(const Log& log, const AxisLog& axis, const KnownAxis& known) {
  std::vector<Question> questions;
  const double increment = increment_of(axis, &AxisLog::x);
  ask_channels("x", axis.x, "x_set", axis.x_set, increment, false, axis.rotary, questions);
  if (!axis.v.empty())
    ask_channels("v", axis.v, "the speed of x", fitted_motion(axis.x, log.period).v, increment / log.period, false,
                 axis.rotary, questions);
  ask_channels("i", axis.i, "i_set", axis.i_set, 0.0, true, axis.rotary, questions);
  const auto effort = effort_of(axis, known);
  if (effort.values->empty()) return questions;
  const auto moving = without_weight(axis, known, effort);
  auto motion = rigid_motion(log, axis, moving);
  if (!motion) return questions;
  const auto asked = questions.size();
  ask_delay(effort, *motion, questions);
  // The mass belongs to the effort at its own time.
  if (questions.size() > asked) motion = rigid_motion(log, axis, moving, motion->delay);
  if (motion) ask_force(axis, known, effort, *motion, questions);
  return questions;
}

std::string known_only_as_ratio(const Log& log, const AxisLog& axis) {
  const auto effort = effort_of(axis, {});
  if (effort.values->empty() || effort.constant != 0.0) return "";
  const auto motion = rigid_motion(log, axis, *effort.values);
  if (!motion || motion->mass < determined * motion->mass_error) return "";
  return fmt::format(
      "Only the ratio of {} and force constant is known from {}: {:.4g} ± {:.2g} {} per {}. A force constant, or a "
      "known "
      "{}, makes it two figures.",
      axis.rotary ? "inertia" : "mass", effort.name, motion->mass, 1.96 * motion->mass_error, effort.unit,
      axis.rotary ? "rad/s²" : "m/s²", axis.rotary ? "inertia" : "mass");
}

}  // namespace stiction::host
