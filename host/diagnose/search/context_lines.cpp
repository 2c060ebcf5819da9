#include "host/diagnose/search/context_lines.hpp"

#include <utility>
#include <vector>

#include "host/diagnose/record/inverse_dynamics.hpp"

namespace stiction::host {
namespace {

constexpr std::size_t pitches_tried = 3;
constexpr std::size_t lines_tried = 2;

}  // namespace

void find_lines(const LogRows& rows, const Eigen::VectorXd& residual, const Whitening& whitening,
                SearchContext& context) {
  std::vector<double> known;
  for (const double pitch : {context.axis.motor.pole_pair_pitch, 0.5 * context.axis.motor.pole_pair_pitch})
    if (pitch > 0.0) known.push_back(pitch);
  const Eigen::VectorXd by_itself = Eigen::VectorXd::Ones(rows.rows());
  const auto carrier = rows.stacked([&](const Motion& m) { return force_along(context.axis, m); });
  context.pitches = scan_pitches(rows, residual, whitening, by_itself, known, pitches_tried);
  context.modulation = scan_pitches(rows, residual, whitening, carrier, known, pitches_tried);
  context.by_speed =
      scan_pitches(rows, residual, whitening, rows.velocity.cwiseAbs() / context.highest_speed, known, pitches_tried);
  context.times = scan_times(rows, whitening(residual), lines_tried);
  context.signals_of_encoder =
      scan_signal_periods(rows, residual, whitening, context.axis, context.timing, lines_tried);
  const auto level = rows.stacked([&](const Motion& m) { return contact_level(context.axis, m); });
  for (auto& [scan, of] :
       {std::pair<PlaceScan*, const Eigen::VectorXd*>{&context.tight_spots, &level}, {&context.pushes, &by_itself}})
    scan_places(rows, residual, whitening, *of, context.lowest_position, context.highest_position, *scan);
}

}  // namespace stiction::host
