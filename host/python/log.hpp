// A log that Python holds.
#pragma once

#include <memory>

#include "host/log/log.hpp"

namespace stiction::python {

using LogHandle = std::shared_ptr<host::Log>;

}  // namespace stiction::python
