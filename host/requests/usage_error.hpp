// What is wrong with a request, wherever it comes from: a command line, Python, C.
#pragma once

#include <stdexcept>

namespace stiction::host {

// Bad usage or input; what() says what was found and what was expected.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace stiction::host
