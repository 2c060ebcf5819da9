// A mapping file states what the channels of a foreign recording are. Its keys, with an example: docs/formats.md,
// "Recordings of drives and the mapping file".
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "host/log/recording.hpp"

namespace stiction::host {

struct MappedChannel {
  std::string from;
  std::string axis;
  const LogChannel* to = nullptr;
  std::string unit;     // empty: that of the recording
  double factor = 1.0;  // from the recording's amperes and direction to those of the log
  enum class Fill { none, hold, linear } fill = Fill::none;
  std::string place;  // "mapping.toml:3", for messages
};

struct Mapping {
  std::string source;  // the file
  std::vector<MappedChannel> channels;
  TableForm table;
  bool has_table_keys = false;  // [table] or [time]
};

// Throws LogError (the file cannot be read) or sim::MachineFileError (what stands in it, with file and line).
Mapping read_mapping(const std::filesystem::path& file);

// The recording as a log: SI units, amplitude amperes, all on the time of the first axis' measured position. Channels
// that are not mapped are listed in `ignored`. Throws LogError, among others for a channel that is not there, one with
// values that are no numbers, one with another sampling and no `fill`.
Log apply_mapping(const Mapping& mapping, const Recording& recording);

// What a user must write to map `recording`: for the message when he gave no mapping.
std::string mapping_hint(const Recording& recording);

}  // namespace stiction::host
