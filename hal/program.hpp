// What the programmes at both ends of a bus begin with: their options, signals that ask them to stop, and the exit
// status of a start that was refused.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>

namespace stiction::hal {

inline constexpr int exit_refused = 2;

// Set by SIGTERM and SIGINT, from catch_stop_signals() on.
inline volatile std::sig_atomic_t stop_wanted = 0;

inline void catch_stop_signals() {
  struct sigaction action {};
  action.sa_handler = [](int) { stop_wanted = 1; };
  ::sigaction(SIGTERM, &action, nullptr);
  ::sigaction(SIGINT, &action, nullptr);
}

struct ProgramName {
  const char* name;
  const char* text;
  std::string (*version)();
};

// Reads the options and serves by them; what goes wrong before or in it is said on standard error and refuses the
// start. Options: add_to(CLI::App&). Serve: int(const Options&), the exit status. `argc`, `argv`: of main(); `program`:
// its name, text and what gives its version; `serve`: called with the options.
template <class Options, class Serve>
int run_program(int argc, char** argv, const ProgramName& program, Serve serve) noexcept {
  try {
    CLI::App app(program.text, program.name);
    app.set_version_flag("--version", program.version());
    Options options;
    options.add_to(app);
    try {
      app.parse(argc, argv);
    } catch (const CLI::Success& wanted) {
      return app.exit(wanted);
    } catch (const CLI::ParseError& error) {
      fmt::print(stderr, "{}: {}; see {} --help\n", program.name, error.what(), program.name);
      return exit_refused;
    }
    return serve(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", program.name, error.what());
    return exit_refused;
  } catch (...) {
    return exit_refused;
  }
}

}  // namespace stiction::hal
