#include "host/python/effects.hpp"

#include <fmt/format.h>

#include <memory>

#include "host/requests/usage_error.hpp"

namespace stiction::python {
namespace {

namespace py = pybind11;

// A thread's state in the interpreter, kept from its first call to its end: Python maps memory for each new one, which
// took 95 s of processor time in place of 5 in the test of effects.
class ThreadState {
 public:
  ThreadState() : state_(PyGILState_Ensure()), kept_(PyEval_SaveThread()) {}
  ~ThreadState() {
    PyEval_RestoreThread(kept_);
    PyGILState_Release(state_);
  }
  ThreadState(const ThreadState&) = delete;
  ThreadState& operator=(const ThreadState&) = delete;

 private:
  PyGILState_STATE state_;
  PyThreadState* kept_;
};

// A function, which any thread may call and let go of.
class PythonForce {
 public:
  PythonForce(std::string axis, py::object function, const std::function<void()>& look)
      : axis_(std::move(axis)), function_(std::move(function)), look_(look) {}
  ~PythonForce() {
    const py::gil_scoped_acquire acquired;
    function_ = py::object();
  }
  PythonForce(const PythonForce&) = delete;
  PythonForce& operator=(const PythonForce&) = delete;

  double at(const host::AxisState& s) const {
    look_();
    thread_local const ThreadState kept;
    const py::gil_scoped_acquire acquired;
    const auto force = py::reinterpret_steal<py::object>(
        PyObject_CallFunction(function_.ptr(), "dddd", s.time, s.position, s.velocity, s.motor_force));
    if (!force) throw py::error_already_set();
    const double value = PyFloat_AsDouble(force.ptr());
    if (value == -1.0 && PyErr_Occurred() != nullptr) {
      PyErr_Clear();
      throw host::UsageError(
          fmt::format("effect on axis {}: found that its function returned a value of type {}; "
                      "expected the force as a number",
                      axis_, Py_TYPE(force.ptr())->tp_name));
    }
    return value;
  }

 private:
  std::string axis_;
  py::object function_;
  const std::function<void()>& look_;
};

}  // namespace

std::vector<host::RequestForce> forces_of(const Effects& effects, const std::function<void()>& look) {
  std::vector<host::RequestForce> forces;
  for (const auto& [axis, function] : effects)
    forces.push_back({axis, [force = std::make_shared<const PythonForce>(axis, function, look)](
                                const host::AxisState& state) { return force->at(state); }});
  return forces;
}

}  // namespace stiction::python
