// Logs as a command reads them: the option --columns, and progress in bytes.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <system_error>

#include "host/cli/progress.hpp"
#include "host/log/read_log.hpp"

namespace stiction::host {

// Adds --columns to a command that reads logs. `columns`: takes the option's text.
inline CLI::Option* add_columns(CLI::App& command, std::string& columns) {
  return command
      .add_option("--columns", columns,
                  "names and units of the columns of a table or MAT matrix that has no header: "
                  "\"t[ms],x_set[mm],x[mm],i[mA]\"; a column with an unknown name (\"-\") is ignored")
      ->type_name("NAMES");
}

// The log in `file`; a line on standard error shows how much of it was read. `columns`: see add_columns. Throws
// LogError.
inline Log read_log_shown(const std::string& file, const std::string& columns) {
  constexpr std::size_t mebibyte = std::size_t{1} << 20;
  std::error_code none;
  const auto size = std::filesystem::file_size(file, none);
  Progress progress("reading MiB of " + file, none ? 0 : (static_cast<std::size_t>(size) + mebibyte - 1) / mebibyte);
  std::size_t waiting = 0;
  return read_log(file, {columns, [&](std::size_t bytes) {
                           for (waiting += bytes; waiting >= mebibyte; waiting -= mebibyte) progress.add();
                         }});
}

}  // namespace stiction::host
