// Effects that are functions of Python.
#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "host/requests/request.hpp"

namespace stiction::python {

// Axes with functions of (time, position, speed, motor force) that return the force on the axis.
using Effects = std::vector<std::pair<std::string, pybind11::object>>;

// `effects` as forces of a request, whose runs call the functions from any thread. `look`: called before each call of
// a function; what it throws ends the run.
std::vector<host::RequestForce> forces_of(const Effects& effects, const std::function<void()>& look);

}  // namespace stiction::python
