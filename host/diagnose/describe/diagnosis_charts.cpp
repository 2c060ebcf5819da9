#include "host/diagnose/describe/diagnosis_charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "host/diagnose/verdict/chart_means.hpp"

namespace stiction::host {
namespace {

constexpr std::size_t most_points = 3000;

std::vector<double> thinned(const Eigen::VectorXd& values, std::size_t step, double factor = 1.0) {
  std::vector<double> kept;
  for (Eigen::Index i = 0; i < values.size(); i += static_cast<Eigen::Index>(step)) kept.push_back(factor * values[i]);
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

std::string axis_label(std::string_view quantity, const ShownQuantity& shown) {
  std::string unit = shown.unit;
  for (const auto& [plain, printed] :
       {std::pair<std::string_view, std::string_view>{"^2", "²"}, {"um", "µm"}, {"urad", "µrad"}})
    if (const auto at = unit.find(plain); at != std::string::npos) unit.replace(at, plain.size(), printed);
  return fmt::format("{}, {}", quantity, unit);
}

void add_charts(Verdict& verdict, const LogRows& rows, const Eigen::VectorXd& before, const Eigen::VectorXd& after) {
  // Over time: the first log alone, times of several overlap.
  const auto first = rows.logs().size() > 1 ? static_cast<Eigen::Index>(rows.logs()[1]) : rows.rows();
  const std::size_t step = static_cast<std::size_t>(first) / most_points + 1;
  const auto time = thinned(rows.time.head(first), step);
  sim::Chart over_time;
  over_time.title = "Residual force over time";
  over_time.x_label = "time, s";
  const auto& own = verdict.units;
  over_time.y_label = fmt::format("measured minus expected force, {}", own.force.unit);
  over_time.caption = "Measured motor force minus the force that the machine file predicts for the measured motion.";
  over_time.series = {
      of_machine_file({.name = {}, .x = time, .y = thinned(before.head(first), step, own.force.factor)}),
      of_extended({.name = {}, .x = time, .y = thinned(after.head(first), step, own.force.factor)})};
  over_time.shape = {true, sim::Shape::Height::usual};
  verdict.before_after.push_back(std::move(over_time));

  const auto position = rows.sampled([](const Motion& m) { return m.x; });
  struct Abscissa {
    const char *title, *label;
    const Eigen::VectorXd& values;
    ShownQuantity shown;
  };
  const Eigen::VectorXd shown_before = own.force.factor * before, shown_after = own.force.factor * after;
  for (const auto& a :
       {Abscissa{"Residual force over position", "position", position, own.position},
        Abscissa{"Residual force over speed", "velocity", rows.velocity, own.slow},
        Abscissa{"Residual force over acceleration", "acceleration", rows.acceleration, own.acceleration}}) {
    sim::Chart chart;
    chart.title = a.title;
    chart.x_label = axis_label(a.label, a.shown);
    chart.y_label = fmt::format("mean of measured minus expected force, {}", own.force.unit);
    chart.series = {of_machine_file(even_means("", a.values, a.shown.factor, shown_before)),
                    of_extended(even_means("", a.values, a.shown.factor, shown_after))};
    chart.levels = {0.0};
    verdict.before_after.push_back(std::move(chart));
  }
  sim::Chart frequencies;
  frequencies.title = "Spectrum of the residual force";
  frequencies.x_label = "frequency, Hz";
  frequencies.y_label = fmt::format("residual force, {}/√Hz", own.force.unit);
  frequencies.logarithmic_x = true;
  frequencies.series = {of_machine_file(spectrum(shown_before.head(first), rows.period(0))),
                        of_extended(spectrum(shown_after.head(first), rows.period(0)))};
  verdict.before_after.push_back(std::move(frequencies));
}

}  // namespace stiction::host
