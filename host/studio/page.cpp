#include "host/studio/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>

#include "host/report/assets.hpp"
#include "host/report/base64.hpp"
#include "host/report/origin.hpp"
#include "host/report/page.hpp"
#include "host/studio/studio.hpp"

#define STICTION_STUDIO_ASSET(name)                                                                                   \
  extern "C" const char stiction_studio_##name[];                                                                     \
  extern "C" const char stiction_studio_##name##_end[];                                                               \
  static std::string_view name() {                                                                                    \
    return {stiction_studio_##name, static_cast<std::size_t>(stiction_studio_##name##_end - stiction_studio_##name)}; \
  }

STICTION_STUDIO_ASSET(html)
STICTION_STUDIO_ASSET(css)
STICTION_STUDIO_ASSET(engine_js)
STICTION_STUDIO_ASSET(charts_js)
STICTION_STUDIO_ASSET(studio_js)
STICTION_STUDIO_ASSET(step_js)
STICTION_STUDIO_ASSET(report_js)
STICTION_STUDIO_ASSET(wasm)

namespace stiction::host {
namespace {

using json = nlohmann::ordered_json;

json file_json(const std::optional<StudioFile>& file) {
  if (!file) return nullptr;
  return {{"name", file->name}, {"text", file->text}};
}

// What a browser without WebAssembly shows: the figures and the curve of the position, as they are now.
std::string still_html(const Studio& studio, double speed) {
  const auto state = json::parse(studio.state_json(speed));
  const auto curves = studio.curves(speed, 240);
  double low = 0.0, high = 0.0;
  for (std::size_t i = 1; i < curves.values.size(); i += curves.columns)
    low = std::min(low, curves.values[i]), high = std::max(high, curves.values[i]);
  const double range = high > low ? high - low : 1.0, cycle = studio.cam().cycle();
  std::string path;
  for (std::size_t i = 0; i < curves.values.size(); i += curves.columns)
    path += fmt::format("{}{:.2f} {:.2f}", path.empty() ? "M" : "L", 600.0 * curves.values[i] / cycle,
                        150.0 - 140.0 * (curves.values[i + 1] - low) / range);
  std::string rows;
  const auto number = [](const json& value) {
    return value.is_number() ? fmt::format("{:.5g}", value.get<double>()) : "–";
  };
  const auto unit = [](std::string text) {
    for (const auto& [plain, raised] : {std::pair{"^2", "²"}, std::pair{"^3", "³"}})
      if (const auto place = text.find(plain); place != std::string::npos) text.replace(place, 2, raised);
    return escape_html(text);
  };
  for (const auto& limit : state["limits"])
    rows += fmt::format("<tr><th>{}</th><td>{}</td><td>{}</td><td class=\"text\">{}</td></tr>",
                        escape_html(limit["name"].get<std::string>()), number(limit["found"]), number(limit["allowed"]),
                        unit(limit["unit"].get<std::string>()));
  // In the units of the page: degrees, or millimetres.
  constexpr double degree = 180.0 / std::numbers::pi;
  const auto length = [&](const char* side, double value) {
    return state[side] == "rotary" ? fmt::format("{:.5g}°", degree * value) : fmt::format("{:.5g} mm", 1e3 * value);
  };
  return fmt::format(
      "<svg viewBox=\"-8 -26 616 208\" role=\"img\" aria-label=\"Position of {0} over a cycle of {1}, from {2} to "
      "{3}\">"
      "<path class=\"grid\" d=\"M0 10H600M0 150H600\"/><text class=\"axis\" y=\"-10\">position, up to {3}</text>"
      "<text class=\"tick\" y=\"166\">lowest {2}</text><text class=\"tick end\" x=\"600\" y=\"166\">master, to "
      "{1}</text>"
      "<path class=\"curve\" d=\"{4}\"/></svg><table><thead><tr><th>Limit</th><th>Found</th><th>Allowed</th>"
      "<th>Unit</th></tr></thead><tbody>{5}</tbody></table>",
      escape_html(studio.cam().name), length("master", cycle), length("slave", low), length("slave", high), path, rows);
}

}  // namespace

std::string studio_page(const StudioPageContent& content) {
  // Whatever the page could not read is refused here.
  Studio studio;
  if (content.motion) studio.load_motion(content.motion->name, content.motion->text);
  if (content.machine) studio.load_machine(content.machine->name, content.machine->text);
  if (content.step) studio.load_step(content.step->name, content.step->text);
  const json data{{"version", content.version},
                  {"command", content.command},
                  {"date", present_date()},
                  {"motion", file_json(content.motion)},
                  {"machine", file_json(content.machine)},
                  {"step", file_json(content.step)},
                  {"speed", content.master_speed},
                  {"speed_text", content.speed_text}};
  const auto programme = wasm();
  const std::string scripts =
      fmt::format("{}\n{}\n{}\n{}\n{}", engine_js(), charts_js(), studio_js(), report_js(), step_js());
  return fill_template(
      html(), {{"version", escape_html(content.version)},
               {"title", escape_html("Cam studio: " + studio.cam().name)},
               {"scheme", std::string(assets::scheme_js())},
               {"style", std::string(assets::colours_css()) + std::string(css())},
               {"still", still_html(studio, content.master_speed > 0.0 ? content.master_speed : 1.0)},
               {"data", json_for_script(data)},
               {"programme", base64({reinterpret_cast<const std::uint8_t*>(programme.data()), programme.size()})},
               {"scripts", scripts}});
}

}  // namespace stiction::host
