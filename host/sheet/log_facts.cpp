#include "host/sheet/log_facts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <set>

#include "host/log/inspection.hpp"
#include "host/log/statistics.hpp"
#include "host/sheet/drive_values.hpp"

namespace stiction::host {
namespace {

constexpr double whole_turn = 2.0 * std::numbers::pi;
constexpr double whole_counts = 0.02;  // of a count, in a turn
constexpr double finer = 1.001;        // an increment of a sheet above so many of the log's is not that of its encoder
// What a sheet's largest value may be exceeded by: an acceleration over 10 ms has the encoder's rounding in it.
constexpr double over = 0.01, over_of_acceleration = 0.1;

std::string file_name(const std::string& source) {
  const auto comma = source.find(", segment ");
  return std::filesystem::path(source.substr(0, comma)).filename().string();
}

// The channels of `axis`, or of the only one.
const AxisLog& channels_in(const Log& log, const std::string& axis) {
  std::vector<std::string> names;
  for (const auto& each : log.axes) {
    if (each.axis == axis || (log.axes.size() == 1 && (axis.empty() || each.axis.empty()))) return each;
    names.push_back(each.axis);
  }
  throw LogError(fmt::format("{}: found {}; expected --axis with one of its axes: {}", log.source,
                             axis.empty() ? fmt::format("channels of {} axes", names.size()) : "no axis " + axis,
                             fmt::join(names, ", ")));
}

// The largest of a quantity and the log that shows it.
struct Reached {
  double value = 0.0;
  std::string log;
  void take(double each, const std::string& source) {
    if (each > value) *this = {each, file_name(source)};
  }
};

std::string quantity(double value, std::string_view unit) { return fmt::format("{:.7g} {}", value, unit); }

class Reader {
 public:
  Reader(const std::vector<Log>& logs, const std::string& axis) {
    std::vector<std::string> names;
    for (const auto& log : logs)
      if (const auto name = file_name(log.source); std::find(names.begin(), names.end(), name) == names.end())
        names.push_back(name);
    facts_.names = fmt::format("{}", fmt::join(names, ", "));
    facts_.source = names.size() > 2    ? fmt::format("the {} logs named above", names.size())
                    : names.size() == 2 ? fmt::format("the logs {} and {}", names[0], names[1])
                                        : "the log " + names[0];
    facts_.marks.any = true;
    const auto& first = channels_in(logs.front(), axis);
    facts_.rotary = first.rotary;
    for (const auto& log : logs) read(log, channels_in(log, axis));
    keep(first, axis);
  }

  LogFacts take() { return std::move(facts_); }

 private:
  void read(const Log& log, const AxisLog& channels) {
    if (channels.rotary != facts_.rotary)
      throw LogError(fmt::format("{}: found columns of a {} axis; expected those of a {} one, as in the log before",
                                 log.source, channels.rotary ? "rotary" : "linear",
                                 facts_.rotary ? "rotary" : "linear"));
    Log alone = log;
    alone.axes = {channels};
    const auto seen = inspect(alone).axes.front();
    stroke_.take(seen.stroke, log.source);
    speed_.take(seen.max_speed, log.source);
    acceleration_.take(seen.max_acceleration, log.source);
    for (const auto& each : seen.resolution)
      if (each.channel->values == &AxisLog::x && each.increment > 0.0 &&
          (step_.value == 0.0 || each.increment < step_.value))
        step_ = {each.increment, file_name(log.source)};
    for (const auto& each : seen.limited) limit(each, log.source);
    if (period_.value == 0.0) period_ = {log.period, file_name(log.source)};
    if (seen.force_per_current && *seen.force_per_current > 0.0) constant_.take(*seen.force_per_current, log.source);
    facts_.effort_volts = std::max(facts_.effort_volts, channels.u.empty() ? 0.0 : largest_magnitude(channels.u));
    facts_.effort_amperes = std::max(facts_.effort_amperes, channels.i.empty() ? 0.0 : largest_magnitude(channels.i));
    facts_.has_force = facts_.has_force || !channels.force.empty();
  }

  void limit(const LimitedChannel& limited, const std::string& source) {
    if (limited.kind == LimitedChannel::Kind::off || !(limited.level > 0.0)) return;
    const bool volts = limited.channel->values == &AxisLog::u;
    if (!volts && limited.channel->values != &AxisLog::i) return;
    const auto count = std::count(limited.samples.begin(), limited.samples.end(), true);
    const double part = 100.0 * static_cast<double>(count) / static_cast<double>(limited.samples.size());
    auto& fact = facts_.facts[volts ? "supply" : "current-limit"];
    if (limited.level <= fact.value) return;
    fact = {quantity(limited.level, volts ? "V" : "A"),
            "the log " + file_name(source),
            fmt::format("{:.2g} % of its samples are there", part),
            limited.level,
            (1.0 - over) * limited.level,
            std::numeric_limits<double>::infinity()};
  }

  void bound(const char* question, const Reached& reached, const char* unit, const char* what, double tolerance) {
    if (!(reached.value > 0.0)) return;
    facts_.facts[question] = {fmt::format("{:.5g} {}", reached.value, unit),
                              "the log " + reached.log,
                              what,
                              reached.value,
                              (1.0 - tolerance) * reached.value,
                              std::numeric_limits<double>::infinity()};
  }

  void keep(const AxisLog& first, const std::string& axis) {
    const bool rotary = facts_.rotary;
    facts_.facts["kind"] = {rotary ? "rotary" : "linear", facts_.source, "the units of its columns"};
    if (axis.empty() && !first.axis.empty())
      facts_.facts["axis"] = {first.axis, facts_.source, "the name of its columns"};
    bound("travel", stroke_, rotary ? "rad" : "m", "its stroke; the axis may have more", over);
    bound("max-velocity", speed_, rotary ? "rad/s" : "m/s", "its largest; the axis may be faster", over);
    bound("max-acceleration", acceleration_, rotary ? "rad/s^2" : "m/s^2",
          "its largest over 10 ms; the axis may do more", over_of_acceleration);
    facts_.increment = step_.value;
    if (step_.value > 0.0)
      facts_.facts["increment"] = {quantity(step_.value, rotary ? "rad" : "m"),
                                   "the log " + step_.log,
                                   "the smallest step of x",
                                   step_.value,
                                   0.0,
                                   finer * step_.value};
    if (constant_.value > 0.0)
      facts_.facts[rotary ? "torque-constant" : "force-constant"] = {
          quantity(constant_.value, rotary ? "N m/A" : "N/A"),
          "the log " + constant_.log,
          rotary ? "T over i" : "F over i",
          constant_.value,
          0.95 * constant_.value,
          1.05 * constant_.value};
    facts_.marks.period = MarkedValue{
        period_.value, fmt::format("the rate of the log {}, not proven to be the controller's", period_.log)};
  }

  LogFacts facts_;
  Reached stroke_, speed_, acceleration_, step_, period_, constant_;
};

// The counts in a turn of what the encoder sits on that make the step of the log; 0: no whole number of them.
double counts_of(const LogFacts& facts, const SheetAnswers& answers) {
  const bool on_motor = answer_to(answers, "transmission") != "direct" && answer_to(answers, "encoder-on") == "motor";
  const double counts = whole_turn * (on_motor ? way_of(answers) : 1.0) / facts.increment;
  return std::abs(counts - std::round(counts)) < std::max(whole_counts, 1e-5 * counts) ? std::round(counts) : 0.0;
}

const SheetQuestion* question_of(std::string_view name) {
  const auto all = sheet_questions();
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& q) { return q.name == name; });
  return found == all.end() ? nullptr : &*found;
}

std::string in_words(const SheetQuestion& question) {
  const auto text = question.text.substr(0, question.text.find_first_of(";,("));
  return std::string(text.substr(0, text.find_last_not_of(' ') + 1));
}

class Marker {
 public:
  Marker(const LogFacts& facts, const SheetAnswers& answers, const SheetAnswers& given)
      : facts_(facts), answers_(answers), given_(given) {
    sheet_.marks = facts.marks;
  }

  MarkedSheet mark() {
    sheet_.marks.effort = driven_by_volts(answers_) ? facts_.effort_volts : facts_.effort_amperes;
    for (const auto& question : sheet_questions()) {
      const std::string name(question.name);
      if (const auto why = facts_.open.find(name); why != facts_.open.end())
        sheet_.marks.remarks[name].push_back(fmt::format("Not determined by {}: {}.", facts_.source, why->second));
      const auto fact = facts_.facts.find(name);
      if (fact == facts_.facts.end() || fact->second.answer.empty()) continue;
      if (!is_given(name)) {
        sheet_.marks.comments[name] = fact->second.comment();
      } else if (fact->second.value > 0.0) {
        compare(question, fact->second);
      }
    }
    if (is_given("counts") && facts_.increment > 0.0) compare_counts();
    if (answers_.contains("counts") && !is_given("counts") && facts_.facts.contains("increment"))
      sheet_.marks.comments["counts"] = facts_.facts.at("increment").comment();
    return std::move(sheet_);
  }

 private:
  bool is_given(std::string_view name) const {
    const auto found = given_.find(name);
    return found != given_.end() && !found->second.empty();
  }

  double sheet_value(const SheetQuestion& question) const {
    auto unit = std::string(unit_of(question, answers_));
    if (driven_by_volts(answers_) && unit.ends_with("/A")) unit.back() = 'V';
    const double value = sheet_quantity(answers_, question.name, unit);
    const bool amperes = question.name == "current-limit" && answer_to(answers_, "amperes") == "rms";
    return amperes ? std::numbers::sqrt2 * value : value;
  }

  void contradict(const SheetQuestion& question, const LogFact& fact) {
    const auto text =
        fmt::format("{}: the sheet's {} and the {} of {} ({}) contradict one another; the file keeps the sheet's.",
                    in_words(question), answer_to(given_, question.name), fact.answer, fact.source, fact.detail);
    sheet_.contradictions.push_back(text);
    sheet_.marks.remarks[std::string(question.name)].push_back("CONTRADICTION: " + text);
  }

  void compare(const SheetQuestion& question, const LogFact& fact) {
    if (!question.wanted(answers_)) return;
    if (question.name.ends_with("-constant") && driven_by_volts(answers_)) return;
    const double value = sheet_value(question);
    if (value >= fact.low && value <= fact.high)
      sheet_.marks.remarks[std::string(question.name)].push_back(
          fmt::format("In addition to the sheet's value: {} {}.", fact.answer, fact.comment()));
    else
      contradict(question, fact);
  }

  void compare_counts() {
    const auto& question = *question_of("counts");
    const double counts = std::stod(answer_to(answers_, "counts"));
    const bool on_motor =
        answer_to(answers_, "transmission") != "direct" && answer_to(answers_, "encoder-on") == "motor";
    const double step = whole_turn * (on_motor ? way_of(answers_) : 1.0) / counts;
    if (step > finer * facts_.increment) contradict(question, facts_.facts.at("increment"));
  }

  const LogFacts& facts_;
  const SheetAnswers &answers_, &given_;
  MarkedSheet sheet_;
};

}  // namespace

LogFacts facts_of(const std::vector<Log>& logs, const std::string& axis) { return Reader(logs, axis).take(); }

bool take_from_logs(const LogFacts& facts, const SheetQuestion& question, SheetAnswers& answers) {
  const std::string name(question.name);
  if (name == "counts" && facts.increment > 0.0) {
    if (const double counts = counts_of(facts, answers); counts > 0.0)
      answers[name] = fmt::format("{:.0f}", counts);
    else
      answers["increment"] = facts.facts.at("increment").answer;
    return true;
  }
  const auto fact = facts.facts.find(name);
  if (fact == facts.facts.end() || fact->second.answer.empty()) return false;
  const bool rms = name == "current-limit" && answer_to(answers, "amperes") == "rms";
  answers[name] = rms ? quantity(fact->second.value / std::numbers::sqrt2, "A") : fact->second.answer;
  return true;
}

MarkedSheet marks_of(const LogFacts& facts, const SheetAnswers& answers, const SheetAnswers& given) {
  return Marker(facts, answers, given).mark();
}

}  // namespace stiction::host
