#pragma once

#include <stdexcept>

namespace stiction::hal {

// Nothing may be enabled. what() says what was found and what to do.
class ModbusError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace stiction::hal
