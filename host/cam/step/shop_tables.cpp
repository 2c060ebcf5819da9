#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "host/cam/step/shop_files.hpp"

namespace stiction::host::step {
namespace {

// In place of the checksum until it is known; as long as it is.
constexpr std::string_view mark = "########";

// CRC-32 as zlib has it, least bit first; a page has no zlib.
constexpr std::array<std::uint32_t, 256> crc_table = [] {
  std::array<std::uint32_t, 256> words{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t word = byte;
    for (int bit = 0; bit < 8; ++bit) word = word >> 1 ^ ((word & 1u) != 0 ? 0xedb88320u : 0u);
    words[byte] = word;
  }
  return words;
}();

std::string number_text(double value, int decimals, char decimal) {
  auto text = fmt::format("{:.{}f}", value, decimals);
  if (decimal != '.') std::replace(text.begin(), text.end(), '.', decimal);
  return text;
}

std::string cell(const StepProject& project, const ProfilePoint& point, std::string_view column, char decimal) {
  const Point wheel = point.place() - point.normal * project.wheel_radius;
  const auto number = [&](double value, int decimals = 6) { return number_text(value, decimals, decimal); };
  if (column == "angle") return number(point.angle / degree);
  if (column == "radius") return number(1e3 * point.radius);
  if (column == "x") return number(1e3 * point.place().real());
  if (column == "y") return number(1e3 * point.place().imag());
  // Out of the cam, as a wheel or a probe comes.
  if (column == "normal") return number(wrapped(sim::angle_of(-point.normal) + 1e-12) / degree);
  if (column == "curvature") return number(1e-3 * point.curvature, 9);
  if (column == "roller") return fmt::format("{}", point.roller + 1);
  if (column == "cam_angle") return number(point.psi / degree);
  if (project.wheel_radius == 0.0) return "";
  return column == "wheel_angle" ? number(wrapped(sim::angle_of(wheel) + 1e-12) / degree)
                                 : number(1e3 * sim::magnitude(wheel));
}

std::string commented(const std::vector<std::string>& lines) {
  std::string text;
  for (const auto& line : lines) text += "# " + line + "\n";
  return text;
}

}  // namespace

std::vector<std::string> detail::head_lines(const StepProject& project, std::string_view what,
                                            const FileOrigin& origin) {
  return {
      fmt::format("{} of the step cam {}", what, origin.project),
      fmt::format("made by {}", origin.program),
      "units: mm and degrees",
      "zero: the line from the cam's axis to the carousel's at the start of the cycle",
      fmt::format("direction: angles grow counterclockwise, seen from the side of cam 1; the cam turns clockwise and "
                  "the carousel {}clockwise",
                  project.mechanism.against ? "counter" : ""),
      fmt::format("CRC-32 of the other lines: {}", mark)};
}

std::uint32_t checksum_of(const std::string& text) {
  std::string others;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
    const auto line = std::string_view(text).substr(begin, end - begin);
    if (line.find("CRC-32") == std::string_view::npos) others += line;
    begin = end;
  }
  std::uint32_t value = ~0u;
  for (const char c : others) value = value >> 8 ^ crc_table[(value ^ static_cast<unsigned char>(c)) & 0xffu];
  return ~value;
}

std::string detail::with_checksum(std::string text) {
  const auto at = text.find(mark);
  return text.replace(at, mark.size(), fmt::format("{:08x}", checksum_of(text)));
}

const std::vector<TableColumn>& table_columns() {
  static const std::vector<TableColumn> columns{
      {"angle", "deg", "manufacturing angle"},
      {"radius", "mm", "radius of the profile"},
      {"x", "mm", "place of the profile at the zero"},
      {"y", "mm", "place of the profile across it"},
      {"normal", "deg", "direction of the normal out of the cam"},
      {"wheel_angle", "deg", "angle of the wheel's centre"},
      {"wheel_radius", "mm", "distance of the wheel's centre from the cam's axis"},
      {"curvature", "1/mm", "curvature, above 0 where the profile is convex"},
      {"roller", "", "roller of the row that touches there"},
      {"cam_angle", "deg", "the cam's angle at which it does"},
  };
  return columns;
}

std::string coordinates_text(const StepProject& project, const StepProfile& profile, const TableLayout& layout,
                             const FileOrigin& origin) {
  auto head = detail::head_lines(project, fmt::format("manufacturing coordinates of cam {}", profile.row + 1), origin);
  if (project.wheel_radius > 0.0)
    head.insert(head.begin() + 2, fmt::format("grinding wheel: radius {:.6g} mm", 1e3 * project.wheel_radius));
  std::string text = commented(head);
  for (const auto& column : layout.columns) {
    const auto& all = table_columns();
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& each) { return each.name == column; });
    if (found == all.end()) {
      std::string names;
      for (const auto& each : all) names += fmt::format("{}{}", names.empty() ? "" : ", ", each.name);
      throw sim::cam::CamError(fmt::format("found the column \"{}\"; expected {}", column, names));
    }
    text += fmt::format("{}{}{}{}", &column == &layout.columns.front() ? "" : std::string(1, layout.separator), column,
                        found->unit.empty() ? "" : " ", found->unit);
  }
  text += '\n';
  for (const ProfilePoint& point : profile.points) {
    for (const auto& column : layout.columns) {
      if (&column != &layout.columns.front()) text += layout.separator;
      text += cell(project, point, column, layout.decimal);
    }
    text += '\n';
  }
  return detail::with_checksum(std::move(text));
}

std::string inspection_text(const StepProject& project, const StepProfile& profile, double spacing,
                            const TableLayout& layout, const FileOrigin& origin) {
  auto head = detail::head_lines(project, fmt::format("inspection of cam {}", profile.row + 1), origin);
  head.insert(head.begin() + 2,
              fmt::format("tolerance of the profile along its normal: +-{:.4g} um; measured with a point",
                          1e6 * project.tolerances.profile));
  std::string text = commented(head);
  const std::string separator(1, layout.separator);
  for (const auto* name : {"angle deg", "radius mm", "least mm", "most mm", "measured mm"})
    text += (std::string_view(name) == "angle deg" ? "" : separator) + name;
  text += '\n';
  const auto each = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(spacing / profile.step())));
  for (std::size_t j = 0; j < profile.points.size(); j += each) {
    const ProfilePoint& point = profile.points[j];
    // Beside a corner a radius says nothing of the profile.
    if (profile.has_corner(point.angle, 2.0 * profile.step())) continue;
    // A move along the normal, seen along the radius.
    const double radial =
        project.tolerances.profile / std::fabs(dot(point.normal, sim::in_direction(1.0, point.angle)));
    const double values[] = {point.angle / degree, 1e3 * point.radius, 1e3 * (point.radius - radial),
                             1e3 * (point.radius + radial)};
    for (const double value : values) text += number_text(value, 4, layout.decimal) + separator;
    text += '\n';
  }
  return detail::with_checksum(std::move(text));
}

}  // namespace stiction::host::step
