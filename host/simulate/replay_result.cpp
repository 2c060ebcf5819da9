#include "host/simulate/replay_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "host/log/own_units.hpp"
#include "host/simulate/injection.hpp"
#include "host/simulate/replay.hpp"

namespace stiction::host {
namespace {

double rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, values.size())));
}

std::vector<double> difference(const std::vector<double>& a, const std::vector<double>& b, std::size_t from,
                               double offset = 0.0) {
  std::vector<double> out;
  out.reserve(a.size() - from);
  for (std::size_t k = from; k < a.size(); ++k) out.push_back(a[k] - b[k] - offset);
  return out;
}

// The channel that both have and that tells the motor's effort.
struct Effort {
  std::vector<double> AxisLog::*values;
  const char* name;
  const char* unit;
};
const Effort* effort_of(const AxisLog& measured, const AxisLog& simulated) {
  static constexpr Effort efforts[] = {{&AxisLog::i, "current", "A"},
                                       {&AxisLog::u, "voltage", "V"},
                                       {&AxisLog::force, "motor force", "N"},
                                       {&AxisLog::force, "motor torque", "N m"}};
  for (const auto& effort : efforts)
    if (!(measured.*effort.values).empty() && !(simulated.*effort.values).empty() &&
        (effort.values != &AxisLog::force || std::string_view(effort.unit) == force_unit(measured.rotary)))
      return &effort;
  return nullptr;
}

std::size_t first_compared(const Log& log) {
  const auto samples = static_cast<std::size_t>(settling / log.period);
  return samples + 2 < log.t.size() ? samples : 0;
}

std::vector<double> scaled(std::vector<double> values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

class Result {
 public:
  Result(const Log& measured, const std::vector<ReplayCase>& cases, std::string axis)
      : log_(measured), cases_(cases), axis_(std::move(axis)) {}

  sim::ExperimentResult make(const std::string& signals) {
    result_.experiment = "replay";
    result_.title = "Replay of a log";
    result_.signals = signals;
    result_.question = fmt::format(
        "Simulation with the set-points of {} ({} samples at {:.4g} ms), compared with the measured signals.",
        log_.source, log_.t.size(), log_.period * 1e3);
    for (std::size_t axis = 0; axis < log_.axes.size(); ++axis) add_axis(axis);
    return std::move(result_);
  }

 private:
  void add_axis(std::size_t axis) {
    const auto& measured = log_.axes[axis];
    const auto& name = measured.axis;
    const std::string of = name.empty() ? "" : " of " + name;
    const auto deviation = shown_deviation(measured.rotary), speed = shown_speed(measured.rotary),
               length = shown_position(measured.rotary);
    const auto* effort = effort_of(measured, cases_.front().simulated.axes[axis]);
    sim::Chart error{
        "Following error" + of, "time, s", fmt::format("set minus actual position, {}", deviation.unit), "", false, {}};
    sim::Chart position{"Simulated minus measured position" + of,
                        "time, s",
                        fmt::format("difference, {}", deviation.unit),
                        "",
                        false,
                        {}};
    sim::Chart current, rest;
    if (effort != nullptr) {
      const std::string unit = effort->unit;
      current = {fmt::format("Motor {}{}", short_name(*effort), of),
                 "time, s",
                 fmt::format("{}, {}", effort->name, unit),
                 "",
                 false,
                 {}};
      rest = {fmt::format("Measured minus simulated {}{}", effort->name, of),
              fmt::format("set velocity, {}", speed.unit),
              fmt::format("difference, {}", unit),
              "Residual that friction, force constant and mass of the machine file do not explain, over the velocity.",
              false,
              {}};
    }
    const double offset = replay_offset(log_, cases_.front(), axis, axis_);
    error.series.push_back(measured_line(scaled(difference(measured.x_set, measured.x, 0, -offset), deviation.factor)));
    add_measured(name, deviation, compare_replay(log_, cases_.front().simulated, axis, offset));
    if (effort != nullptr) current.series.push_back(measured_line(measured.*effort->values));
    bool any = false;
    for (const auto& c : cases_) {
      if (const auto why = withheld_replay(log_, c, axis, axis_); !why.empty()) {
        result_.findings.push_back(
            fmt::format("{}{}: the figures of the simulation are withheld. {}: {}.", c.label, of, log_.source, why));
        continue;
      }
      any = true;
      const auto& simulated = c.simulated.axes[axis];
      const auto d = compare_replay(log_, c.simulated, axis, offset);
      add_figures(c.label, name, deviation, d);
      error.series.push_back(line(c, scaled(difference(simulated.x_set, simulated.x, 0, -offset), deviation.factor)));
      position.series.push_back(line(c, scaled(difference(simulated.x, measured.x, 0), deviation.factor)));
      if (effort == nullptr) continue;
      current.series.push_back(line(c, simulated.*effort->values));
      const auto from = first_compared(log_);
      sim::Series over_velocity{
          c.label, {}, difference(measured.*effort->values, simulated.*effort->values, from), true};
      over_velocity.friction = c.friction;
      for (std::size_t k = from; k < log_.t.size(); ++k) over_velocity.x.push_back(simulated.v_set[k] * speed.factor);
      rest.series.push_back(std::move(over_velocity));
    }
    if (offset != 0.0)
      result_.findings.push_back(
          fmt::format("The measured position{} differs from its set-point by {:.6g} {} on average, more than the "
                      "machine allows: the zero of the encoder differs. The offset is subtracted.",
                      of, offset * length.factor, length.unit));
    result_.charts.push_back(std::move(error));
    if (any) result_.charts.push_back(std::move(position));
    if (effort == nullptr) {
      result_.findings.push_back(
          fmt::format("The measured actuating signal{} has no counterpart in the simulation: record the current, or "
                      "the voltage of a force motor.",
                      of));
      return;
    }
    result_.charts.push_back(std::move(current));
    if (any) result_.charts.push_back(std::move(rest));
  }

  static std::string short_name(const Effort& effort) {
    return std::string(effort.name).starts_with("motor ") ? effort.name + 6 : effort.name;
  }

  // What is measured is the same beside every case.
  void add_measured(const std::string& axis, const ShownUnit& deviation, const ReplayDifference& d) {
    const std::string key = axis.empty() ? "" : "_" + axis, of = axis.empty() ? "" : " of " + axis;
    result_.figures.push_back({"following_error_rms_measured" + key,
                               deviation.unit,
                               "measured following error, rms" + of,
                               d.measured_following_error * deviation.factor,
                               {}});
    if (*d.effort_unit == '\0') return;
    result_.figures.push_back({effort_name(d) + "_rms_measured" + key,
                               d.effort_unit,
                               "measured " + effort_name(d) + ", rms" + of,
                               d.measured_effort,
                               {}});
  }

  void add_figures(const std::string& label, const std::string& axis, const ShownUnit& deviation,
                   const ReplayDifference& d) {
    std::string key = axis.empty() ? "" : axis + "_";
    for (const char c : label) key += (c == ' ' || c == ',' || c == '/') ? '_' : c;
    const std::string of = axis.empty() ? "" : " of " + axis;
    const auto add = [&](const char* figure, const char* unit, const std::string& text, double value) {
      result_.figures.push_back({std::string(figure) + "_" + key, unit, text + of + ", " + label, value, {}});
    };
    add("position_difference_rms", deviation.unit, "simulated - measured position, rms", d.position * deviation.factor);
    add("following_error_rms", deviation.unit, "simulated following error, rms", d.following_error * deviation.factor);
    std::string sentence = fmt::format("{}{}: the position deviates by {:.3g} {} rms from the measured one", label, of,
                                       d.position * deviation.factor, deviation.unit);
    if (*d.effort_unit != '\0') {
      const auto what = effort_name(d);
      result_.figures.push_back({what + "_difference_rms_" + key,
                                 d.effort_unit,
                                 "simulated - measured " + what + ", rms" + of + ", " + label,
                                 d.effort,
                                 {}});
      result_.figures.push_back({what + "_difference_" + key,
                                 "%",
                                 "simulated - measured " + what + ", part of the measured" + of + ", " + label,
                                 d.measured_effort > 0.0 ? 100.0 * d.effort / d.measured_effort : 0.0,
                                 {}});
      sentence += fmt::format(", the {} by {:.4f} {} rms, {:.2f} % of the measured one", what, d.effort, d.effort_unit,
                              result_.figures.back().value);
    }
    result_.findings.push_back(sentence + ".");
  }

  sim::Series line(const ReplayCase& of, std::vector<double> values) const {
    sim::Series series{of.label, log_.t, std::move(values), false};
    series.friction = of.friction;
    return series;
  }
  sim::Series measured_line(std::vector<double> values) const {
    sim::Series series{"measured", log_.t, std::move(values), false};
    series.role = sim::SeriesRole::measured;
    return series;
  }

  const Log& log_;
  const std::vector<ReplayCase>& cases_;
  std::string axis_;
  sim::ExperimentResult result_;
};

}  // namespace

std::string effort_name(const ReplayDifference& difference) {
  const std::string unit = difference.effort_unit;
  return unit == "A" ? "current" : unit == "V" ? "voltage" : unit == "N" ? "force" : unit == "N m" ? "torque" : "";
}

double replay_offset(const Log& measured, const ReplayCase& replayed, std::size_t axis, const std::string& name) {
  const auto& machine_axis = replayed.machine.axes[match_axes(replayed.machine, measured, name)[axis]];
  if (!machine_axis.cascaded()) return 0.0;  // as the replay does: its axis may lag and sag
  const double allowed = machine_axis.supervision.following_error.value_or(2e-3);
  return encoder_offset(measured.axes[axis], machine_axis.coordinate.own("m").from_linear(allowed));
}

std::string withheld_replay(const Log& measured, const ReplayCase& replayed, std::size_t axis,
                            const std::string& name) {
  const auto matched = match_axes(replayed.machine, measured, name);
  return refused_injection(measured.axes[axis], replayed.machine.axes[matched[axis]]);
}

ReplayDifference compare_replay(const Log& measured, const Log& simulated, std::size_t axis, double offset) {
  const auto& m = measured.axes[axis];
  const auto& s = simulated.axes[axis];
  const auto from = first_compared(measured);
  ReplayDifference d;
  d.position = rms(difference(s.x, m.x, from));
  d.following_error = rms(difference(s.x_set, s.x, from, -offset));
  d.measured_following_error = rms(difference(m.x_set, m.x, from, -offset));
  if (const auto* effort = effort_of(m, s)) {
    d.effort = rms(difference(s.*effort->values, m.*effort->values, from));
    d.measured_effort = rms(std::vector<double>((m.*effort->values).begin() + static_cast<std::ptrdiff_t>(from),
                                                (m.*effort->values).end()));
    d.effort_unit = effort->unit;
  }
  return d;
}

sim::ExperimentResult replay_result(const Log& measured, const std::vector<ReplayCase>& cases,
                                    const std::string& signals, const std::string& axis) {
  return Result(measured, cases, axis).make(signals);
}

}  // namespace stiction::host
