// `stiction cam studio` and `stiction cam open`.
#pragma once

#include <CLI/CLI.hpp>

#include "host/cli/commands.hpp"

namespace stiction::host {

// Adds the commands to `cam`; `invocation`: how the programme was called.
void add_cam_studio(CLI::App& cam, const Invocation& invocation);

}  // namespace stiction::host
