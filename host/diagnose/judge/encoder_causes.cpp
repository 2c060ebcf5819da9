#include "host/diagnose/judge/encoder_causes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/diagnose/classes/effect_regressor.hpp"
#include "host/diagnose/judge/holdout.hpp"
#include "host/diagnose/statistics/evidence.hpp"
#include "host/diagnose/statistics/level.hpp"
#include "host/diagnose/statistics/most_odds.hpp"
#include "host/diagnose/verdict/chart_means.hpp"
#include "host/identify/identification.hpp"
#include "sim/effects/effects.hpp"

namespace stiction::host {
namespace {

struct EncoderOption {
  sim::EffectId effect;
  const EncoderCause* cause;
  double shape;
};

std::vector<EncoderOption> encoder_options_of(const machine::AxisModel& axis) {
  std::vector<EncoderOption> options;
  for (const auto effect : sim::all_effects())
    if (const auto* regressor = regressor_of(effect); regressor != nullptr && regressor->encoders.columns != nullptr)
      for (const double shape : regressor->encoders.grid(axis))
        options.push_back({effect, &regressor->encoders, shape});
  return options;
}

struct EncoderTerm {
  std::size_t option;
  ColumnIndices columns;
  double p_value = 1.0;
};

// The columns of all options beside the nuisances, and what a choice of them explains of the training records.
class EncoderChoice {
 public:
  EncoderChoice(const EncoderDifference& difference, const std::vector<EncoderOption>& options,
                const machine::AxisModel& axis)
      : options_(options), axis_(axis), evidence_(difference.target(), blocks_for(difference)) {
    for (const auto& nuisance : difference.nuisances())
      if (nuisance.squaredNorm() > 0.0) nuisances_.push_back(evidence_.add({nuisance}));
    for (const auto& option : options) {
      const auto columns = difference.columns(*option.cause, option.shape);
      const auto first = evidence_.add(columns);
      columns_.emplace_back();
      for (std::size_t k = 0; k < columns.size(); ++k) columns_.back().push_back(first + static_cast<Eigen::Index>(k));
    }
  }

  // The best one is added as long as there is one.
  std::vector<EncoderTerm> run() const {
    std::vector<EncoderTerm> terms;
    while (const auto best = best_beside(terms)) terms.push_back(*best);
    return terms;
  }
  // Weights of the `terms`, one behind the other, with the nuisances behind them.
  ColumnIndices all(const std::vector<EncoderTerm>& terms) const {
    ColumnIndices chosen;
    for (const auto& term : terms) chosen.insert(chosen.end(), term.columns.begin(), term.columns.end());
    chosen.insert(chosen.end(), nuisances_.begin(), nuisances_.end());
    return chosen;
  }
  const Evidence& evidence() const { return evidence_; }

 private:
  static std::vector<RowBlock> blocks_for(const EncoderDifference& difference) {
    const auto& rows = difference.rows();
    const auto n = static_cast<double>(rows.rows());
    const double correlation = correlation_length(difference.target(), rows.logs());
    return blocks_of(rows.velocity, rows.logs(),
                     static_cast<std::size_t>(std::clamp(6.0 * correlation, n / 100.0, n / 30.0)) + 1);
  }
  std::optional<EncoderTerm> best_beside(const std::vector<EncoderTerm>& terms) const {
    std::optional<EncoderTerm> best;
    double least = evidence_.fit(all(terms)).left;
    for (std::size_t k = 0; k < options_.size(); ++k) {
      if (std::ranges::any_of(terms, [&](const EncoderTerm& term) { return term.option == k; })) continue;
      auto trial = terms;
      trial.insert(trial.begin(), {k, columns_[k]});
      const auto chosen = all(trial);
      const auto fit = evidence_.fit(chosen);
      if (fit.left >= least) continue;
      const auto count = static_cast<Eigen::Index>(columns_[k].size());
      if (!options_[k].cause->possible(axis_, options_[k].shape, fit.coefficients.head(count))) continue;
      const double p_value = evidence_.test(chosen, fit.coefficients, 0, count).p_value;
      if (most_odds(p_value) < loss_ratio * static_cast<double>(options_.size())) continue;
      if (!foretells(terms, trial)) continue;
      least = fit.left;
      best = {k, columns_[k], p_value};
    }
    return best;
  }
  // Whether the last of the `terms` helps in the blocks whose weights are the others', and not by one odd event.
  bool foretells(const std::vector<EncoderTerm>& without, const std::vector<EncoderTerm>& terms) const {
    const auto before = evidence_.held_out(all(without)), after = evidence_.held_out(all(terms));
    double gained = 0.0, most = 0.0;
    for (std::size_t k = 0; k < before.size(); ++k) {
      gained += before[k] - after[k];
      most = std::max(most, before[k] - after[k]);
    }
    return gained > 0.0 && most < 0.8 * gained;
  }

  const std::vector<EncoderOption>& options_;
  const machine::AxisModel& axis_;
  Evidence evidence_;
  ColumnIndices nuisances_;
  std::vector<ColumnIndices> columns_;
};

// The difference of the held-out records less `of_causes`, with their own nuisances taken off.
Eigen::VectorXd left_of_difference(const EncoderDifference& difference, const Eigen::VectorXd& of_causes) {
  const Eigen::VectorXd target = difference.target() - of_causes;
  Eigen::MatrixXd nuisances(target.size(), static_cast<Eigen::Index>(difference.nuisances().size()));
  for (std::size_t k = 0; k < difference.nuisances().size(); ++k)
    nuisances.col(static_cast<Eigen::Index>(k)) = difference.nuisances()[k];
  return target - nuisances * nuisances.completeOrthogonalDecomposition().solve(target);
}

sim::Chart twist_over_force(const EncoderDifference& difference, const Eigen::VectorXd& explained,
                            const machine::AxisModel& axis, const ShownUnits& units) {
  const double stiffness = *axis.transmission->stiffness;
  const Eigen::VectorXd force = difference.force();
  const Eigen::VectorXd file = -force / stiffness;
  const auto shown = [&](const Eigen::VectorXd& values) -> Eigen::VectorXd {
    return units.deviation.factor * (values.array() - values.mean());
  };
  sim::Chart chart;
  chart.title = "Load against motor over the force in the shaft";
  chart.x_label = fmt::format("{} through the shaft, by the motor's current, {}", units.force_word, units.force.unit);
  chart.y_label = fmt::format("load ahead of motor, {}", units.deviation.unit);
  auto measured = even_means("measured", force, units.force.factor, shown(difference.measured()), 60);
  measured.role = sim::SeriesRole::measured;
  chart.series = {std::move(measured), of_machine_file(even_means("", force, units.force.factor, shown(file), 60)),
                  of_extended(even_means("", force, units.force.factor, shown(file + explained), 60))};
  return chart;
}

// Over the turn of the wheel in which the cause returns.
sim::Chart error_over_turn(const Eigen::VectorXd& before, const Eigen::VectorXd& after, const Eigen::VectorXd& load,
                           const Finding& finding, const machine::AxisModel& axis, const ShownUnits& units) {
  const double per = finding.values.at("per").front();
  const double turn = 2.0 * std::numbers::pi * axis.transmission->ratio * axis.motor_coordinate.radius / per;  // m
  const Eigen::VectorXd angle = load.unaryExpr([&](double x) { return 360.0 * (x / turn - std::floor(x / turn)); });
  sim::Chart chart;
  chart.title = "Load against motor over the wheel's turn";
  chart.x_label = "angle of the wheel, deg";
  chart.y_label = fmt::format("load further ahead of its motor than by the file, {}", units.deviation.unit);
  chart.series = {of_machine_file(even_means("", angle, 1.0, units.deviation.factor * before, 120)),
                  of_extended(even_means("", angle, 1.0, units.deviation.factor * after, 120))};
  chart.levels = {0.0};
  return chart;
}

}  // namespace

EncoderCauses find_between_encoders(const EncoderDifference& training, const EncoderDifference& held_out,
                                    const machine::AxisModel& axis, const ShownUnits& units, std::uint64_t seed) {
  EncoderCauses found;
  const auto options = encoder_options_of(axis);
  const EncoderChoice choice(training, options, axis);
  const auto terms = choice.run();
  if (terms.empty()) return found;
  const auto chosen = choice.all(terms);
  const auto& evidence = choice.evidence();
  const auto fit = evidence.fit(chosen);
  const auto covariance = evidence.interval_covariance(chosen, fit.coefficients);
  const Eigen::VectorXd left = evidence.residual(chosen, fit.coefficients);

  // What each term makes of the held-out records.
  std::vector<Eigen::VectorXd> in_training, in_held_out;
  std::vector<Eigen::Index> begins;
  Eigen::Index begin = 0;
  for (const auto& term : terms) {
    const auto& option = options[term.option];
    const auto sum = [&](const std::vector<Eigen::VectorXd>& columns) {
      Eigen::VectorXd all = Eigen::VectorXd::Zero(columns.front().size());
      for (std::size_t k = 0; k < columns.size(); ++k)
        all += fit.coefficients[begin + static_cast<Eigen::Index>(k)] * columns[k];
      return all;
    };
    in_training.push_back(sum(training.columns(*option.cause, option.shape)));
    in_held_out.push_back(sum(held_out.columns(*option.cause, option.shape)));
    begins.push_back(begin);
    begin += static_cast<Eigen::Index>(term.columns.size());
  }
  const Eigen::VectorXd all_of_them = std::accumulate(in_held_out.begin(), in_held_out.end(),
                                                      Eigen::VectorXd(Eigen::VectorXd::Zero(held_out.rows().rows())));
  const auto after = left_of_difference(held_out, all_of_them);
  const double total = evidence.fit(choice.all({})).left;
  for (std::size_t k = 0; k < terms.size(); ++k) {
    const auto& option = options[terms[k].option];
    const auto before = left_of_difference(held_out, all_of_them - in_held_out[k]);
    Finding finding(option.effect);
    finding.axis = axis.name;
    finding.residual = Residual::encoders;
    const auto count = static_cast<Eigen::Index>(terms[k].columns.size());
    option.cause->describe(axis, option.shape, fit.coefficients.segment(begins[k], count),
                           covariance.block(begins[k], begins[k], count, count), finding);
    auto others = terms;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    finding.explains = std::clamp((evidence.fit(choice.all(others)).left - fit.left) / total, 0.0, 1.0);
    finding.p_value = terms[k].p_value;
    finding.holdout.encoder_rms_ratio = rms(after) / rms(before);
    finding.holdout.ci95 = ratio_interval(after, before, held_out.rows(), seed);
    if (*finding.holdout.encoder_rms_ratio >= 1.0) {
      std::string why =
          fmt::format("withdrawn: found in the {} of the training data, but without improvement on held-out data",
                      residual_words(Residual::encoders));
      found.rejected.push_back({option.effect, std::move(why)});
      continue;
    }
    finding.evidence = fmt::format(
        "Explains {:.1f} % of the variance of the difference of the two encoders (the load ahead of its motor, less "
        "the twist of the machine file's shaft under the force through it): the twist itself was recorded.",
        100.0 * finding.explains);
    for (const auto& confusion : sim::confusions_of(option.effect))
      finding.confused_with.push_back({confusion.other, std::string(confusion.separate_by), confusion.always, 0.0});
    if (finding.values.contains("per"))
      finding.charts.push_back(error_over_turn(left + in_training[k], left, training.load(), finding, axis, units));
    else
      finding.charts.push_back(twist_over_force(training, in_training[k], axis, units));
    found.findings.push_back(std::move(finding));
  }
  return found;
}

}  // namespace stiction::host
