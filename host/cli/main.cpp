// The program `stiction`.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <exception>

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "firmware/machine/file/machine_file.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/errors.hpp"
#include "host/log/log.hpp"
#include "host/simulate/circle.hpp"

namespace stiction::host {
namespace {

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

int run(int argc, char** argv) {
  Invocation invocation{"stiction", STICTION_VERSION};
  for (int i = 1; i < argc; ++i) invocation.command_line += " " + quoted(argv[i]);

  CLI::App program("controller firmware of a servo axis, its simulated machine, and tools to identify and diagnose it",
                   "stiction");
  program.set_version_flag("--version", STICTION_VERSION);
  expect_subcommand(program, "command");
  program.failure_message(CLI::FailureMessage::help);
  add_simulate(program, invocation);
  add_compare(program, invocation);
  add_machine(program, invocation);
  add_identify(program, invocation);
  add_diagnose(program, invocation);
  add_tune_friction(program, invocation);
  add_convert(program);
  add_inspect(program);

  refuse_unknown_arguments(program);

  const auto bad_input = [](const std::exception& error) {
    fmt::print(stderr, "stiction: {}\n", error.what());
    return exit_bad_input;
  };
  try {
    program.parse(argc, argv);
    return exit_done;
  } catch (const CLI::Success& wanted) {  // --help, --version
    return program.exit(wanted);
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "stiction: {}; see stiction --help\n", error.what());
    return exit_bad_input;
  } catch (const UsageError& error) {
    return bad_input(error);
  } catch (const machine::MachineFileError& error) {
    return bad_input(error);
  } catch (const machine::ConfigurationError& error) {
    return bad_input(error);
  } catch (const LogError& error) {
    return bad_input(error);
  } catch (const InfeasibleMotion& error) {
    return bad_input(error);
  } catch (const std::exception& error) {
    fmt::print(stderr, "stiction: {}\n", error.what());
    return exit_failed;
  }
}

}  // namespace

void expect_subcommand(CLI::App& command, const std::string& kind) {
  command.require_subcommand(0, 1);
  command.prefix_command();  // leaves what it does not know to the callback
  command.callback([&command, kind] {
    if (!command.get_subcommands().empty()) return;
    std::vector<std::string> known;
    for (const auto* sub : command.get_subcommands([](const CLI::App*) { return true; }))
      known.push_back(sub->get_name());
    const auto found = command.remaining();
    throw UsageError(fmt::format("{}: found {}; expected {}{}; see {} --help", kind,
                                 found.empty() ? "none" : "'" + found.front() + "'", known.size() > 1 ? "one of " : "",
                                 fmt::join(known, ", "), command.get_name()));
  });
}

}  // namespace stiction::host

int main(int argc, char** argv) {
  try {
    return stiction::host::run(argc, argv);
  } catch (...) {
    return stiction::host::exit_failed;  // standard error cannot be written either
  }
}
