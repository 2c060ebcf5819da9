// Recordings of a SINUMERIK Edge: see recording.hpp.
#include <fmt/format.h>
#include <zip.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "host/log/message.hpp"
#include "host/log/recording.hpp"

namespace stiction::host {
namespace {

using json = nlohmann::json;

constexpr std::string_view zip_mark = "PK\x03\x04";
constexpr std::size_t largest_entry = std::size_t{2} << 30;  // a bomb, or hours at 1 kHz

struct ZipFree {
  void operator()(zip_t* archive) const { zip_discard(archive); }
  void operator()(zip_file_t* file) const { zip_fclose(file); }
};

// The one JSON file in the archive.
std::string unzipped(const std::string& bytes, const std::string& name) {
  zip_error_t error;
  zip_error_init(&error);
  auto* source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error);
  const std::unique_ptr<zip_t, ZipFree> archive(source == nullptr ? nullptr
                                                                  : zip_open_from_source(source, ZIP_RDONLY, &error));
  if (!archive) {
    if (source != nullptr) zip_source_free(source);
    const std::string why = zip_error_strerror(&error);
    zip_error_fini(&error);
    throw LogError(
        fmt::format("{}: found a zip archive that cannot be read ({}); expected a recorder's export", name, why));
  }
  zip_error_fini(&error);
  const auto entries = zip_get_num_entries(archive.get(), 0);
  zip_stat_t found{};
  int json_files = 0;
  for (zip_int64_t k = 0; k < entries; ++k) {
    zip_stat_t stat;
    if (zip_stat_index(archive.get(), static_cast<zip_uint64_t>(k), 0, &stat) != 0) continue;
    if (!std::string_view(stat.name).ends_with(".json")) continue;
    found = stat;
    ++json_files;
  }
  if (json_files != 1)
    throw LogError(fmt::format("{}: found {} JSON files in the archive; expected one recording", name, json_files));
  // In pieces: the size that the archive states may be a false one, and too much for the memory.
  const std::unique_ptr<zip_file_t, ZipFree> file(zip_fopen_index(archive.get(), found.index, 0));
  std::string content;
  std::vector<char> piece(std::size_t{1} << 16);
  zip_int64_t count = file ? 1 : -1;
  while (count > 0 && content.size() <= largest_entry) {
    count = zip_fread(file.get(), piece.data(), piece.size());
    if (count > 0) content.append(piece.data(), static_cast<std::size_t>(count));
  }
  if (count < 0)
    throw LogError(fmt::format("{}: {} cannot be unpacked; expected a whole archive", name, excerpt(found.name)));
  if (count > 0)
    throw LogError(
        fmt::format("{}: found more than {} bytes in {}; expected fewer", name, largest_entry, excerpt(found.name)));
  return content;
}

// The member, or a null that has no members of its own.
const json& member(const json& object, const char* key) {
  static const json none;
  if (!object.is_object()) return none;
  const auto found = object.find(key);
  return found == object.end() ? none : *found;
}

std::string text(const json& value) { return value.is_string() ? value.get<std::string>() : std::string(); }

bool counts_cycles(std::string_view name) { return name == "CYCLE" || name == "HFProbeCounter"; }

}  // namespace

bool is_recorder_export(std::string_view bytes) {
  const auto first = bytes.find_first_not_of(" \t\r\n");
  return bytes.starts_with(zip_mark) || (first != std::string_view::npos && bytes[first] == '{');
}

Recording read_recorder_export(const std::string& bytes, const std::string& name) {
  const auto content = bytes.starts_with(zip_mark) ? unzipped(bytes, name) : bytes;
  json document;
  try {
    document = json::parse(content);
  } catch (const json::exception& error) {  // also a number beyond the range of double, which is no parse_error
    throw LogError(
        fmt::format("{}: found no valid JSON ({}); expected a recorder's export", name, excerpt(error.what(), 120)));
  }
  const auto refuse = [&](const std::string& what) { return LogError(name + ": " + what); };
  const auto& header = member(document, "Header");
  const auto& signals = member(header, "SignalListHFData");
  const auto& payload = member(document, "Payload");
  const auto& cycle = member(header, "CycleTimeMs");
  if (!signals.is_array() || !payload.is_array())
    throw refuse("found no Header.SignalListHFData or no Payload; expected a recorder's export with both");
  if (!cycle.is_number() || !(cycle.get<double>() > 0.0))
    throw refuse("found no Header.CycleTimeMs; expected the cycle of the recording in ms");
  Recording recording;
  recording.source = name;
  recording.kind = "a recorder's export";
  std::size_t counter = signals.size();
  for (const auto& signal : signals) {
    auto& channel = recording.channels.emplace_back();
    channel.name = text(member(signal, "Address"));
    if (channel.name.empty()) channel.name = text(member(signal, "Name"));
    if (counts_cycles(channel.name) || counts_cycles(text(member(signal, "Name"))))
      counter = recording.channels.size() - 1;
  }
  if (counter == signals.size())
    throw refuse("found no CYCLE (HFProbeCounter) among the signals; expected the counter of cycles as clock");
  const double period = cycle.get<double>() * 1e-3;
  double first = 0.0;
  std::size_t row_number = 0;
  for (const auto& part : payload) {
    const auto& rows = member(part, "HFData");
    if (rows.is_null()) continue;
    for (const auto& row : rows) {
      ++row_number;
      if (!row.is_array() || row.size() != signals.size())
        throw refuse(fmt::format("row {} of HFData: found {} values; expected {}, one a signal", row_number,
                                 row.is_array() ? row.size() : 0, signals.size()));
      if (!row[counter].is_number())
        throw refuse(fmt::format("row {} of HFData: found no number as CYCLE; expected the counter", row_number));
      const double count = row[counter].get<double>();
      if (row_number == 1) first = count;
      for (std::size_t k = 0; k < signals.size(); ++k) {
        auto& channel = recording.channels[k];
        if (k == counter || !channel.bad.empty() || row[k].is_null()) continue;
        if (!row[k].is_number()) {
          channel.bad = fmt::format("{}: row {} of HFData, {}: found {}", name, row_number, excerpt(channel.name),
                                    row[k].is_structured() ? row[k].type_name() : excerpt(row[k].dump()));
          continue;
        }
        channel.t.push_back((count - first) * period);
        channel.values.push_back(row[k].get<double>());
      }
    }
  }
  recording.channels.erase(recording.channels.begin() + static_cast<std::ptrdiff_t>(counter));
  return recording;
}

}  // namespace stiction::host
