// A mapping file states what the channels of a foreign recording are. Its keys, with an example: docs/formats.md,
// "Recordings of drives and the mapping file".
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/log/recording.hpp"

namespace stiction::host {

struct MappedChannel {
  std::string from;
  std::string axis;
  const LogChannel* to = nullptr;
  std::string name;     // of it as the mapping writes it: "T" and "F" are one channel
  std::string unit;     // empty: that of the recording
  double factor = 1.0;  // from the recording's amperes and direction to those of the log
  enum class Fill { none, hold, linear } fill = Fill::none;
  enum class Scaling { unstated, done, apply } scaling = Scaling::unstated;  // of the head of a scope export
  std::string place;                                                         // "mapping.toml:3", for messages
};

struct Mapping {
  std::string source;  // the file
  std::vector<MappedChannel> channels;
  TableForm table;
  bool has_table_keys = false;  // [table] or [time]
};

// Throws LogError (the file cannot be read) or sim::MachineFileError (what stands in it, with file and line).
Mapping read_mapping(const std::filesystem::path& file);

// The mapping of a recording whose channels have the names of a log's already ("X.x[mm]", or "x" with a unit of its
// own). None: no measured position is among them. `recording`: with its channels.
std::optional<Mapping> mapping_by_names(const Recording& recording);

// The recording as a log: SI units, amplitude amperes, all on the time of the first axis' measured position. A channel
// that begins later or ends earlier is NaN (a blank) where it has no sample. Channels that are not mapped are listed in
// `ignored`. Throws LogError, among others for a channel that is not there, one with values that are no numbers, one
// with another sampling and no `fill`, linear and rotary channels of one axis.
Log apply_mapping(const Mapping& mapping, const Recording& recording);

// What a user must write to map `recording`: for the message when he gave no mapping.
std::string mapping_hint(const Recording& recording);

}  // namespace stiction::host
