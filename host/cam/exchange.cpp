#include "host/cam/exchange.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/cam/points.hpp"

namespace stiction::host {
namespace {

using sim::cam::CamError;

// Between two points of a file the difference is looked at so often; it has one or two lobes there.
constexpr int looks_each_interval = 32;

// The points as the importer joins them.
sim::cam::PointTable table_of(const detail::ExchangeRows& rows, Importer importer, bool periodic) {
  sim::cam::PointTable table;
  table.master = rows.master;
  table.slave = rows.slave;
  const double begin = table.master.front();
  for (double& x : table.master) x -= begin;
  const auto ends = periodic ? sim::cam::SplineEnds::periodic : sim::cam::SplineEnds::natural;
  table.interpolation = {
      importer == Importer::quintic ? sim::cam::SplineDegree::quintic : sim::cam::SplineDegree::cubic, ends, {}, {}};
  if (!rows.speed.empty()) {
    table.speed = rows.speed;
    table.acceleration = rows.acceleration;
  }
  return table;
}

// Of the lines of a linear importer the acceleration is nothing but jumps.
sim::cam::Curve lines_through(const sim::cam::PointTable& table) {
  std::vector<sim::cam::Piece> pieces;
  for (std::size_t k = 1; k < table.master.size(); ++k) {
    const double h = table.master[k] - table.master[k - 1];
    pieces.push_back(sim::cam::polynomial_piece(table.master[k - 1], table.master[k],
                                                {table.slave[k - 1], (table.slave[k] - table.slave[k - 1]) / h}));
  }
  return sim::cam::Curve(std::move(pieces));
}

bool closes(const detail::ExchangeRows& rows) {
  const auto [low, high] = std::minmax_element(rows.slave.begin(), rows.slave.end());
  return std::fabs(rows.slave.back() - rows.slave.front()) <= 1e-6 * (*high - *low);
}

sim::cam::Curve importer_curve(const detail::ExchangeRows& rows, const ExchangeFormat& format, bool periodic) {
  const auto table = table_of(rows, format.importer, periodic);
  if (const auto problem = problem_of(table); !problem.empty()) throw CamError(problem);
  return format.importer == Importer::linear ? lines_through(table) : curve_of(table);
}

}  // namespace

sim::cam::Cam imported(const std::string& text, const ExchangeFormat& format, const ExchangeSettings& settings,
                       const sim::cam::Cam& like) {
  const auto rows = detail::read_rows(text, format, settings, like);
  sim::cam::Cam cam = like;
  cam.segments.clear();
  cam.periodic = rows.cyclic.value_or(closes(rows));
  const bool ring = cam.periodic && closes(rows);
  auto table = table_of(rows, format.importer, ring);
  // Rounded rows may end where a cycle does not quite close.
  if (ring) table.slave.back() = table.slave.front();
  if (const auto problem = problem_of(table); !problem.empty()) throw CamError(problem);
  cam.start = table.slave.front();
  sim::cam::Segment segment{
      .length = table.master.back(), .stroke = table.slave.back() - table.slave.front(), .law = "points"};
  segment.points = std::move(table);
  cam.segments.push_back(std::move(segment));
  if (const auto problem = problem_of(cam); !problem.empty()) throw CamError(problem);
  return cam;
}

ExchangeError exchange_error(const sim::cam::Motion& motion, const std::string& text, const ExchangeFormat& format,
                             const ExchangeSettings& settings) {
  const auto rows = detail::read_rows(text, format, settings, motion.cam);
  const auto curve = importer_curve(rows, format, motion.cam.periodic && closes(rows));
  ExchangeError error;
  error.acceleration_peak = extremes(motion.curve, 2).magnitude();
  const auto include = [](sim::cam::Peak& peak, double value, double place) {
    if (std::fabs(value) > std::fabs(peak.value)) peak = {value, place};
  };
  const double begin = motion.curve.begin();
  for (const auto& piece : curve.pieces())
    for (int k = 0; k <= looks_each_interval; ++k) {
      const double x = piece.begin + piece.length() * k / looks_each_interval;
      const double at = std::min(begin + x, motion.curve.end());
      const auto side = k == looks_each_interval ? sim::cam::Side::left : sim::cam::Side::right;
      include(error.position, piece.derivative(x, 0) - motion.curve.derivative(at, 0, side), at);
      include(error.acceleration, piece.derivative(x, 2) - motion.curve.derivative(at, 2, side), at);
    }
  // Lines have their acceleration in the steps of the speed.
  const auto& pieces = curve.pieces();
  for (std::size_t k = 0; k < pieces.size() && format.importer == Importer::linear; ++k) {
    if (k == 0 && !(motion.cam.periodic && closes(rows))) continue;
    const auto& before = pieces[(k + pieces.size() - 1) % pieces.size()];
    include(error.speed_step, pieces[k].derivative(pieces[k].begin, 1) - before.derivative(before.end, 1),
            begin + pieces[k].begin);
  }
  // The places that were not looked at lie at most 1/64 of a lobe away from one that was: 1 % covers them.
  error.position.value *= 1.01;
  error.acceleration.value *= 1.01;
  return error;
}

}  // namespace stiction::host
