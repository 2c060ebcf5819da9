#include "host/identify/standstill.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/plant/friction/friction.hpp"

namespace stiction::host {
namespace {

constexpr double reach = 2.0;                // of the filter, in periods of its cut-off, to either side
constexpr double distances_to_forget = 2.0;  // of a contact, each of which leaves a tenth

double jump_of(const machine::AxisModel& axis) { return sim::steady_friction(axis.friction)(0.0, 1.0); }

// m/s, at which friction stops the mass within what the filter resolves.
double stopped_from(const machine::AxisModel& axis, double cutoff) {
  return jump_of(axis) / axis.mass / (2.0 * std::numbers::pi * cutoff);
}

}  // namespace

bool sticks_rigidly(const machine::AxisModel& axis) { return !sim::contact_of(axis.friction) && jump_of(axis) != 0.0; }

double unresolved_distance(const machine::AxisModel& axis, double cutoff) {
  return stopped_from(axis, cutoff) * reach / cutoff;
}

Eigen::VectorXd moving_rows(const LogRows& rows, const machine::AxisModel& axis, double cutoff) {
  Eigen::VectorXd moves = Eigen::VectorXd::Ones(rows.rows());
  if (!sticks_rigidly(axis)) return moves;
  const double slow = stopped_from(axis, cutoff);
  const auto beside = static_cast<Eigen::Index>(std::ceil(reach / cutoff / rows.period(0)));
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
    if (std::abs(rows.velocity[i]) < slow)
      for (Eigen::Index k = std::max<Eigen::Index>(i - beside, 0); k <= std::min(i + beside, rows.rows() - 1); ++k)
        moves[k] = 0.0;
  return moves;
}

std::vector<double> samples_faster_than(double speed, const Motion& motion, double cutoff) {
  std::vector<double> faster(motion.v.size(), 1.0);
  const auto beside = static_cast<std::size_t>(std::ceil(reach / cutoff / motion.period));
  for (std::size_t i = 0, cleared = 0; i < faster.size(); ++i) {
    if (std::abs(motion.v[i]) >= speed) continue;
    const std::size_t end = std::min(i + beside + 1, faster.size());
    for (std::size_t k = std::max(cleared, i - std::min(i, beside)); k < end; ++k) faster[k] = 0.0;
    cleared = end;
  }
  return faster;
}

Eigen::VectorXd rows_after_first_slide(const LogRows& rows, const machine::AxisModel& axis) {
  Eigen::VectorXd after = Eigen::VectorXd::Ones(rows.rows());
  const auto contact = sim::contact_of(axis.friction);
  if (!contact) return after;
  const double slide = distances_to_forget * contact->distance;
  const Eigen::VectorXd position = rows.stacked([](const Motion& motion) { return motion.x; });
  for (std::size_t k = 0; k < rows.logs().size(); ++k) {
    const auto first = static_cast<Eigen::Index>(rows.logs()[k]);
    const auto end = k + 1 < rows.logs().size() ? static_cast<Eigen::Index>(rows.logs()[k + 1]) : rows.rows();
    auto slid = first;
    while (slid < end && std::abs(position[slid] - position[first]) < slide) ++slid;
    if (slid < end) after.segment(first, slid - first).setZero();
  }
  return after;
}

}  // namespace stiction::host
