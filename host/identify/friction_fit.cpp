#include "host/identify/friction_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "host/identify/fit_support.hpp"
#include "sim/plant/friction/coulomb_viscous.hpp"

namespace stiction::host {

using namespace fitting;

const FittedParameter* FrictionFit::find(std::string_view name) const {
  const auto found = std::find_if(parameters.begin(), parameters.end(), [&](const auto& p) { return p.name == name; });
  return found == parameters.end() ? nullptr : &*found;
}
const FittedParameter& FrictionFit::at(std::string_view name) const {
  if (const auto* parameter = find(name)) return *parameter;
  throw std::out_of_range(std::string(name));
}

FrictionFit fit_coulomb_viscous(const LogRows& rows, const FitSettings& settings) {
  FrictionFit fit;
  fit.model = std::string(sim::CoulombViscous<>::name);
  fit.contact = rows.stacked([](const Motion& m) {
    std::vector<double> sign(m.v.size());
    std::transform(m.v.begin(), m.v.end(), sign.begin(), [](double v) { return v > 0.0 ? 1.0 : v < 0.0 ? -1.0 : 0.0; });
    return sign;
  });
  fit.columns.resize(rows.rows(), 4);
  fit.columns << rows.acceleration, rows.velocity, rows.one, fit.contact;
  fit.weights = weights_of(fit.columns, rows.force);
  fit.residual = rows.force - fit.columns * fit.weights;
  choose_blocks(fit, rows);
  const auto replicates =
      BlockRegression(fit.columns, rows.force, fit.blocks).bootstrap(settings.replicates, settings.seed);
  const Eigen::RowVectorXd centre = fit.weights.transpose();
  add_sliding_parameters(fit, centre, replicates);
  return fit;
}

std::vector<FittedParameter> fit_directions(const LogRows& rows, const FrictionFit& fit, const FitSettings& settings) {
  const Eigen::Index base = fit.columns.cols();
  Eigen::MatrixXd columns(rows.rows(), base + 1);
  columns << fit.columns, rows.stacked([](const Motion& m) {
    std::vector<double> speed(m.v.size());
    std::transform(m.v.begin(), m.v.end(), speed.begin(), [](double v) { return std::abs(v); });
    return speed;
  });
  const BlockRegression regression(columns, rows.force, fit.blocks);
  const auto replicates = regression.bootstrap(settings.replicates, settings.seed);
  const Eigen::RowVectorXd centre = regression.solve().transpose();
  FrictionFit both;
  add(both, "viscous_positive_N_s_per_m", centre, replicates, [=](const auto& w) { return w[velocity] + w[base]; });
  add(both, "viscous_negative_N_s_per_m", centre, replicates, [=](const auto& w) { return w[velocity] - w[base]; });
  add(both, "coulomb_positive_N", centre, replicates, [](const auto& w) { return w[level] + w[one]; });
  add(both, "coulomb_negative_N", centre, replicates, [](const auto& w) { return w[level] - w[one]; });
  return both.parameters;
}

MaxwellSlipFit fit_maxwell_slip(const LogRows& rows) {
  // Slip distances from 0.25 um to 1 mm, two an octave's worth of three: finer ones share their weights at random.
  constexpr int elements = 13;
  Eigen::MatrixXd columns(rows.rows(), 3 + elements);
  columns.col(acceleration) = rows.acceleration;
  columns.col(velocity) = rows.velocity;
  columns.col(one) = rows.one;
  std::array<double, elements> distance{};
  for (int i = 0; i < elements; ++i) {
    distance[static_cast<std::size_t>(i)] = 0.25e-6 * std::pow(4000.0, i / (elements - 1.0));
    columns.col(3 + i) =
        rows.stacked([&](const Motion& m) { return stop_operator(m, distance[static_cast<std::size_t>(i)]); });
  }
  const auto weights = solve_not_negative(columns, rows.force, 3);
  MaxwellSlipFit fit{{}, weights[acceleration], weights[velocity], weights[one], rows.force - columns * weights};
  for (int i = 0; i < elements; ++i)
    if (weights[3 + i] > 0.0)
      fit.elements.push_back({weights[3 + i], weights[3 + i] * distance[static_cast<std::size_t>(i)]});
  return fit;
}

}  // namespace stiction::host
