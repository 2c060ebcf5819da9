// `stiction machine new`: a commented machine file from what data sheets give, by flags or by questions at a terminal.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <iostream>
#include <memory>

#include "host/cli/commands.hpp"
#include "host/cli/errors.hpp"
#include "host/cli/machine_options.hpp"
#include "host/cli/output.hpp"
#include "host/sheet/machine_text.hpp"
#include "sim/machine_file.hpp"

namespace stiction::host {
namespace {

struct NewMachine {
  SheetAnswers given;  // by flags; empty: not given
  std::string out;
};

std::string shape_of(const SheetQuestion& question, const SheetAnswers& answers) {
  if (!question.choices.empty()) return fmt::format("{}", fmt::join(question.choices, "|"));
  const auto unit = unit_of(question, answers);
  return unit.empty() ? "" : unit == "1" ? "a number" : fmt::format("in {} or the like", unit);
}

// Asks until the answer is one. Throws UsageError at the end of the input.
std::string ask(const SheetQuestion& question, const SheetAnswers& answers) {
  const bool optional = !question.fallback.empty();
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

// The answers by flags, completed by questions where a terminal is there. Throws UsageError with all that is missing or
// wrong.
SheetAnswers complete(const SheetAnswers& given, bool terminal) {
  SheetAnswers answers;
  std::vector<std::string> errors;
  for (const auto& question : sheet_questions()) {
    const auto flag = given.find(question.name);
    const bool has_flag = flag != given.end() && !flag->second.empty();
    if (!question.wanted(answers)) {
      if (has_flag)
        errors.push_back(
            fmt::format("--{}: found \"{}\"; expected none after the other answers", question.name, flag->second));
      continue;
    }
    if (has_flag) {
      if (const auto objection = objection_to(question, flag->second, answers); !objection.empty())
        errors.push_back(fmt::format("--{}: {}", question.name, objection));
      answers[std::string(question.name)] = flag->second;
    } else if (terminal) {
      if (const auto answer = ask(question, answers); !answer.empty()) answers[std::string(question.name)] = answer;
    } else if (question.fallback.empty()) {
      const auto shape = shape_of(question, answers);
      errors.push_back(fmt::format("--{}: found none; expected {}{}", question.name, question.text,
                                   shape.empty() ? "" : " (" + shape + ")"));
    }
  }
  if (!errors.empty()) throw UsageError(fmt::format("{}", fmt::join(errors, "\n")));
  return answers;
}

void run_new(const NewMachine& options, const std::string& command) {
  const auto answers = complete(options.given, isatty(STDIN_FILENO) == 1);
  const auto text = machine_text(answers, command);
  sim::parse_machine(options.out.empty() ? "machine new" : options.out, text);  // what is written must be a machine
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
                                         "make a commented machine file from data sheets, by the flags below; what "
                                         "they leave open is asked at a terminal");
  auto o = std::make_shared<NewMachine>();
  for (const auto& question : sheet_questions()) {
    std::string text(question.text);
    if (!question.choices.empty()) text += fmt::format(": {}", fmt::join(question.choices, " or "));
    if (!question.fallback.empty() && question.fallback != " ") text += fmt::format(" [{}]", question.fallback);
    command->add_option("--" + std::string(question.name), o->given[std::string(question.name)], text)
        ->type_name(question.unit.empty() || question.unit == "1" ? "VALUE" : "\"NUMBER UNIT\"");
  }
  add_output_file(*command, "--out", o->out, "write the file here [standard output]");
  command->callback([o, &invocation] { run_new(*o, invocation.command_line); });
}

}  // namespace stiction::host
