#include "host/diagnose/next_measurement/cam_charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "host/cam/axis_load.hpp"

namespace stiction::host {
namespace {

constexpr double degrees_of_master = 180.0 / std::numbers::pi;
constexpr int most_cycle_orders = 60;
constexpr double nearly_all = 0.99;  // of the squares of all lines
constexpr int lift_places = 360;     // of a cycle, at which the lift is drawn

// Amplitudes of the harmonics 1, 2, .. of the cycle.
struct CycleOrders {
  std::vector<double> lines;

  std::size_t largest() const {  // its order
    return static_cast<std::size_t>(std::max_element(lines.begin(), lines.end()) - lines.begin()) + 1;
  }
  // The order up to which nearly all of it lies.
  std::size_t end() const {
    double whole = 0.0, sum = 0.0;
    for (const double line : lines) whole += line * line;
    for (std::size_t k = 0; k < lines.size(); ++k)
      if ((sum += lines[k] * lines[k]) >= nearly_all * whole) return k + 1;
    return lines.size();
  }
};

// Of `values` at `times` (s), evenly spaced, over as many whole cycles of `period` (s) as there are.
CycleOrders cycle_orders_of(const Eigen::VectorXd& values, const Eigen::VectorXd& times, double period) {
  CycleOrders orders;
  const auto n = values.size();
  if (n < 2) return orders;
  const double step = (times[n - 1] - times[0]) / static_cast<double>(n - 1);
  const auto cycles = std::floor((times[n - 1] - times[0] + step) / period);
  const auto used = std::min(n, static_cast<Eigen::Index>(std::llround(cycles * period / step)));
  if (used < 2) return orders;
  const auto highest = std::min(most_cycle_orders, static_cast<int>(0.5 * period / step) - 1);
  for (int order = 1; order <= highest; ++order) {
    std::complex<double> sum = 0.0;
    for (Eigen::Index k = 0; k < used; ++k)
      sum += values[k] * std::polar(1.0, -2.0 * std::numbers::pi * order * (times[k] - times[0]) / period);
    orders.lines.push_back(2.0 * std::abs(sum) / static_cast<double>(used));
  }
  return orders;
}

sim::Chart lift_chart(const Rehearsal& rehearsal, const machine::AxisModel& axis, const ShownUnits& units) {
  const auto motion = sim::cam::compose(rehearsal.cam->cam);
  const double unit = axis.coordinate.rotary() ? axis.coordinate.radius : 1.0;
  sim::Chart chart;
  chart.title = "Proposed lift: " + rehearsal.name;
  chart.x_label = "master, deg";
  chart.y_label = fmt::format("set position, {}", units.position.unit);
  chart.shape = {true, sim::Shape::Height::low};
  sim::Series series{.name = "proposed", .x = {}, .y = {}};
  for (int k = 0; k <= lift_places; ++k) {
    const double place = motion.cam.cycle() * k / lift_places;
    series.x.push_back(place * degrees_of_master);
    series.y.push_back(units.position(unit * motion.curve(place)));
  }
  chart.series = {std::move(series)};
  return chart;
}

sim::Series shown_orders(std::string name, const CycleOrders& orders) {
  sim::Series series{.name = std::move(name), .x = {}, .y = {}};
  const double largest = orders.lines.empty() ? 0.0 : orders.lines[orders.largest() - 1];
  for (std::size_t k = 0; k < orders.lines.size(); ++k) {
    series.x.push_back(static_cast<double>(k + 1));
    series.y.push_back(largest > 0.0 ? 100.0 * orders.lines[k] / largest : 0.0);
  }
  return series;
}

}  // namespace

CamPicture cam_picture(const Rehearsal& rehearsal, const CamSpectrum& spectrum, const machine::AxisModel& axis,
                       const ShownUnits& units) {
  const auto& cam = *rehearsal.cam;
  const double period = cam.cam.cycle() / cam.master_speed, one = 1.0 / period;
  const auto line = [&](std::size_t order) {
    return fmt::format("order {} ({:.3g} Hz)", order, static_cast<double>(order) * one);
  };
  CamPicture picture{{lift_chart(rehearsal, axis, units)}, {}};
  const auto& channels = rehearsal.log.axes.front();
  const auto count = static_cast<Eigen::Index>(rehearsal.log.t.size());
  const auto lift = cycle_orders_of(Eigen::Map<const Eigen::VectorXd>(channels.a_set.data(), count),
                                    Eigen::Map<const Eigen::VectorXd>(rehearsal.log.t.data(), count), period);
  if (lift.lines.empty()) return picture;

  sim::Chart chart;
  chart.title = "Spectrum of the proposed lift and of both candidates";
  chart.x_label = fmt::format("order of the master, {:.3g} Hz each", one);
  chart.y_label = "amplitude, % of the largest line";
  chart.caption = "The separating part is what neither the other candidate nor a nuisance imitates, over the noise.";
  chart.shape = {true, sim::Shape::Height::low};
  chart.series = {shown_orders("acceleration of the lift", lift)};
  picture.words = fmt::format(
      "At {} one order of the master is {:.3g} Hz. The acceleration of the lift is largest at {} and lies nearly all "
      "within {}.",
      cam.speed, one, line(lift.largest()), line(lift.end()));
  const auto& times = rehearsal.rows.time;
  for (const auto& [title, force] : spectrum.candidates) {
    const auto found = cycle_orders_of(force, times, period);
    if (found.lines.empty()) continue;
    chart.series.push_back(shown_orders(title, found));
    picture.words +=
        fmt::format(" {} acts most at {} and nearly all within {}.", title, line(found.largest()), line(found.end()));
  }
  const auto separating = cycle_orders_of(spectrum.separating, times, period);
  if (!separating.lines.empty()) {
    chart.series.push_back(shown_orders("separating part", separating));
    picture.words += fmt::format(" What separates them is largest at {}.", line(separating.largest()));
  }
  if (const auto frequency = load_of(axis).frequency)
    picture.words +=
        fmt::format(" The load oscillates on its shaft at {:.3g} Hz, order {:.3g}.", *frequency, *frequency / one);
  picture.charts.push_back(std::move(chart));
  return picture;
}

}  // namespace stiction::host
