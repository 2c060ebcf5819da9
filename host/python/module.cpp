// The module stiction._core: what the package stiction (stiction/__init__.py) is made of.
#include "host/python/module.hpp"

#include "host/requests/library_folder.hpp"

PYBIND11_MODULE(_core, module) {
  stiction::host::add_machines_of_library(reinterpret_cast<const void*>(&stiction::python::add_errors));
  stiction::python::add_errors(module);
  stiction::python::add_logs(module);
  stiction::python::add_requests(module);
  stiction::python::add_batches(module);
  stiction::python::add_friction(module);
}
