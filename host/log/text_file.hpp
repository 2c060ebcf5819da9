// Whole files as bytes.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace stiction::host {

// Throws LogError, "FILE: found ...; expected ...", when it is not there or cannot be read; `expected`: what the file
// should be, for the message.
std::string read_text_file(const std::filesystem::path& file, std::string_view expected = "a log");

// Throws std::runtime_error when the disk did not take all of it.
void write_text_file(const std::filesystem::path& file, std::string_view content);

}  // namespace stiction::host
