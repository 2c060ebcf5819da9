// `stiction fleet`: records of many axes over months, the trend of each parameter, and alarms at a stated rate of false
// ones.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>

#include "host/cli/choices.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/output.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/temporaries.hpp"
#include "host/fleet/results.hpp"
#include "host/requests/fleet_request.hpp"

namespace stiction::host {
namespace {

struct FleetOptions {
  FleetRequest request;
  bool json = false;
};

// A line of the terminal for each step.
class FleetProgress {
 public:
  void reach(const std::string& step, std::size_t done, std::size_t all) {
    const std::lock_guard guard(mutex_);
    if (step != step_) {
      line_.reset();
      line_ = std::make_unique<Progress>(step, all);
      step_ = step;
    }
    line_->reach(std::max(done, most_of(step)));
    most_ = std::max(done, most_of(step));
  }

 private:
  std::size_t most_of(const std::string& step) const { return step == step_ ? most_ : 0; }

  std::mutex mutex_;
  std::string step_;
  std::size_t most_ = 0;
  std::unique_ptr<Progress> line_;
};

std::string percents(const nlohmann::ordered_json& value) {
  return value.is_null() ? "-" : fmt::format("{:+.2f}", value.get<double>() * 100.0);
}

std::string fleet_text(const FleetResult& result, const nlohmann::ordered_json& json) {
  auto out = fmt::format("{}\n", fleet_sentence(result));
  for (std::size_t a = 0; a < result.trends.axes.size(); ++a)
    for (std::size_t c = 0; c < fleet_causes; ++c)
      if (result.trends.axes[a].causes[c].alarm)
        out += fmt::format("  {}\n", alarm_sentence(result, a, static_cast<FleetCause>(c)));
  if (!json["broken"].empty()) out += fmt::format("\n{} records could not be judged:\n", json["broken"].size());
  for (const auto& each : json["broken"])
    out += fmt::format("  {} {}: {}\n", each["axis"].get<std::string>(), each["date"].get<std::string>(),
                       each["message"].get<std::string>());
  constexpr std::size_t most_shown = 20;
  out += fmt::format("\n{:<20} {:>7}  trend in % a month\n{:<20} {:>7}", "axis", "records", "", "");
  for (std::size_t c = 0; c < fleet_causes; ++c) out += fmt::format(" {:>17}", cause_words(static_cast<FleetCause>(c)));
  out += '\n';
  for (std::size_t k = 0; k < std::min(json["axes"].size(), most_shown); ++k) {
    const auto& axis = json["axes"][k];
    out += fmt::format("{:<20} {:>7}", axis["axis"].get<std::string>(), axis["records"].get<std::size_t>());
    for (const auto& each : axis["parameters"]) {
      const auto half =
          each["per_month_high"].is_null()
              ? std::string()
              : fmt::format(" ± {:.2f}", (each["per_month_high"].get<double>() - each["per_month_low"].get<double>()) *
                                             50.0 / each["scale"].get<double>());
      // "±" is two bytes and one character.
      out += fmt::format(" {:>{}}", percents(each["relative_per_month"]) + half, half.empty() ? 17 : 17);
    }
    out += '\n';
  }
  if (json["axes"].size() > most_shown)
    out += fmt::format("and {} axes more in fleet.json\n", json["axes"].size() - most_shown);
  return out;
}

void run(const FleetOptions& options, const Invocation& invocation) {
  const auto& out = options.request.out;
  FleetHooks hooks{invocation.version, invocation.command_line};
  hooks.begin = [&] {
    say_when_interrupted(fmt::format("stiction: interrupted; the same command goes on in {}\n", out));
  };
  auto progress = std::make_optional<FleetProgress>();
  hooks.progress = [&](const std::string& step, std::size_t done, std::size_t all) {
    progress->reach(step, done, all);
  };
  const auto [result, json] = fleet_request(options.request, hooks);
  progress.reset();
  say_when_interrupted({});
  if (options.json) {
    fmt::print("{}\n", json.dump(2));
    return;
  }
  fmt::print("{}", fleet_text(result, json));
  fmt::print("\nestimates: {0}/fleet.csv, {0}/fleet.npz\nsummary: {0}/fleet.json\nreport: {0}/report.html\n", out);
}

}  // namespace

void add_fleet(CLI::App& program, const Invocation& invocation) {
  auto* command = program.add_subcommand(
      "fleet", "trends of mass and friction of many axes from their records over months, with alarms");
  auto o = std::make_shared<FleetOptions>();
  command
      ->add_option("list", o->request.list,
                   "list of records (CSV with the columns axis, machine, date, log; or TOML), or a folder with "
                   "fleet.csv or fleet.toml")
      ->required()
      ->type_name("LIST");
  command
      ->add_option("--out", o->request.out,
                   "folder of fleet.json, fleet.csv, fleet.npz and report.html; records that it has judged are not "
                   "judged again")
      ->required()
      ->type_name("DIR");
  command->add_option("--threads", o->request.threads, "threads [all processors]")
      ->check(whole_number_between(1, 1024))
      ->type_name("N");
  command
      ->add_option("--false-alarms", o->request.false_alarms,
                   "false alarms that are expected of an axis in a year, all parameters together (1e-6 to 1)")
      ->check(number_between(1e-6, 1.0))
      ->type_name("RATE")
      ->capture_default_str();
  auto* full =
      command->add_flag("--full", o->request.full, "diagnose every record, not only those that alarm; takes longer");
  command->add_flag("--no-diagnosis", o->request.without_diagnosis, "diagnose no record, not even those that alarm")
      ->excludes(full);
  command->add_flag("--json", o->json, "print the summary as JSON on standard output");
  command->callback([o, &invocation] { run(*o, invocation); });
}

}  // namespace stiction::host
