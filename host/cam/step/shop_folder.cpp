#include "host/cam/step/shop_folder.hpp"

#include <fmt/format.h>

#include "host/cam/step/project_text.hpp"
#include "sim/cam/motion_file.hpp"

namespace stiction::host::step {
namespace {

// Between radii that are measured, rad.
constexpr double inspection_spacing = 5.0 * degree;

}  // namespace

std::vector<ShopFile> shop_tables(const StepProject& project, const StepProfile& profile, const TableLayout& layout,
                                  const FileOrigin& origin) {
  const auto cam = profile.row + 1;
  return {
      {fmt::format("cam_{}.csv", cam), coordinates_text(project, profile, layout, origin)},
      {fmt::format("inspection_{}.csv", cam), inspection_text(project, profile, inspection_spacing, layout, origin)}};
}

std::vector<ShopFile> source_files(const StepProject& project) {
  std::string name = project.name + ".toml";
  if (name == project.motion_name()) name = project.name + "_project.toml";
  std::vector<ShopFile> files{{std::move(name), project_text(project)}};
  if (project.cam) files.push_back({project.motion_name(), sim::cam::motion_text({*project.cam})});
  return files;
}

std::vector<ShopFile> shop_folder(StepResult& result, const TableLayout& layout, const FileOrigin& origin) {
  const auto& [project, made] = std::pair<const StepProject&, const StepSynthesis&>(result.project, result.made);
  std::vector<ShopFile> files{{"cams_r12.dxf", dxf_text(project, made, DxfVersion::r12, origin)},
                              {"cams_r2000.dxf", dxf_text(project, made, DxfVersion::r2000, origin)}};
  for (const auto& profile : made.profiles)
    for (auto& table : shop_tables(project, profile, layout, origin)) files.push_back(std::move(table));
  result.files.clear();
  for (const auto& [name, text] : files) result.files.emplace_back(name, fmt::format("{:08x}", checksum_of(text)));
  for (auto& source : source_files(project)) files.push_back(std::move(source));
  files.push_back({"result.json", step_json_text(result)});
  return files;
}

}  // namespace stiction::host::step
