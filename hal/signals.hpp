// What each signal does to a programme that holds power stages: one table for all of them, so that none of those whose
// default ends or stops the process is forgotten. SIGKILL and SIGSTOP cannot be caught: what they leave is put to rest
// by whoever started the programme.
#pragma once

#include <array>
#include <csignal>
#include <cstdint>

namespace stiction::hal {

enum class SignalReaction : std::uint8_t {
  stop,    // a controlled stop, then the end
  ignore,  // nothing
  ask,     // signal_asked says so; what comes of it is the programme's
  cut,     // the power is taken off beside the loop, then the process ends by the signal
};

struct SignalRow {
  int number;
  const char* name;
  SignalReaction reaction;
  const char* sent;  // when, for docs and messages
};

// Those of Linux whose default ends or stops the process; real-time signals are all ignored.
inline constexpr std::array<SignalRow, 25> signal_table{{
    {SIGTERM, "SIGTERM", SignalReaction::stop, "by the service manager"},
    {SIGINT, "SIGINT", SignalReaction::stop, "by Ctrl-C"},
    {SIGQUIT, "SIGQUIT", SignalReaction::stop, "by Ctrl-\\"},
    {SIGHUP, "SIGHUP", SignalReaction::stop, "when the terminal or the connection to it is gone"},
    {SIGPWR, "SIGPWR", SignalReaction::stop, "when the supply fails"},
    {SIGXCPU, "SIGXCPU", SignalReaction::stop, "at a limit of processor time"},
    {SIGPIPE, "SIGPIPE", SignalReaction::ignore, "when a reader is gone"},
    {SIGXFSZ, "SIGXFSZ", SignalReaction::ignore, "at a limit of a file's size"},
    {SIGUSR1, "SIGUSR1", SignalReaction::ask, "by an operator who opens the commissioning window"},
    {SIGUSR2, "SIGUSR2", SignalReaction::ask, "by an operator who closes it"},
    {SIGALRM, "SIGALRM", SignalReaction::ignore, "by a timer"},
    {SIGVTALRM, "SIGVTALRM", SignalReaction::ignore, "by a timer"},
    {SIGPROF, "SIGPROF", SignalReaction::ignore, "by a profiler"},
    {SIGIO, "SIGIO", SignalReaction::ignore, "by a descriptor"},
    {SIGSTKFLT, "SIGSTKFLT", SignalReaction::ignore, "never on this architecture"},
    {SIGTSTP, "SIGTSTP", SignalReaction::ignore, "by Ctrl-Z, which would halt the loop with the power on"},
    {SIGTTIN, "SIGTTIN", SignalReaction::ignore, "by the terminal to a background job"},
    {SIGTTOU, "SIGTTOU", SignalReaction::ignore, "by the terminal to a background job"},
    {SIGSEGV, "SIGSEGV", SignalReaction::cut, "by an error of the programme"},
    {SIGBUS, "SIGBUS", SignalReaction::cut, "by an error of the programme or of memory"},
    {SIGFPE, "SIGFPE", SignalReaction::cut, "by an error of the programme"},
    {SIGILL, "SIGILL", SignalReaction::cut, "by an error of the programme"},
    {SIGABRT, "SIGABRT", SignalReaction::cut, "by an uncaught exception"},
    {SIGSYS, "SIGSYS", SignalReaction::cut, "by a forbidden system call"},
    {SIGTRAP, "SIGTRAP", SignalReaction::cut, "by a debugger"},
}};

// Set by the signals whose reaction is `stop`, from install_signal_reactions() on.
inline volatile std::sig_atomic_t stop_wanted = 0;

// The last of those whose reaction is `ask`; 0: none since it was taken.
inline volatile std::sig_atomic_t signal_asked = 0;

// "SIGSEGV"; "a signal" for one that is not in the table. Async-signal-safe.
const char* name_of_signal(int signal) noexcept;

// Of the process, before it starts threads. Where an exception is uncaught, or a signal ends the process, the power
// is cut first (power_cut) and one line goes to standard error, if that takes it at once. `last_words`: called in the
// signal's handler with its number, after the power is off; may be null; only what is async-signal-safe.
void install_signal_reactions(void (*last_words)(int signal) noexcept = nullptr);

// One line on standard error if it takes it within `patience_ms`; async-signal-safe. `text`: at most 4096 bytes of it
// are written.
void say_if_heard(const char* text, int patience_ms) noexcept;

// Descriptors 0 to 2 lead somewhere from now on: else the first file or bus that is opened would take the place of a
// standard error that is closed, and the log would be written into it.
void keep_standard_descriptors() noexcept;

}  // namespace stiction::hal
