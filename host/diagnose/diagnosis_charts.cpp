#include "host/diagnose/diagnosis_charts.hpp"

#include <algorithm>
#include <numeric>

namespace stiction::host {
namespace {

constexpr std::size_t most_points = 3000;

std::vector<double> thinned(const Eigen::VectorXd& values, std::size_t step) {
  std::vector<double> kept;
  for (Eigen::Index i = 0; i < values.size(); i += static_cast<Eigen::Index>(step)) kept.push_back(values[i]);
  return kept;
}

// Mean of `values` in equally filled ranges of `over`.
sim::Series means(const char* name, const Eigen::VectorXd& over, double scale, const Eigen::VectorXd& values) {
  constexpr std::size_t ranges = 60;
  std::vector<Eigen::Index> order(static_cast<std::size_t>(over.size()));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return over[a] < over[b]; });
  sim::Series series{.name = name, .x = {}, .y = {}};
  for (std::size_t k = 0; k < ranges; ++k) {
    const std::size_t from = order.size() * k / ranges, to = order.size() * (k + 1) / ranges;
    if (to == from) continue;
    double x = 0.0, y = 0.0;
    for (std::size_t i = from; i < to; ++i) {
      x += over[order[i]] / static_cast<double>(to - from);
      y += values[order[i]] / static_cast<double>(to - from);
    }
    series.x.push_back(scale * x);
    series.y.push_back(y);
  }
  return series;
}

}  // namespace

void add_charts(Verdict& verdict, const LogRows& rows, const Eigen::VectorXd& before, const Eigen::VectorXd& after) {
  // Over time: the first log alone, times of several overlap.
  const auto first = rows.logs().size() > 1 ? static_cast<Eigen::Index>(rows.logs()[1]) : rows.rows();
  const std::size_t step = static_cast<std::size_t>(first) / most_points + 1;
  const auto time = thinned(rows.time.head(first), step);
  sim::Chart over_time;
  over_time.title = "Residual force over time";
  over_time.x_label = "time (s)";
  over_time.y_label = "measured minus expected force (N)";
  over_time.caption = "What the motor's force holds beyond what the machine file expects of the measured motion.";
  over_time.series = {{.name = "machine file", .x = time, .y = thinned(before.head(first), step)},
                      {.name = "extended", .x = time, .y = thinned(after.head(first), step)}};
  over_time.shape = {true, sim::Shape::Height::usual};
  verdict.before_after.push_back(std::move(over_time));

  const auto position = rows.sampled([](const Motion& m) { return m.x; });
  struct Abscissa {
    const char *title, *label;
    const Eigen::VectorXd& values;
    double scale;
  };
  for (const auto& a : {Abscissa{"Residual force over position", "position (mm)", position, 1e3},
                        Abscissa{"Residual force over speed", "velocity (mm/s)", rows.velocity, 1e3},
                        Abscissa{"Residual force over acceleration", "acceleration (m/s²)", rows.acceleration, 1.0}}) {
    sim::Chart chart;
    chart.title = a.title;
    chart.x_label = a.label;
    chart.y_label = "mean of measured minus expected force (N)";
    chart.series = {means("machine file", a.values, a.scale, before), means("extended", a.values, a.scale, after)};
    verdict.before_after.push_back(std::move(chart));
  }
}

}  // namespace stiction::host
