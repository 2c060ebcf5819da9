// All files of a step cam that the command writes into a folder but for the page: drawings, tables, the project and its
// motion as the programme writes them, and the figures.
#pragma once

#include <string>
#include <vector>

#include "host/cam/step/result.hpp"
#include "host/cam/step/shop_files.hpp"

namespace stiction::host::step {

struct ShopFile {
  std::string name, text;
};

// The files of `result`, tables in that `layout`, heads of `origin`; the names and checksums of drawings and tables are
// set in it.
std::vector<ShopFile> shop_folder(StepResult& result, const TableLayout& layout, const FileOrigin& origin);

// Coordinates and inspection table of `profile` in that `layout`, with heads of `origin`. `project`: the profile's.
std::vector<ShopFile> shop_tables(const StepProject& project, const StepProfile& profile, const TableLayout& layout,
                                  const FileOrigin& origin);

// The project and the motion file beside it, from which the folder is made again.
std::vector<ShopFile> source_files(const StepProject& project);

}  // namespace stiction::host::step
