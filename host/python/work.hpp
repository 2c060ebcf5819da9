// Work in a thread of its own, while the interpreter's thread looks for Ctrl-C and calls the user's progress function:
// Python runs signal handlers in its main thread alone, and a progress hook may be called from any.
#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <string>

namespace stiction::python {

// Tells the interpreter's thread of `words`, if there are any. Throws when the work is to end; called from any thread
// of the work.
using Report = std::function<void(std::string words)>;

// Runs `work` to its end, or to its next report after Ctrl-C or an exception of `progress`, and throws what it threw,
// or that. `progress`: None, or called with each text that was reported. Called with the interpreter's lock, which
// other threads of Python have meanwhile.
void run_work(const std::function<void(const Report&)>& work, const pybind11::object& progress);

}  // namespace stiction::python
