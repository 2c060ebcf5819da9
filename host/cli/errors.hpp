// How a command ends: exit 0 done, 1 failed, 2 bad usage or bad input.
#pragma once

#include <stdexcept>

namespace stiction::host {

inline constexpr int exit_done = 0;
inline constexpr int exit_failed = 1;
inline constexpr int exit_bad_input = 2;

// Bad usage or input; what() says what was found and what was expected.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace stiction::host
