#include "host/studio/read_back.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "stiction/motion/cam_table.hpp"
#include "stiction/motion/cam_words.hpp"

namespace stiction::host {
namespace {

using sim::cam::Cam;
using sim::cam::CamError;
using sim::cam::Coordinate;
using sim::cam::PointTable;

constexpr std::size_t most_points = 720;
// A cycle of a rotary master is a turn where its log ends within so much of one.
constexpr double near_turn = 0.01;

// One segment of points; a slave that does not come back is endless.
Cam cam_of(PointTable points, const std::string& name) {
  Cam cam;
  cam.name = name;
  const double rise = points.slave.back() - points.slave.front();
  double size = 0.0;
  for (const double y : points.slave) size = std::max(size, std::fabs(y - points.slave.front()));
  if (std::fabs(rise) <= 1e-6 * size)
    points.slave.back() = points.slave.front();
  else
    cam.modulo = std::fabs(rise);
  cam.start = points.slave.front();
  sim::cam::Segment segment{
      .length = points.master.back(), .stroke = points.slave.back() - points.slave.front(), .law = "points"};
  segment.points = std::move(points);
  cam.segments.push_back(std::move(segment));
  if (const auto problem = problem_of(cam); !problem.empty()) throw CamError(problem);
  return cam;
}

Coordinate kind_of(CamTable::Kind kind) {
  return kind == CamTable::Kind::rotary ? Coordinate::rotary : Coordinate::linear;
}

// Where the master begins anew in `master`: the first sample of each cycle.
std::vector<std::size_t> begins_of(const std::vector<double>& master) {
  std::vector<std::size_t> begins;
  // A record that begins with a cycle.
  if (master.size() > 1 && master[0] >= 0.0 && master[0] < 1.5 * (master[1] - master[0])) begins.push_back(0);
  const double range =
      *std::max_element(master.begin(), master.end()) - *std::min_element(master.begin(), master.end());
  for (std::size_t k = 1; k < master.size(); ++k)
    if (master[k - 1] - master[k] > 0.5 * range) begins.push_back(k);
  return begins;
}

}  // namespace

Cam cam_of_table(std::span<const std::uint8_t> bytes, const std::string& name) {
  CamTable table;
  if (const auto problem = CamTable::read(bytes, table); problem != CamTableProblem::none)
    throw CamError(std::string("found ") + words_of(problem));
  const auto& header = table.header();
  const double cycle = std::ldexp(static_cast<double>(header.cycle), -CamTable::cycle_bits);
  PointTable points;
  const auto add = [&](double place, const CamTable::Output& at, std::int64_t rise) {
    points.master.push_back(place);
    points.slave.push_back(std::ldexp(static_cast<double>(at.position + rise), -header.position_bits));
    points.speed.push_back(std::ldexp(static_cast<double>(at.speed), -header.speed_bits) / cycle);
    points.acceleration.push_back(std::ldexp(static_cast<double>(at.acceleration), -header.acceleration_bits) /
                                  (cycle * cycle));
  };
  for (std::uint32_t k = 0; k < header.count; ++k) {
    const std::uint32_t start = table.segment(k).start;
    add(std::ldexp(static_cast<double>(start), -32) * cycle, table.evaluate(start), 0);
  }
  if (header.periodic)
    add(cycle, table.evaluate(0), header.rise);
  else
    add(cycle, table.evaluate(UINT32_MAX), 0);
  Cam cam = cam_of(std::move(points), name);
  cam.master = kind_of(header.master), cam.slave = kind_of(header.slave);
  cam.periodic = header.periodic;
  return cam;
}

Cam cam_of_log(const Log& log, const std::string& name) {
  const auto found = std::find_if(log.axes.begin(), log.axes.end(), [](const AxisLog& axis) {
    return !axis.master.empty() && !(axis.x_set.empty() && axis.x.empty());
  });
  if (found == log.axes.end())
    throw CamError("found a log without the channel master; expected one of an axis that follows a cam");
  const auto& master = found->master;
  const auto& slave = found->x_set.empty() ? found->x : found->x_set;
  const auto begins = begins_of(master);
  if (begins.size() < 2)
    throw CamError("found no whole cycle of the master; expected a log with one, from its begin to the next");
  const std::size_t first = begins[0], last = begins[1];
  // The cycle ends between two samples.
  const double step = master[first + 1] - master[first];
  double cycle = master[last - 1] + step - master[last];
  const double turns = std::nearbyint(cycle / (2.0 * std::numbers::pi));
  if (turns > 0.0 && std::fabs(cycle - turns * 2.0 * std::numbers::pi) < near_turn * cycle)
    cycle = turns * 2.0 * std::numbers::pi;
  const auto at_seam = [&](std::size_t k) {  // between the sample before it and its own
    if (k == 0) return slave[0] - master[0] / step * (slave[1] - slave[0]);
    const double before = cycle - master[k - 1], share = before / (before + master[k]);
    return slave[k - 1] + share * (slave[k] - slave[k - 1]);
  };
  PointTable points;
  points.master.push_back(0.0);
  points.slave.push_back(at_seam(first));
  const std::size_t each = std::max<std::size_t>(1, (last - first) / (most_points - 2));
  for (std::size_t k = first + each / 2; k < last; k += each) {
    if (!(master[k] > points.master.back() + 1e-9 * cycle) || !(master[k] < cycle * (1.0 - 1e-9))) continue;
    points.master.push_back(master[k]);
    points.slave.push_back(slave[k]);
  }
  points.master.push_back(cycle);
  points.slave.push_back(at_seam(last));
  Cam cam = cam_of(std::move(points), name);
  cam.slave = found->rotary ? Coordinate::rotary : Coordinate::linear;
  return cam;
}

}  // namespace stiction::host
