// Logs as CSV (RFC 4180, UTF-8, point as decimal mark; docs/formats.md): leading "# key: value" lines, one header
// row with a unit for every channel, uniform samples.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "host/log/log.hpp"

namespace stiction::host {

// Values in SI units whatever the header's units are. Columns that are no channel are listed in `ignored`, their values
// not looked at. Channels that can be derived (v_set, a_set) stay empty when the file does not have them. Throws
// LogError, "NAME:LINE: ...": a missing, empty or ragged field, anything but a finite number, a time stamp that repeats
// or falls, steps that are not uniform (sampling.hpp), a wrong or missing unit, a required channel that is not there.
Log parse_csv_log(std::string_view text, const std::string& name);

// The same of a file. Throws LogError also when it cannot be read.
Log read_csv_log(const std::filesystem::path& file);

// Every channel in its SI unit, with the digits that give back the same double. Columns that were ignored are not kept.
std::string csv_log_text(const Log& log);

// Throws std::runtime_error when the file cannot be written.
void write_csv_log(const std::filesystem::path& file, const Log& log);

}  // namespace stiction::host
