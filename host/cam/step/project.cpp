#include "host/cam/step/project.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "firmware/machine/file/machine_file.hpp"
#include "firmware/machine/file/quantity_table.hpp"
#include "sim/cam/motion_file.hpp"

namespace stiction::host::step {
namespace {

using machine::QuantityTable;

double required(const QuantityTable& table, std::string_view key, std::string_view unit, std::string_view text) {
  const double value = *table.quantity(key, unit, text, true);
  if (!(value > 0.0)) table.fail(key, fmt::format("{}", value), fmt::format("more than 0 ({})", text));
  return value;
}
double not_negative(const QuantityTable& table, std::string_view key, std::string_view unit, std::string_view text,
                    double fallback = 0.0) {
  const double value = table.quantity(key, unit, text).value_or(fallback);
  if (!(value >= 0.0)) table.fail(key, fmt::format("{}", value), fmt::format("0 or more ({})", text));
  return value;
}
int whole(const QuantityTable& table, std::string_view key, int least, int most, std::optional<int> fallback,
          std::string_view text) {
  const auto value = table.quantity(key, "1", text, !fallback);
  if (!value) return *fallback;
  if (*value != std::floor(*value) || *value < least || *value > most)
    table.fail(key, fmt::format("{}", *value), fmt::format("a whole number from {} to {} ({})", least, most, text));
  return static_cast<int>(*value);
}

StepMechanism read_mechanism(const QuantityTable& table) {
  table.allow({"axis_distance", "arm", "roller_radius", "roller_width", "rollers", "row_angle", "dwell_position",
               "carousel_turns", "hub_radius"});
  StepMechanism m;
  m.axis_distance = required(table, "axis_distance", "m", "between cam shaft and carousel");
  m.arm = required(table, "arm", "m", "from the carousel's axis to the roller's");
  m.roller_radius = required(table, "roller_radius", "m", "radius of a roller");
  m.roller_width = required(table, "roller_width", "m", "width of a roller");
  m.rollers = whole(table, "rollers", 1, 64, std::nullopt, "rollers of a row");
  m.row_angle = table.quantity("row_angle", "rad", "between the rows").value_or(0.5 * m.pitch());
  m.dwell_position = table.quantity("dwell_position", "rad", "of a roller at rest").value_or(0.25 * m.pitch());
  m.hub_radius = not_negative(table, "hub_radius", "m", "radius of the cam shaft's hub");
  m.against = table.choice("carousel_turns", {"against the cam", "with the cam"}, "against the cam",
                           "sense of rotation") == "against the cam";
  return m;
}

Material read_material(const QuantityTable& root, std::string_view name) {
  const auto table = root.subtable(name, "a material");
  if (!table) root.fail(name, "no such key", fmt::format("a table [{}] with modulus and poisson", name));
  table->allow({"modulus", "poisson"});
  Material material;
  material.modulus = required(*table, "modulus", "Pa", "modulus of elasticity");
  material.poisson = *table->quantity("poisson", "1", "Poisson's ratio", true);
  if (!(material.poisson > 0.0 && material.poisson < 0.5))
    table->fail("poisson", fmt::format("{}", material.poisson), "more than 0, less than 0.5");
  return material;
}

StepLoad read_load(const QuantityTable& root) {
  StepLoad load;
  const auto table = root.subtable("load", "what the carousel carries");
  if (!table) root.fail("load", "no such key", "a table [load] with inertia and speed");
  table->allow({"inertia", "torque", "speed", "preload", "stiffness", "largest_pressure"});
  load.inertia = required(*table, "inertia", "kg m^2", "of the carousel and its load");
  load.torque = not_negative(*table, "torque", "N m", "of the load, against the motion");
  load.speed = required(*table, "speed", "rad/s", "of the cam");
  load.preload = not_negative(*table, "preload", "m", "by which the axes are nearer");
  load.stiffness = not_negative(*table, "stiffness", "N/m", "of a roller on its cam");
  if (load.preload > 0.0 && load.stiffness == 0.0)
    table->fail("preload", "a preload of rigid rollers", "stiffness, so that it becomes a force");
  if (table->has("largest_pressure"))
    load.largest_pressure = required(*table, "largest_pressure", "Pa", "Hertz pressure");
  load.cam = read_material(root, "cam_material");
  load.roller = read_material(root, "roller_material");
  return load;
}

ReliefShape read_shape(const QuantityTable& relief, std::string_view name, const ReliefShape& usual) {
  const auto table = relief.subtable(name, "relief of such arcs");
  if (!table) return usual;
  table->allow({"depth", "blend", "middle_arc"});
  return {not_negative(*table, "depth", "m", "depth of the relief", usual.depth),
          not_negative(*table, "blend", "rad", "angle of a blend", usual.blend),
          table->boolean("middle_arc", usual.middle_arc, "a circle between the blends")};
}

ReliefSettings read_relief(const QuantityTable& root) {
  ReliefSettings relief;
  const auto table = root.subtable("relief", "relief");
  if (!table) return relief;
  table->allow({"depth", "blend", "law", "lead_in", "middle_arc", "valley", "peak", "vertex"});
  const ReliefShape usual{not_negative(*table, "depth", "m", "depth of the relief"),
                          not_negative(*table, "blend", "rad", "angle of a blend"),
                          table->boolean("middle_arc", false, "a circle between the blends")};
  relief.valley = read_shape(*table, "valley", usual);
  relief.peak = read_shape(*table, "peak", usual);
  relief.law = table->text("law", "law of the blends").value_or(relief.law);
  relief.lead_in = not_negative(*table, "lead_in", "rad", "of a corner's sides");
  for (const QuantityTable& each : table->subtables("vertex", "one arc of its own")) {
    each.allow({"cam", "at", "depth", "blend", "begin", "end"});
    ReliefOverride change;
    change.cam = whole(each, "cam", 1, 2, std::nullopt, "1 or 2") - 1;
    change.angle = *each.quantity("at", "rad", "an angle in the arc", true);
    if (each.has("depth")) change.depth = not_negative(each, "depth", "m", "depth of the relief");
    if (each.has("blend")) change.blend = not_negative(each, "blend", "rad", "angle of a blend");
    change.begin = each.quantity("begin", "rad", "begin of the arc");
    change.end = each.quantity("end", "rad", "end of the arc");
    relief.overrides.push_back(change);
  }
  return relief;
}

StepTolerances read_tolerances(const QuantityTable& root) {
  StepTolerances t;
  const auto table = root.subtable("tolerance", "half widths of tolerances");
  if (!table) return t;
  table->allow({"axis_distance", "roller", "arm", "profile", "preload"});
  t.axis_distance = not_negative(*table, "axis_distance", "m", "of the axis distance", t.axis_distance);
  t.roller = not_negative(*table, "roller", "m", "of a roller's radius", t.roller);
  t.arm = not_negative(*table, "arm", "m", "of the arm", t.arm);
  t.profile = not_negative(*table, "profile", "m", "of the profile along its normal", t.profile);
  t.preload = not_negative(*table, "preload", "m", "of the preload", t.preload);
  return t;
}

MeasuredLift read_table(const QuantityTable& table) {
  table.allow({"rows", "master_unit", "slave_unit", "splits"});
  const auto scale = [&](std::string_view key) {
    const auto unit = table.text(key, "unit of a column");
    if (!unit) return 1.0;
    try {
      return machine::parse_quantity("1 " + *unit, "rad");
    } catch (const machine::UnitError& error) {
      table.fail(key, fmt::format("\"{}\" ({})", *unit, error.what()), "a unit of rad");
    }
  };
  const double x = scale("master_unit"), y = scale("slave_unit");
  MeasuredLift lift;
  for (const auto& row : table.rows("rows", 2, 4)) {
    lift.psi.push_back(row[0] * x);
    lift.way.push_back(row[1] * y);
    if (row.size() > 2) lift.speed.push_back(row[2] * y / x);
    if (row.size() > 3) lift.acceleration.push_back(row[3] * y / (x * x));
  }
  lift.splits = table.quantities("splits", "rad", "cam angles where the acceleration jumps");
  return lift;
}

void read_lift(const QuantityTable& root, const detail::MotionSource& motion, StepProject& project) {
  if (root.has("motion") == root.has("table"))
    root.fail("motion", root.has("motion") ? "a motion file and a table" : "neither a motion file nor a table",
              "one of them");
  if (const auto table = root.subtable("table", "a measured lift")) {
    project.measured = read_table(*table);
    return;
  }
  const std::string file = *root.text("motion", "motion file");
  const auto cams = motion(file);
  const auto name = root.text("cam", "cam of the motion file");
  project.motion_file = file;
  project.cam_name = name.value_or("");
  std::vector<std::string_view> names;
  for (const auto& cam : cams) names.push_back(cam.name);
  if (!name && cams.size() > 1)
    root.fail("cam", "no such key", fmt::format("one of the cams of {}: {}", file, machine::quoted_list(names)));
  for (const auto& cam : cams)
    if (!name || cam.name == *name) project.cam = cam;
  if (!project.cam)
    root.fail("cam", fmt::format("\"{}\"", *name), machine::quoted_list(names) + machine::did_you_mean(*name, names));
}

}  // namespace

std::string StepProject::motion_name() const {
  return motion_file.substr(motion_file.find_last_of('/') + 1);  // npos + 1 is 0
}

StepProject detail::parsed(const std::string& file, const std::string& text, const MotionSource& motion) {
  const machine::Document document(file, text);
  const QuantityTable root(document, document.root(), "");
  root.allow({"schema", "motion", "cam", "table", "mechanism", "cam_material", "roller_material", "load", "relief",
              "wheel_radius", "tolerance", "electronic", "spring", "steps", "chord"});
  const auto schema = root.text("schema", "version of the format");
  if (schema != project_schema)
    root.fail("schema", schema ? fmt::format("\"{}\"", *schema) : "no such key", fmt::format("\"{}\"", project_schema));
  StepProject project;
  project.name = std::filesystem::path(file).stem().string();
  const auto mechanism = root.subtable("mechanism", "dimensions");
  if (!mechanism) root.fail("mechanism", "no such key", "a table [mechanism]");
  project.mechanism = read_mechanism(*mechanism);
  read_lift(root, motion, project);
  project.load = read_load(root);
  project.relief = read_relief(root);
  project.tolerances = read_tolerances(root);
  project.wheel_radius = not_negative(root, "wheel_radius", "m", "of the grinding wheel");
  if (const auto table = root.subtable("electronic", "the motor of an electronic cam")) {
    table->allow({"rotor", "largest_torque"});
    project.electronic = ElectronicCam{not_negative(*table, "rotor", "kg m^2", "of the motor at the axis"),
                                       not_negative(*table, "largest_torque", "N m", "of the motor at the axis")};
  }
  if (const auto table = root.subtable("spring", "the spring of a single cam")) {
    table->allow({"rate", "preload"});
    if (root.has("relief")) root.fail("relief", "relief of a single cam", "none: pairs of cams have it");
    if (project.load.stiffness > 0.0)
      root.fail("spring", "a spring and a stiffness in [load]", "one of them: a stiffness is of a pair of cams");
    project.spring = ReturnSpring{not_negative(*table, "rate", "N m/rad", "about the arm's axis"),
                                  not_negative(*table, "preload", "N m", "where the lift is 0")};
  }
  project.steps = whole(root, "steps", 720, 36000, 3600, "of a turn");
  project.chord = root.has("chord") ? required(root, "chord", "m", "largest distance of files from the profile") : 1e-6;
  if (project.chord < 1e-7 || project.chord > 1e-4)
    root.fail("chord", fmt::format("{} m", project.chord), "0.1 um to 0.1 mm");
  return project;
}

StepProject parse_step_project(const std::string& file, const std::string& text, const std::string& motion) {
  return detail::parsed(file, text, [&](const std::string& name) { return sim::cam::parse_motion_file(name, motion); });
}

}  // namespace stiction::host::step
