#include "host/log/recording.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "host/log/mat_log.hpp"
#include "host/log/text_source.hpp"

namespace stiction::host {

std::string place_of(const Recording& recording, const RecordedChannel& channel, std::size_t sample) {
  if (channel.lines.empty()) return fmt::format("{}: sample {}", recording.source, sample + 1);
  return fmt::format("{}:{}", recording.source, channel.lines[std::min(sample, channel.lines.size() - 1)]);
}

bool parse_number(std::string_view text, char decimal, double& value) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return false;
  text = text.substr(first, text.find_last_not_of(" \t") - first + 1);
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  char buffer[64];
  if (decimal == ',') {
    if (text.size() > sizeof buffer || text.find('.') != std::string_view::npos) return false;
    text.copy(buffer, text.size());
    std::string_view copy(buffer, text.size());
    if (const auto comma = copy.find(','); comma != std::string_view::npos) buffer[comma] = '.';
    text = copy;
  }
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() && std::isfinite(value);
}

Recording read_recording(const std::filesystem::path& file, const TableForm& form) {
  const auto bytes = read_plain_or_gzip(file);
  if (is_mat_file(file, std::string_view(bytes).substr(0, 16))) return read_mat_recording(file, form);
  if (is_recorder_export(bytes)) return read_recorder_export(bytes, file.string());
  if (is_scope_export(bytes)) return read_scope_export(bytes, file.string());
  if (is_trace_xml(bytes)) return read_trace_xml(bytes, file.string());
  return read_plain_table(bytes, file.string(), form);
}

}  // namespace stiction::host
