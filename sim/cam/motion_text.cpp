#include <fmt/format.h>
#include <fmt/ranges.h>

#include "sim/cam/motion_file.hpp"
#include "sim/cam/motion_keys.hpp"
#include "sim/cam/quantity_text.hpp"

namespace stiction::sim::cam {
namespace {

// In degrees or millimetres.
std::string usual_text(double value, std::string_view si) {
  return quantity_text(value, si, si == "rad" ? "deg" : si == "m" ? "mm" : "");
}

void write_boundary(std::string& text, const Cam& cam, const Boundary& boundary, std::string_view prefix) {
  const std::optional<double> values[] = {boundary.speed, boundary.acceleration, boundary.jerk};
  constexpr std::string_view names[] = {"speed", "acceleration", "jerk"};
  for (int order = 1; order <= 3; ++order)
    if (values[order - 1])
      text += fmt::format("{}_{} = {}\n", prefix, names[order - 1],
                          usual_text(*values[order - 1], derivative_unit(cam.slave, cam.master, order)));
}

void write_points(std::string& text, const Cam& cam, const PointTable& points) {
  text += fmt::format("points.spline = \"{}\"\n", name_of(points.interpolation));
  if (points.interpolation.ends == SplineEnds::clamped) {
    const auto boundary = [](const EndState& s) { return Boundary{s.speed, s.acceleration, {}}; };
    write_boundary(text, cam, boundary(points.interpolation.first), "points.start");
    write_boundary(text, cam, boundary(points.interpolation.last), "points.end");
  }
  if (!points.splits.empty()) {
    std::vector<std::string> splits;
    for (const double split : points.splits) splits.push_back(usual_text(split, unit_of(cam.master)));
    text += fmt::format("points.splits = [{}]\n", fmt::join(splits, ", "));
  }
  text += "points.rows = [\n";
  for (std::size_t i = 0; i < points.master.size(); ++i) {
    text += fmt::format("  [{}, {}", number_text(points.master[i]), number_text(points.slave[i]));
    if (!points.speed.empty()) text += ", " + number_text(points.speed[i]);
    if (!points.acceleration.empty()) text += ", " + number_text(points.acceleration[i]);
    text += "],\n";
  }
  text += "]\n";
}

void write_segment(std::string& text, const Cam& cam, const Segment& segment) {
  text += fmt::format("\n[[cam.{}.segment]]\nlength = {}\nstroke = {}\n", cam.name,
                      usual_text(segment.length, unit_of(cam.master)), usual_text(segment.stroke, unit_of(cam.slave)));
  if (segment.points)
    write_points(text, cam, *segment.points);
  else
    text += fmt::format("law = \"{}\"\n", segment.law);
  std::vector<std::string> values;
  for (const auto& [key, list] : segment.values) {
    std::vector<std::string> numbers;
    for (const double each : list) numbers.push_back(number_text(each));
    values.push_back(list.size() == 1 ? fmt::format("{} = {}", key, numbers.front())
                                      : fmt::format("{} = [{}]", key, fmt::join(numbers, ", ")));
  }
  if (!values.empty()) text += fmt::format("parameters = {{ {} }}\n", fmt::join(values, ", "));
  write_boundary(text, cam, segment.end, "end");
}

void write_track(std::string& text, const Cam& cam, const Track& track) {
  std::vector<std::string> on, off;
  for (const auto& [first, last] : track.windows) {
    on.push_back(usual_text(first, unit_of(cam.master)));
    off.push_back(usual_text(last, unit_of(cam.master)));
  }
  text += fmt::format("\n[[cam.{}.track]]\nname = \"{}\"\non = [{}]\noff = [{}]\n", cam.name, track.name,
                      fmt::join(on, ", "), fmt::join(off, ", "));
  if (track.on_compensation != 0.0) text += fmt::format("on_compensation = \"{} s\"\n", track.on_compensation);
  if (track.off_compensation != 0.0) text += fmt::format("off_compensation = \"{} s\"\n", track.off_compensation);
  if (track.hysteresis != 0.0)
    text += fmt::format("hysteresis = {}\n", usual_text(track.hysteresis, unit_of(cam.master)));
}

}  // namespace

std::string motion_text(const std::vector<Cam>& cams) {
  std::string text = fmt::format("schema = \"{}\"\n", motion_schema);
  for (const Cam& cam : cams) {
    text += fmt::format("\n[cam.{}]\nmaster = \"{}\"\nslave = \"{}\"\ncycle = {}\n", cam.name, name_of(cam.master),
                        name_of(cam.slave), usual_text(cam.cycle(), unit_of(cam.master)));
    if (!cam.periodic) text += "periodic = false\n";
    if (cam.start != 0.0) text += fmt::format("start = {}\n", usual_text(cam.start, unit_of(cam.slave)));
    if (cam.modulo) text += fmt::format("modulo = {}\n", usual_text(*cam.modulo, unit_of(cam.slave)));
    write_boundary(text, cam, cam.begin, "start");
    for (const Segment& segment : cam.segments) write_segment(text, cam, segment);
    for (const Track& track : cam.tracks) write_track(text, cam, track);
  }
  return text;
}

}  // namespace stiction::sim::cam
