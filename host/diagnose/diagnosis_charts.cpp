#include "host/diagnose/diagnosis_charts.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "host/diagnose/chart_means.hpp"

namespace stiction::host {
namespace {

constexpr std::size_t most_points = 3000;

std::vector<double> thinned(const Eigen::VectorXd& values, std::size_t step) {
  std::vector<double> kept;
  for (Eigen::Index i = 0; i < values.size(); i += static_cast<Eigen::Index>(step)) kept.push_back(values[i]);
  return kept;
}

// Root of the power density of the first log's rows, N/sqrt(Hz): Welch's mean over windows of 4 s, half overlapping.
sim::Series spectrum(const Eigen::VectorXd& values, double period) {
  sim::Series series;
  const auto length = std::min<Eigen::Index>(values.size(), static_cast<Eigen::Index>(4.0 / period));
  const auto hop = std::max<Eigen::Index>(length / 2, 1);
  const double pi = std::numbers::pi;
  for (double f = 0.5; f < 0.4 / period; f *= 1.03) {
    double power = 0.0, windows = 0.0;
    for (Eigen::Index begin = 0; begin + length <= values.size(); begin += hop) {
      std::complex<double> sum = 0.0;
      const auto turn = std::polar(1.0, -2.0 * pi * f * period);
      std::complex<double> phase = 1.0;
      for (Eigen::Index i = 0; i < length; ++i, phase *= turn)
        sum += values[begin + i] * phase *
               (1.0 - std::cos(2.0 * pi * static_cast<double>(i) / static_cast<double>(length)));
      power += std::norm(sum) * 2.0 * period / (1.5 * static_cast<double>(length));
      windows += 1.0;
    }
    series.x.push_back(f);
    series.y.push_back(std::sqrt(power / windows));
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
  over_time.x_label = "time, s";
  over_time.y_label = "measured minus expected force, N";
  over_time.caption = "Measured motor force minus the force that the machine file predicts for the measured motion.";
  over_time.series = {of_machine_file({.name = {}, .x = time, .y = thinned(before.head(first), step)}),
                      of_extended({.name = {}, .x = time, .y = thinned(after.head(first), step)})};
  over_time.shape = {true, sim::Shape::Height::usual};
  verdict.before_after.push_back(std::move(over_time));

  const auto position = rows.sampled([](const Motion& m) { return m.x; });
  struct Abscissa {
    const char *title, *label;
    const Eigen::VectorXd& values;
    double scale;
  };
  for (const auto& a : {Abscissa{"Residual force over position", "position, mm", position, 1e3},
                        Abscissa{"Residual force over speed", "velocity, mm/s", rows.velocity, 1e3},
                        Abscissa{"Residual force over acceleration", "acceleration, m/s²", rows.acceleration, 1.0}}) {
    sim::Chart chart;
    chart.title = a.title;
    chart.x_label = a.label;
    chart.y_label = "mean of measured minus expected force, N";
    chart.series = {of_machine_file(even_means("", a.values, a.scale, before)),
                    of_extended(even_means("", a.values, a.scale, after))};
    chart.levels = {0.0};
    verdict.before_after.push_back(std::move(chart));
  }
  sim::Chart frequencies;
  frequencies.title = "Spectrum of the residual force";
  frequencies.x_label = "frequency, Hz";
  frequencies.y_label = "residual force, N/√Hz";
  frequencies.logarithmic_x = true;
  frequencies.series = {of_machine_file(spectrum(before.head(first), rows.period(0))),
                        of_extended(spectrum(after.head(first), rows.period(0)))};
  verdict.before_after.push_back(std::move(frequencies));
}

}  // namespace stiction::host
