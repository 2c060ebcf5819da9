#include "host/cam/step/project_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>

#include "sim/cam/quantity_text.hpp"

namespace stiction::host::step {
namespace {

using Number = std::optional<double>;

// A value that is always there, and one that 0 leaves out of the file.
#define STICTION_ALWAYS(member)                          \
  [](const StepProject& p) { return Number(p.member); }, \
      [](StepProject& p, Number value) { p.member = value.value_or(StepProject().member); }
#define STICTION_UNLESS_ZERO(member)                                                      \
  [](const StepProject& p) { return p.member != 0.0 ? Number(p.member) : std::nullopt; }, \
      [](StepProject& p, Number value) { p.member = value.value_or(0.0); }
#define STICTION_WHOLE(member)                                                \
  [](const StepProject& p) { return Number(static_cast<double>(p.member)); }, \
      [](StepProject& p, Number value) { p.member = whole_number(value.value_or(StepProject().member)); }
// Of a part that a project may lack.
#define STICTION_OF(part, Type, member)                                                \
  [](const StepProject& p) { return p.part ? Number(p.part->member) : std::nullopt; }, \
      [](StepProject& p, Number value) {                                               \
        if (!p.part && !value) return;                                                 \
        if (!p.part) p.part = Type{};                                                  \
        p.part->member = value.value_or(0.0);                                          \
      }

// Nothing that a reader takes for what is no whole number.
int whole_number(double value) {
  return value >= 0.0 && value <= 1e6 && value == static_cast<int>(value) ? static_cast<int>(value) : -1;
}

void write_number(std::string& text, const ProjectNumber& number, double value) {
  const auto shown = [&] {
    if (number.unit != "1") return sim::cam::quantity_text(value, number.unit, number.shown);
    return value == std::floor(value) ? fmt::format("{:.0f}", value) : sim::cam::number_text(value);
  };
  text += fmt::format("{} = {}\n", number.key, shown());
}

// What the table `group` of `project` holds.
std::string table_text(const StepProject& project, std::string_view group) {
  std::string text;
  for (const auto& number : project_numbers())
    if (const auto value = number.get(project); number.group == group && value) write_number(text, number, *value);
  for (const auto& choice : project_choices()) {
    if (choice.group != group) continue;
    const auto value = choice.get(project);
    text += fmt::format("{} = {}\n", choice.key,
                        value == "true" || value == "false" ? value : fmt::format("\"{}\"", value));
  }
  return text;
}

std::string vertex_text(const ReliefOverride& change) {
  std::string text = fmt::format("\n[[relief.vertex]]\ncam = {}\nat = {}\n", change.cam + 1,
                                 sim::cam::quantity_text(change.angle, "rad", "deg"));
  if (change.depth) text += fmt::format("depth = {}\n", sim::cam::quantity_text(*change.depth, "m", "mm"));
  if (change.blend) text += fmt::format("blend = {}\n", sim::cam::quantity_text(*change.blend, "rad", "deg"));
  if (change.begin) text += fmt::format("begin = {}\n", sim::cam::quantity_text(*change.begin, "rad", "deg"));
  if (change.end) text += fmt::format("end = {}\n", sim::cam::quantity_text(*change.end, "rad", "deg"));
  return text;
}

std::string measured_text(const MeasuredLift& table) {
  std::string text = "\n[table]\n";
  if (!table.splits.empty()) {
    std::vector<std::string> splits;
    for (const double split : table.splits) splits.push_back(sim::cam::quantity_text(split, "rad", "deg"));
    text += fmt::format("splits = [{}]\n", fmt::join(splits, ", "));
  }
  text += "rows = [\n";
  for (std::size_t k = 0; k < table.psi.size(); ++k) {
    text += fmt::format("  [{}, {}", sim::cam::number_text(table.psi[k]), sim::cam::number_text(table.way[k]));
    if (!table.speed.empty()) text += ", " + sim::cam::number_text(table.speed[k]);
    if (!table.acceleration.empty()) text += ", " + sim::cam::number_text(table.acceleration[k]);
    text += "],\n";
  }
  return text + "]\n";
}

// A text as TOML has it.
std::string toml_text(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

std::string full_name(std::string_view group, std::string_view key) {
  return group.empty() ? std::string(key) : fmt::format("{}.{}", group, key);
}

}  // namespace

std::string ProjectNumber::name() const { return full_name(group, key); }
std::string ProjectChoice::name() const { return full_name(group, key); }

const std::vector<ProjectNumber>& project_numbers() {
  static const std::vector<ProjectNumber> numbers{
      {"", "wheel_radius", "m", "mm", "radius of the grinding wheel", STICTION_UNLESS_ZERO(wheel_radius)},
      {"", "steps", "1", "", "steps of a turn", STICTION_WHOLE(steps)},
      {"", "chord", "m", "um", "largest distance of files from the profile", STICTION_ALWAYS(chord)},
      {"mechanism", "axis_distance", "m", "mm", "distance of the axes", STICTION_ALWAYS(mechanism.axis_distance)},
      {"mechanism", "arm", "m", "mm", "arm of the rollers", STICTION_ALWAYS(mechanism.arm)},
      {"mechanism", "roller_radius", "m", "mm", "radius of a roller", STICTION_ALWAYS(mechanism.roller_radius)},
      {"mechanism", "roller_width", "m", "mm", "width of a roller", STICTION_ALWAYS(mechanism.roller_width)},
      {"mechanism", "rollers", "1", "", "rollers of a row", STICTION_WHOLE(mechanism.rollers)},
      {"mechanism", "row_angle", "rad", "deg", "angle between the rows", STICTION_ALWAYS(mechanism.row_angle)},
      {"mechanism", "dwell_position", "rad", "deg", "roller at rest", STICTION_ALWAYS(mechanism.dwell_position)},
      {"mechanism", "hub_radius", "m", "mm", "radius of the hub", STICTION_UNLESS_ZERO(mechanism.hub_radius)},
      {"cam_material", "modulus", "Pa", "GPa", "modulus of the cams", STICTION_ALWAYS(load.cam.modulus)},
      {"cam_material", "poisson", "1", "", "Poisson’s ratio of the cams", STICTION_ALWAYS(load.cam.poisson)},
      {"roller_material", "modulus", "Pa", "GPa", "modulus of the rollers", STICTION_ALWAYS(load.roller.modulus)},
      {"roller_material", "poisson", "1", "", "Poisson’s ratio of the rollers", STICTION_ALWAYS(load.roller.poisson)},
      {"load", "inertia", "kg m^2", "", "inertia of carousel and load", STICTION_ALWAYS(load.inertia)},
      {"load", "torque", "N m", "", "torque against the motion", STICTION_UNLESS_ZERO(load.torque)},
      {"load", "speed", "rad/s", "rpm", "speed of the cam", STICTION_ALWAYS(load.speed)},
      {"load", "preload", "m", "um", "preload: axes nearer by", STICTION_UNLESS_ZERO(load.preload)},
      {"load", "stiffness", "N/m", "N/um", "stiffness of a contact", STICTION_UNLESS_ZERO(load.stiffness)},
      {"load", "largest_pressure", "Pa", "MPa", "largest Hertz pressure",
       [](const StepProject& p) { return p.load.largest_pressure; },
       [](StepProject& p, Number value) { p.load.largest_pressure = value; }},
      {"relief", "lead_in", "rad", "deg", "lead-in on both sides of a corner", STICTION_UNLESS_ZERO(relief.lead_in)},
      {"relief.valley", "depth", "m", "mm", "depth in valleys", STICTION_ALWAYS(relief.valley.depth)},
      {"relief.valley", "blend", "rad", "deg", "blend in valleys", STICTION_ALWAYS(relief.valley.blend)},
      {"relief.peak", "depth", "m", "mm", "depth in peaks", STICTION_ALWAYS(relief.peak.depth)},
      {"relief.peak", "blend", "rad", "deg", "blend in peaks", STICTION_ALWAYS(relief.peak.blend)},
      {"tolerance", "axis_distance", "m", "um", "tolerance of the axes’ distance, ±",
       STICTION_ALWAYS(tolerances.axis_distance)},
      {"tolerance", "roller", "m", "um", "tolerance of a roller’s radius, ±", STICTION_ALWAYS(tolerances.roller)},
      {"tolerance", "arm", "m", "um", "tolerance of the arm, ±", STICTION_ALWAYS(tolerances.arm)},
      {"tolerance", "profile", "m", "um", "tolerance of the profile, ±", STICTION_ALWAYS(tolerances.profile)},
      {"tolerance", "preload", "m", "um", "tolerance of the preload, ±", STICTION_ALWAYS(tolerances.preload)},
      {"electronic", "rotor", "kg m^2", "", "rotor of an electronic cam’s motor",
       STICTION_OF(electronic, ElectronicCam, rotor)},
      {"electronic", "largest_torque", "N m", "", "largest torque of that motor",
       STICTION_OF(electronic, ElectronicCam, largest_torque)},
      {"spring", "rate", "N m/rad", "", "rate of the spring", STICTION_OF(spring, ReturnSpring, rate)},
      {"spring", "preload", "N m", "", "preload of the spring", STICTION_OF(spring, ReturnSpring, preload)},
  };
  return numbers;
}

const std::vector<ProjectChoice>& project_choices() {
  static const std::vector<ProjectChoice> choices{
      {"mechanism",
       "carousel_turns",
       "carousel turns",
       {"against the cam", "with the cam"},
       [](const StepProject& p) { return std::string(p.mechanism.against ? "against the cam" : "with the cam"); },
       [](StepProject& p, std::string_view value) { p.mechanism.against = value == "against the cam"; }},
      {"relief",
       "law",
       "law of the blends",
       {},
       [](const StepProject& p) { return p.relief.law; },
       [](StepProject& p, std::string_view value) { p.relief.law = value; }},
      {"relief.valley",
       "middle_arc",
       "circle in the middle of valleys",
       {"false", "true"},
       [](const StepProject& p) { return std::string(p.relief.valley.middle_arc ? "true" : "false"); },
       [](StepProject& p, std::string_view value) { p.relief.valley.middle_arc = value == "true"; }},
      {"relief.peak",
       "middle_arc",
       "circle in the middle of peaks",
       {"false", "true"},
       [](const StepProject& p) { return std::string(p.relief.peak.middle_arc ? "true" : "false"); },
       [](StepProject& p, std::string_view value) { p.relief.peak.middle_arc = value == "true"; }},
  };
  return choices;
}

std::string project_text(const StepProject& project) {
  std::string text = fmt::format("schema = \"{}\"\n", project_schema);
  if (!project.measured) {
    text += fmt::format("motion = {}\n", toml_text(project.motion_name()));
    if (!project.cam_name.empty()) text += fmt::format("cam = {}\n", toml_text(project.cam_name));
  }
  text += table_text(project, "");
  constexpr std::array groups{"mechanism",     "cam_material", "roller_material", "load",       "relief",
                              "relief.valley", "relief.peak",  "tolerance",       "electronic", "spring"};
  for (const std::string_view group : groups) {
    if (project.spring && group.starts_with("relief")) continue;
    const auto table = table_text(project, group);
    if (!table.empty()) text += fmt::format("\n[{}]\n{}", group, table);
    if (group == "relief.peak")
      for (const auto& change : project.relief.overrides) text += vertex_text(change);
  }
  if (project.measured) text += measured_text(*project.measured);
  return text;
}

}  // namespace stiction::host::step
