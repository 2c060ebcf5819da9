#include "host/identify/sliding_curve.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>

#include "host/identify/fit_support.hpp"

namespace stiction::host {
namespace {

// A curve is sign * (level + sum of weighted terms of the speed); `term(i)` with its one nonlinear parameter.
struct CurveKind {
  const char* name;
  bool viscous;                                   // a term |v| stands beside
  double (*term)(double speed, double shape);     // none: nullptr
  std::vector<double> (*shapes)(double highest);  // trials of the nonlinear parameter
  const char* shape_name;                         // as --json shows it
  const char* term_name;
};

std::vector<double> spaced(double from, double to, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(from * std::pow(to / from, i / (count - 1.0)));
  return values;
}
std::vector<double> knees(double highest) { return spaced(0.02 * highest, 0.7 * highest, 8); }
std::vector<double> exponents(double) { return {0.15, 0.2, 0.25, 1.0 / 3.0, 0.4, 0.5, 0.65, 0.8}; }

const std::array<CurveKind, 4> kinds{{
    {"linear", true, nullptr, nullptr, nullptr, nullptr},
    {"two-slope", true, [](double v, double knee) { return std::max(v - knee, 0.0); }, knees, "knee_velocity_m_per_s",
     "slope_change_N_s_per_m"},
    {"exponential", true, [](double v, double v1) { return 1.0 - std::exp(-v / v1); }, knees,
     "exponential_velocity_m_per_s", "exponential_force_N"},
    {"power", false, [](double v, double p) { return std::pow(v, p); }, exponents, "exponent", "force_at_1_m_per_s_N"},
}};

// One column of all trials of all curves, and which belong to which.
struct Trials {
  Eigen::MatrixXd columns;                                     // others, sign, sign |v|, then the terms
  std::vector<std::vector<std::vector<std::size_t>>> choices;  // of each kind, of each trial
  std::vector<std::vector<double>> shapes;                     // of each kind
};

Eigen::VectorXd term_column(const SlidingData& data, const CurveKind& kind, double shape) {
  Eigen::VectorXd column(data.speed.size());
  for (Eigen::Index i = 0; i < column.size(); ++i) column[i] = data.sign[i] * kind.term(std::abs(data.speed[i]), shape);
  return column;
}

Trials trials_of(const SlidingData& data) {
  const Eigen::Index others = data.others.cols();
  const double highest = data.speed.cwiseAbs().maxCoeff();
  Trials trials;
  std::vector<Eigen::VectorXd> terms;
  for (const auto& kind : kinds) {
    std::vector<std::size_t> base(static_cast<std::size_t>(others) + 1);
    std::iota(base.begin(), base.end(), 0);
    if (kind.viscous) base.push_back(base.size());
    trials.shapes.push_back(kind.term != nullptr ? kind.shapes(highest) : std::vector<double>{0.0});
    trials.choices.emplace_back();
    for (const double shape : trials.shapes.back()) {
      trials.choices.back().push_back(base);
      if (kind.term == nullptr) continue;
      trials.choices.back().back().push_back(static_cast<std::size_t>(others) + 2 + terms.size());
      terms.push_back(term_column(data, kind, shape));
    }
  }
  trials.columns.resize(data.speed.size(), others + 2 + static_cast<Eigen::Index>(terms.size()));
  trials.columns.leftCols(others) = data.others;
  trials.columns.col(others) = data.sign;
  trials.columns.col(others + 1) = data.sign.cwiseProduct(data.speed.cwiseAbs());
  for (std::size_t i = 0; i < terms.size(); ++i)
    trials.columns.col(others + 2 + static_cast<Eigen::Index>(i)) = terms[i];
  return trials;
}

// Others, sign, sign |v| where the curve has it, the term.
Eigen::MatrixXd columns_of(const SlidingData& data, const CurveKind& kind, double shape) {
  const Eigen::Index others = data.others.cols();
  Eigen::MatrixXd columns(data.speed.size(), others + 1 + (kind.viscous ? 1 : 0) + (kind.term != nullptr ? 1 : 0));
  columns.leftCols(others) = data.others;
  columns.col(others) = data.sign;
  if (kind.viscous) columns.col(others + 1) = data.sign.cwiseProduct(data.speed.cwiseAbs());
  if (kind.term != nullptr) columns.rightCols(1) = term_column(data, kind, shape);
  return columns;
}

// The nonlinear parameter with the least residual: the best trial, then golden sections between its neighbours.
double best_shape(const SlidingData& data, const BlockRegression& regression, const Trials& trials, std::size_t kind) {
  if (kinds[kind].term == nullptr) return 0.0;
  const auto& shapes = trials.shapes[kind];
  std::size_t best = 0;
  double least = INFINITY;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const auto& chosen = trials.choices[kind][i];
    const double left = regression.residual_sum(chosen, regression.solve(chosen));
    if (left >= least) continue;
    least = left;
    best = i;
  }
  const auto left_over = [&](double logarithm) {
    const auto columns = columns_of(data, kinds[kind], std::exp(logarithm));
    return (data.force - columns * fitting::weights_of(columns, data.force)).squaredNorm();
  };
  constexpr double golden = 0.6180339887498949;
  double low = std::log(shapes[best > 0 ? best - 1 : 0]),
         high = std::log(shapes[std::min(best + 1, shapes.size() - 1)]);
  double a = high - golden * (high - low), b = low + golden * (high - low);
  double of_a = left_over(a), of_b = left_over(b);
  while (high - low > 1e-3) {
    if (of_a < of_b) {
      high = b;
      b = a;
      of_b = of_a;
      of_a = left_over(a = high - golden * (high - low));
    } else {
      low = a;
      a = b;
      of_a = of_b;
      of_b = left_over(b = low + golden * (high - low));
    }
  }
  return std::exp(0.5 * (low + high));
}

// Whether the data have a least within the trials. At an end of them they ask for more than what was tried, and what is
// linear about the value there does not hold.
bool within_trials(double shape, const std::vector<double>& shapes) {
  constexpr double end = 1.005;  // the sections stop a thousandth before it
  return shapes.size() < 2 || (shape > shapes.front() * end && shape < shapes.back() / end);
}

std::vector<MeasuredPoint> measured_points(const SlidingData& data, const Eigen::VectorXd& friction,
                                           double correlation) {
  struct Bin {
    double speed = 0.0, force = 0.0, square = 0.0;
    int count = 0;
  };
  std::map<std::pair<int, int>, Bin> bins;  // direction; eighth of a decade of the speed
  for (Eigen::Index i = 0; i < friction.size(); ++i) {
    const double speed = std::abs(data.speed[i]);
    if (speed <= 0.0) continue;
    auto& bin = bins[{data.sign[i] > 0.0 ? 1 : 0, static_cast<int>(std::floor(8.0 * std::log10(speed)))}];
    bin.speed += speed;
    bin.force += friction[i];
    bin.square += friction[i] * friction[i];
    ++bin.count;
  }
  // Rows caught while passing through a speed say nothing about it; in a table every row was waited for.
  const int least = data.blocks.size() == static_cast<std::size_t>(friction.size()) ? 1 : 5;
  std::vector<MeasuredPoint> points;
  for (const auto& [key, bin] : bins) {
    if (bin.count < least) continue;
    const double n = bin.count, mean = bin.force / n;
    const double variance = std::max(bin.square / n - mean * mean, 0.0);
    const double direction = key.first == 1 ? 1.0 : -1.0;
    points.push_back({direction * bin.speed / n, mean, std::sqrt(variance / std::max(n / correlation, 1.0))});
  }
  return points;
}

// Curve and band at the speeds between the slowest and the fastest of the data, evenly in their logarithm.
std::vector<CurvePoint> curve_points(const SlidingData& data, const CurveKind& kind, double shape,
                                     const Eigen::RowVectorXd& centre, const Eigen::MatrixXd& replicates) {
  const Eigen::Index others = data.others.cols(), first_term = others + 1;
  const auto at = [&](const Eigen::RowVectorXd& w, double v) {
    double force = w[others];
    Eigen::Index next = first_term;
    if (kind.viscous) force += w[next++] * v;
    if (kind.term == nullptr) return force;
    const double moved = shape * std::exp(std::clamp(w[next + 1], -2.0, 2.0));
    return force + w[next] * kind.term(v, moved);
  };
  double slowest = INFINITY, highest = 0.0;
  for (Eigen::Index i = 0; i < data.speed.size(); ++i) {
    const double v = std::abs(data.speed[i]);
    if (v > 0.0) slowest = std::min(slowest, v);
    highest = std::max(highest, v);
  }
  std::vector<CurvePoint> points;
  for (const double v : spaced(std::max(slowest, 1e-4 * highest), highest, 60)) {
    const auto band = interval_95(fitting::replicate(replicates, [&](const auto& w) { return at(w, v); }));
    points.push_back({v, at(centre, v), band.low, band.high});
  }
  return points;
}

}  // namespace

SlidingData sliding_data(const LogRows& rows, const FrictionFit& fit) {
  std::vector<Eigen::Index> kept;
  std::vector<std::size_t> new_place(static_cast<std::size_t>(rows.rows()) + 1);
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    new_place[static_cast<std::size_t>(i)] = kept.size();
    if (std::abs(fit.contact[i]) > 0.98 && fit.contact[i] * rows.velocity[i] > 0.0) kept.push_back(i);
  }
  new_place.back() = kept.size();
  SlidingData data;
  data.speed = rows.velocity(kept);
  data.sign = data.speed.cwiseSign();
  data.force = rows.force(kept);
  // A weight goes with the angle, and its friction with both.
  const bool weighed = !rows.motions().front().constant.empty();
  const bool rises = fit.find("load_coefficient") != nullptr;
  data.others.resize(data.speed.size(), rises ? 3 : 2);
  data.others.col(0) = rows.acceleration(kept);
  if (weighed)
    data.others.col(1) = rows.one(kept);
  else
    data.others.col(1).setOnes();
  if (rises) data.others.col(2) = fit.columns.col(fitting::risen_level)(kept);
  for (const auto& block : fit.blocks)
    if (new_place[block.end] > new_place[block.begin])
      data.blocks.push_back({new_place[block.begin], new_place[block.end]});
  return data;
}

SlidingCurve choose_sliding_curve(const SlidingData& data, double correlation, const FitSettings& settings) {
  SlidingCurve result;
  const auto trials = trials_of(data);
  const BlockRegression regression(trials.columns, data.force, data.blocks);
  const std::size_t folds = std::min<std::size_t>(10, data.blocks.size());
  std::size_t chosen = 0;
  double shape = 0.0;  // of the chosen one; the straight line has none
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    result.errors.push_back({kinds[k].name, std::sqrt(regression.held_out(trials.choices[k], folds))});
    const double best = result.errors[chosen].held_out, linear = result.errors[0].held_out;
    const double error = result.errors[k].held_out;
    if (!(error < best && error * error < 0.99 * linear * linear)) continue;
    const double found = best_shape(data, regression, trials, k);
    if (!within_trials(found, trials.shapes[k])) continue;
    chosen = k;
    shape = found;
  }
  const auto& kind = kinds[chosen];
  result.curve = kind.name;

  const Eigen::Index others = data.others.cols();
  Eigen::MatrixXd columns = columns_of(data, kind, shape);
  const Eigen::Index linear_columns = columns.cols();
  Eigen::RowVectorXd centre = fitting::weights_of(columns, data.force).transpose();
  const Eigen::VectorXd friction = (data.force - data.others * centre.head(others).transpose()).eval();
  if (kind.term != nullptr) {  // the change with the logarithm of the nonlinear parameter
    constexpr double step = 1e-3;
    Eigen::MatrixXd wider(columns.rows(), linear_columns + 1);
    wider << columns,
        (term_column(data, kind, shape * std::exp(step)) - term_column(data, kind, shape * std::exp(-step))) *
            (centre[linear_columns - 1] / (2.0 * step));
    columns = std::move(wider);
    centre.conservativeResize(linear_columns + 1);
    centre[linear_columns] = 0.0;
  }
  const auto replicates =
      BlockRegression(columns, data.force, data.blocks).bootstrap(settings.replicates, settings.seed);
  FrictionFit named;
  fitting::add(named, "coulomb_N", centre, replicates, [=](const auto& w) { return w[others]; });
  if (kind.viscous)
    fitting::add(named, "viscous_N_s_per_m", centre, replicates, [=](const auto& w) { return w[others + 1]; });
  if (kind.term != nullptr) {
    fitting::add(named, kind.term_name, centre, replicates, [=](const auto& w) { return w[linear_columns - 1]; });
    fitting::add(named, kind.shape_name, centre, replicates,
                 [=](const auto& w) { return shape * std::exp(std::clamp(w[linear_columns], -2.0, 2.0)); });
  }
  result.parameters = std::move(named.parameters);
  result.points = curve_points(data, kind, shape, centre, replicates);
  result.measured = measured_points(data, friction, correlation);
  return result;
}

}  // namespace stiction::host
