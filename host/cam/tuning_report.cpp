#include "host/cam/tuning_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/cam/quality_map.hpp"

namespace stiction::host {
namespace {

struct TuningUnits {
  double slave, master;
  std::string slave_unit, master_unit;
};

TuningUnits units_of_tuning(const sim::cam::Cam& cam) {
  const bool turn = cam.slave == sim::cam::Coordinate::rotary, angle = cam.master == sim::cam::Coordinate::rotary;
  const double degrees = 180.0 / std::numbers::pi;
  return {turn ? degrees : 1e3, angle ? degrees : 1e3, turn ? "°" : "mm", angle ? "°" : "mm"};
}

sim::Chart dwell_records(const sim::cam::ShapingTask& task, const std::vector<TuningCycle>& cycles,
                         const TuningUnits& units) {
  sim::Chart chart;
  chart.title = "The load's encoder in the dwell";
  chart.x_label = "master, " + units.master_unit;
  chart.y_label = "deviation, " + units.slave_unit;
  chart.shape.wide = true;
  for (std::size_t c = 0; c < cycles.size(); ++c) {
    sim::Series series{.name = fmt::format("cycle {}", c + 1), .x = {}, .y = {}};
    const auto& record = cycles[c].record;
    for (std::size_t k = 0; k < record.master.size(); ++k) {
      if (record.master[k] < task.end() || record.master[k] > task.dwell.end()) continue;
      series.x.push_back(record.master[k] * units.master);
      series.y.push_back((record.position[k] - task.start - task.stroke) * units.slave);
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

sim::Chart over_frequency(const sim::cam::ShapingTask& task, const sim::cam::RecordTuner& tuner,
                          const TuningUnits& units) {
  sim::Chart chart;
  chart.title = "Residual over the frequency, by the model that was identified";
  chart.x_label = "frequency of the load, % of the identified one";
  chart.y_label = "peak to peak, " + units.slave_unit;
  auto identified = task;
  if (tuner.drive()) identified.drive = tuner.drive()->drive;
  const auto add = [&](const char* name, const sim::cam::Motion& motion) {
    sim::Series series{.name = name, .x = {}, .y = {}};
    constexpr int points = 33;
    const auto figures = band_figures(identified, motion, points);
    for (std::size_t k = 0; k < figures.factors.size(); ++k) {
      series.x.push_back(100.0 * figures.factors[k]);
      series.y.push_back(figures.figures[k].peak_to_peak * units.slave);
    }
    chart.series.push_back(std::move(series));
  };
  add("before", task.motion);
  add("after", sim::cam::compose(tuner.cam()));
  return chart;
}

// Lines of one number, each level by its own name.
void add_lines(sim::Chart& chart, const std::vector<LevelLine>& lines, double along, const TuningUnits& units) {
  for (const LevelLine& line : lines) {
    sim::Series series{.name = fmt::format("{:.3g} {}·{}", line.level * units.slave * units.master, units.slave_unit,
                                           units.master_unit),
                       .x = {},
                       .y = {}};
    for (const auto& [x, y] : line.points) {
      series.x.push_back(x * along);
      series.y.push_back(y * units.slave);
    }
    chart.series.push_back(std::move(series));
  }
}

// The number over place and amplitude of one pulse, by the model that was identified; of two modes the first.
sim::Chart map_of_tuning(const sim::cam::ShapingTask& task, const sim::cam::RecordTuner& tuner, bool running,
                         const TuningUnits& units) {
  sim::Chart chart;
  chart.title = "Area of the deviation over place and amplitude of one pulse, by the model that was identified";
  chart.x_label = "beginning of the pulse, master, " + units.master_unit;
  chart.y_label = "amplitude, " + units.slave_unit;
  chart.caption =
      "Lines of one area; the innermost ones have a twentieth of the untuned area. A pulse at the end of the rise "
      "is the smallest.";
  if (running) chart.caption += " The machine runs on with the pulse in every cycle.";
  auto identified = task;
  if (tuner.drive()) identified.drive = tuner.drive()->drive;
  const double length = std::min(identified.period_length(), 0.5 * task.length());
  add_lines(chart, map_of_one_pulse(identified, length, 2.0, running), units.master, units);
  return chart;
}

// The number over the amplitudes of both pulses, with those of the cycles in turn; of one mode.
sim::Chart path_of_tuning(const sim::cam::ShapingTask& task, const sim::cam::RecordTuner& tuner,
                          const std::vector<TuningCycle>& cycles, bool running, const TuningUnits& units) {
  sim::Chart chart;
  chart.title = "Amplitudes of both pulses, cycle by cycle";
  chart.x_label = "amplitude of the first pulse, " + units.slave_unit;
  chart.y_label = "amplitude of the second pulse, " + units.slave_unit;
  chart.caption = running ? "Lines of one area are those of a machine that runs on with such pulses in every cycle, by "
                            "the model that was identified. The second cycle has pulses for what the first one left, "
                            "too, and so it lies off the least area; the path comes back to it."
                          : "Lines of one area are those of a cycle from rest, by the model that was identified.";
  sim::Series path{.name = "cycles in turn", .x = {}, .y = {}}, next{.name = "next", .x = {}, .y = {}, .points = true};
  for (const TuningCycle& cycle : cycles) {
    path.x.push_back(cycle.pulses ? cycle.pulses->first.amplitude * units.slave : 0.0);
    path.y.push_back(cycle.pulses ? cycle.pulses->second.amplitude * units.slave : 0.0);
  }
  const auto& now = *tuner.pulses();
  next.x.push_back(now.first.amplitude * units.slave);
  next.y.push_back(now.second.amplitude * units.slave);
  chart.series = {std::move(path), std::move(next)};
  auto identified = task;
  if (tuner.drive()) identified.drive = tuner.drive()->drive;
  add_lines(chart, map_of_two_pulses(identified, now, running), units.slave, units);
  return chart;
}

// `lines`: of one number by the model of the machine file.
sim::Chart path_of_search(const sim::cam::NumberSearch& search, bool one_pulse, const std::vector<LevelLine>& lines,
                          const TuningUnits& units) {
  sim::Chart chart;
  chart.title = "Path of the search";
  chart.x_label = one_pulse ? "master, " + units.master_unit : "amplitude of the first pulse, " + units.slave_unit;
  chart.y_label = fmt::format("amplitude of the {} pulse, {}", one_pulse ? "one" : "second", units.slave_unit);
  sim::Series path{.name = "trials in turn", .x = {}, .y = {}};
  sim::Series best{.name = "least area", .x = {}, .y = {}, .points = true};
  const double along = one_pulse ? units.master : units.slave;
  for (const auto& trial : search.trials) {
    path.x.push_back(trial.at[0] * along);
    path.y.push_back(trial.at[1] * units.slave);
  }
  best.x.push_back(search.least.at[0] * along);
  best.y.push_back(search.least.at[1] * units.slave);
  chart.series = {std::move(path), std::move(best)};
  chart.caption = "Lines of one area are those of the model of the machine file.";
  add_lines(chart, lines, along, units);
  return chart;
}

sim::Chart numbers_of_search(const sim::cam::NumberSearch& search, const TuningUnits& units) {
  sim::Chart chart;
  chart.title = "Area of the deviation, cycle by cycle";
  chart.x_label = "cycle";
  chart.y_label = fmt::format("area, {}·{}", units.slave_unit, units.master_unit);
  sim::Series areas{.name = "each", .x = {}, .y = {}}, least{.name = "least so far", .x = {}, .y = {}};
  double so_far = search.trials.empty() ? 0.0 : search.trials.front().quality;
  for (std::size_t k = 0; k < search.trials.size(); ++k) {
    so_far = std::min(so_far, search.trials[k].quality);
    for (auto* series : {&areas, &least}) series->x.push_back(static_cast<double>(k + 1));
    areas.y.push_back(search.trials[k].quality * units.slave * units.master);
    least.y.push_back(so_far * units.slave * units.master);
  }
  chart.series = {std::move(areas), std::move(least)};
  return chart;
}

}  // namespace

sim::ExperimentResult search_report(const sim::cam::ShapingTask& task, const sim::cam::NumberSearch& search,
                                    bool one_pulse, double length) {
  const auto units = units_of_tuning(task.motion.cam);
  sim::ExperimentResult result;
  result.experiment = "tune-cam";
  result.title = fmt::format("Tuned cam {}", task.motion.cam.name);
  result.question = "How much less does the load vibrate in the dwell, by its quality number alone?";
  const auto add = [&](const std::string& name, const std::string& unit, const std::string& text, double value) {
    result.figures.push_back({.name = name, .unit = unit, .text = text, .value = value, .expected = {}});
  };
  for (std::size_t c = 0; c < search.trials.size(); ++c)
    add(fmt::format("quality_cycle_{}", c + 1), units.slave_unit + " " + units.master_unit,
        fmt::format("cycle {}: area of the deviation in the dwell", c + 1),
        search.trials[c].quality * units.slave * units.master);
  if (one_pulse && !search.trials.empty()) {
    add("pulse_1_at", units.master_unit, "pulse: begins at", search.least.at[0] * units.master);
    add("pulse_1_amplitude", units.slave_unit, "pulse: amplitude", search.least.at[1] * units.slave);
    add("pulse_length", units.master_unit, "length of the pulse", length * units.master);
  } else if (!search.trials.empty()) {
    add("pulse_1_amplitude", units.slave_unit, "pulse 1: amplitude", search.least.at[0] * units.slave);
    add("pulse_2_amplitude", units.slave_unit, "pulse 2: amplitude", search.least.at[1] * units.slave);
  }
  if (!search.trials.empty())
    result.findings.push_back(fmt::format("Least area of the deviation: {:.3g} {}·{} after {} cycles.",
                                          search.least.quality * units.slave * units.master, units.slave_unit,
                                          units.master_unit, search.trials.size()));
  if (search.next)
    result.findings.push_back("The motion file is the trial of the next cycle; its number is wanted next.");
  const auto lines = search.where ? map_of_two_pulses(task, *search.where)
                     : one_pulse  ? map_of_one_pulse(task, length, 2.0)
                                  : std::vector<LevelLine>{};
  if (!search.trials.empty())
    result.charts = {path_of_search(search, one_pulse, lines, units), numbers_of_search(search, units)};
  return result;
}

sim::ExperimentResult tuning_report(const sim::cam::ShapingTask& task, const sim::cam::RecordTuner& tuner,
                                    const std::vector<TuningCycle>& cycles, bool running) {
  const auto units = units_of_tuning(task.motion.cam);
  sim::ExperimentResult result;
  result.experiment = "tune-cam";
  result.title = fmt::format("Tuned cam {}", task.motion.cam.name);
  result.question = "How much less does the load vibrate in the dwell, and what are its frequency and damping?";
  const auto add = [&](const std::string& name, const std::string& unit, const std::string& text, double value) {
    result.figures.push_back({.name = name, .unit = unit, .text = text, .value = value, .expected = {}});
  };
  const auto add_mode = [&](const std::string& prefix, const std::string& of, const sim::cam::DwellFit& fit) {
    add(prefix + "frequency", "Hz", "frequency of " + of, fit.mode.frequency() / (2.0 * std::numbers::pi));
    add(prefix + "frequency_error", "Hz", "its standard error", fit.frequency_error / (2.0 * std::numbers::pi));
    add(prefix + "damping_ratio", "", prefix.empty() ? "damping ratio" : "damping ratio of " + of,
        fit.mode.damping_ratio());
    add(prefix + "damping_ratio_error", "", "its standard error", fit.damping_error);
  };
  if (const auto& fit = cycles.front().learned.fit) add_mode("", "the load", *fit);
  // From the cycle that showed it.
  for (const TuningCycle& cycle : cycles)
    if (const auto& fit = cycle.learned.second) {
      add_mode("second_", "the second mode", *fit);
      add("second_peak_to_peak", units.slave_unit, "vibration of the second mode at the beginning of the dwell",
          fit->peak_to_peak() * units.slave);
      break;
    }
  if (const auto& drive = tuner.drive()) {
    add("delay", "ms", "lag of the load's encoder", drive->delay * 1e3);
    add("delay_error", "ms", "its standard error", drive->delay_error * 1e3);
  }
  for (std::size_t c = 0; c < cycles.size(); ++c) {
    const auto& learned = cycles[c].learned;
    add(fmt::format("quality_cycle_{}", c + 1), units.slave_unit + " " + units.master_unit,
        fmt::format("cycle {}: area of the deviation in the dwell, behind the lag of the drive", c + 1),
        learned.quality * units.slave * units.master);
    add(fmt::format("peak_to_peak_cycle_{}", c + 1), units.slave_unit,
        fmt::format("cycle {}: vibration at the beginning of the dwell", c + 1), learned.peak_to_peak * units.slave);
    if (!learned.note.empty()) result.findings.push_back(fmt::format("Cycle {}: {}", c + 1, learned.note));
  }
  int number = 0;
  for (const auto& pair : {tuner.pulses(), tuner.second_pulses()}) {
    if (!pair) continue;
    for (const auto& pulse : {pair->first, pair->second}) {
      ++number;
      add(fmt::format("pulse_{}_at", number), units.master_unit, fmt::format("pulse {}: begins at", number),
          pulse.position * units.master);
      add(fmt::format("pulse_{}_amplitude", number), units.slave_unit, fmt::format("pulse {}: amplitude", number),
          pulse.amplitude * units.slave);
    }
    add(number > 2 ? "second_pulse_length" : "pulse_length", units.master_unit,
        number > 2 ? "length of the pulses for the second mode" : "length of the pulses", pair->length * units.master);
  }
  const auto area = [&](const TuningCycle& cycle) {
    return fmt::format("{:.3g} {}·{}", cycle.learned.quality * units.slave * units.master, units.slave_unit,
                       units.master_unit);
  };
  result.findings.push_back(
      cycles.size() == 1 ? fmt::format("Area of the deviation in the dwell: {}; the next cycle shows the pulses.",
                                       area(cycles.front()))
                         : fmt::format("Area of the deviation in the dwell: {} in the first cycle, {} in the last one.",
                                       area(cycles.front()), area(cycles.back())));
  result.charts = {dwell_records(task, cycles, units)};
  // The model that was identified has one mode.
  if (!tuner.second_pulses()) result.charts.push_back(over_frequency(task, tuner, units));
  result.charts.push_back(map_of_tuning(task, tuner, running, units));
  if (tuner.pulses() && !tuner.second_pulses())
    result.charts.push_back(path_of_tuning(task, tuner, cycles, running, units));
  return result;
}

}  // namespace stiction::host
