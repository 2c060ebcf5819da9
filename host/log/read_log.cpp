#include "host/log/read_log.hpp"

#include <fmt/format.h>

#include <string_view>

#include "host/log/csv_log.hpp"
#include "host/log/mapping.hpp"
#include "host/log/mat_log.hpp"

namespace stiction::host {
namespace {

constexpr std::size_t looked_at = std::size_t{1} << 16;  // bytes, in which every format shows itself

Log of_recording(const std::filesystem::path& file, const ReadSettings& settings) {
  const auto recording = read_recording(file, {});
  if (!settings.columns.empty())
    throw LogError(
        fmt::format("{}: found {} together with --columns; expected no --columns, as the file names its "
                    "channels itself",
                    file.string(), recording.kind));
  const auto mapping = mapping_by_names(recording);
  if (!mapping) throw LogError(mapping_hint(recording));
  return apply_mapping(*mapping, recording);
}

}  // namespace

Log read_log(const std::filesystem::path& file, const ReadSettings& settings) {
  const auto bytes = first_bytes(file, looked_at);
  const std::string_view begin = bytes;
  if (!begin.empty() && is_mat_file(file, begin))
    return settings.columns.empty() ? read_mat_log(file) : read_mat_columns(file, settings.columns);
  if (is_recorder_export(begin) || is_scope_export(begin) || is_trace_xml(begin)) return of_recording(file, settings);
  return read_csv_log(file, settings.columns, settings.progress);
}

}  // namespace stiction::host
