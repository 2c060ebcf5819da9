#include "host/diagnose/record/record_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/identify/identification.hpp"
#include "host/identify/suitability.hpp"
#include "host/log/questions.hpp"
#include "host/log/set_points.hpp"
#include "host/log/shown_units.hpp"

namespace stiction::host {
namespace {

constexpr double much_unexplained = 0.5;  // of the force's variance: more than a known effect causes

}  // namespace

std::vector<std::string> questions_before(std::span<const Log> logs, const machine::AxisModel& axis) {
  std::vector<std::string> all;
  for (const auto& log : logs)
    for (const auto& question : questions_of(log, channels_of(log, axis), known_axis(axis)))
      all.push_back(fmt::format("{}: {}", log.source, question.text));
  return all;
}

void refuse_same_record(std::span<const Log> logs, std::span<const Log> held_out, const machine::AxisModel& axis) {
  for (const auto& held : held_out)
    for (const auto& log : logs) {
      const auto &a = channels_of(log, axis), &b = channels_of(held, axis);
      // Samples in the middle of the held-out log, anywhere in the other one. A coarse encoder shows the same few
      // counts again on different motions; what the motor does then differs.
      const std::size_t length = std::min<std::size_t>(100, b.x.size());
      const std::size_t from = b.x.size() / 2 > length ? b.x.size() / 2 : 0;
      const auto part = std::span(b.x).subspan(from, length);
      if (part.empty() || std::all_of(part.begin(), part.end(), [&](double x) { return x == part.front(); })) continue;
      const auto same_effort = [&](std::size_t at) {
        for (const auto effort : {&AxisLog::i, &AxisLog::force, &AxisLog::u})
          for (std::size_t k = 0; k < length && !(a.*effort).empty() && !(b.*effort).empty(); ++k)
            if ((a.*effort)[at + k] != (b.*effort)[from + k]) return false;
        return true;
      };
      for (auto found = a.x.begin(); (found = std::search(found, a.x.end(), part.begin(), part.end())) != a.x.end();
           ++found)
        if (same_effort(static_cast<std::size_t>(found - a.x.begin())))
          throw LogError(fmt::format(
              "{}: found the samples of {} again; expected a held-out log that was not used for the search. "
              "Record a different trajectory",
              held.source, log.source));
    }
}

void refuse_unreachable_set_points(const Log& log, const machine::AxisModel& axis) {
  const auto& channels = channels_of(log, axis);
  if (channels.x_set.empty()) return;
  const ShownUnits own(axis.coordinate);
  const SetPoints points(log, channels);
  double speed = 0.0;
  for (const double v : points.velocity()) speed = std::max(speed, std::abs(v));
  if (speed > 1.001 * axis.max_velocity)
    throw LogError(fmt::format(
        "{}: found a set velocity of {:.4g} {}; expected at most {:.4g} {}, the max_velocity of axis {}: "
        "the machine in the machine file cannot follow these set-points",
        log.source, own.speed(speed), own.speed.unit, own.speed(axis.max_velocity), own.speed.unit, axis.name));
  const auto [low, high] = std::minmax_element(channels.x_set.begin(), channels.x_set.end());
  if (!axis.modulo && axis.travel > 0.0 && *high - *low > 1.001 * axis.travel)
    throw LogError(
        fmt::format("{}: found set positions over {:.4g} {}; expected at most {:.4g} {}, the travel of axis {}: the "
                    "machine in the machine file cannot follow these set-points",
                    log.source, own.position(*high - *low), own.position.unit, own.position(axis.travel),
                    own.position.unit, axis.name));
}

void refuse_other_units(const LogRows& rows, const Eigen::VectorXd& expected) {
  const auto centred = [](const Eigen::VectorXd& v) { return Eigen::VectorXd(v.array() - v.mean()); };
  const Eigen::VectorXd force = centred(rows.force), model = centred(expected);
  const double force_square = force.squaredNorm(), model_square = model.squaredNorm();
  if (!(force_square > 0.0) || !(model_square > 0.0)) return;
  const auto source = sources_of(rows.motions());
  // One factor between the logged and the expected force, and what it leaves of the force.
  const double scale = force.dot(model) / model_square;
  const double left = (force - scale * model).squaredNorm() / force_square;
  const double off = (force - model).squaredNorm() / force_square;
  if (scale < 0.0 && left < 0.5)
    throw LogError(fmt::format(
        "{}: found {:.3g} times the force that the machine file predicts for this motion; expected force and position "
        "positive in the same direction. The sign of the current (or of the encoder) is swapped",
        source, scale));
  for (const auto& [ratio, text] :
       {std::pair{1.0 / std::numbers::sqrt2,
                  "the current of the log is in rms amperes instead of amplitudes: multiply it by 1.414"},
        std::pair{
            std::numbers::sqrt2,
            "the force constant of the machine file refers to rms amperes instead of amplitudes: divide it by 1.414"}})
    if (std::abs(scale / ratio - 1.0) < 0.04 && left < 0.1 && left < 0.15 * off)
      throw LogError(
          fmt::format("{}: found {:.3f} times the force that the machine file predicts, over the whole record; "
                      "expected 1. Most likely {}",
                      source, scale, text));
}

std::string suspected_file(const LogRows& rows, const Eigen::VectorXd& expected) {
  const auto centred = [](const Eigen::VectorXd& v) { return Eigen::VectorXd(v.array() - v.mean()); };
  const double force_square = centred(rows.force).squaredNorm();
  const double off = centred(rows.force - expected).squaredNorm() / force_square;
  if (!(force_square > 0.0) || !(off > much_unexplained)) return "";
  return fmt::format(
      "The machine file does not explain {:.0f} % of the variance of the force in {}. If mass and friction of the file "
      "were never identified on this machine, begin with --identify; otherwise the log belongs to a different machine "
      "or axis, or has different units, or its encoder is too coarse for the accelerations.",
      100.0 * off, sources_of(rows.motions()));
}

}  // namespace stiction::host
