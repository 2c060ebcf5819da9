// `stiction inspect LOG`: what a log holds, what is suspicious in it, what it can determine.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "host/cli/commands.hpp"
#include "host/cli/errors.hpp"
#include "host/cli/log_input.hpp"
#include "host/cli/machine_options.hpp"
#include "host/log/channel_name.hpp"
#include "host/log/inspection.hpp"
#include "host/log/stretches.hpp"
#include "host/output/questions_json.hpp"
#include "host/simulate/replay.hpp"

namespace stiction::host {
namespace {

using json = nlohmann::ordered_json;

struct InspectOptions {
  MachineOptions machine;
  std::string log, columns, axis;
  bool json = false;
};

std::vector<KnownAxis> known_axes(const InspectOptions& options, const Log& log) {
  if (options.machine.machine.empty()) return {};
  const auto machine = options.machine.load(options.machine.machine, "", needs_of("inspect"));
  std::vector<KnownAxis> known;
  for (const auto index : match_axes(machine, log, options.axis)) known.push_back(known_axis(machine.axes[index]));
  return known;
}

// How the amperes are counted cannot be seen without a machine: it takes the mass and the motor's constant.
std::string ampere_text(const AxisInspection& axis, bool machine_known) {
  if (axis.effort == nullptr || std::string_view(axis.effort->name) != "i") return "";
  if (!machine_known) return "interpreted as amplitudes, as the format requires; --machine allows a check";
  if (!axis.force_constant) return "interpreted as amplitudes; the accelerations are too small for a check";
  return fmt::format("{:.4g} N/A, estimated from the accelerations and the mass in the machine file",
                     *axis.force_constant);
}

const char* kind_of(const LimitedChannel& limited) {
  switch (limited.kind) {
    case LimitedChannel::Kind::limit:
      return "limit";
    case LimitedChannel::Kind::clipped:
      return "clipped";
    case LimitedChannel::Kind::off:
      return "off";
  }
  return "";
}

double part_of(const LimitedChannel& limited) {
  return static_cast<double>(std::ranges::count(limited.samples, true)) / static_cast<double>(limited.samples.size());
}

std::string limited_text(const LimitedChannel& limited) {
  const double percent = 100.0 * part_of(limited);
  switch (limited.kind) {
    case LimitedChannel::Kind::limit:
      return fmt::format(
          "{} is at the limit of {:.4g} {} in the machine file for {:.1f} % of the samples, which no fit "
          "uses",
          limited.channel->name, limited.level, limited.channel->unit, percent);
    case LimitedChannel::Kind::clipped:
      return fmt::format(
          "{} is held at the end of its range, up to {:.4g} {}, for {:.1f} % of the samples, which no fit "
          "uses",
          limited.channel->name, limited.level, limited.channel->unit, percent);
    case LimitedChannel::Kind::off:
      return fmt::format(
          "{} is exactly 0 while the axis moves, for {:.1f} % of the samples: the drive is off, and no fit "
          "uses them",
          limited.channel->name, percent);
  }
  return "";
}

// How lengths of an axis are said: mm, or degrees of a rotary one.
struct Spoken {
  double factor;
  const char* unit;
};
Spoken spoken(const AxisLog& axis) {
  if (axis.rotary) return {180.0 / std::numbers::pi, "deg"};
  return {1e3, "mm"};
}

std::string direction_text(const AxisInspection& axis) {
  if (axis.at_rest > 0.999) return "";
  if (axis.forward > 0.95) return "; in one direction only, +x";
  if (axis.forward < 0.05) return "; in one direction only, -x";
  return "";
}

std::string resolution_text(const AxisLog& log, const AxisInspection& axis) {
  std::string text;
  for (const auto& r : axis.resolution) {
    if (r.increment == 0.0 && r.noise == 0.0) continue;
    text += fmt::format("{}{}", text.empty() ? "" : "; ", r.channel->name);
    if (r.increment > 0.0) text += fmt::format(" in steps of {:.4g} {}", r.increment, unit_on(log, *r.channel));
    if (r.noise > 0.0)
      text += fmt::format("{} noise {:.2g} {} rms", r.increment > 0.0 ? "," : "", r.noise, unit_on(log, *r.channel));
  }
  return text.empty() ? "no increment and no noise found" : text;
}

std::string clock_text(const Log& log) {
  std::string text = log.clock.jitter > 0.0 ? fmt::format("jitter {:.3g} us rms ({:.2g} % of a step)",
                                                          1e6 * log.clock.jitter, 100.0 * log.clock.jitter / log.period)
                                            : std::string("no jitter beyond the digits of the stamps");
  if (log.clock.resampled)
    text += fmt::format(
        "; the samples are interpolated at even times; if the stamps are not those of the sampling, the jitter adds "
        "{:.3g} {} to the position at 1 {}/s",
        1e6 * log.clock.jitter, log.axes.front().rotary ? "urad" : "um", log.axes.front().rotary ? "rad" : "m");
  return text;
}

json clock_json(const Log& log) {
  return {{"source", log.source},   {"begin_s", log.t.front()},     {"samples", log.t.size()},
          {"period_s", log.period}, {"jitter_s", log.clock.jitter}, {"resampled", log.clock.resampled}};
}

json axis_json(const Log& log, std::size_t index, const AxisInspection& axis) {
  const std::string length = log.axes[index].rotary ? "rad" : "m";
  json channels = json::array();
  for (const auto& channel : log_channels)
    if (!(log.axes[index].*channel.values).empty())
      channels.push_back({{"name", name_on(log.axes[index], channel)}, {"unit", unit_on(log.axes[index], channel)}});
  json out{{"axis", axis.axis},
           {"channels", channels},
           {"stroke_" + length, axis.stroke},
           {"max_speed_" + length + "_per_s", axis.max_speed},
           {"max_acceleration_" + length + "_per_s2", axis.max_acceleration},
           {"reversals", axis.reversals},
           {"at_rest", axis.at_rest},
           {"forward", axis.forward}};
  out["speeds"] = json::array();
  for (const auto& p : axis.plateaus)
    out["speeds"].push_back({{"speed_" + length + "_per_s", p.speed}, {"duration_s", p.duration}});
  out["saturation"] = json::array();
  for (const auto& s : axis.saturation)
    out["saturation"].push_back(
        {{"channel", s.channel}, {"level", s.level}, {"unit", find_channel(s.channel)->unit}, {"part", s.part}});
  if (axis.delay) out["delay_s"] = *axis.delay;
  if (axis.force_per_current) out["force_per_current_N_per_A"] = *axis.force_per_current;
  if (axis.force_constant) out[std::string("force_constant_N_per_") + axis.effort->unit] = *axis.force_constant;
  out["resolution"] = json::array();
  for (const auto& r : axis.resolution)
    out["resolution"].push_back({{"channel", name_on(log.axes[index], *r.channel)},
                                 {"unit", unit_on(log.axes[index], *r.channel)},
                                 {"increment", r.increment},
                                 {"noise", r.noise}});
  out["limited"] = json::array();
  for (const auto& l : axis.limited)
    out["limited"].push_back({{"channel", l.channel->name},
                              {"unit", l.channel->unit},
                              {"kind", kind_of(l)},
                              {"level", l.level},
                              {"part", part_of(l)}});
  out["left_out"] = axis.left_out;
  out["questions"] = questions_json(axis.questions);
  if (!axis.only_a_ratio.empty()) out["only_a_ratio"] = axis.only_a_ratio;
  out["suspicions"] = axis.suspicions;
  out["determinable"] = json::array();
  for (const auto& d : axis.determinable) {
    json each{{"what", d.what}, {"possible", d.possible}, {"reason", d.reason}};
    if (!d.possible) each["record_instead"] = d.remedy;
    out["determinable"].push_back(each);
  }
  return out;
}

std::string axis_text(const Log& log, std::size_t index, const AxisInspection& axis, bool machine_known) {
  std::string text = axis.axis.empty() ? "\n" : fmt::format("\naxis {}\n", axis.axis);
  std::string channels;
  for (const auto& channel : log_channels)
    if (!(log.axes[index].*channel.values).empty())
      channels += fmt::format("{}{}[{}]", channels.empty() ? "" : ", ", name_on(log.axes[index], channel),
                              unit_on(log.axes[index], channel));
  const auto line = [&](const char* name, const std::string& value) {
    text += fmt::format("  {:<14} {}\n", name, value);
  };
  for (const auto& question : axis.questions) line("QUESTION", question.text);
  line("channels", channels);
  line("resolution", resolution_text(log.axes[index], axis));
  const bool rotary = log.axes[index].rotary;
  const auto [factor, unit] = spoken(log.axes[index]);
  line("stroke", fmt::format("{:.5g} {}", axis.stroke * factor, unit));
  line("speed", fmt::format("up to {:.4g} {}/s ({:.4g} {}), acceleration up to {:.3g} {}/s^2", axis.max_speed * factor,
                            unit, axis.max_speed * (rotary ? 30.0 / std::numbers::pi : 60.0),
                            rotary ? "turns/min" : "m/min", axis.max_acceleration, rotary ? "rad" : "m"));
  line("motion", fmt::format("{} reversals; {:.1f} % of the samples at rest; {:.0f} % of the others in +x{}",
                             axis.reversals, 100.0 * axis.at_rest, 100.0 * axis.forward, direction_text(axis)));
  for (const auto& limited : axis.limited) line("left out", limited_text(limited));
  if (axis.left_out > 0.0) line("used", fmt::format("{:.1f} % of the samples", 100.0 * (1.0 - axis.left_out)));
  if (!axis.only_a_ratio.empty()) line("ratio", axis.only_a_ratio);
  std::string speeds;
  for (const auto& p : axis.plateaus) {
    if (!speeds.empty()) speeds += ", ";
    speeds += fmt::format("{:.4g} ({:.2g} s)", p.speed * factor, p.duration);
  }
  line("steady speeds",
       speeds.empty() ? "none (at least 0.1 s and 0.1 mm within 1 %)" : fmt::format("{} {}/s", speeds, unit));
  if (axis.delay) line("position", fmt::format("{:.3g} ms behind the set position", *axis.delay * 1e3));
  if (axis.fit && !rotary)
    line("sign",
         fmt::format("{} {} with the acceleration and {} with the direction of motion", axis.effort->name,
                     axis.fit->value[0] >= 0.0 ? "rises" : "falls", axis.fit->value[2] >= 0.0 ? "rises" : "falls"));
  if (const auto amperes = ampere_text(axis, machine_known); !amperes.empty()) line("amperes", amperes);
  if (axis.force_per_current) line("F over i", fmt::format("{:.4g} N/A", *axis.force_per_current));
  for (const auto& suspicion : axis.suspicions) line("SUSPICIOUS", suspicion);
  if (rotary) return text + "  What it can determine is said of linear axes only.\n";
  text += "  this log can determine\n";
  for (const auto& d : axis.determinable)
    text += fmt::format("    {:<4} {:<45} {}{}\n", d.possible ? "yes" : "no", d.what, d.reason,
                        d.possible ? "" : "; record " + d.remedy);
  return text;
}

void run(const InspectOptions& options) {
  auto read = read_log_shown(options.log, options.columns);
  const auto which = read.clock.stretch;
  const auto stretches = stretches_of(std::move(read));
  const auto& log = stretches.at(which);
  const auto known = known_axes(options, log);
  const auto inspection = inspect(log, known);
  if (options.json) {
    json out{{"schema", "stiction.inspection/1"},
             {"log", options.log},
             {"samples", log.t.size()},
             {"period_s", log.period},
             {"duration_s", inspection.duration},
             {"segments", json::array()},
             {"notes", log.notes},
             {"ignored", log.ignored},
             {"axes", json::array()}};
    for (const auto& each : stretches) out["segments"].push_back(clock_json(each));
    for (std::size_t k = 0; k < log.axes.size(); ++k) out["axes"].push_back(axis_json(log, k, inspection.axes[k]));
    fmt::print("{}\n", out.dump(2));
    return;
  }
  fmt::print("{}: {} samples at {:.6g} ms ({:.5g} kHz), {:.5g} s\n", log.source, log.t.size(), log.period * 1e3,
             1e-3 / log.period, inspection.duration);
  fmt::print("  clock: {}\n", clock_text(log));
  if (stretches.size() > 1) {
    fmt::print("  the record has {} segments; this is the one with the most samples that a fit may use:\n",
               stretches.size());
    for (const auto& each : stretches)
      fmt::print("    {} to {} s: {} samples at {:.6g} ms, {}\n", each.t.front(), each.t.back(), each.t.size(),
                 each.period * 1e3, clock_text(each));
  }
  for (const auto& note : log.notes) fmt::print("  {}\n", note);
  for (const auto& [key, value] : log.comments) fmt::print("  # {}{}{}\n", key, value.empty() ? "" : ": ", value);
  std::string ignored;
  for (const auto& header : log.ignored) ignored += (ignored.empty() ? "" : ", ") + header;
  if (!ignored.empty()) fmt::print("  ignored columns: {}\n", ignored);
  for (std::size_t k = 0; k < log.axes.size(); ++k)
    fmt::print("{}", axis_text(log, k, inspection.axes[k], !known.empty()));
}

}  // namespace

void add_inspect(CLI::App& program) {
  auto* command = program.add_subcommand(
      "inspect", "describe a log: channels, suspicious signals, and quantities that it can determine");
  auto o = std::make_shared<InspectOptions>();
  command->add_option("LOG", o->log, "a log (CSV, MAT)")->required()->type_name("LOG");
  add_columns(*command, o->columns);
  command
      ->add_option("--machine", o->machine.machine,
                   "machine of the log, for further checks: a shipped machine by name, or a machine file")
      ->type_name("MACHINE");
  command->add_option("--axis", o->axis, "axis of the machine, for a log without axis names")->type_name("AXIS");
  command->add_flag("--json", o->json, "print the result as JSON on standard output");
  command->callback([o] { run(*o); });
}

}  // namespace stiction::host
