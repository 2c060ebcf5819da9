// Many axes at once.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>

#include "host/batch/batch_recording.hpp"
#include "host/python/machine.hpp"
#include "host/python/module.hpp"
#include "host/python/work.hpp"
#include "host/requests/names.hpp"
#include "host/requests/usage_error.hpp"

namespace stiction::python {
namespace {

namespace py = pybind11;
using Values = py::array_t<double, py::array::c_style | py::array::forcecast>;

struct Member {
  const MachineHandle* machine;
  std::string axis;
  double position;
};

host::InstructionSet instruction_set_of(const std::string& name) {
  if (name.empty()) return host::widest_instruction_set();
  std::vector<std::string> names;
  for (const auto set : host::instruction_sets()) names.emplace_back(host::name_of(set));
  host::require_known("instruction_set", name, "one that this processor has", names);
  return *std::ranges::find(host::instruction_sets(), name, [](auto set) { return std::string(host::name_of(set)); });
}

host::BatchRun::Member member_of(const std::tuple<const MachineHandle*, std::string, double>& text) {
  const auto& [handle, axis, position] = text;
  const auto names = host::axis_names(handle->machine);
  std::size_t index = 0;
  if (!axis.empty()) {
    host::require_known("axis", axis, "an axis of " + handle->machine.id, names);
    index = static_cast<std::size_t>(std::ranges::find(names, axis) - names.begin());
  } else if (names.size() != 1) {
    throw host::UsageError(fmt::format("axis: found none; expected one of {}, the axes of {}", fmt::join(names, ", "),
                                       handle->machine.id));
  }
  return {&handle->machine, index, position};
}

host::Row row_of(const std::string& name) {
  std::vector<std::string> names;
  for (const auto& signal : host::batch_signals()) names.emplace_back(signal.name);
  host::require_known("rows", name, "one of", names);
  return std::ranges::find(host::batch_signals(), name, [](const auto& each) { return std::string(each.name); })->row;
}

py::dict batch(const std::vector<std::tuple<const MachineHandle*, std::string, double>>& members, const Values& x,
               const Values& v, const Values& a, const std::vector<std::string>& rows, std::size_t every,
               const std::string& instruction_set, const py::object& progress) {
  std::vector<host::BatchRun::Member> each;
  for (const auto& member : members) each.push_back(member_of(member));
  host::BatchRun run(each, instruction_set_of(instruction_set));
  const bool shared = x.shape(1) == 1;
  const auto ticks = static_cast<std::size_t>(x.shape(0));
  const auto kept = host::kept_ticks(ticks, every);
  py::dict found;
  std::vector<host::BatchColumn> columns;
  for (const auto& name : rows) {
    py::array_t<double> values({kept, each.size()});
    columns.push_back({row_of(name), values.mutable_data()});
    found[py::str(name)] = values;
  }
  const auto values_of = [](const Values& array) {
    return std::span(array.data(), static_cast<std::size_t>(array.size()));
  };
  const host::BatchSetPoints set_points{values_of(x), values_of(v), values_of(a), shared};
  run_work(
      [&](const Report& report) {
        host::record_batch(run, set_points, every, columns,
                           [&](std::size_t done) { report(fmt::format("{} of {} ticks", done, ticks)); });
      },
      progress);
  py::array_t<int> faults(static_cast<py::ssize_t>(each.size()));
  for (std::size_t k = 0; k < each.size(); ++k) faults.mutable_at(k) = static_cast<int>(run.fault(k));
  found["fault"] = faults;
  return found;
}

}  // namespace

void add_batches(py::module_& module) {
  module.def("batch", &batch);
  module.def("batch_signals", [] {
    py::dict units;
    for (const auto& signal : host::batch_signals()) units[py::str(signal.name)] = signal.unit;
    return units;
  });
  module.def("instruction_sets", [] {
    std::vector<std::string> names;
    for (const auto set : host::instruction_sets()) names.emplace_back(host::name_of(set));
    return names;
  });
}

}  // namespace stiction::python
