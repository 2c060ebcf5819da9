#include "host/diagnose/judge/withheld_keys.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>

namespace stiction::host {
namespace {

constexpr int runs = 10;           // under forces drawn like those that act on the axis beside
constexpr double scatters = 2.0;   // standard deviations over the runs
constexpr double relevant = 0.01;  // of the file's error: less is nothing that a user sees
constexpr double never = std::numeric_limits<double>::infinity();

// m rms in each run, the same forces for every machine; infinite where it cannot follow.
Eigen::ArrayXd errors(const ReplaySetup& setup, const std::vector<Finding>& findings, const Positions& measured,
                      const Disturbance& disturbance) {
  const auto extended = extended_setup(setup, findings);
  return Eigen::ArrayXd::NullaryExpr(runs, [&](Eigen::Index run) {
    const auto positions = positions_under(disturbance, extended, static_cast<std::uint64_t>(run) + 1);
    return positions ? difference_rms(measured, *positions, setup.logs) : never;
  });
}

double deviation(const Eigen::ArrayXd& values) {
  return std::sqrt((values - values.mean()).square().sum() / static_cast<double>(values.size() - 1));
}

bool follows_worse(const Eigen::ArrayXd& machine, const Eigen::ArrayXd& file) {
  const Eigen::ArrayXd more = machine - file;
  if (!std::isfinite(more.mean())) return true;
  return more.mean() > std::max(scatters * deviation(more), relevant * file.mean());
}

}  // namespace

void withhold_what_follows_worse(std::vector<Finding>& findings, const ReplaySetup& setup, const Positions& measured,
                                 const Disturbance& disturbance) {
  const auto of_file = errors(setup, {}, measured, disturbance);
  if (!std::isfinite(of_file.mean()) || of_file.mean() <= scatters * deviation(of_file)) return;
  for (auto written = written_findings(findings); !written.empty(); written = written_findings(findings)) {
    const auto with = errors(setup, written, measured, disturbance);
    if (!follows_worse(with, of_file)) return;
    Finding* worst = nullptr;
    double least = never;
    for (auto& finding : findings) {
      if (!finding.withheld.empty()) continue;
      std::vector<Finding> others;
      for (const auto& other : findings)
        if (other.withheld.empty() && &other != &finding) others.push_back(other);
      const double left = errors(setup, others, measured, disturbance).mean();
      if (!worst || left < least) worst = &finding, least = left;
    }
    worst->withheld = std::isfinite(with.mean()) ? fmt::format(
                                                       "with its keys the simulation is {:.2g} times as far off the "
                                                       "held-out positions as {} (mean of {} runs)",
                                                       with.mean() / std::min(least, with.mean()),
                                                       written.size() > 1 ? "without them" : "the file's", runs)
                                                 : "with its keys the simulation cannot follow the held-out set-points";
  }
}

}  // namespace stiction::host
