// The C API over the requests that Python has too.
#include <fmt/format.h>
#include <fmt/ranges.h>
// The functions of the header are all that a library shows.
#pragma GCC visibility push(default)
#include <stiction.h>
#pragma GCC visibility pop

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "firmware/machine/file/machine_file.hpp"
#include "firmware/version/version.hpp"
#include "host/requests/library_folder.hpp"
#include "host/requests/request.hpp"
#include "host/requests/usage_error.hpp"
#include "host/simulate/loaded_machine.hpp"
#include "host/simulate/machine_needs.hpp"

struct stiction_machine {
  std::string file;
  std::vector<std::string> set;
  stiction::machine::Machine machine;
};

struct stiction_log {
  explicit stiction_log(stiction::host::Log of) : log(std::move(of)), columns(stiction::host::columns_of(log)) {}
  stiction_log(const stiction_log&) = delete;
  stiction_log& operator=(const stiction_log&) = delete;
  ~stiction_log() = default;

  stiction::host::Log log;
  std::vector<stiction::host::LogColumn> columns;  // point into the log
};

struct stiction_result {
  std::string document;
  std::vector<std::unique_ptr<stiction_log>> logs;
};

namespace {

using namespace stiction;

std::string& last_error() {
  thread_local std::string text;
  return text;
}

// What `call` returns; null, with the text for stiction_error(), when it throws.
template <class Call>
auto guarded(Call call) noexcept -> decltype(call()) {
  try {
    return call();
  } catch (const std::exception& error) {
    try {
      last_error() = error.what();
    } catch (...) {  // no memory is left for the text; that of the call before stays
    }
  } catch (...) {
    last_error().clear();
  }
  return nullptr;
}

const char* required(const char* text, const char* what) {
  if (text == nullptr) throw host::UsageError(fmt::format("{}: found NULL; expected a text", what));
  return text;
}

std::vector<std::string> texts_of(const char* const* texts, size_t count, const char* what) {
  if (texts == nullptr && count > 0)
    throw host::UsageError(fmt::format("{}: found NULL; expected {} texts", what, count));
  std::vector<std::string> all;
  for (size_t k = 0; k < count; ++k) all.emplace_back(required(texts[k], what));
  return all;
}

std::pair<std::string, std::string> option_of(const std::string& text) {
  const auto sign = text.find('=');
  if (sign == std::string::npos)
    throw host::UsageError(fmt::format("options: found '{}'; expected NAME=VALUE, as \"feed=16 m/min\"", text));
  return {text.substr(0, sign), text.substr(sign + 1)};
}

// Once, before the first machine is looked for.
void find_machines() {
  static const bool found =
      (host::add_machines_of_library(reinterpret_cast<const void*>(&stiction_open_machine)), true);
  static_cast<void>(found);
}

}  // namespace

extern "C" {

const char* stiction_version(void) {
  return guarded([] {
    static const std::string text = program_version();
    return text.c_str();
  });
}

const char* stiction_error(void) { return last_error().c_str(); }

stiction_machine* stiction_open_machine(const char* name, const char* const* set, size_t assignments) {
  return guarded([&] {
    find_machines();
    const std::string which = required(name, "name");
    auto texts = texts_of(set, assignments, "set");
    auto read = host::load_machine(which, texts, "", host::needs_of("machine"));
    return new stiction_machine{machine::find_machine(which).string(), std::move(texts), std::move(read)};
  });
}
void stiction_close_machine(stiction_machine* machine) { delete machine; }

const char* stiction_machine_id(const stiction_machine* machine) { return machine->machine.id.c_str(); }
size_t stiction_axes(const stiction_machine* machine) { return machine->machine.axes.size(); }
const char* stiction_axis_name(const stiction_machine* machine, size_t axis) {
  return axis < stiction_axes(machine) ? machine->machine.axes[axis].name.c_str() : nullptr;
}

stiction_result* stiction_run(const char* command, const stiction_machine* machine, const stiction_options* given) {
  return guarded([&] {
    const stiction_options none{};
    const auto& options = given == nullptr ? none : *given;
    if (machine == nullptr) throw host::UsageError("machine: found NULL; expected one of stiction_open_machine()");
    host::Request request{required(command, "command"), machine->file, machine->set,
                          texts_of(options.logs, options.log_count, "logs")};
    for (const auto& text : texts_of(options.options, options.option_count, "options"))
      request.options.push_back(option_of(text));
    request.keep_logs = options.keep_logs != 0;
    host::RequestProgress progress;
    if (options.progress != nullptr)
      progress = [&](std::string_view what) {
        if (options.progress(std::string(what).c_str(), options.user) != 0)
          throw std::runtime_error("the run was ended by its progress function");
      };
    auto found = host::answer(request, progress);
    auto result = std::make_unique<stiction_result>();
    result->document = found.document.dump(2);
    for (auto& each : found.logs) result->logs.push_back(std::make_unique<stiction_log>(std::move(each.log)));
    return result.release();
  });
}
void stiction_close_result(stiction_result* result) { delete result; }

const char* stiction_document(const stiction_result* result) { return result->document.c_str(); }
size_t stiction_result_logs(const stiction_result* result) { return result->logs.size(); }
const stiction_log* stiction_result_log(const stiction_result* result, size_t log) {
  return log < result->logs.size() ? result->logs[log].get() : nullptr;
}

stiction_log* stiction_read_log(const char* file, const char* columns) {
  return guarded([&] {
    auto logs = host::logs_of({required(file, "file")}, columns == nullptr ? "" : columns);
    if (logs.size() != 1)
      throw host::UsageError(fmt::format("{}: found a record of {} segments; expected one", file, logs.size()));
    return new stiction_log(std::move(logs.front()));
  });
}
void stiction_close_log(stiction_log* log) { delete log; }

size_t stiction_log_samples(const stiction_log* log) { return log->log.t.size(); }
size_t stiction_log_columns(const stiction_log* log) { return log->columns.size(); }
const char* stiction_column_name(const stiction_log* log, size_t column) {
  return column < log->columns.size() ? log->columns[column].name.c_str() : nullptr;
}
const char* stiction_column_unit(const stiction_log* log, size_t column) {
  return column < log->columns.size() ? log->columns[column].unit : nullptr;
}

const double* stiction_column(const stiction_log* log, const char* name) {
  return guarded([&]() -> const double* {
    const std::string wanted = required(name, "name");
    std::vector<std::string> names;
    for (const auto& column : log->columns) {
      if (column.name == wanted) return column.values->data();
      names.push_back(column.name);
    }
    throw host::UsageError(
        fmt::format("name: found no column '{}'; expected one of {}", wanted, fmt::join(names, ", ")));
  });
}

}  // extern "C"
