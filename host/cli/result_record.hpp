// Which files of a folder are results, and of which command: a hidden file of the folder, a line a file.
#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace stiction::host {

inline constexpr const char* result_record_file = ".stiction-results";

// File name: the command that made it, "simulate circle"; empty for a result of a version that kept no record, which is
// known by its names.
using ResultRecord = std::map<std::string, std::string>;

// What is recorded of `folder`; without a record the usual names of results if one of them is there that marks a
// result.
ResultRecord read_result_record(const std::filesystem::path& folder);

// The content of the record's file.
std::string result_record_text(const ResultRecord& record);

}  // namespace stiction::host
