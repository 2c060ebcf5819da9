// False alarms and delays of the fleet's alarms over many axis-years of drawn estimates: residuals of real records, as
// tests/fleet/campaign.py leaves them, drawn with replacement, or normal ones.
// usage: fleet_alarms SEED AXIS_YEARS RATE [RESIDUALS]
//   RESIDUALS: a line "CAUSE RESIDUAL ERROR" for each estimate (0 mass, 1 constant force, 2 Coulomb, 3 viscous
//   friction), relative, of axes without a change
// Prints a line for axes without a change, and one for the Coulomb friction of axes that grows by 2 % a month.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "host/fleet/trends.hpp"

namespace {

using namespace stiction::host;

constexpr std::size_t axes_of_fleet = 50, months = 24;
constexpr std::size_t growing = 5;  // axes of each fleet in the second part
constexpr std::size_t first_month = 12;
constexpr double growth = 0.02;  // a month
constexpr double level = 100.0;
constexpr std::size_t coulomb = static_cast<std::size_t>(FleetCause::coulomb);

struct Residual {
  double value, error;  // relative
};
using Residuals = std::array<std::vector<Residual>, fleet_causes>;

class FleetDraw {
 public:
  FleetDraw(unsigned seed, const Residuals& residuals) : engine_(seed), residuals_(residuals) {}

  std::vector<AxisHistory> fleet(std::size_t growing_axes) {
    std::vector<AxisHistory> axes(axes_of_fleet);
    for (std::size_t a = 0; a < axes.size(); ++a) {
      axes[a].name = fmt::format("axis {}", a);
      for (std::size_t m = 0; m < months; ++m) {
        axes[a].days.push_back(20000.0 + days_of_month * static_cast<double>(m));
        const double grown =
            a < growing_axes && m >= first_month ? growth * static_cast<double>(m - first_month + 1) : 0.0;
        axes[a].records.push_back(record(grown));
      }
    }
    return axes;
  }

 private:
  RecordEstimate record(double grown) {
    RecordEstimate drawn;
    for (std::size_t c = 0; c < fleet_causes; ++c) {
      const double truth = static_cast<FleetCause>(c) == FleetCause::constant_force ? 0.0 : 1.0;
      const auto residual = one(c);
      const double more = c == coulomb ? 1.0 + grown : 1.0;
      drawn.causes[c] = {level * (truth * more + residual.value * more), level * residual.error};
    }
    return drawn;
  }

  Residual one(std::size_t cause) {
    const auto& all = residuals_[cause];
    if (all.empty()) return {0.01 * normal_(engine_), 0.003};
    return all[std::uniform_int_distribution<std::size_t>(0, all.size() - 1)(engine_)];
  }

  std::mt19937_64 engine_;
  std::normal_distribution<double> normal_;
  const Residuals& residuals_;
};

Residuals read_residuals(const char* file) {
  Residuals residuals;
  std::ifstream in(file);
  std::size_t cause = 0;
  double value = 0.0, error = 0.0;
  while (in >> cause >> value >> error)
    if (cause < fleet_causes) residuals[cause].push_back({value, error});
  return residuals;
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 4) {
    fmt::print(stderr, "usage: fleet_alarms SEED AXIS_YEARS RATE [RESIDUALS]\n");
    return 2;
  }
  const auto seed = static_cast<unsigned>(std::strtoul(arguments[1], nullptr, 10));
  const double wanted = std::strtod(arguments[2], nullptr), rate = std::strtod(arguments[3], nullptr);
  const auto residuals = count > 4 ? read_residuals(arguments[4]) : Residuals{};
  for (const auto& each : residuals)
    if (count > 4 && each.empty()) {
      fmt::print(stderr, "fleet_alarms: {}: found no residuals of a parameter; expected some of each\n", arguments[4]);
      return 2;
    }
  FleetDraw draw(seed, residuals);
  constexpr double years = static_cast<double>(axes_of_fleet * months) / 12.0;
  std::array<std::size_t, fleet_causes> alarms{};
  double done = 0.0;
  for (; done < wanted; done += years)
    for (const auto& axis : trends_of(draw.fleet(0), rate).axes)
      for (std::size_t c = 0; c < fleet_causes; ++c) alarms[c] += axis.causes[c].alarm.has_value();
  fmt::print(
      "false alarms: {} in {:.0f} axis-years (mass {}, constant force {}, Coulomb {}, viscous {}); {:g} stated\n",
      alarms[0] + alarms[1] + alarms[2] + alarms[3], done, alarms[0], alarms[1], alarms[2], alarms[3], rate * done);
  std::vector<std::size_t> found(months + 1);  // by records of the growth until the alarm; the last: never
  std::size_t early = 0, all = 0;
  for (double years_done = 0.0; years_done < wanted; years_done += years)
    for (const auto& axis : trends_of(draw.fleet(growing), rate).axes) {
      if (axis.history >= growing) continue;
      ++all;
      const auto& alarm = axis.causes[coulomb].alarm;
      if (alarm && alarm->record < first_month)
        ++early;
      else
        ++found[alarm ? alarm->record - first_month + 1 : months];
    }
  std::string delays;
  std::size_t within = 0;
  for (std::size_t k = 1; k < found.size(); ++k) {
    if (k <= 3) within += found[k];
    if (found[k] > 0)
      delays +=
          fmt::format("{}{}: {}", delays.empty() ? "" : ", ", k == months ? "never" : fmt::format("{}", k), found[k]);
  }
  fmt::print("growth of 2 % a month: {} of {} found within 3 months; month of the alarm: {}; before it {}\n", within,
             all, delays, early);
  return 0;
}
