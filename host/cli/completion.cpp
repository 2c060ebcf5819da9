// `stiction completion bash|zsh`: the script with which a shell completes commands, options and their values, made from
// the commands themselves.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "host/cli/commands.hpp"
#include "host/cli/completion_scripts.hpp"
#include "host/cli/parse_errors.hpp"
#include "sim/plant/friction/friction.hpp"

namespace stiction::host {
namespace {

using Commands = std::vector<const CLI::App*>;

Commands below(const CLI::App& command) {
  return command.get_subcommands([](const CLI::App*) { return true; });
}

// A command and all below it, each before those below it.
Commands all_commands(const CLI::App& command) {
  Commands all{&command};
  for (const auto* each : below(command))
    for (const auto* inner : all_commands(*each)) all.push_back(inner);
  return all;
}

// "simulate circle"; empty for the programme.
std::string words_below(const CLI::App& command) {
  return command.get_parent() == nullptr ? "" : command_words(command).substr(std::string("stiction ").size());
}

// Of options that take one or several of some names, and say so in words only.
std::string listed_values(const std::string& option) {
  std::string names;
  if (option == "--friction") {
    names = "all";
    for (const auto& law : sim::friction_tables()) names += fmt::format(" {}", law.name);
  }
  if (option == "--loop") names = "all current velocity position";
  if (option == "--equations") names = "corrected printed";
  return names;
}

// What completes an option's value, in the words of the scripts: ":machine", ":axis", ":file", ":folder", names with
// blanks between them; empty: nothing is known of it.
std::string values_of(const CLI::Option& option) {
  const auto name = option.get_name(), type = option.get_type_name();
  const auto open = type.find('{'), close = type.find('}');
  if (open != std::string::npos && close != std::string::npos) {
    auto names = type.substr(open + 1, close - open - 1);
    std::replace(names.begin(), names.end(), ',', ' ');
    return names;
  }
  if (type.starts_with("MACHINE")) return ":machine";
  if (name == "--axis") return ":axis";
  if (type.starts_with("FILE") || type.starts_with("LOG")) return ":file";
  if (type.starts_with("DIR")) return ":folder";
  return listed_values(name);
}

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

// The cases of a shell that put what completes the value of an option into `values`. An option that is the same in all
// commands is written once.
std::string value_cases(const Commands& commands) {
  std::map<std::string, std::map<std::string, std::vector<std::string>>> of;  // option, values, commands
  for (const auto* command : commands)
    for (const auto* option : command->get_options())
      if (!option->get_positional()) {
        const auto values = takes_value(*option) ? values_of(*option) : ":flag";
        of[option->get_name()][values].push_back(words_below(*command));
      }
  std::string text;
  for (const auto& [option, meanings] : of)
    for (const auto& [values, where] : meanings) {
      if (values == ":flag") continue;
      std::vector<std::string> patterns;
      for (const auto& command : where) patterns.push_back(fmt::format("'{} {}'", command, option));
      text += fmt::format(
          "    {}) values='{}' takes=1 ;;\n",
          meanings.size() == 1 ? fmt::format("*' {}'", option) : fmt::format("{}", fmt::join(patterns, "|")),
          values.empty() ? ":nothing" : values);
    }
  return text;
}

// The cases that tell a command's word from a value.
std::string command_cases(const Commands& commands) {
  std::vector<std::string> patterns;
  for (const auto* command : commands)
    if (const auto* parent = command->get_parent(); parent != nullptr)
      patterns.push_back(fmt::format("'{}/{}'", words_below(*parent), command->get_name()));
  return fmt::format("      {}) command=\"${{command:+$command }}$word\" ;;\n", fmt::join(patterns, "|"));
}

// For a single-quoted word of a shell.
std::string shell_quoted(const std::string& text) {
  std::string quoted;
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted;
}

// Text of zsh's _describe, where a colon ends the name.
std::string described(const std::string& name, std::string text) {
  for (auto& c : text)
    if (c == '\n' || c == ':') c = c == ':' ? ';' : ' ';
  return fmt::format(" '{}:{}'", name, shell_quoted(text));
}

// What may stand in a command's place of an option or a command, each with its text.
std::string described_case(const CLI::App& command, bool with_texts) {
  std::string options, commands;
  for (const auto* option : command.get_options())
    for (const auto& name : option->get_lnames())
      options += with_texts ? described("--" + name, option->get_description()) : " --" + name;
  for (const auto* each : below(command))
    commands += with_texts ? described(each->get_name(), each->get_description()) : " " + each->get_name();
  std::string first;  // what completes the first argument without a dash
  for (const auto* option : command.get_options())
    if (option->get_positional() && first.empty()) first = values_of(*option).empty() ? ":file" : values_of(*option);
  const auto list = [](const std::string& words) { return words.empty() ? words : words.substr(1); };
  return fmt::format("    '{}') options=({}) commands=({}) first='{}' ;;\n", words_below(command), list(options),
                     list(commands), first);
}

std::string filled(std::string_view script, const Commands& commands, bool with_texts) {
  std::string words;
  for (const auto* command : commands) words += described_case(*command, with_texts);
  std::string text(script);
  for (const auto& [mark, content] :
       {std::pair{std::string("@COMMANDS@\n"), command_cases(commands)},
        std::pair{std::string("@VALUES@\n"), value_cases(commands)}, std::pair{std::string("@WORDS@\n"), words}})
    text.replace(text.find(mark), mark.size(), content);
  return text;
}

}  // namespace

void add_completion(CLI::App& program) {
  auto* completion = program.add_subcommand("completion", "print a script that completes command lines in a shell");
  expect_subcommand(*completion, "shell");
  completion->add_subcommand("bash", "for bash: source <(stiction completion bash)")->callback([&program] {
    fmt::print("{}", filled(bash_completion, all_commands(program), false));
  });
  completion->add_subcommand("zsh", "for zsh: source <(stiction completion zsh), after compinit")->callback([&program] {
    fmt::print("{}", filled(zsh_completion, all_commands(program), true));
  });
}

}  // namespace stiction::host
