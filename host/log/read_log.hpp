// A log from a file of any of the program's formats.
#pragma once

#include <filesystem>
#include <string>

#include "host/log/log.hpp"
#include "host/log/text_source.hpp"

namespace stiction::host {

struct ReadSettings {
  std::string
      columns;  // names of the columns of a table or matrix without header: "t[ms],x[mm],i[mA]"; empty: it has one
  BytesRead progress;  // may be empty
};

// The format is told by the content, not by the file's name. A recording of a drive (recording.hpp) is taken where its
// channels have the names of a log's; else the error says how a mapping would name them. `file`: plain or compressed by
// gzip; `settings`: what the file does not say. Throws LogError.
Log read_log(const std::filesystem::path& file, const ReadSettings& settings = {});

}  // namespace stiction::host
