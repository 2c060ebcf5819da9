// Logs as MAT-files, level 5 and 7.3 (HDF5), through matio (https://github.com/tbeu/matio). Variables, units and
// comments: docs/formats.md, "MAT". Other variables and fields are listed in `ignored`.
#pragma once

#include <filesystem>

#include "host/log/log.hpp"

namespace stiction::host {

enum class MatLevel { level_5, level_7_3 };

// Whether the file begins as a MAT-file does, or is named ".mat".
bool is_mat_file(const std::filesystem::path& file, std::string_view first_bytes);

// Throws LogError: no MAT-file, an array of another shape or kind, another number of samples than t has, a value that
// is not finite, a unit of another dimension, and all that sampling.hpp and channel_name.hpp refuse. A sample is named
// as in MATLAB, "t(17)".
Log read_mat_log(const std::filesystem::path& file);

// A log in one matrix, a channel a column (or a row, where it has as many rows as names). `file`: that has one such
// matrix; `columns`: the names of its columns, "t[ms],x[mm],i[mA]". Throws LogError as above.
Log read_mat_columns(const std::filesystem::path& file, std::string_view columns);

// Throws LogError for axes of two kinds, one linear and one rotary, or for an axis whose name no variable can have;
// std::runtime_error when the file cannot be written. `file`: to write; `log`: its channels in SI units; `level`: of
// the format.
void write_mat_log(const std::filesystem::path& file, const Log& log, MatLevel level = MatLevel::level_5);

}  // namespace stiction::host
