// `stiction machine new`: a commented machine file from what data sheets give, by flags or by questions at a terminal,
// and from what logs tell.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <iostream>
#include <memory>
#include <vector>

#include "host/cli/commands.hpp"
#include "host/cli/errors.hpp"
#include "host/cli/logs.hpp"
#include "host/cli/machine_options.hpp"
#include "host/cli/output.hpp"
#include "host/cli/progress.hpp"
#include "host/sheet/log_facts.hpp"
#include "host/sheet/machine_text.hpp"
#include "sim/machine_file.hpp"

namespace stiction::host {
namespace {

struct NewMachine {
  SheetAnswers given;  // by flags; empty: not given
  std::vector<std::string> logs;
  std::string columns;
  std::string out;
};

std::string shape_of(const SheetQuestion& question, const SheetAnswers& answers) {
  if (!question.choices.empty()) return fmt::format("{}", fmt::join(question.choices, "|"));
  const auto unit = unit_of(question, answers);
  return unit.empty() ? "" : unit == "1" ? "a number" : fmt::format("in {} or the like", unit);
}

// Asks until the answer is one. Throws UsageError at the end of the input.
std::string ask(const SheetQuestion& question, const SheetAnswers& answers) {
  const bool optional = may_stay_open(question, answers);
  const std::string fallback = answer_to(answers, question.name);
  const auto shape = shape_of(question, answers);
  while (true) {
    fmt::print(stderr, "{}{}{}: ", question.text, shape.empty() ? "" : " (" + shape + ")",
               fallback.empty() ? (optional ? " [none]" : "") : " [" + fallback + "]");
    std::string answer;
    if (!std::getline(std::cin, answer))
      throw UsageError("machine new: found the end of the input; expected an answer");
    if (answer.empty() && optional) return {};
    const auto objection = objection_to(question, answer, answers);
    if (objection.empty()) return answer;
    fmt::print(stderr, "  {}\n", objection);
  }
}

// The answers by flags, completed by logs, and by questions where a terminal is there.
class Completion {
 public:
  Completion(const SheetAnswers& given, const LogFacts* facts, bool terminal)
      : given_(given), facts_(facts), terminal_(terminal) {}

  // All questions that `takes` takes; what is missing or wrong is collected.
  template <class Takes>
  void complete(Takes&& takes) {
    for (const auto& question : sheet_questions())
      if (takes(question)) complete_one(question);
  }

  // Throws UsageError with all that is missing or wrong.
  const SheetAnswers& answers() const {
    if (!errors_.empty()) throw UsageError(fmt::format("{}", fmt::join(errors_, "\n")));
    return answers_;
  }

 private:
  void complete_one(const SheetQuestion& question) {
    const auto flag = given_.find(question.name);
    const bool has_flag = flag != given_.end() && !flag->second.empty();
    const std::string name(question.name);
    if (!question.wanted(answers_)) {
      if (has_flag)
        errors_.push_back(fmt::format("--{}: found \"{}\"; expected none after the other answers", name, flag->second));
      return;
    }
    if (has_flag) {
      if (const auto objection = objection_to(question, flag->second, answers_); !objection.empty())
        errors_.push_back(fmt::format("--{}: {}", name, objection));
      else if (name == "kind" && facts_ != nullptr && flag->second != facts_->facts.at("kind").answer)
        errors_.push_back(fmt::format("--kind: found \"{}\"; expected \"{}\", {}", flag->second,
                                      facts_->facts.at("kind").answer, facts_->facts.at("kind").comment()));
      answers_[name] = flag->second;
    } else if (facts_ != nullptr && (errors_.empty() ? take_from_logs(*facts_, question, answers_)
                                                     : facts_->facts.contains(question.name) ||
                                                           (name == "counts" && facts_->increment > 0.0))) {
      return;  // after an error of a flag nothing is computed of the answers
    } else if (terminal_) {
      if (const auto answer = ask(question, answers_); !answer.empty()) answers_[name] = answer;
    } else if (!may_stay_open(question, answers_)) {
      miss(question);
    }
  }

  void miss(const SheetQuestion& question) {
    const auto shape = shape_of(question, answers_);
    std::string why;
    if (facts_ != nullptr)
      if (const auto open = facts_->open.find(question.name); open != facts_->open.end())
        why = fmt::format(", and {} does not determine it ({})", facts_->source, open->second);
    errors_.push_back(fmt::format("--{}: found none{}; expected {}{}", question.name, why, question.text,
                                  shape.empty() ? "" : " (" + shape + ")"));
  }

  const SheetAnswers& given_;
  const LogFacts* facts_;
  bool terminal_;
  SheetAnswers answers_;
  std::vector<std::string> errors_;
};

// What is identified from logs with the motor's constant, and is asked after it.
bool is_identified(const SheetQuestion& question) {
  constexpr std::array<std::string_view, 10> names{"load",        "coulomb",       "viscous", "guide-coefficient",
                                                   "carriages",   "seal-drag",     "preload", "attraction",
                                                   "drag-torque", "friction-share"};
  return std::find(names.begin(), names.end(), question.name) != names.end();
}

// Logs know of no windings: unless a flag tells of them, drive and motor are one source.
void take_motor_for_a_source(SheetAnswers& given) {
  constexpr std::array<std::string_view, 8> windings{
      "voltage-constant", "resistance",      "inductance", "volts",
      "pole-pairs",       "pole-pair-pitch", "between",    "winding-between"};
  const auto is_given = [&](std::string_view name) {
    const auto found = given.find(name);
    return found != given.end() && !found->second.empty();
  };
  if (!is_given("motor") && std::none_of(windings.begin(), windings.end(), is_given)) given["motor"] = "force";
}

MarkedSheet sheet_of_logs(NewMachine& options, SheetAnswers& answers) {
  const auto logs = read_logs(options.logs, options.columns);
  auto facts = facts_of(logs, options.given["axis"]);
  take_motor_for_a_source(options.given);
  Completion completion(options.given, &facts, isatty(STDIN_FILENO) == 1);
  completion.complete([](const SheetQuestion& question) { return !is_identified(question); });
  auto known = completion.answers();
  for (const char* name : {"load", "coulomb"})
    if (!options.given[name].empty()) known[name] = options.given[name];
  {
    const Progress progress("identifying");
    identify_facts(facts, known, logs);
  }
  completion.complete(is_identified);
  answers = completion.answers();
  return marks_of(facts, answers, options.given);
}

void run_new(NewMachine options, const std::string& command) {
  SheetAnswers answers;
  MarkedSheet marked;
  if (options.logs.empty()) {
    if (!options.columns.empty())
      throw UsageError(fmt::format("--columns: found \"{}\"; expected none without --from-log", options.columns));
    Completion completion(options.given, nullptr, isatty(STDIN_FILENO) == 1);
    completion.complete([](const SheetQuestion&) { return true; });
    answers = completion.answers();
  } else {
    marked = sheet_of_logs(options, answers);
  }
  const auto text = machine_text(answers, command, marked.marks);
  sim::parse_machine(options.out.empty() ? "machine new" : options.out, text);  // what is written must be a machine
  for (const auto& each : marked.contradictions) fmt::print(stderr, "note: {}\n", each);
  if (options.out.empty()) {
    fmt::print("{}", text);
    return;
  }
  PendingFile file(options.out);
  file.write(text);
  file.commit();
  fmt::print("machine file: {0}\nstiction machine check {0} prints what was understood.\n", options.out);
}

}  // namespace

void add_machine_new(CLI::App& machine, const Invocation& invocation) {
  auto* command = machine.add_subcommand("new",
                                         "make a commented machine file from data sheets, by the flags below, and "
                                         "from logs; what they leave open is asked at a terminal");
  auto o = std::make_shared<NewMachine>();
  for (const auto& question : sheet_questions()) {
    std::string text(question.text);
    if (!question.choices.empty()) text += fmt::format(": {}", fmt::join(question.choices, " or "));
    if (!question.fallback.empty() && question.fallback != " ") text += fmt::format(" [{}]", question.fallback);
    command->add_option("--" + std::string(question.name), o->given[std::string(question.name)], text)
        ->type_name(question.unit.empty() || question.unit == "1" ? "VALUE" : "\"NUMBER UNIT\"");
  }
  command
      ->add_option(
          "--from-log", o->logs,
          "logs of the axis: what they tell is not asked, and is marked in the file; with the motor's constant "
          "mass and friction are identified; without flags on its windings the motor is a source of force")
      ->type_name("LOG");
  add_columns(*command, o->columns);
  add_output_file(*command, "--out", o->out, "write the file here [standard output]");
  command->callback([o, &invocation] {
    try {
      run_new(*o, invocation.command_line);
    } catch (const LogError& error) {
      throw UsageError(error.what());
    }
  });
}

}  // namespace stiction::host
