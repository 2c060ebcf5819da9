#include "sim/cam/shaping/task.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/cam/characteristics.hpp"

namespace stiction::sim::cam {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

}  // namespace

ShapingTask shaping_task(const Motion& motion, const ElasticDrive& drive, double master_speed, double band,
                         const LiftLimits& limits) {
  const auto dwell = longest_dwell(motion);
  if (!dwell)
    throw CamError(
        fmt::format("cam {}: found no dwell; expected one, in which the load is to be still", motion.cam.name));
  const auto& curve = motion.curve;
  const double speed = extremes(curve, 1).magnitude();
  // Back over what moves.
  double begin = dwell->begin;
  for (std::size_t k = curve.pieces().size(); k-- > 0;) {
    const Piece& piece = curve.pieces()[k];
    if (piece.end > dwell->begin + 1e-12 * curve.length()) continue;
    const bool still = std::fabs(piece.derivative(piece.begin + 0.37 * piece.length(), 1)) < 1e-9 * speed &&
                       std::fabs(piece.derivative(piece.begin + 0.81 * piece.length(), 1)) < 1e-9 * speed;
    if (still) break;
    begin = piece.begin;
  }
  if (begin == dwell->begin)
    throw CamError(
        fmt::format("cam {}: found a dwell at the master's 0 with its rise before the seam; expected the "
                    "rise and its dwell in one cycle",
                    motion.cam.name));
  if (std::fabs(curve.derivative(begin, 1)) > 1e-9 * speed)
    throw CamError(fmt::format("cam {}: found a speed at {:.6g}°, where the rise into the dwell begins; expected rest",
                               motion.cam.name, begin / degree));
  ShapingTask task;
  task.motion = motion;
  task.dwell = *dwell;
  task.begin = begin;
  task.start = curve(begin);
  task.stroke = curve.derivative(dwell->begin, 0, Side::left) - task.start;
  task.master_speed = master_speed;
  task.drive = drive;
  task.band = band;
  task.limits = limits;
  return task;
}

std::complex<double> residual_of(const ShapingTask& task, const Curve& lift, double at) {
  std::vector<Piece> pieces = lift.pieces();
  const double end = lift.end(), rest = lift.derivative(end, 0, Side::left);
  if (at > end + 1e-9 * lift.length()) pieces.push_back(polynomial_piece(end, at, {rest}));
  const Motion motion{.cam = {}, .curve = Curve(std::move(pieces)), .segments = {}};
  return modal_residual(task.drive, motion, task.master_speed, at);
}

BandFigures band_figures(const ShapingTask& task, const Motion& motion, int count, int cycles) {
  BandFigures found;
  // Over the seam a dwell ends in the next cycle.
  const bool over_seam = task.dwell.end() > motion.curve.length() * (1.0 + 1e-12);
  for (int k = 0; k < count; ++k) {
    const double factor = count == 1 ? 1.0 : 1.0 - task.band + 2.0 * task.band * k / (count - 1);
    const auto states = transfer_response(task.drive.with_load_frequency(factor), motion,
                                          {.master_speed = task.master_speed, .cycles = cycles + (over_seam ? 1 : 0)});
    found.factors.push_back(factor);
    found.figures.push_back(dwell_figures(states, motion, task.dwell));
    found.worst = std::max(found.worst, found.figures.back().peak_to_peak);
  }
  return found;
}

}  // namespace stiction::sim::cam
