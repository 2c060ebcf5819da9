// What the programmes at both ends of a bus begin with: their options, and exit statuses that say what happened.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>

#include "hal/signals.hpp"

namespace stiction::hal {

inline constexpr int exit_done = 0;
inline constexpr int exit_fault = 1;    // a fault stopped the axes
inline constexpr int exit_refused = 2;  // the start was refused: nothing was enabled
inline constexpr int exit_failed = 3;   // the axes are off after they ran, and something beside them failed

// Whether the axes may have been enabled: what goes wrong from then on does not refuse a start.
inline bool start_is_over = false;

struct ProgramName {
  const char* name;
  const char* text;
  std::string (*version)();
};

// Reads the options and serves by them; what goes wrong before or in it is said on standard error and refuses the
// start, or fails where the start was over. Options: add_to(CLI::App&). Serve: int(const Options&), the exit status.
// `argc`, `argv`: of main(); `program`: its name, text and what gives its version; `serve`: called with the options.
template <class Options, class Serve>
int run_program(int argc, char** argv, const ProgramName& program, Serve serve) noexcept {
  constexpr int patience_ms = 1'000;  // for a standard error that is not read
  keep_standard_descriptors();
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
    const int status = serve(options);
    if (std::fflush(stdout) == 0) return status;
    say_if_heard((std::string(program.name) + ": standard output did not take all of it\n").c_str(), patience_ms);
    return start_is_over && status == exit_done ? exit_failed : status;
  } catch (const std::exception& error) {
    say_if_heard((std::string(program.name) + ": " + error.what() + "\n").c_str(), patience_ms);
  } catch (...) {
    say_if_heard("error: an exception without a text\n", patience_ms);
  }
  return start_is_over ? exit_failed : exit_refused;
}

}  // namespace stiction::hal
