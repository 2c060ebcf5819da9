// Logs: their columns are arrays over the library's own memory.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <memory>

#include "host/log/csv_log.hpp"
#include "host/python/log.hpp"
#include "host/python/module.hpp"
#include "host/requests/request.hpp"

namespace stiction::python {
namespace {

namespace py = pybind11;

// A view that cannot be written; it keeps the log as long as it is there itself.
py::array view_of(const LogHandle& log, const std::vector<double>& values) {
  auto* owner = new LogHandle(log);
  const py::capsule kept(owner, [](void* held) { delete static_cast<LogHandle*>(held); });
  py::array_t<double> array(static_cast<py::ssize_t>(values.size()), values.data(), kept);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

py::dict arrays_of(const LogHandle& log) {
  py::dict arrays;
  for (const auto& column : host::columns_of(*log)) arrays[py::str(column.name)] = view_of(log, *column.values);
  return arrays;
}

py::dict units_of(const LogHandle& log) {
  py::dict units;
  for (const auto& column : host::columns_of(*log)) units[py::str(column.name)] = column.unit;
  return units;
}

// True where a sample is one that no fit may use.
py::dict left_out_of(const LogHandle& log) {
  py::dict all;
  for (const auto& axis : log->axes) {
    if (axis.left_out.empty()) continue;
    py::array_t<bool> mask(static_cast<py::ssize_t>(axis.left_out.size()));
    std::copy(axis.left_out.begin(), axis.left_out.end(), mask.mutable_data());
    all[py::str(axis.axis)] = mask;
  }
  return all;
}

}  // namespace

void add_logs(py::module_& module) {
  py::class_<host::Log, LogHandle>(module, "Log")
      .def_readonly("source", &host::Log::source)
      .def_readonly("period", &host::Log::period)
      .def_readonly("comments", &host::Log::comments)
      .def_readonly("ignored", &host::Log::ignored)
      .def_readonly("notes", &host::Log::notes)
      .def("arrays", &arrays_of)
      .def("units", &units_of)
      .def("left_out", &left_out_of)
      .def("write", [](const LogHandle& log, const std::filesystem::path& file) {
        const py::gil_scoped_release release;
        host::write_csv_log(file, *log);
      });
  module.def("read_log", [](const std::string& file, const std::string& columns) {
    std::vector<LogHandle> logs;
    const py::gil_scoped_release release;
    for (auto& log : host::logs_of({file}, columns)) logs.push_back(std::make_shared<host::Log>(std::move(log)));
    return logs;
  });
}

}  // namespace stiction::python
