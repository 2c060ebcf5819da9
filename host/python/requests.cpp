// Machines and commands.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include "firmware/machine/file/machine_file.hpp"
#include "firmware/version/version.hpp"
#include "host/python/effects.hpp"
#include "host/python/log.hpp"
#include "host/python/machine.hpp"
#include "host/python/module.hpp"
#include "host/python/work.hpp"
#include "host/report/machine_sheet.hpp"
#include "host/requests/fleet_request.hpp"
#include "host/requests/request.hpp"
#include "host/simulate/loaded_machine.hpp"
#include "host/simulate/machine_needs.hpp"

namespace stiction::python {
namespace {

namespace py = pybind11;

MachineHandle machine_of(const std::string& name, const std::vector<std::string>& set) {
  return {machine::find_machine(name).string(), set, host::load_machine(name, set, "", host::needs_of("machine"))};
}

py::list sheet_of(const MachineHandle& handle) {
  py::list rows;
  for (const auto& section : host::machine_sheet(handle.machine))
    for (const auto& row : section.rows)
      for (std::size_t k = 0; k < row.values.size(); ++k)
        if (!row.values[k].empty())
          rows.append(py::make_tuple(section.title, section.columns[k], row.label, row.unit, row.values[k]));
  return rows;
}

py::dict axes_of(const MachineHandle& handle) {
  py::dict axes;
  for (const auto& axis : handle.machine.axes)
    axes[py::str(axis.name)] = py::dict(py::arg("kind") = axis.coordinate.rotary() ? "rotary" : "linear",
                                        py::arg("mass") = axis.mass, py::arg("friction") = axis.friction.use);
  return axes;
}

py::list handles_of(std::vector<host::KeptLog>& logs) {
  py::list kept;
  for (auto& each : logs) kept.append(py::make_tuple(each.run, std::make_shared<host::Log>(std::move(each.log))));
  return kept;
}

py::tuple answer(const std::string& command, const MachineHandle& handle, const std::vector<std::string>& logs,
                 const std::vector<std::pair<std::string, std::string>>& options, bool keep_logs,
                 const Effects& effects, const py::object& progress) {
  // The functions belong to the thread that called: they are let go of by it, when no run asks for them any more.
  Report report;
  const std::function<void()> look = [&] { report({}); };
  const host::Request request{command, handle.file, handle.set, logs, options, keep_logs, forces_of(effects, look)};
  host::RequestAnswer found;
  std::string document;
  run_work(
      [&](const Report& given) {
        report = given;
        found = host::answer(request, [&](std::string_view words) { report(std::string(words)); });
        document = found.document.dump();
      },
      progress);
  return py::make_tuple(document, handles_of(found.logs));
}

std::string fleet(const std::string& list, const std::string& out, int threads, double false_alarms, bool full,
                  bool without_diagnosis, const py::object& progress) {
  std::string document;
  run_work(
      [&](const Report& report) {
        host::FleetHooks hooks{program_version(), "stiction.fleet() of Python"};
        hooks.progress = [&](const std::string& step, std::size_t done, std::size_t all) {
          report(fmt::format("{}: {} of {}", step, done, all));
        };
        const host::FleetRequest request{list, out, threads, false_alarms, full, without_diagnosis};
        document = host::fleet_request(request, hooks).document.dump();
      },
      progress);
  return document;
}

}  // namespace

void add_requests(py::module_& module) {
  py::class_<MachineHandle>(module, "Machine")
      .def(py::init(&machine_of))
      .def_readonly("file", &MachineHandle::file)
      .def_readonly("set", &MachineHandle::set)
      .def_property_readonly("id", [](const MachineHandle& handle) { return handle.machine.id; })
      .def_property_readonly("name", [](const MachineHandle& handle) { return handle.machine.name; })
      .def_property_readonly("period", [](const MachineHandle& handle) { return handle.machine.timing.fast_period; })
      .def_property_readonly("axes", &axes_of)
      .def_property_readonly("sheet", &sheet_of);
  module.def("answer", &answer);
  module.def("fleet", &fleet);
  module.def("commands", &host::request_commands);
  module.def("options", &host::request_options);
  module.def("shipped_machines", &machine::shipped_machines);
  module.def("version", &program_version);
}

}  // namespace stiction::python
