#include "sim/cam/motion_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "firmware/machine/file/description.hpp"
#include "firmware/machine/file/document.hpp"
#include "firmware/machine/file/nearest_name.hpp"
#include "firmware/machine/file/quantity_table.hpp"
#include "firmware/machine/file/units.hpp"
#include "sim/cam/laws.hpp"
#include "sim/cam/motion_keys.hpp"

namespace stiction::sim::cam {
namespace {

using machine::describe_node;
using machine::Document;
using MotionTable = machine::QuantityTable;

Boundary read_boundary(const MotionTable& table, const Cam& cam, const std::string& prefix) {
  const auto unit = [&](int order) { return derivative_unit(cam.slave, cam.master, order); };
  return {table.quantity(prefix + "_speed", unit(1), "forced speed of the slave over the master"),
          table.quantity(prefix + "_acceleration", unit(2), "forced acceleration of the slave over the master"),
          table.quantity(prefix + "_jerk", unit(3), "forced jerk of the slave over the master")};
}

LawValues read_values(const MotionTable& table, const Law& law) {
  LawValues values;
  std::vector<std::string_view> known;
  for (const auto& parameter : law.parameters) known.push_back(parameter.key);
  if (known.empty() && !table.table().empty())
    table.fail(fmt::format("found parameters; expected none, the law {} has none", law.name));
  table.allow(known);
  for (const auto& parameter : law.parameters)
    if (table.has(parameter.key)) {
      auto given = table.quantities(parameter.key, parameter.unit, parameter.text);
      if (!parameter.list && given.size() != 1) table.fail(parameter.key, "a list", "one number");
      values[std::string(parameter.key)] = std::move(given);
    }
  return values;
}

PointTable read_points(const MotionTable& table, const Cam& cam) {
  table.allow({"rows", "master_unit", "slave_unit", "spline", "splits", "start_speed", "start_acceleration",
               "end_speed", "end_acceleration"});
  const std::string_view master = unit_of(cam.master), slave = unit_of(cam.slave);
  const auto scale = [&](std::string_view key, std::string_view si) {
    const auto unit = table.text(key, "unit of a column");
    if (!unit) return 1.0;
    try {
      return machine::parse_quantity("1 " + *unit, si);
    } catch (const machine::UnitError& error) {
      table.fail(key, fmt::format("\"{}\" ({})", *unit, error.what()), fmt::format("a unit of {}", si));
    }
  };
  const double x = scale("master_unit", master), y = scale("slave_unit", slave);
  PointTable points;
  for (const auto& row : table.rows("rows", 2, 4)) {
    points.master.push_back(row[0] * x);
    points.slave.push_back(row[1] * y);
    if (row.size() > 2) points.speed.push_back(row[2] * y / x);
    if (row.size() > 3) points.acceleration.push_back(row[3] * y / (x * x));
  }
  points.interpolation =
      *interpolation_of(table.choice("spline", interpolation_names(), "natural", "how rows are interpolated"));
  const Boundary first = read_boundary(table, cam, "start"), last = read_boundary(table, cam, "end");
  points.interpolation.first = {0.0, first.speed.value_or(0.0), first.acceleration.value_or(0.0), 0.0};
  points.interpolation.last = {0.0, last.speed.value_or(0.0), last.acceleration.value_or(0.0), 0.0};
  for (const double split : table.quantities("splits", master, "masters where derivatives jump")) {
    // A quantity with a unit and a row times that unit may differ in the last digit.
    const auto near = [&](double place) { return std::fabs(place - split) <= 1e-12 * (1.0 + std::fabs(split)); };
    const auto found = std::find_if(points.master.begin(), points.master.end(), near);
    points.splits.push_back(found == points.master.end() ? split : *found);
  }
  return points;
}

// Length and stroke: directly, or from where the segment ends.
void read_extent(const MotionTable& table, const Cam& cam, double cycle, Segment& segment) {
  const double begin = cam.cycle(), from = cam.position_of(cam.segments.size());
  if (table.has("end") && table.has("length")) table.fail("length", "end and length", "one of them");
  if (table.has("to") && table.has("stroke")) table.fail("stroke", "to and stroke", "one of them");
  const auto unit = unit_of(cam.master);
  const auto length = table.quantity("length", unit, "length over the master");
  const double end = table.quantity("end", unit, "the master where the segment ends").value_or(cycle);
  segment.length = length ? *length : end - begin;
  if (!(segment.length > 0.0))
    table.fail(table.has("length") ? "length" : "end",
               fmt::format("a segment from {} to {} {}", begin, begin + segment.length, unit),
               "an end behind its begin");
  const auto to = table.quantity("to", unit_of(cam.slave), "the position of the slave at the end");
  const auto stroke = table.quantity("stroke", unit_of(cam.slave), "what the slave moves by");
  segment.stroke = to ? *to - from : stroke.value_or(0.0);
}

Segment read_segment(const MotionTable& table, const Cam& cam, double cycle) {
  table.allow(
      {"end", "length", "to", "stroke", "law", "parameters", "points", "end_speed", "end_acceleration", "end_jerk"});
  Segment segment;
  read_extent(table, cam, cycle, segment);
  segment.end = read_boundary(table, cam, "end");
  if (const auto points = table.subtable("points", "a table of points")) {
    if (table.has("law") && *table.text("law", "") != "points") table.fail("law", "a law and points", "one of them");
    segment.law = "points";
    segment.points = read_points(*points, cam);
    if (!table.has("to") && !table.has("stroke") && problem_of(*segment.points).empty())
      segment.stroke = segment.points->slave.back() - segment.points->slave.front();
  } else if (const auto name = table.text("law", "name of a law")) {
    const Law* law = find_law(*name);
    std::vector<std::string_view> names{"points"};
    for (const Law& each : laws()) names.push_back(each.name);
    if (law == nullptr)
      table.fail("law", fmt::format("\"{}\"", *name),
                 "a law of `stiction cam laws`" + machine::did_you_mean(*name, names));
    segment.law = law->name;
    if (const auto values = table.subtable("parameters", "parameters of the law"))
      segment.values = read_values(*values, *law);
  } else if (segment.stroke != 0.0) {
    table.fail("law", "no such key", "a law of `stiction cam laws` for a segment that moves");
  }
  if (const auto problem = problem_of(Cam{.name = cam.name, .periodic = false, .segments = {segment}});
      !problem.empty())
    table.fail(problem.substr(problem.find(": ") + 2));
  return segment;
}

Track read_track(const MotionTable& table, const Cam& cam) {
  table.allow({"name", "on", "off", "on_compensation", "off_compensation", "hysteresis"});
  Track track;
  const auto unit = unit_of(cam.master);
  track.name = table.text("name", "name of the track").value_or("");
  if (track.name.empty()) table.fail("name", "no such key", "a text (name of the track)");
  for (const char c : track.name)
    if (c == '"' || c == '\\' || static_cast<unsigned char>(c) < ' ' || c == '\x7f')
      table.fail("name", "a quote, a backslash or a control character", "a name without them");
  const auto on = table.quantities("on", unit, "masters where it switches on");
  const auto off = table.quantities("off", unit, "masters where it switches off");
  if (on.empty() || on.size() != off.size())
    table.fail("off", fmt::format("{} of on and {} of off", on.size(), off.size()), "as many of both, at least one");
  for (std::size_t k = 0; k < on.size(); ++k) {
    for (const double x : {on[k], off[k]})
      if (x < 0.0 || x > cam.cycle() * (1.0 + 1e-12))
        table.fail("on", fmt::format("{} {}", x, unit), fmt::format("0 to the cycle {} {}", cam.cycle(), unit));
    track.windows.push_back({on[k], off[k]});
  }
  track.on_compensation = table.quantity("on_compensation", "s", "negative switches earlier").value_or(0.0);
  track.off_compensation = table.quantity("off_compensation", "s", "negative switches earlier").value_or(0.0);
  track.hysteresis = table.quantity("hysteresis", unit, "over the master").value_or(0.0);
  if (track.hysteresis < 0.0) table.fail("hysteresis", "a negative one", "0 or more");
  return track;
}

Coordinate read_coordinate(const MotionTable& table, std::string_view name, std::string_view text) {
  return table.choice(name, {"rotary", "linear"}, "rotary", text) == "linear" ? Coordinate::linear : Coordinate::rotary;
}

// Names are bare keys of TOML, so that they are written as they are read.
bool is_bare(std::string_view name) {
  return !name.empty() && name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") ==
                              std::string_view::npos;
}

Cam read_cam(const MotionTable& table, std::string name) {
  if (!is_bare(name)) table.fail(fmt::format("found the name \"{}\"; expected letters, digits, - and _", name));
  table.allow({"cycle", "master", "slave", "periodic", "start", "modulo", "start_speed", "start_acceleration",
               "start_jerk", "segment", "track"});
  Cam cam;
  cam.name = std::move(name);
  cam.master = read_coordinate(table, "master", "the master's kind");
  cam.slave = read_coordinate(table, "slave", "the slave's kind");
  cam.periodic = table.boolean("periodic", true, "false: the cam runs once");
  const double cycle = *table.quantity("cycle", unit_of(cam.master), "the master's cycle", true);
  if (!(cycle > 0.0)) table.fail("cycle", fmt::format("{}", cycle), "more than 0");
  cam.start = table.quantity("start", unit_of(cam.slave), "the slave's position at the master's 0").value_or(0.0);
  cam.modulo = table.quantity("modulo", unit_of(cam.slave), "a turn of an endless slave");
  if (cam.modulo && !(*cam.modulo > 0.0)) table.fail("modulo", fmt::format("{}", *cam.modulo), "more than 0");
  cam.begin = read_boundary(table, cam, "start");
  if (cam.periodic && cam.begin.any())
    table.fail("periodic", "a periodic cam with forced values at its start", "those of the end of its last segment");
  for (const auto& segment : table.subtables("segment", "in the order of the master"))
    cam.segments.push_back(read_segment(segment, cam, cycle));
  if (!cam.segments.empty() && std::fabs(cam.cycle() - cycle) > 1e-12 * cycle)
    table.fail("cycle", fmt::format("{}, and segments up to {}", cycle, cam.cycle()), "segments that fill the cycle");
  for (const auto& track : table.subtables("track", "a switch track")) cam.tracks.push_back(read_track(track, cam));
  if (const auto problem = problem_of(cam); !problem.empty()) table.fail(problem);
  try {
    compose(cam);
  } catch (const CamError& error) {
    table.fail(error.what());
  }
  return cam;
}

}  // namespace

std::vector<Cam> parse_motion_file(const std::string& file, const std::string& text) {
  const Document document(file, text);
  const MotionTable root(document, document.root(), "");
  root.allow({"schema", "cam"});
  const auto schema = root.text("schema", "version of the format");
  if (schema != motion_schema)
    root.fail("schema", schema ? fmt::format("\"{}\"", *schema) : "no such key", fmt::format("\"{}\"", motion_schema));
  const auto tables = root.subtable("cam", "cams by name");
  if (!tables || tables->table().empty()) root.fail("cam", "no cam", "a table [cam.NAME]");
  std::vector<Cam> cams;
  for (auto&& [name, node] : tables->table())
    cams.push_back(read_cam(*tables->subtable(name.str(), "a cam"), std::string(name.str())));
  return cams;
}

std::vector<Cam> read_motion_file(const std::filesystem::path& file) {
  return parse_motion_file(file.string(), machine::content_of(file));
}

}  // namespace stiction::sim::cam
