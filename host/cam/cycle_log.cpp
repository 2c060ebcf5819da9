#include "host/cam/cycle_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "sim/cam/shaping/normal_equations.hpp"

namespace stiction::host {
namespace {

// A master that is slower than this share over this time has been stopped: encoders of masters have less jitter.
constexpr double stopped_share = 0.5, stopped_time = 10e-3;  // 1, s

// Of the slave's way, which the set-points go while an encoder stays: more than what any encoder is late by.
constexpr double unseen_share = 0.05;

// A master's mean speed is known within far less from one cycle, and the frequencies that are identified are off as
// much as it is.
constexpr double speed_share = 0.02;

// A sine that is eight increments high stays at its highest one for a quarter of its period; a higher one stays
// shorter.
constexpr double increments_of_a_vibration = 8.0, period_at_the_end = 1.0 / 3.0;

// Of the slave's way. Friction lets a load creep by less.
constexpr double moving_share = 0.02;

}  // namespace

std::optional<std::string> stop_in_cycle(const CycleSamples& samples, double master_speed, double scale,
                                         const std::string& unit) {
  const auto& [time, master, load, set] = samples;
  std::size_t from = 0;
  for (std::size_t k = 1; k < time.size(); ++k) {
    while (time[k] - time[from + 1] >= stopped_time) ++from;
    const double passed = time[k] - time[from];
    if (passed < stopped_time || master[k] - master[from] >= stopped_share * master_speed * passed) continue;
    // To where it turns again.
    std::size_t end = k;
    while (end + 1 < time.size() &&
           master[end + 1] - master[end] < stopped_share * master_speed * (time[end + 1] - time[end]))
      ++end;
    return fmt::format(
        "found a master that stops at {:.4g} {} for {:.3g} ms; expected a cycle without a stop, since the dwell is "
        "counted from the master",
        master[k] * scale, unit, (time[end] - time[from]) * 1e3);
  }
  return std::nullopt;
}

std::optional<std::string> encoder_at_its_end(const CycleSamples& samples, double range, double scale,
                                              const std::string& unit) {
  const auto& [time, master, load, set] = samples;
  if (set.empty()) return std::nullopt;
  std::size_t from = 0;
  for (std::size_t k = 1; k < load.size(); ++k) {
    if (load[k] != load[from]) {
      from = k;
      continue;
    }
    if (std::fabs(set[k] - set[from]) < unseen_share * range) continue;
    return fmt::format(
        "found an encoder at the load that stays where it is from the master's {:.4g} {} on, while the set-points go "
        "{:.0f} % of the stroke; expected one that follows, not one at the end of its range",
        master[from] * scale, unit, 100.0 * unseen_share);
  }
  return std::nullopt;
}

std::optional<std::string> other_speed(const CycleSamples& samples, double master_speed, double scale,
                                       const std::string& unit) {
  const double passed = samples.time.empty() ? 0.0 : samples.time.back() - samples.time.front();
  if (!(passed > 0.0)) return std::nullopt;
  const double found = (samples.master.back() - samples.master.front()) / passed;
  if (std::fabs(found - master_speed) <= speed_share * std::fabs(master_speed)) return std::nullopt;
  return fmt::format("found a master that turns at {:.4g} {}/s; expected the {:.4g} {}/s of --speed", found * scale,
                     unit, master_speed * scale, unit);
}

std::optional<std::string> cut_off_in_dwell(const CycleSamples& dwell, const DwellJudge& judge) {
  const auto& load = dwell.load;
  if (load.empty()) return std::nullopt;
  const auto [least, largest] = std::minmax_element(load.begin(), load.end());
  if (*largest - *least < increments_of_a_vibration * judge.resolution) return std::nullopt;
  const double longest = period_at_the_end * 2.0 * std::numbers::pi / judge.frequency;
  for (const double end : {*least, *largest}) {
    std::size_t from = 0;
    for (std::size_t k = 0; k < load.size(); ++k) {
      if (load[k] != end) {
        from = k + 1;
        continue;
      }
      if (dwell.time[k] - dwell.time[from] <= longest) continue;
      return fmt::format(
          "found an encoder at the load that goes no further than {:.4g} {} and stays there for {:.3g} ms or more of a "
          "vibration; expected one that shows all of it, not one at the end of its range",
          end * judge.scale, judge.unit, longest * 1e3);
    }
  }
  return std::nullopt;
}

std::optional<std::string> motion_in_dwell(const CycleSamples& dwell, const DwellJudge& judge) {
  // Over less than a period and a half a vibration and a motion are not told apart.
  const double period = 2.0 * std::numbers::pi / judge.frequency;
  const double length = dwell.time.empty() ? 0.0 : dwell.time.back() - dwell.time.front();
  if (length < 1.5 * period) return std::nullopt;
  // Two thousand samples say as much as all of them do.
  const std::size_t step = std::max<std::size_t>(1, dwell.time.size() / 2000);
  const double middle = dwell.time.front() + 0.5 * length;
  double least = std::numeric_limits<double>::infinity(), way = 0.0;
  // A place, a straight motion and a sine with each of the frequencies in doubt; the one that leaves least is right.
  constexpr int frequencies = 71;
  for (int f = 0; f < frequencies; ++f) {
    const double frequency = judge.frequency * (0.65 + 0.01 * f);
    sim::cam::Normal<4> normal;
    double squares = 0.0;
    for (std::size_t k = 0; k < dwell.time.size(); k += step) {
      const double t = dwell.time[k] - middle, value = dwell.load[k] - dwell.load[0];
      normal.add({1.0, t / length, std::cos(frequency * t), std::sin(frequency * t)}, value);
      squares += value * value;
    }
    const auto found = normal.solve();
    for (std::size_t i = 0; i < found.size(); ++i) squares -= found[i] * normal.right[i];
    if (squares < least) least = squares, way = found[1];
  }
  if (std::fabs(way) <= moving_share * judge.range) return std::nullopt;
  return fmt::format(
      "found a load that still moves by {:.3g} {} in the dwell; expected an axis at rest there, which does no more "
      "than vibrate",
      way * judge.scale, judge.unit);
}

}  // namespace stiction::host
