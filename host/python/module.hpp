// The parts of the module stiction._core.
#pragma once

#include <pybind11/pybind11.h>

namespace stiction::python {

void add_errors(pybind11::module_& module);
void add_logs(pybind11::module_& module);
void add_requests(pybind11::module_& module);
void add_batches(pybind11::module_& module);
void add_friction(pybind11::module_& module);

}  // namespace stiction::python
