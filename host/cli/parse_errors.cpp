#include "host/cli/parse_errors.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "host/cli/choices.hpp"
#include "host/log/message.hpp"

namespace stiction::host {
namespace {

// The command that the arguments name, and those that follow its name.
struct Named {
  const CLI::App* command;
  std::vector<std::string> rest;
};

Named named_command(const CLI::App& program, const std::vector<std::string>& arguments) {
  Named named{&program, {}};
  for (const auto& argument : arguments) {
    if (argument == "--" && named.rest.empty()) continue;  // commands may follow it, as CLI11 reads them
    const CLI::App* below = nullptr;
    if (named.rest.empty())
      for (const auto* each : named.command->get_subcommands([](const CLI::App*) { return true; }))
        if (each->get_name() == argument) below = each;
    if (below != nullptr)
      named.command = below;
    else
      named.rest.push_back(argument);
  }
  return named;
}

// "--machine" of "--machine=emps"; empty for what is no option.
std::string option_name(const std::string& argument) {
  const bool number = argument.size() > 1 && argument[1] >= '0' && argument[1] <= '9';
  if (argument.size() < 2 || argument[0] != '-' || argument == "--" || number) return "";
  return argument.substr(0, argument.find('='));
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const auto* option : command.get_options()) {
    for (const auto& name : option->get_lnames()) names.push_back("--" + name);
    for (const auto& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

const CLI::Option* find_option(const CLI::App& command, const std::string& name) {
  for (const auto* option : command.get_options())
    if (option->get_name() == name || option->check_name(name)) return option;
  return nullptr;
}

// "MACHINE, shipped machine by name, or a machine file".
std::string wanted_value(const CLI::Option& option) {
  const auto type = option.get_type_name();
  auto text = option.get_description();  // a sentence, which becomes a part of one
  if (text.size() > 1 && text[1] >= 'a' && text[1] <= 'z' && text[0] >= 'A' && text[0] <= 'Z')
    text[0] = static_cast<char>(text[0] - 'A' + 'a');
  if (text.ends_with('.')) text.pop_back();
  return fmt::format("{}{}{}", type, type.empty() ? "" : ", ", text);
}

std::string surplus(const CLI::App& command, const std::string& argument) {
  auto names = option_names(command);
  std::erase_if(names, [](const std::string& name) { return !name.starts_with("--"); });
  for (auto& name : names) name.erase(0, 2);
  const auto nearest = nearest_words(argument, names);
  const auto mark = nearest.find('\'');
  return fmt::format("found '{}' after `{}`; expected no further argument{}", excerpt(argument), command_words(command),
                     nearest.empty() ? "" : nearest.substr(0, mark + 1) + "--" + nearest.substr(mark + 1));
}

// CLI11 has its sentences and no fields: the option's name stands before the first blank or colon.
std::string about_option(const CLI::App& command, const std::string& text, const CLI::ParseError& error) {
  const std::string name = text.substr(0, text.find_first_of(": "));
  const auto* option = find_option(command, name);
  if (option == nullptr) return text;
  if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr)
    return fmt::format("{}: found none; expected {}", name, wanted_value(*option));
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr)
    return option->get_items_expected_max() == 0
               ? fmt::format("{}: found a value; expected none", name)
               : fmt::format("{}: found no value; expected {}", name, wanted_value(*option));
  if (dynamic_cast<const CLI::ExcludesError*>(&error) != nullptr)
    return fmt::format("{}: found it together with {}; expected only one of the two", name,
                       text.substr(text.rfind(' ') + 1));
  if (dynamic_cast<const CLI::RequiresError*>(&error) != nullptr)
    return fmt::format("{0}: found it without {1}; expected {1} as well", name, text.substr(text.rfind(' ') + 1));
  return text;
}

std::string words_of(const Named& named, const CLI::ParseError& error) {
  const std::string text = error.what();
  constexpr std::string_view conversion = "Could not convert: ";
  if (text.starts_with(conversion)) {
    const auto equals = text.find(" = ");
    return fmt::format("{}: found '{}'; expected a whole number, at least 0",
                       text.substr(conversion.size(), equals - conversion.size()),
                       excerpt(text.substr(std::min(equals + 3, text.size()))));
  }
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
    const auto left = named.command->remaining();
    for (const auto& argument : named.rest)
      if (std::find(left.begin(), left.end(), argument) != left.end()) return surplus(*named.command, argument);
  }
  return about_option(*named.command, text, error);
}

}  // namespace

std::string unknown_option(const CLI::App& command, const std::string& name) {
  return fmt::format("{}: found an unknown option; expected an option of `{}`{}", excerpt(name), command_words(command),
                     nearest_words(name, option_names(command)));
}

std::string command_words(const CLI::App& command) {
  const auto* parent = command.get_parent();
  return parent == nullptr ? command.get_name() : command_words(*parent) + " " + command.get_name();
}

std::string usage_message(const CLI::App& program, const std::vector<std::string>& arguments,
                          const CLI::ParseError& error) {
  const auto named = named_command(program, arguments);
  const auto see = fmt::format(" (see `{} --help`)", command_words(*named.command));
  for (const auto& argument : named.rest) {
    if (argument == "--") break;
    const auto name = option_name(argument);
    if (!name.empty() && find_option(*named.command, name) == nullptr)
      return unknown_option(*named.command, name) + see;
  }
  // "machine emps" for "--machine emps".
  if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr)
    for (const auto& argument : named.rest)
      if (find_option(*named.command, "--" + argument) != nullptr) return surplus(*named.command, argument) + see;
  return words_of(named, error) + see;
}

std::string called_command(const CLI::App& program, const std::vector<std::string>& arguments) {
  const auto words = command_words(*named_command(program, arguments).command);
  return words.substr(std::min(words.size(), program.get_name().size() + 1));
}

}  // namespace stiction::host
