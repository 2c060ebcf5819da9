// Logs as tables of text (docs/formats.md): leading "# key: value" lines, one header row with a unit for every channel,
// one sample a row. As stiction writes them they are CSV (RFC 4180, UTF-8, point as decimal mark); as drives write them
// a semicolon, a tab or blanks separate the columns, numbers have a decimal comma, cells are blank, the text is
// UTF-16 or compressed by gzip, and the header is not there.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "host/log/log.hpp"
#include "host/log/text_source.hpp"

namespace stiction::host {

// The log in `text`. Values in SI units whatever the header's units are; blank cells are NaN. Columns that are no
// channel are listed in `ignored`, their values not looked at. Channels that can be derived (v_set, a_set) stay empty
// when the file does not have them. `columns`: the names of the columns ("t[ms],x[mm],i[mA]"), which count instead of
// the table's own header where it has one; empty: the header counts. `name`: for messages. Throws LogError, "NAME:LINE:
// ...": a ragged row, anything but a finite number or a blank, a time stamp that is blank, repeats or falls, all that
// sampling.hpp refuses, a wrong or missing unit, linear and rotary columns of one axis, a required channel that is not
// there.
Log parse_csv_log(std::string_view text, const std::string& name, std::string_view columns = {});

// The same of a file, plain or compressed by gzip, which is not held in memory. `columns`: as above; `progress`: see
// text_source.hpp. Throws LogError also when it cannot be read.
Log read_csv_log(const std::filesystem::path& file, std::string_view columns = {}, const BytesRead& progress = {});

// Every channel in its SI unit, with the digits that give back the same double, NaN as a blank cell. Columns that were
// ignored are not kept.
std::string csv_log_text(const Log& log);

// The same text into a file, piece by piece. Throws std::runtime_error when it cannot be written.
void write_csv_log(const std::filesystem::path& file, const Log& log);

}  // namespace stiction::host
