#include "host/identify/identification.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "host/identify/fit_support.hpp"
#include "host/identify/standstill.hpp"
#include "host/identify/suitability.hpp"
#include "sim/plant/friction/coulomb_viscous.hpp"

namespace stiction::host {
namespace {

// How wide half of a 95 % interval may be for the parameter to be called determined.
enum class Scale {
  value,     // a share of the parameter's own value
  coulomb,   // a share of the Coulomb friction, in newtons
  at_speed,  // a share of the value, or a tenth of the Coulomb friction at the machine's highest speed
  absolute,
};
struct Criterion {
  const char* name;
  Scale scale;
  double widest;
  const char* how;
  const char* record;
};

constexpr const char* record_reversals =
    "slow reversals of several small amplitudes, 5 to 200 um, a few periods of each at 1 to 2 Hz";
constexpr const char* record_speeds = "constant speeds from a few mm/s up to the highest, each both ways";
constexpr std::array<Criterion, 12> criteria{{
    {"mass_kg", Scale::value, 0.2, "force over acceleration",
     "moves with accelerations of 1 m/s^2 and more, both ways"},
    {"coulomb_N", Scale::value, 0.3, "friction level in sliding, extrapolated to standstill", record_speeds},
    {"viscous_N_s_per_m", Scale::at_speed, 0.5, "slope of the friction over speed", record_speeds},
    {"constant_force_N", Scale::coulomb, 0.1,
     "half the difference of both directions; includes gravity, current offset, and Coulomb friction that differs "
     "between the directions",
     record_speeds},
    {"coulomb_positive_N", Scale::value, 0.3, "includes the constant force, which no log of one axis can separate",
     record_speeds},
    {"coulomb_negative_N", Scale::value, 0.3, "includes the constant force, which no log of one axis can separate",
     record_speeds},
    {"viscous_positive_N_s_per_m", Scale::at_speed, 0.5, "slope of the friction over speed in +x", record_speeds},
    {"viscous_negative_N_s_per_m", Scale::at_speed, 0.5, "slope of the friction over speed in -x", record_speeds},
    {"stiffness_N_per_m", Scale::value, 0.5, "initial slope of the contact after a reversal", record_reversals},
    {"damping_ratio", Scale::absolute, 0.05, "force of the contact's deflection rate", record_reversals},
    {"static_ratio", Scale::absolute, 0.05, "friction at 1 mm/s and below against the sliding level",
     "four constant speeds and more below 10 mm/s, each both ways"},
    {"stribeck_velocity_m_per_s", Scale::value, 0.5, "speed over which the friction falls",
     "four constant speeds and more below 10 mm/s, each both ways"},
}};

const Criterion* criterion_of(std::string_view name) {
  const auto found = std::find_if(criteria.begin(), criteria.end(), [&](const auto& c) { return c.name == name; });
  return found == criteria.end() ? nullptr : &*found;
}

struct Scales {
  double coulomb;            // N
  double highest_speed;      // m/s, of the machine
  double data_speed;         // m/s, the highest of the data
  double data_acceleration;  // m/s^2, the highest of the data
};

// What no friction model gets right, as a share of the Coulomb level. A parameter whose whole force in the data is less
// than that is read off the model's errors, however narrow its interval: the dither of a position controller's
// quantizer turned 500 N s/m into 3100 +- 100 in reversals of 5 to 40 um, and into 2200 +- 400 in some of up to 200 um.
constexpr double model_error = 0.05;

double floor_of(std::string_view name, const Scales& scales) {
  if (name == "mass_kg") return model_error * scales.coulomb / scales.data_acceleration;
  if (name.starts_with("viscous")) return model_error * scales.coulomb / scales.data_speed;
  return 0.0;
}

double allowed(const Criterion& c, double value, const Scales& scales) {
  switch (c.scale) {
    case Scale::value:
      return c.widest * std::abs(value);
    case Scale::coulomb:
      return c.widest * scales.coulomb;
    case Scale::at_speed:
      return std::max(c.widest * std::abs(value), 0.1 * scales.coulomb / scales.highest_speed);
    case Scale::absolute:
      return c.widest;
  }
  return 0.0;
}

constexpr std::size_t least_blocks = 8;  // fewer do not say how much they scatter

// Sorts a parameter into one of the two lists.
void judge(Identification& result, const FittedParameter& fitted, const Scales& scales, std::size_t blocks,
           const std::string& how) {
  const auto* criterion = criterion_of(fitted.name);
  const auto interval = fitted.interval();
  const double half = 0.5 * (interval.high - interval.low);
  const char* record = criterion != nullptr ? criterion->record : record_speeds;
  if (blocks < least_blocks) {
    result.not_determined.push_back(
        {fitted.name, fmt::format("the data have {} independent blocks, fewer than {}", blocks, least_blocks), record});
    return;
  }
  if (criterion != nullptr && floor_of(fitted.name, scales) > allowed(*criterion, fitted.value, scales)) {
    result.not_determined.push_back({fitted.name,
                                     fmt::format("the motion is too slow for it: at most {:.3g} mm/s and {:.3g} m/s^2",
                                                 scales.data_speed * 1e3, scales.data_acceleration),
                                     record});
    return;
  }
  if (criterion != nullptr && !(half <= allowed(*criterion, fitted.value, scales))) {
    result.not_determined.push_back({fitted.name,
                                     fmt::format("the 95 % interval {:.3g} to {:.3g} around {:.3g} is too wide",
                                                 interval.low, interval.high, fitted.value),
                                     record});
    return;
  }
  std::string text = criterion != nullptr ? criterion->how : "shape of the sliding curve";
  if (!how.empty()) text += "; " + how;
  result.parameters.push_back({fitted.name, fitted.value, interval, text});
}

// Below 1 a ratio means that friction does not fall with speed, which a machine file writes as 1.
void bound_static_ratio(Identification& result) {
  for (auto& p : result.parameters) {
    if (p.name != "static_ratio") continue;
    const auto bounded = [](double ratio) { return std::max(ratio, 1.0); };
    p = {p.name, bounded(p.value), {bounded(p.ci95.low), bounded(p.ci95.high)}, p.how};
  }
}

void judge_contact(Identification& result, const FrictionFit& fit, const Scales& scales) {
  for (const char* name : {"stiffness_N_per_m", "damping_ratio", "static_ratio", "stribeck_velocity_m_per_s"}) {
    const auto* fitted = fit.find(name);
    if (fitted == nullptr) continue;
    const bool damping = std::string_view(name) == "damping_ratio";
    if (damping && result.find("stiffness_N_per_m") == nullptr)
      result.not_determined.push_back({name, "the ratio needs the contact stiffness", record_reversals});
    else
      judge(result, *fitted, scales, fit.blocks.size(), "");
  }
  if (fit.find("stribeck_velocity_m_per_s") == nullptr)
    result.not_determined.push_back({"stribeck_velocity_m_per_s", "the friction does not fall with speed",
                                     criterion_of("stribeck_velocity_m_per_s")->record});
  bound_static_ratio(result);
}

// What a fit without a contact leaves open.
void name_contact(Identification& result, const char* why) {
  for (const char* name : {"stiffness_N_per_m", "damping_ratio", "static_ratio", "stribeck_velocity_m_per_s"})
    result.not_determined.push_back({name, why, criterion_of(name)->record});
}

void keep_residuals(Identification& result, const LogRows& rows, const FrictionFit& fit) {
  const auto n = static_cast<double>(std::max<Eigen::Index>(rows.rows(), 1));
  result.force_rms = rows.force.norm() / std::sqrt(n);
  result.residual_rms = fit.residual.norm() / std::sqrt(n);
  for (std::size_t k = 0; k < rows.motions().size(); ++k) {
    const auto begin = static_cast<Eigen::Index>(rows.logs()[k]);
    const auto end = k + 1 < rows.logs().size() ? static_cast<Eigen::Index>(rows.logs()[k + 1]) : rows.rows();
    const auto part = [&](const Eigen::VectorXd& v) { return std::vector<double>(v.begin() + begin, v.begin() + end); };
    result.residuals.push_back({rows.motions()[k].source, part(rows.time), part(rows.velocity), part(fit.residual)});
  }
}

constexpr std::size_t least_sliding_rows = 40;  // eight curves' worth of parameters

void add_curve(Identification& result, const LogRows& rows, const FrictionFit& fit, const FitSettings& settings) {
  const auto data = sliding_data(rows, fit);
  if (data.speed.size() >= static_cast<Eigen::Index>(least_sliding_rows) && data.blocks.size() >= least_blocks)
    result.curve = choose_sliding_curve(data, fit.correlation, settings);
  else
    result.not_determined.push_back({"sliding_curve", "the data contain hardly any sliding", record_speeds});
}

}  // namespace

const AxisLog& channels_of(const Log& log, const machine::AxisModel& axis) {
  for (const auto& channels : log.axes)
    if (channels.axis == axis.name || channels.axis.empty()) return channels;
  std::string names;
  for (const auto& channels : log.axes) names += (names.empty() ? "" : ", ") + channels.axis;
  throw LogError(fmt::format("{}: found channels of {}; expected those of axis {}", log.source, names, axis.name));
}

const IdentifiedParameter* Identification::find(std::string_view name) const {
  const auto found = std::find_if(parameters.begin(), parameters.end(), [&](const auto& p) { return p.name == name; });
  return found == parameters.end() ? nullptr : &*found;
}

Identification identify_logs(const std::vector<Log>& logs, const machine::AxisModel& axis,
                             const IdentifyOptions& options) {
  const bool recipe = options.friction == sim::CoulombViscous<>::name;
  const auto signals = recipe ? published_recipe() : SignalSettings{};
  Identification result;
  result.axis = axis.name;
  std::vector<Motion> motions;
  for (const auto& log : logs) {
    const auto& channels = channels_of(log, axis);
    require_samples(log);
    refuse_saturation(log, channels, axis);
    motions.push_back(motion_of(log, channels, axis, options.amperes, signals));
    result.sources.push_back(log.source);
    result.samples += log.t.size();
  }
  LogRows rows(std::move(motions), signals);
  const auto excitation = excitation_of(rows);
  require_excitation(excitation, sources_of(rows.motions()));
  refuse_swapped_sign(rows);
  if (options.moving_rows_only) rows.weigh(moving_rows(rows, axis, signals.cutoff));
  const bool own = options.friction == axis.friction.use && has_contact_of_one_length(axis.friction);
  const auto fit = recipe ? fit_coulomb_viscous(rows, options.fit)
                   : own  ? fit_law(rows, axis.friction, options.fit)
                          : fit_lugre(rows, options.fit);
  result.friction = fit.model;
  refuse_contradiction(fit, rows);

  result.method = recipe ? "Least squares with sgn(v) of every sample, as published for EMPS; data filtered at 100 Hz, "
                           "rows at 100 Hz, intervals by block bootstrap."
                         : fmt::format(
                               "Least squares with the contact of the law {} driven by the measured position; "
                               "data filtered at 100 Hz, rows at 100 Hz, intervals by block bootstrap.",
                               fit.model);
  if (options.moving_rows_only && rows.counts().minCoeff() < 1.0)
    result.method += fmt::format(
        " Rows at standstill, {:.0f} % of all, have no weight: there the friction of {} is a reaction, which no motion "
        "tells.",
        100.0 * (1.0 - rows.counts().mean()), axis.friction.use);
  if (fit.sliding_only)
    result.method +=
        " The contact model contradicts the rows in steady sliding. Mass, Coulomb and viscous friction therefore come "
        "from those rows alone, and the contact parameters are a compromise.";
  const Scales scales{std::abs(fit.at("coulomb_N").value), axis.max_velocity, excitation.highest_speed,
                      excitation.highest_acceleration};
  const char* how = fit.sliding_only ? "rows in steady sliding only" : "";
  for (const char* name : {"mass_kg", "coulomb_N", "viscous_N_s_per_m", "constant_force_N"})
    judge(result, fit.at(name), scales, fit.blocks.size(), how);
  for (const auto& each : fit_directions(rows, fit, options.fit)) judge(result, each, scales, fit.blocks.size(), "");
  if (recipe)
    name_contact(result, "sgn(v) contains no presliding; --friction lugre identifies it");
  else
    judge_contact(result, fit, scales);
  if (result.find("stiffness_N_per_m") != nullptr) result.elements = fit_maxwell_slip(rows).elements;
  add_curve(result, rows, fit, options.fit);
  result.initial = initial_values(rows);
  keep_residuals(result, rows, fit);
  return result;
}

Identification identify_table(const SteadyTable& table, const machine::AxisModel& axis, std::optional<Amperes> stated,
                              const FitSettings& settings) {
  const auto data = sliding_data(table, axis, stated);
  Identification result;
  result.axis = axis.name;
  result.sources = {table.source};
  result.samples = table.speed.size();
  result.method = "Sliding curve fitted to the steady states of a table; intervals by bootstrap of its rows.";
  result.curve = choose_sliding_curve(data, 1.0, settings);
  // Coulomb and viscous friction are those of a straight line, whatever curve is nearer to the points.
  Eigen::MatrixXd columns(data.speed.size(), data.others.cols() + 2);
  columns << data.others, data.sign, data.speed;
  const BlockRegression line(columns, data.force, data.blocks);
  const auto replicates = line.bootstrap(settings.replicates, settings.seed);
  const Eigen::RowVectorXd centre = line.solve().transpose();
  const Eigen::Index sign = data.others.cols();
  FrictionFit straight;
  fitting::add(straight, "coulomb_N", centre, replicates, [=](const auto& w) { return w[sign]; });
  fitting::add(straight, "viscous_N_s_per_m", centre, replicates, [=](const auto& w) { return w[sign + 1]; });
  if (sign > 0) fitting::add(straight, "constant_force_N", centre, replicates, [](const auto& w) { return w[0]; });
  const Scales scales{std::abs(centre[sign]), axis.max_velocity, data.speed.cwiseAbs().maxCoeff(), INFINITY};
  for (const auto& each : straight.parameters) judge(result, each, scales, data.blocks.size(), "straight line");
  if (sign == 0)
    result.not_determined.push_back(
        {"constant_force_N", "the table has speeds of one direction only, so it is a part of the Coulomb friction",
         record_speeds});
  result.not_determined.push_back({"mass_kg", "a table of steady states has no acceleration", criteria[0].record});
  name_contact(result, "a table of steady states has no presliding");
  const Eigen::VectorXd left = data.force - columns * centre.transpose();
  const auto n = static_cast<double>(left.size());
  result.force_rms = data.force.norm() / std::sqrt(n);
  result.residual_rms = left.norm() / std::sqrt(n);
  return result;
}

}  // namespace stiction::host
