// `stiction tune-cam`: two pulses against residual vibration from records of a dwell.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>

#include "firmware/machine/configuration/double_signals.hpp"
#include "host/cam/cycle_log.hpp"
#include "host/cam/duty.hpp"
#include "host/cam/limit_share.hpp"
#include "host/cam/tuning_report.hpp"
#include "host/cli/cam_options.hpp"
#include "host/cli/choices.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/errors.hpp"
#include "host/cli/logs.hpp"
#include "host/cli/output.hpp"
#include "host/cli/report_origin.hpp"
#include "host/output/experiment_output.hpp"
#include "host/report/experiment_report.hpp"
#include "host/simulate/stand_run.hpp"
#include "sim/cam/motion_file.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {
namespace {

struct TuneCamOptions {
  std::vector<std::string> logs;
  std::string columns;
  MotionOptions motion;
  MachineOptions machine;
  std::string speed, out;
  std::string feedback = "record", search = "quadratic";
  std::vector<double> numbers;
  int cycles = 3;
  bool running = false, json = false;

  bool by_number() const { return feedback == "number"; }
};

// Steps of the simplexes that Dostrasil 2014 took, and sweeps of the halving.
constexpr int simplex_steps = 14, halving_sweeps = 3;
// The 50 degrees of Dostrasil 2014 at 130/min, in periods of its load.
constexpr double pulse_periods = 0.93;

// The first cycle of a log. Throws UsageError for one that cannot be tuned from.
// `task`: of the tuning, whose dwell is judged with an encoder of that `resolution`; `speed`: of the master; `running`:
// of the cycle that the axis came to in its turn, and not of the one from where its positions begin.
sim::cam::CycleRecord record_of(const Log& log, const machine::AxisModel& axis, const sim::cam::Motion& motion,
                                const sim::cam::ShapingTask& task, double resolution, bool running) {
  const double speed = task.master_speed;
  const auto found = std::find_if(log.axes.begin(), log.axes.end(),
                                  [&](const AxisLog& each) { return each.axis == axis.name || each.axis.empty(); });
  if (found == log.axes.end())
    throw UsageError(fmt::format("{}: found no channel of axis {}; expected x_load and master", log.source, axis.name));
  if (found->master.empty())
    throw UsageError(fmt::format("{}: found no channel master; expected the master's position", log.source));
  if (found->x_load.empty())
    throw UsageError(fmt::format(
        "{}: found no channel x_load; expected an encoder at the load: the motor's following error sees the drive's "
        "lag and not what the shaft does",
        log.source));
  if (running && found->x_set.empty())
    throw UsageError(fmt::format(
        "{}: found no channel x_set; expected set-points, which say where a running cycle began", log.source));
  const double cycle = motion.curve.length();
  const double start = running ? found->x_set[0] - motion.curve(found->master[0]) : 0.0;
  double range = 0.0;
  for (const auto& piece : motion.curve.pieces())
    range = std::max(range, std::fabs(piece.derivative(piece.end, 0) - motion.curve(motion.curve.begin())));
  sim::cam::CycleRecord record;
  double largest = 0.0, off = 0.0;
  for (std::size_t k = 0; k < log.t.size(); ++k) {
    // The first cycle ends where the master falls back.
    if (k > 0 && found->master[k] < found->master[k - 1] - 0.5 * cycle) break;
    record.master.push_back(found->master[k]);
    record.position.push_back(found->x_load[k] - start);
    if (!found->x_set.empty())
      off = std::max(off, std::fabs(found->x_set[k] - found->x_set[0] - motion.curve(found->master[k]) +
                                    motion.curve(found->master[0])));
    if (!found->i.empty()) largest = std::max(largest, std::fabs(found->i[k]));
  }
  const auto use = [&](const auto& channel) {
    return std::span<const double>(channel.data(), std::min(channel.size(), record.master.size()));
  };
  const CycleSamples samples{use(log.t), use(found->master), use(found->x_load), use(found->x_set)};
  const bool turns = motion.cam.master == sim::cam::Coordinate::rotary;
  const double scale = turns ? 180.0 / std::numbers::pi : 1e3;
  const std::string unit = turns ? "°" : "mm";
  // The dwell, behind what the drive and an encoder lag.
  constexpr double encoder_lag = 8e-3;
  const auto begin = std::lower_bound(record.master.begin(), record.master.end(), settled(task) + encoder_lag * speed);
  const auto end = std::upper_bound(begin, record.master.end(), std::min(task.dwell.end(), cycle));
  const auto from = static_cast<std::size_t>(begin - record.master.begin());
  const auto in_dwell = [&](std::span<const double> channel) {
    return channel.empty() ? channel : channel.subspan(from, static_cast<std::size_t>(end - begin));
  };
  const CycleSamples dwell{in_dwell(samples.time), in_dwell(samples.master), in_dwell(samples.load),
                           in_dwell(samples.set)};
  const bool slave_turns = motion.cam.slave == sim::cam::Coordinate::rotary;
  const DwellJudge judge{.frequency = 2.0 * std::numbers::pi / task.mode().period(),
                         .resolution = resolution,
                         .range = range,
                         .scale = slave_turns ? 180.0 / std::numbers::pi : 1e3,
                         .unit = slave_turns ? "°" : "mm"};
  for (const auto& fault :
       {stop_in_cycle(samples, speed, scale, unit), other_speed(samples, speed, scale, unit),
        encoder_at_its_end(samples, range, scale, unit), cut_off_in_dwell(dwell, judge), motion_in_dwell(dwell, judge)})
    if (fault) throw UsageError(fmt::format("{}: {}", log.source, *fault));
  // A tick of the fastest motion is a thousandth of it.
  if (off > 5e-3 * range)
    throw UsageError(
        fmt::format("{}: found set-points that are {:.3g} of the stroke off those of the cam; expected a "
                    "log of this motion",
                    log.source, off / range));
  const double limit = axis.inverter.current_limit * axis.motor.count;
  if (largest >= 0.999 * limit)
    throw UsageError(
        fmt::format("{}: found a current of {:.4g} A, the inverter's limit; expected a cycle below it, "
                    "since a drive at its limit does not follow",
                    log.source, largest));
  return record;
}

sim::cam::CycleRecord simulated_record(const machine::Machine& machine, const sim::cam::Motion& motion, double speed,
                                       std::uint64_t seed) {
  const StandSettings settings{.master_speed = speed, .seed = seed};
  const auto run = machine.fits_formats() ? run_stand<FixedSignals>(machine, motion, settings)
                                          : run_stand<machine::DoubleSignals>(machine, motion, settings);
  sim::cam::CycleRecord record;
  for (const auto& state : run.measured) {
    record.master.push_back(state.master);
    record.position.push_back(state.position);
  }
  return record;
}

// The last of the cycles along `cams`.
sim::cam::CycleRecord simulated_running_record(const machine::Machine& machine, const std::vector<sim::cam::Cam>& cams,
                                               double speed, std::uint64_t seed) {
  sim::cam::Cam all = cams.front();
  all.periodic = false;
  all.segments.clear();
  for (const auto& cam : cams) all.segments.insert(all.segments.end(), cam.segments.begin(), cam.segments.end());
  const auto motion = sim::cam::compose(all), last = sim::cam::compose(cams.back());
  const double begin = motion.curve.length() - last.curve.length();
  const double start = motion.curve(begin) - last.curve(last.curve.begin());
  sim::cam::CycleRecord record;
  const auto whole = simulated_record(machine, motion, speed, seed);
  for (std::size_t k = 0; k < whole.master.size(); ++k) {
    if (whole.master[k] < begin) continue;
    record.master.push_back(whole.master[k] - begin);
    record.position.push_back(whole.position[k] - start);
  }
  return record;
}

void require_within_limits(const sim::cam::Motion& motion, const AxisLoad& load, double speed) {
  for (const Limit& limit : duty_of(motion, load, speed).limits)
    if (limit.broken())
      throw std::runtime_error(
          fmt::format("the tuned motion asks for a {} of {:.4g} {}, the axis has {:.4g} {}; no file is written",
                      limit.name, limit.found, limit.unit, limit.allowed, limit.unit));
}

void require_consistent(const TuneCamOptions& options) {
  if (options.by_number() && !options.logs.empty())
    throw UsageError("LOG: found a log with --feedback number; expected --number for each cycle, or --feedback record");
  if (!options.by_number() && !options.numbers.empty())
    throw UsageError("--number: found it with --feedback record; expected --feedback number");
  if (!options.by_number() && options.search != "quadratic")
    throw UsageError("--search: found it with --feedback record; expected --feedback number");
  if (options.by_number() && options.running)
    throw UsageError("--running: found it with --feedback number; expected --feedback record");
  for (const double number : options.numbers)
    if (!(number >= 0.0 && std::isfinite(number)))
      throw UsageError(fmt::format("--number: found {}; expected an area, 0 or more", number));
}

// From numbers of real cycles, in degrees and mm as the reports have them, or of simulated ones.
sim::cam::NumberSearch search_by(const TuneCamOptions& options, const sim::cam::ShapingTask& task,
                                 const sim::cam::TunerSettings& settings, const machine::Machine& machine) {
  const double degree = std::numbers::pi / 180.0;
  const auto unit = [&](sim::cam::Coordinate kind) { return kind == sim::cam::Coordinate::rotary ? degree : 1e-3; };
  const double area = unit(task.motion.cam.slave) * unit(task.motion.cam.master);
  std::size_t cycle = 0;
  const sim::cam::CycleQuality quality = [&](const sim::cam::Cam& cam) -> std::optional<double> {
    const std::size_t now = cycle++;
    if (!options.numbers.empty())
      return now < options.numbers.size() ? std::optional(options.numbers[now] * area) : std::nullopt;
    return record_quality(task, simulated_record(machine, sim::cam::compose(cam), task.master_speed, now + 1));
  };
  const double length = pulse_periods * task.period_length();
  if (options.search == "nelder-mead")
    return search_by_simplex(task, length, sim::cam::first_simplex(task, length), simplex_steps, quality);
  if (options.search == "halving") return search_by_halving(task, length, halving_sweeps, quality);
  return search_by_quadratic_form(task, settings, quality);
}

void run_tuning(const TuneCamOptions& options, const Invocation& invocation) {
  require_consistent(options);
  const auto cam = options.motion.one();
  const AxisLoad load = load_of_axis(options.machine, &cam);
  auto machine = options.machine.load(
      options.machine.machine, "",
      {.command = "tune-cam", .rotary = true, .controllers = Controllers::known, .formats = Formats::or_doubles});
  std::erase_if(machine.axes, [&](const auto& axis) { return axis.name != load.axis; });
  const auto& axis = machine.axes.front();
  const double speed = master_speed("--speed", options.speed, cam.master);
  if (!axis.second_encoder || axis.second_encoder->on != machine::EncoderPlace::load)
    throw UsageError(
        fmt::format("--machine: found axis {} without a second encoder on the load; expected one: the "
                    "motor's following error does not see what the shaft does",
                    axis.name));
  const double radius = axis.coordinate.rotary() ? axis.coordinate.radius : 1.0;
  const auto logs = read_logs(options.logs, options.columns);
  std::vector<TuningCycle> cycles;
  try {
    const auto motion = sim::cam::compose(cam);
    const auto task = shaping_task(motion, sim::cam::elastic_drive_of(axis), speed, 0.2, {});
    const sim::cam::TunerSettings settings{.resolution = axis.second_encoder->increment / radius,
                                           .share_of_limits = shares_of_limits(load, speed),
                                           .largest_force = load.effort_left(),
                                           .running = options.running};
    sim::cam::Cam tuned;
    std::optional<sim::cam::Cam> steady;
    sim::ExperimentResult result;
    if (options.by_number()) {
      const auto search = search_by(options, task, settings, machine);
      tuned = search.next.value_or(search.best);
      result = search_report(task, search, options.search != "quadratic", pulse_periods * task.period_length());
    } else {
      sim::cam::RecordTuner tuner(task, settings);
      // Behind so many cycles the machine runs steadily: 0.56^12 is a thousandth.
      std::vector<sim::cam::Cam> run(options.running ? 12 : 0, cam);
      const std::size_t count = logs.empty() ? static_cast<std::size_t>(options.cycles) : logs.size();
      // Logs behind the end of the tuning are of production, whose gear may have become warm.
      for (std::size_t c = 0; c < count && (!tuner.done() || c < logs.size()); ++c) {
        const auto now = sim::cam::compose(tuner.cam());
        auto record = !logs.empty()     ? record_of(logs[c], axis, now, task, settings.resolution, options.running)
                      : options.running ? simulated_running_record(machine, run, speed, c + 1)
                                        : simulated_record(machine, now, speed, c + 1);
        cycles.push_back({std::move(record), {}, tuner.pulses()});
        auto& learned = cycles.back().learned;
        try {
          learned = tuner.done() ? tuner.follow(cycles.back().record, false) : tuner.learn(cycles.back().record);
        } catch (const sim::cam::CamError& error) {
          // It is the log that lacks something, not the motion.
          if (logs.empty()) throw;
          throw UsageError(fmt::format("{}: {}", logs[c].source, error.what()));
        }
        run.push_back(tuner.cam());
      }
      tuned = tuner.cam();
      steady = tuner.steady_cam();
      result = tuning_report(task, tuner, cycles, options.running);
    }
    require_within_limits(sim::cam::compose(tuned), load, speed);
    if (steady) require_within_limits(sim::cam::compose(*steady), load, speed);
    const auto json = experiment_json(result, machine);
    if (!options.out.empty()) {
      auto sources = options.logs;
      sources.push_back(options.motion.motion);
      PendingFolder folder(options.out, invocation.command);
      folder.write("tuned.toml", sim::cam::motion_text({tuned}));
      if (options.running) folder.write("steady.toml", sim::cam::motion_text({*steady}));
      folder.write("report.html", experiment_report_html({invocation.command_line, invocation.version, machine, result,
                                                          report_origin(options.machine.machine, std::move(sources))}));
      folder.write("result.json", json.dump(2) + "\n");
      folder.commit();
    }
    if (options.json) {
      fmt::print("{}\n", json.dump(2));
      return;
    }
    fmt::print("{}", experiment_text(result, machine));
    if (!options.out.empty()) fmt::print("\nmotion file: {0}/tuned.toml\nreport: {0}/report.html\n", options.out);
  } catch (const sim::cam::StandError& error) {
    throw UsageError(fmt::format("--machine: {}", error.what()));
  } catch (const sim::cam::CamError& error) {
    throw UsageError(fmt::format("{}: {}", options.motion.motion, error.what()));
  }
}

}  // namespace

void add_tune_cam(CLI::App& program, const Invocation& invocation) {
  auto* command = program.add_subcommand(
      "tune-cam", "take residual vibration out of a cam by two pulses, from records of its dwell");
  auto o = std::make_shared<TuneCamOptions>();
  command
      ->add_option("logs", o->logs,
                   "a log of one cycle from rest with x_load and master, then those of the motions that this command "
                   "made of it [simulations of the machine file]")
      ->type_name("LOG");
  add_columns(*command, o->columns);
  o->machine.add_to(*command, "shipped machine by name, or a machine file, with an elastic axis that follows the cam");
  o->machine.add_axis_to(*command);
  command->add_option("--cam", o->motion.motion, "motion file (stiction.cam/1)")->required()->type_name("MOTION");
  command->add_option("--name", o->motion.cam, "name of the cam in the file [the only one]")->type_name("NAME");
  command->add_option("--speed", o->speed, "speed of the master, such as \"130 rpm\"")->required()->type_name("SPEED");
  command->add_option("--cycles", o->cycles, "simulated cycles, where no log is given [3]")
      ->check(whole_number_between(1, 20))
      ->type_name("N");
  command
      ->add_option(
          "--feedback", o->feedback,
          "record: the dwell of each cycle; number: its quality number alone, the area of the deviation [record]")
      ->check(one_of({"record", "number"}))
      ->type_name("KIND");
  command
      ->add_option(
          "--search", o->search,
          "with --feedback number: quadratic: two pulses in seven cycles; for comparison nelder-mead and halving, "
          "one pulse in about 29 and 61 [quadratic]")
      ->check(one_of({"quadratic", "nelder-mead", "halving"}))
      ->type_name("SEARCH");
  command
      ->add_option(
          "--number", o->numbers,
          "with --feedback number: that of each cycle run so far, in degrees or mm of the slave times those of the "
          "master [simulations of the machine file]")
      ->type_name("AREA");
  command->add_flag(
      "--running", o->running,
      "the machine does not stop: logs of one running cycle each; tuned.toml is for the next cycle alone, "
      "steady.toml for those behind it");
  add_out(*command, o->out, "write tuned.toml, report.html and result.json into this folder");
  command->add_flag("--json", o->json, "print the figures as JSON on standard output");
  command->callback([o, &invocation] { run_tuning(*o, invocation); });
}

}  // namespace stiction::host
