// C++ exceptions as those of Python: what() says what was found and what was expected.
#include "firmware/machine/configuration/axis_configuration.hpp"
#include "firmware/machine/file/machine_file.hpp"
#include "firmware/machine/file/units.hpp"
#include "host/identify/friction_curves.hpp"
#include "host/log/log.hpp"
#include "host/python/module.hpp"
#include "host/requests/usage_error.hpp"
#include "host/simulate/circle.hpp"
#include "host/simulate/control_run.hpp"

namespace stiction::python {
namespace {

namespace py = pybind11;

// Owned by the module, which is never unloaded.
PyObject *error_type = nullptr, *input_error_type = nullptr, *fault_type = nullptr;

PyObject* new_type(py::module_& module, const char* name, const char* text, PyObject* bases) {
  const std::string full = std::string("stiction.") + name;
  PyObject* type = PyErr_NewExceptionWithDoc(full.c_str(), text, bases, nullptr);
  if (type == nullptr) throw py::error_already_set();
  module.attr(name) = py::reinterpret_borrow<py::object>(type);
  return type;
}

}  // namespace

void add_errors(py::module_& module) {
  error_type = new_type(module, "Error", "What stiction refuses or what fails in it.", PyExc_Exception);
  const auto both = py::make_tuple(py::handle(error_type), py::handle(PyExc_ValueError));
  input_error_type =
      new_type(module, "InputError", "Input that cannot be used: what was found and what was expected.", both.ptr());
  fault_type = new_type(module, "Fault", "A fault of the drive stopped a run.", error_type);
  py::register_exception_translator([](std::exception_ptr raised) {
    const auto bad_input = [](const std::exception& error) { PyErr_SetString(input_error_type, error.what()); };
    try {
      std::rethrow_exception(raised);
    } catch (const py::error_already_set&) {
      throw;
    } catch (const py::builtin_exception&) {
      throw;
    } catch (const host::FaultTripped& error) {
      PyErr_SetString(fault_type, error.what());
    } catch (const host::UsageError& error) {
      bad_input(error);
    } catch (const machine::MachineFileError& error) {
      bad_input(error);
    } catch (const machine::ConfigurationError& error) {
      bad_input(error);
    } catch (const machine::UnitError& error) {
      bad_input(error);
    } catch (const host::LogError& error) {
      bad_input(error);
    } catch (const host::InfeasibleMotion& error) {
      bad_input(error);
    } catch (const std::runtime_error& error) {
      PyErr_SetString(error_type, error.what());
    }
  });
}

}  // namespace stiction::python
