// The files of a step cam for a shop: drawings (DXF), manufacturing coordinates and an inspection table (CSV). Each
// says its unit, zero, direction, what made it, and the CRC-32 of everything else in it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "host/cam/step/synthesis.hpp"

namespace stiction::host::step {

// What a head says of who made a file: "stiction 0.1.0", and the name of the project.
struct FileOrigin {
  std::string program, project;
};

enum class DxfVersion { r12, r2000 };

// A drawing of both cams, with pitch curves, rollers at rest and the zero pin on layers of their own, in mm: arcs in
// R12, splines in R2000 as `version` says, within the chord of `project`. `made`: of that project; `origin`: for the
// head.
std::string dxf_text(const StepProject& project, const StepSynthesis& made, DxfVersion version,
                     const FileOrigin& origin);

// The user's layout of a table.
struct TableLayout {
  // Of the file, in their order: angle, radius, x, y, normal, wheel_angle, wheel_radius, curvature, roller, cam_angle.
  std::vector<std::string> columns{"angle", "radius", "wheel_angle", "wheel_radius", "normal"};
  char separator = ',';
  char decimal = '.';
};
// All columns that there are, each with its unit and meaning.
struct TableColumn {
  std::string_view name, unit, text;
};
const std::vector<TableColumn>& table_columns();

// The manufacturing coordinates of `profile` for the wheel of `project` in that `layout`, with a head of `origin`;
// without a wheel its columns are empty. Throws sim::cam::CamError for an unknown column.
std::string coordinates_text(const StepProject& project, const StepProfile& profile, const TableLayout& layout,
                             const FileOrigin& origin);

// Radii to measure at whole multiples of `spacing`, rad, with the limits that the profile's tolerance leaves, and an
// empty column for what is found. `project`, `profile` and `layout` as above; `origin` of the head.
std::string inspection_text(const StepProject& project, const StepProfile& profile, double spacing,
                            const TableLayout& layout, const FileOrigin& origin);

// The CRC-32 (of zlib) of `text` without its line that holds "CRC-32".
std::uint32_t checksum_of(const std::string& text);

namespace detail {
// Lines of a head, without marks of comments; the last one is for the checksum.
std::vector<std::string> head_lines(const StepProject& project, std::string_view what, const FileOrigin& origin);
// `text` with its checksum in place of the mark that head_lines() leaves.
std::string with_checksum(std::string text);
}  // namespace detail

}  // namespace stiction::host::step
