// How a command ends: exit 0 done, 1 failed, 2 bad usage or bad input.
#pragma once

#include "host/requests/usage_error.hpp"

namespace stiction::host {

inline constexpr int exit_done = 0;
inline constexpr int exit_failed = 1;
inline constexpr int exit_bad_input = 2;

}  // namespace stiction::host
