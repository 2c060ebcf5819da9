// The friction bench, for laws of the product and for laws written in Python.
#include <pybind11/numpy.h>

#include "host/python/machine.hpp"
#include "host/python/module.hpp"
#include "host/requests/names.hpp"
#include "host/requests/usage_error.hpp"
#include "host/simulate/friction_bench.hpp"
#include "host/simulate/friction_choice.hpp"

namespace stiction::python {
namespace {

namespace py = pybind11;
using Values = py::array_t<double, py::array::c_style | py::array::forcecast>;

// `advance(k, force)` moves the bench on by a step; returns its motion in every step.
template <class Bench, class Advance>
py::dict record(const Values& force, const Bench& bench, Advance advance) {
  const auto steps = force.size();
  py::array_t<double> x(steps), v(steps), friction(steps);
  for (py::ssize_t k = 0; k < steps; ++k) {
    advance(force.data()[k]);
    x.mutable_data()[k] = bench.position();
    v.mutable_data()[k] = bench.velocity();
    friction.mutable_data()[k] = bench.friction_force();
  }
  return py::dict(py::arg("x") = x, py::arg("v") = v, py::arg("friction") = friction);
}

py::dict bench_of_machine(const MachineHandle& handle, const std::string& axis, const std::string& law,
                          const Values& force) {
  auto machine = handle.machine;
  host::require_known("axis", axis, "an axis of " + machine.id, host::axis_names(machine));
  if (!law.empty()) host::use_friction(machine, law);
  for (const auto& each : machine.axes)
    if (each.name == axis) {
      host::FrictionBench bench(each);
      return record(force, bench, [&](double f) { bench.advance(f); });
    }
  return {};
}

py::dict bench_of_law(const py::object& law, double mass, const Values& force) {
  host::MassOnBench bench(mass);
  const py::object advance = law.attr("advance");
  int until_signals = 0;
  return record(force, bench, [&](double f) {
    if (until_signals-- == 0) {
      until_signals = 1000;
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    }
    bench.move(f, advance(bench.velocity(), f).template cast<double>());
  });
}

}  // namespace

void add_friction(py::module_& module) {
  module.attr("BENCH_STEP") = host::MassOnBench::step;
  module.def("bench_of_machine", &bench_of_machine);
  module.def("bench_of_law", &bench_of_law);
}

}  // namespace stiction::python
