// The motion file, "stiction.cam/1": any number of cams as TOML. docs/formats.md shows it to users.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/cam/motion.hpp"

namespace stiction::sim::cam {

inline constexpr std::string_view motion_schema = "stiction.cam/1";

// All cams of a file, checked. Throws machine::MachineFileError "FILE:LINE: KEY: found ...; expected ...".
std::vector<Cam> read_motion_file(const std::filesystem::path& file);

// The same of a text; `file` is the name shown in messages, `text` the content.
std::vector<Cam> parse_motion_file(const std::string& file, const std::string& text);

// The text of such a file: parse_motion_file() gives the same cams from it, to the last bit.
std::string motion_text(const std::vector<Cam>& cams);

}  // namespace stiction::sim::cam
