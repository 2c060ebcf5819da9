// Files and folders that must not be left when the programme is interrupted (Ctrl-C, a service manager, a closed
// terminal).
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace stiction::host {

// From now on an interruption removes what is registered below, then ends the programme by that signal. To be called
// before any thread is started.
void remove_temporaries_when_interrupted();

// Registers a path that must not outlive the programme, and takes it off again.
void register_temporary(const std::filesystem::path& path);
void forget_temporary(const std::filesystem::path& path);

// An interruption prints `text` on standard error before it ends the programme; empty: nothing.
void say_when_interrupted(std::string text);

// Runs `step`, which puts a temporary in its place: no interruption removes it halfway.
void without_interruption(const std::function<void()>& step);

}  // namespace stiction::host
