#include "host/diagnose/search/context_lines.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "host/diagnose/record/inverse_dynamics.hpp"
#include "host/diagnose/spectrum/signal_scan.hpp"

namespace stiction::host {
namespace {

constexpr std::size_t pitches_tried = 3;
constexpr std::size_t lines_tried = 2;

// `wanted`: of a scan of the context, whether it is made.
template <class Wanted>
void scan(const LogRows& rows, const Eigen::VectorXd& residual, const Whitening& whitening, SearchContext& context,
          const Wanted& wanted) {
  std::vector<double> known;
  for (const double pitch : {context.axis.motor.pole_pair_pitch, 0.5 * context.axis.motor.pole_pair_pitch})
    if (pitch > 0.0) known.push_back(pitch);
  const Eigen::VectorXd by_itself = Eigen::VectorXd::Ones(rows.rows());
  const auto over_position = [&](LineScan& scan, const Eigen::VectorXd& carrier) {
    if (wanted(&scan)) scan = scan_pitches(rows, residual, whitening, carrier, known, pitches_tried);
  };
  over_position(context.pitches, by_itself);
  over_position(context.modulation, rows.stacked([&](const Motion& m) { return force_along(context.axis, m); }));
  over_position(context.by_speed, rows.velocity.cwiseAbs() / context.highest_speed);
  if (wanted(&context.times)) context.times = scan_times(rows, whitening(residual), lines_tried);
  if (wanted(&context.signals_of_encoder))
    context.signals_of_encoder =
        scan_signal_periods(rows, residual, whitening, context.axis, context.timing, context.signals, lines_tried);
  const auto over_stroke = [&](PlaceScan& scan, const Eigen::VectorXd& of) {
    if (wanted(&scan))
      scan_places(rows, residual, whitening, of, context.lowest_position, context.highest_position, scan);
  };
  over_stroke(context.tight_spots, rows.stacked([&](const Motion& m) { return contact_level(context.axis, m); }));
  over_stroke(context.pushes, by_itself);
}

}  // namespace

void find_lines(const LogRows& rows, const Eigen::VectorXd& residual, const Whitening& whitening,
                SearchContext& context) {
  scan(rows, residual, whitening, context, [](const void*) { return true; });
}

void find_lines_of(std::span<const std::size_t> names, const LogRows& rows, const Eigen::VectorXd& residual,
                   const Whitening& whitening, SearchContext& context) {
  scan(rows, residual, whitening, context, [&](const void* scan) {
    return std::any_of(names.begin(), names.end(), [&](std::size_t name) {
      const auto& c = candidates()[name];
      return (c.scan != nullptr && &c.scan(context) == scan) || (c.places != nullptr && &c.places(context) == scan);
    });
  });
}

}  // namespace stiction::host
