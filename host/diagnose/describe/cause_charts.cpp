#include <cmath>
#include <string_view>

#include "host/diagnose/classes/candidate_columns.hpp"
#include "host/diagnose/describe/diagnosis_charts.hpp"
#include "host/diagnose/verdict/chart_means.hpp"

namespace stiction::host {
namespace {

constexpr double creeping = 1e-5;  // m/s; a slower motion has no direction that can be trusted

Eigen::VectorXd direction(const LogRows& rows) {
  return rows.velocity.unaryExpr([](double v) { return v > creeping ? 1.0 : v < -creeping ? -1.0 : 0.0; });
}

// Way since the motion last turned round, at the log's rate.
std::vector<double> since_reversal(const Motion& motion) {
  std::vector<double> way;
  double turned = motion.x.front(), sign = 0.0;
  for (std::size_t i = 0; i < motion.x.size(); ++i) {
    const double v = motion.v[i];
    const double now = v > creeping ? 1.0 : v < -creeping ? -1.0 : sign;
    if (now != sign) turned = motion.x[i];
    sign = now;
    way.push_back(std::abs(motion.x[i] - turned));
  }
  return way;
}

// What a cause's force is shown over. `opposing`: as a friction, positive when it opposes the motion.
struct Abscissa {
  std::string_view title, label;
  Eigen::VectorXd (*values)(const LogRows&);  // SI
  ShownQuantity ShownUnits::*shown;           // none: as they are
  bool opposing = false;
  bool logarithmic = false;
};

Eigen::VectorXd position(const LogRows& rows) {
  return rows.sampled([](const Motion& m) { return m.x; });
}
Eigen::VectorXd velocity(const LogRows& rows) { return rows.velocity; }
Eigen::VectorXd speed(const LogRows& rows) { return rows.velocity.cwiseAbs().cwiseMax(creeping); }
Eigen::VectorXd acceleration(const LogRows& rows) { return rows.acceleration; }
Eigen::VectorXd time(const LogRows& rows) {
  return rows.sampled([](const Motion& m) { return m.t; });
}
Eigen::VectorXd way(const LogRows& rows) { return rows.sampled(since_reversal).cwiseMax(1e-8); }

constexpr Abscissa over_position{"Along the stroke", "position", position, &ShownUnits::position};
constexpr Abscissa over_velocity{"Over velocity", "velocity", velocity, &ShownUnits::slow};
constexpr Abscissa over_speed{"Over speed", "speed", speed, &ShownUnits::slow, true, true};
constexpr Abscissa over_acceleration{"Over acceleration", "acceleration", acceleration, &ShownUnits::acceleration};
constexpr Abscissa over_time{"Over time", "time since the start of the record, s", time, nullptr, true};
constexpr Abscissa after_reversals{
    "After reversals", "displacement since the last reversal", way, &ShownUnits::deviation, true, true};

// Null where nothing but the effect's own force is worth it.
const Abscissa* abscissa_of(sim::Abscissa abscissa) {
  switch (abscissa) {
    case sim::Abscissa::position:
      return &over_position;
    case sim::Abscissa::velocity:
      return &over_velocity;
    case sim::Abscissa::speed:
      return &over_speed;
    case sim::Abscissa::acceleration:
      return &over_acceleration;
    case sim::Abscissa::since_reversal:
      return &after_reversals;
    case sim::Abscissa::time:
      return &over_time;
    case sim::Abscissa::own_force:
    case sim::Abscissa::none:
      return nullptr;
  }
  return nullptr;
}

sim::Chart partial(const LogRows& rows, const ShownUnits& own, const Abscissa& abscissa, const Eigen::VectorXd& left,
                   const Eigen::VectorXd& by) {
  sim::Chart chart;
  chart.title = abscissa.title;
  const bool plain = abscissa.shown == nullptr;
  chart.x_label = plain ? std::string(abscissa.label) : axis_label(abscissa.label, own.*abscissa.shown);
  chart.y_label = axis_label(abscissa.opposing ? "force against the motion" : "force", own.force);
  chart.caption =
      "Means over equal numbers of samples: residual force without the parts of all other causes, and force of this "
      "cause.";
  chart.logarithmic_x = abscissa.logarithmic;
  chart.levels = {0.0};
  const Eigen::VectorXd sign = abscissa.opposing ? direction(rows) : Eigen::VectorXd::Ones(rows.rows());
  const Eigen::VectorXd over = abscissa.values(rows);
  const double scale = plain ? 1.0 : (own.*abscissa.shown).factor;
  const auto mean = [&](const char* name, const Eigen::VectorXd& force) {
    const Eigen::VectorXd signed_force = own.force.factor * sign.cwiseProduct(force);
    return abscissa.logarithmic ? means(name, over, scale, signed_force) : even_means(name, over, scale, signed_force);
  };
  auto residual = mean("residual without this cause", left);
  residual.points = true;
  chart.series = {std::move(residual), mean("this cause", by)};
  return chart;
}

// Against the cause's own force: what is right lies on the diagonal.
sim::Chart added_variable(const ShownUnits& own, const Eigen::VectorXd& left, const Eigen::VectorXd& by) {
  sim::Chart chart;
  chart.title = "Residual against this cause";
  chart.x_label = axis_label("force of this cause", own.force);
  chart.y_label = axis_label("residual force without it", own.force);
  chart.caption =
      "Means over equal numbers of samples, without the parts of all other causes. On the line the cause explains the "
      "residual completely.";
  auto residual = means("residual without this cause", by, own.force.factor, own.force.factor * left, 40);
  residual.points = true;
  sim::Series line{.name = "this cause", .x = residual.x, .y = residual.x};
  chart.series = {std::move(residual), std::move(line)};
  return chart;
}

}  // namespace

void add_cause_charts(Verdict& verdict, const LogRows& rows, const SearchContext& context,
                      const std::vector<Term>& terms, const Eigen::VectorXd& after) {
  for (std::size_t k = 0; k < terms.size() && k < verdict.findings.size(); ++k) {
    const auto by =
        weighted_columns(rows, context, candidates()[terms[k].candidate], terms[k].shape, terms[k].coefficients);
    const Eigen::VectorXd left = after + by;
    auto& finding = verdict.findings[k];
    if (const auto* abscissa = abscissa_of(finding.effect->abscissa))
      finding.charts.push_back(partial(rows, verdict.units, *abscissa, left, by));
    finding.charts.push_back(added_variable(verdict.units, left, by));
  }
}

}  // namespace stiction::host
