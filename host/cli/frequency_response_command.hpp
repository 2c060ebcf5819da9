// `stiction simulate frequency-response`.
#pragma once

#include "host/cli/commands.hpp"

namespace stiction::host {

void add_frequency_response(CLI::App& simulate, const Invocation& invocation);

}  // namespace stiction::host
