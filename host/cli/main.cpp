// The program `stiction`.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <malloc.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "firmware/machine/file/machine_file.hpp"
#include "firmware/machine/file/whole_file.hpp"
#include "firmware/version/version.hpp"
#include "host/cli/choices.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/errors.hpp"
#include "host/cli/parse_errors.hpp"
#include "host/cli/temporaries.hpp"
#include "host/log/log.hpp"
#include "host/log/message.hpp"
#include "host/simulate/circle.hpp"
#include "sim/cam/law.hpp"

namespace stiction::host {
namespace {

// Columns of logs come and go by the hundred, some megabytes each. To give each back to the system and to have its
// pages cleared again took half of the time of a tuning of the friction compensation.
void keep_freed_memory() {
  constexpr int largest = 1 << 30;  // bytes
  ::mallopt(M_MMAP_THRESHOLD, largest);
  ::mallopt(M_TRIM_THRESHOLD, largest);
}

// As one would type it into a shell.
std::string quoted(const std::string& argument) {
  const bool plain = !argument.empty() && argument.find_first_not_of(
                                              "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                              "0123456789_-+./:,=") == std::string::npos;
  if (plain) return argument;
  std::string text = "'";
  for (const char c : argument) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

// A command takes over from its parent that unknown arguments are left to it; the last one in the row has no use for
// them, and a typo must not pass.
void refuse_unknown_arguments(CLI::App& command) {
  const auto commands = command.get_subcommands([](CLI::App*) { return true; });
  if (commands.empty()) command.prefix_command(false);
  for (auto* each : commands) refuse_unknown_arguments(*each);
}

// "Feed along the path.": the sources have phrases, which messages use too. What begins with the name of a value,
// "fixed: ...", keeps it.
std::string sentence(std::string text) {
  const auto end = text.find_first_of(" :");
  const bool name = end != std::string::npos && text[end] != ' ';
  if (text.empty()) return text;
  if (!name && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text.back() == '.' ? text : text + ".";
}

// What holds for all options: their help is in sentences, and an empty value is none.
void finish(CLI::App& command) {
  const auto empty = [](const std::string& value) {
    return value.empty() ? std::string("found an empty value; expected one, or not the option") : std::string();
  };
  command.description(sentence(command.get_description()));
  for (auto* option : command.get_options()) {
    option->description(sentence(option->get_description()));
    if (option->get_items_expected_max() > 0) option->check(CLI::Validator(empty, ""));
  }
  for (auto* each : command.get_subcommands([](CLI::App*) { return true; })) finish(*each);
}

int run(int argc, char** argv) {
  Invocation invocation{"stiction", program_version()};
  const std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
  for (const auto& argument : arguments) invocation.command_line += " " + quoted(argument);

  CLI::App program("simulate, identify and diagnose servo axes", "stiction");
  program.set_version_flag("--version", invocation.version);
  expect_subcommand(program, "command");
  program.failure_message(CLI::FailureMessage::help);
  add_simulate(program, invocation);
  add_compare(program, invocation);
  add_machine(program, invocation);
  add_identify(program, invocation);
  add_diagnose(program, invocation);
  add_tune_friction(program, invocation);
  add_tune_cam(program, invocation);
  add_cam(program, invocation);
  add_sweep(program, invocation);
  add_fleet(program, invocation);
  add_convert(program);
  add_inspect(program);
  add_completion(program);

  refuse_unknown_arguments(program);
  finish(program);

  const auto bad_input = [](const std::exception& error) {
    fmt::print(stderr, "stiction: {}\n", error.what());
    return exit_bad_input;
  };
  try {
    invocation.command = called_command(program, arguments);
    program.parse(argc, argv);
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)  // what is buffered fails here, or nowhere
      throw std::runtime_error("standard output: cannot be written: " + machine::file_error_words(errno));
    return exit_done;
  } catch (const CLI::Success& wanted) {  // --help, --version
    return program.exit(wanted);
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "stiction: {}\n", usage_message(program, arguments, error));
    return exit_bad_input;
  } catch (const UsageError& error) {
    return bad_input(error);
  } catch (const machine::MachineFileError& error) {
    return bad_input(error);
  } catch (const machine::ConfigurationError& error) {
    return bad_input(error);
  } catch (const LogError& error) {
    return bad_input(error);
  } catch (const sim::cam::CamError& error) {
    return bad_input(error);
  } catch (const InfeasibleMotion& error) {
    return bad_input(error);
  } catch (const std::exception& error) {
    fmt::print(stderr, "stiction: {}\n", error.what());
    return exit_failed;
  }
}

}  // namespace

void refuse_unknown_command(const CLI::App& command, const std::string& kind) {
  std::vector<std::string> known;
  for (const auto* sub : command.get_subcommands([](const CLI::App*) { return true; }))
    known.push_back(sub->get_name());
  const auto found = command.remaining();
  const auto see = fmt::format(" (see `{} --help`)", command_words(command));
  if (!found.empty() && found.front().starts_with("--")) throw UsageError(unknown_option(command, found.front()) + see);
  throw UsageError(fmt::format("{}: found {}; expected one of {}{}{}", kind,
                               found.empty() ? "none" : "'" + excerpt(found.front()) + "'", fmt::join(known, ", "),
                               found.empty() ? "" : nearest_words(found.front(), known), see));
}

void expect_subcommand(CLI::App& command, const std::string& kind) {
  command.require_subcommand(0, 1);
  command.prefix_command();  // leaves what it does not know to the callback
  command.callback([&command, kind] {
    if (command.get_subcommands().empty()) refuse_unknown_command(command, kind);
  });
}

}  // namespace stiction::host

int main(int argc, char** argv) {
  try {
    std::signal(SIGXFSZ, SIG_IGN);  // a file at its limit is an error to be told
    stiction::host::keep_freed_memory();
    stiction::host::remove_temporaries_when_interrupted();
    return stiction::host::run(argc, argv);
  } catch (...) {
    return stiction::host::exit_failed;  // standard error cannot be written either
  }
}
