#include "host/identify/identification.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "host/identify/determined.hpp"
#include "host/identify/fit_support.hpp"
#include "host/identify/load_friction.hpp"
#include "host/identify/standstill.hpp"
#include "host/identify/suitability.hpp"
#include "host/log/limits.hpp"
#include "host/log/own_units.hpp"
#include "sim/plant/friction/coulomb_viscous.hpp"
#include "sim/plant/friction/lugre.hpp"

namespace stiction::host {
namespace {

void keep_residuals(Identification& result, const LogRows& rows, const FrictionFit& fit) {
  const auto n = static_cast<double>(std::max<Eigen::Index>(rows.rows(), 1));
  result.force_rms = rows.force.norm() / std::sqrt(n);
  result.residual_rms = fit.residual.norm() / std::sqrt(n);
  for (std::size_t k = 0; k < rows.motions().size(); ++k) {
    const auto begin = static_cast<Eigen::Index>(rows.logs()[k]);
    const auto end = static_cast<Eigen::Index>(rows.end(k));
    const auto part = [&](const Eigen::VectorXd& v) { return std::vector<double>(v.begin() + begin, v.begin() + end); };
    result.residuals.push_back({rows.motions()[k].source, part(rows.time), part(rows.velocity), part(fit.residual)});
  }
}

constexpr std::size_t least_blocks_of_curve = 8;  // of a curve
constexpr std::size_t least_sliding_rows = 40;    // eight curves' worth of parameters

void add_curve(Identification& result, const LogRows& rows, const FrictionFit& fit, const FitSettings& settings) {
  const auto data = sliding_data(rows, fit);
  if (data.speed.size() >= static_cast<Eigen::Index>(least_sliding_rows) && data.blocks.size() >= least_blocks_of_curve)
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

AxisLog& channels_of(Log& log, const machine::AxisModel& axis) {
  const auto& found = channels_of(std::as_const(log), axis);
  return log.axes[static_cast<std::size_t>(&found - log.axes.data())];
}

const IdentifiedParameter* Identification::find(std::string_view name) const {
  const auto found = std::find_if(parameters.begin(), parameters.end(), [&](const auto& p) { return p.name == name; });
  return found == parameters.end() ? nullptr : &*found;
}

namespace {

struct Source {
  std::vector<LogOfAxis> logs;
  std::vector<std::vector<bool>> left_out;
};

// How many samples have the effort at an end: the machine's limit, or where it piles up. `out`: those that do not
// count.
std::size_t limited_samples(const Log& log, const AxisLog& channels, const machine::AxisModel& axis,
                            const std::vector<bool>& out) {
  auto at_end = saturated(channels, axis);
  for (const auto& each : limited_channels(log, channels)) {
    if (each.kind == LimitedChannel::Kind::off || each.channel->values == &AxisLog::x) continue;
    for (std::size_t k = 0; k < at_end.size(); ++k) at_end[k] = at_end[k] || each.samples[k];
  }
  std::size_t count = 0;
  for (std::size_t k = 0; k < at_end.size(); ++k) count += at_end[k] && out[k];
  return count;
}

Source sources_for(Identification& result, const std::vector<Log>& logs, const machine::AxisModel& axis) {
  Source source;
  std::size_t masked = 0, limited = 0;
  const char* effort = "";
  for (const auto& log : logs) {
    const auto& channels = channels_of(log, axis);
    require_samples(log);
    source.logs.push_back({&log, &channels});
    source.left_out.push_back(left_out(channels, axis));
    masked += static_cast<std::size_t>(std::count(source.left_out.back().begin(), source.left_out.back().end(), true));
    limited += limited_samples(log, channels, axis, source.left_out.back());
    effort = name_of_effort(channels, axis);
    result.sources.push_back(log.source);
    result.samples += log.t.size();
  }
  const auto share = [&](std::size_t samples) {
    return 100.0 * static_cast<double>(samples) / static_cast<double>(result.samples);
  };
  if (limited > 0)
    result.notes.push_back(
        fmt::format("{} samples, {:.2g} % of all, do not count, as the {} is at its limit there: what the motion then "
                    "asks for is not known, and the rest says less of high accelerations and loads.",
                    limited, share(limited), effort));
  if (masked > limited)
    result.notes.push_back(
        fmt::format("{} samples, {:.2g} % of all, do not count, as the record has no {} there or the drive is off.",
                    masked - limited, share(masked - limited), effort));
  return source;
}

// A law that sticks says nothing of an axis that cannot be told from one at rest.
void require_counting_samples(const LogRows& rows, const Band& band, const machine::AxisModel& axis) {
  constexpr double least = 1e-3;  // of a row
  if (rows.rows() > 0 && rows.weight.cwiseAbs().maxCoeff() > least) return;
  const auto own = axis.coordinate.own("m");
  const auto shown = shown_deviation(axis.coordinate.rotary());
  throw LogError(fmt::format(
      "{}: found no sample in which the axis is seen to move: at every speed of the record the noise of its "
      "position, {:.3g} {} rms, may be all of the motion; expected faster motion, a longer stroke or a finer "
      "encoder",
      sources_of(rows.motions()), own.from_linear(band.position_noise) * shown.factor, shown.unit));
}

// Which speed the rows have, of logs that record one.
void note_speed(Identification& result, const LogRows& rows) {
  for (const auto& motion : rows.motions()) {
    if (motion.recorded_speed)
      result.notes.push_back(
          fmt::format("{}: speed and acceleration are those of the recorded v, which is quieter.", motion.source));
    else if (!motion.speed_objection.empty())
      result.notes.push_back(fmt::format("{}: the recorded v would be quieter, but is not used: {}.", motion.source,
                                         motion.speed_objection));
  }
}

// What looks wrong in the logs, the likeliest of each kind.
void ask(Identification& result, const Source& source, const machine::AxisModel& axis) {
  for (const auto& each : source.logs)
    for (const auto& question :
         questions_of(*each.log, in_own_units(*each.channels, axis.coordinate), known_axis(axis))) {
      const auto same = std::find_if(result.questions.begin(), result.questions.end(),
                                     [&](const auto& q) { return q.about == question.about; });
      if (same == result.questions.end())
        result.questions.push_back(question);
      else if (same->probability < question.probability)
        *same = question;
    }
}

// Rows of the fixed band, 40 Hz, of logs that are fast and fine enough for it.
LogRows fixed_rows(const Source& source, const machine::AxisModel& axis, Amperes amperes,
                   const SignalSettings& signals) {
  std::vector<Motion> motions;
  for (std::size_t k = 0; k < source.logs.size(); ++k) {
    motions.push_back(motion_of(*source.logs[k].log, *source.logs[k].channels, axis, amperes, signals));
    const auto& out = source.left_out[k];
    if (std::find(out.begin(), out.end(), true) == out.end()) continue;
    for (const bool each : out) motions.back().weight.push_back(each ? 0.0 : 1.0);
  }
  return {std::move(motions), signals};
}

// Whether the log resolves a contact: fast enough for what happens within it, and an encoder whose noise neither bends
// the mass nor the contact's force.
bool resolves_contact(const Band& band, const Source& source) {
  constexpr double slowest = 400.0, coarsest = 1e-6, noisiest = 2e-3;  // Hz, m rms, of the mass
  return band.position_noise < coarsest && band.trials.front().attenuation < noisiest &&
         std::all_of(source.logs.begin(), source.logs.end(),
                     [](const auto& each) { return each.log->period < 1.0 / slowest; });
}

// The direction in which all motion goes; 0: both.
double only_direction(const LogRows& rows) {
  constexpr double least = 0.02;  // of the time in motion
  double forward = 0.0, backward = 0.0;
  for (const auto& motion : rows.motions()) {
    double highest = 0.0;
    for (const double v : motion.v) highest = std::max(highest, std::abs(v));
    for (const double v : motion.v)
      if (std::abs(v) > 0.02 * highest) (v > 0.0 ? forward : backward) += motion.period;
  }
  if (backward < least * (forward + backward)) return 1.0;
  return forward < least * (forward + backward) ? -1.0 : 0.0;
}

// A fit of mass, viscous and Coulomb friction and the constant force in the band that was chosen.
FrictionFit followed_fit(const LogRows& rows, const Band& band, const LevelModel& model, const Held& held,
                         const FitSettings& settings) {
  FrictionFit fit;
  fit.model = std::string(sim::CoulombViscous<>::name);
  const auto equations = equations_of(rows, model);
  fit.columns = equations.columns;
  fit.contact = equations.columns.col(fitting::level);
  fit.blocks =
      blocks_for(rows, rows.force - fit.columns * fitting::weights_of(fit.columns, rows.force), &fit.correlation);
  const InstrumentFit estimate(equations, fit.blocks, held);
  fit.weights = estimate.weights();
  fit.residual = rows.force - fit.columns * fit.weights;
  const auto replicates = estimate.replicates(settings.replicates, settings.seed, band.widening());
  fitting::add_sliding_parameters(fit, fit.weights.transpose(), replicates);
  if (model.rises_with_weight) add_load_coefficient(fit, replicates);
  return fit;
}

// The force (N rms) that is left on held-out blocks, of the fit and of a plain least squares in the same rows.
// `followed`: model of the level of a fit in a band that follows the data; none for another.
HeldOutForce held_out_force(const LogRows& rows, const FrictionFit& fit, const Held& held,
                            const std::optional<LevelModel>& followed) {
  auto own = followed ? equations_of(rows, *followed) : NoisyEquations{};
  if (!followed) {
    // What each log's contact remembers of its start acts in one block alone, and is no prediction.
    const Eigen::Index columns = std::min<Eigen::Index>(fit.columns.cols(), 5);
    const Eigen::Index memories = fit.columns.cols() - columns;
    own.columns = own.instruments = fit.columns.leftCols(columns);
    own.force = rows.force - fit.columns.rightCols(memories) * fit.weights.tail(memories);
    own.acceleration_noise = own.velocity_noise = Eigen::VectorXd::Zero(rows.rows());
  }
  auto plain = own;
  plain.columns.resize(rows.rows(), 4);
  plain.columns << rows.acceleration, rows.velocity, rows.one, rows.stacked([](const Motion& m) {
    std::vector<double> sign(m.v.size());
    std::transform(m.v.begin(), m.v.end(), sign.begin(), [](double v) { return v > 0.0 ? 1.0 : v < 0.0 ? -1.0 : 0.0; });
    return sign;
  });
  plain.instruments = plain.columns;
  plain.force = rows.force;
  plain.acceleration_noise.setZero();
  plain.velocity_noise.setZero();
  return {InstrumentFit(own, fit.blocks, held).held_out(), InstrumentFit(plain, fit.blocks, {}).held_out()};
}

constexpr std::array<const char*, 4> names_of_columns{"mass_kg", "viscous_N_s_per_m", "constant_force_N", "coulomb_N"};

// The constant force that was given of an axis whose weight goes with its angle.
void name_gravity(Identification& result) {
  for (auto& p : result.parameters)
    if (p.name == "constant_force_N") p.name = "gravity_moment_N";
}

// Mass, viscous friction, Coulomb friction, constant force, and those of each direction.
void judge_sliding(Identification& result, const LogRows& rows, const FrictionFit& fit, const Scales& scales,
                   const IdentifyOptions& options, double direction) {
  const char* how = fit.sliding_only ? "rows in steady sliding only" : "";
  for (const std::size_t c : {0u, 3u, 1u, 2u}) {
    const char* name = names_of_columns[c];
    if (c == 2 && !options.held[c] && !rows.motions().front().constant.empty()) {
      auto weight = fit.at(name);
      weight.name = "gravity_moment_N";
      judge(result, weight, scales, fit.blocks.size(), how);
      continue;
    }
    if (options.held[c]) {
      result.parameters.push_back(
          {name, *options.held[c], {*options.held[c], *options.held[c]}, "given, not estimated"});
      continue;
    }
    if (direction != 0.0 && c >= 2) {
      if (c == 3 || options.held[3]) continue;
      auto one_way = fit.at(name);
      one_way.name = direction > 0.0 ? "coulomb_positive_N" : "coulomb_negative_N";
      if (direction < 0.0) {
        one_way.value = -one_way.value;
        for (double& value : one_way.replicates) value = -value;
      }
      judge(result, one_way, scales, fit.blocks.size(), how);
      for (const char* both : {"coulomb_N", "constant_force_N"})
        result.not_determined.push_back(
            {both, "all motion goes in one direction, where Coulomb friction and a constant force are one",
             record_speeds});
      continue;
    }
    judge(result, fit.at(name), scales, fit.blocks.size(), how);
  }
  if (direction == 0.0 && rows.motions().front().constant.empty() &&
      std::none_of(options.held.begin(), options.held.end(), [](const auto& h) { return h.has_value(); }))
    for (const auto& each : fit_directions(rows, fit, options.fit)) judge(result, each, scales, fit.blocks.size(), "");
}

// What of the friction rises with the weight.
void judge_load(Identification& result, const FrictionFit& fit, const Scales& scales, const LogRows& rows) {
  if (rows.motions().front().constant.empty()) return;
  const auto* coefficient = fit.find("load_coefficient");
  if (coefficient == nullptr) {
    result.not_determined.push_back(
        {"load_coefficient", "on held-out rows the friction does not rise with the weight", record_angles});
    return;
  }
  judge(result, *coefficient, scales, fit.blocks.size(), "");
  if (const auto* found = result.find("load_coefficient"))
    result.notes.push_back(
        fmt::format("The friction rises with the load, by {:.2g} of the weight's moment: the Coulomb friction is that "
                    "without load, and no one level holds at every angle.",
                    found->value));
}

// Whether the contact of the machine file predicts worse than sgn(v): of another length than the axis', or shorter than
// the log resolves.
bool contact_misleads(const LogRows& rows, const LevelModel& model, const IdentifyOptions& options) {
  FrictionFit fit;
  fit.blocks = blocks_for(rows, rows.force);
  const auto force = held_out_force(rows, fit, options.held, model);
  return force.fit > force.plain;
}

std::string method_of(const Band& band, const FrictionFit& fit) {
  return fmt::format(
      "Least squares of mass, viscous friction, Coulomb friction and a constant force, all columns through one filter "
      "that ends at {:g} Hz, the widest band with the narrowest intervals; {}; intervals by leaving out one of {} "
      "blocks "
      "at a time, widened by how far the estimates move with the band.",
      band.best().cutoff,
      band.instruments ? "derivatives of the set position are the instruments of speed and acceleration"
                       : "the expected noise of the encoder is taken from the normal equations",
      fit.blocks.size());
}

}  // namespace

Identification identify_logs(const std::vector<Log>& logs, const machine::AxisModel& axis,
                             const IdentifyOptions& options) {
  Identification result;
  result.axis = axis.name;
  const auto source = sources_for(result, logs, axis);
  ask(result, source, axis);
  const bool recipe = options.friction == sim::CoulombViscous<>::name;
  const bool holds = std::any_of(options.held.begin(), options.held.end(), [](const auto& h) { return h.has_value(); });
  const bool published = recipe && !options.moving_rows_only && !holds;
  const bool asked = options.friction == sim::LuGre<>::name;
  auto model = level_model(axis, recipe || (sticks_rigidly(axis) && !asked));
  if (!published) result.band = choose_band(source.logs, axis, options.amperes, model, options.held);
  std::optional<LogRows> rows_in_band;
  if (!published)
    rows_in_band.emplace(followed_rows(source.logs, axis, options.amperes, result.band->best().cutoff, model));
  const double direction = published ? 0.0 : only_direction(*rows_in_band);
  const bool contact =
      !published && !model.sticks && !holds && direction == 0.0 && resolves_contact(*result.band, source);
  const bool followed = !published && !contact;
  const auto take_model = [&](const LevelModel& better) {
    model = better;
    result.band = choose_band(source.logs, axis, options.amperes, model, options.held);
    rows_in_band.emplace(followed_rows(source.logs, axis, options.amperes, result.band->best().cutoff, model));
  };
  if (followed && !model.sticks && contact_misleads(*rows_in_band, model, options)) take_model(unresolved_contact());
  if (followed && direction == 0.0 && rises_with_weight(*rows_in_band, model, options.held)) {
    auto risen = model;
    risen.rises_with_weight = true;
    take_model(risen);
  }
  const LogRows rows =
      followed ? std::move(*rows_in_band)
               : fixed_rows(source, axis, options.amperes, published ? published_recipe() : SignalSettings{});
  if (followed) {
    require_counting_samples(rows, *result.band, axis);
    note_speed(result, rows);
  }
  const auto excitation = excitation_of(rows);
  if (published)
    require_excitation(excitation, sources_of(rows.motions()));
  else
    require_motion(excitation, sources_of(rows.motions()));
  refuse_swapped_sign(rows);
  auto held = options.held;
  if (direction != 0.0 && !held[3]) held[3] = 0.0;  // one column with the constant force
  const bool own = options.friction == axis.friction.use && has_contact_of_one_length(axis.friction);
  const auto fit = published  ? fit_coulomb_viscous(rows, options.fit)
                   : followed ? followed_fit(rows, *result.band, model, held, options.fit)
                   : own      ? fit_law(rows, axis.friction, options.fit)
                              : fit_lugre(rows, options.fit);
  result.friction = fit.model;
  if (published)
    result.method =
        "Least squares with sgn(v) of every sample, as published for EMPS; data filtered at 100 Hz, rows at 100 Hz, "
        "intervals by block bootstrap.";
  else if (followed)
    result.method = method_of(*result.band, fit);
  else
    result.method = fmt::format(
        "Least squares with the contact of the law {} driven by the measured position; data filtered at 100 Hz, rows "
        "at 100 Hz, intervals by block bootstrap.",
        fit.model);
  if (fit.sliding_only)
    result.method +=
        " The contact model contradicts the rows in steady sliding. Mass, Coulomb and viscous friction therefore come "
        "from those rows alone, and the contact parameters are a compromise.";
  const double level = held[3]                   ? std::max(*held[3], std::abs(fit.at("constant_force_N").value))
                       : model.rises_with_weight ? friction_level(fit.columns, fit.weights)
                                                 : std::abs(fit.at("coulomb_N").value);
  Scales scales{level, axis.max_velocity, excitation.highest_speed, excitation.highest_acceleration, axis.coordinate};
  if (const auto* rise = fit.find("load_coefficient"))
    scales.whole_rise = rise->value * level / (level - std::abs(fit.weights[fitting::level]));
  judge_sliding(result, rows, fit, scales, options, direction);
  if (followed) judge_load(result, fit, scales, rows);
  if (published)
    name_contact(result, "sgn(v) contains no presliding; --friction lugre identifies it");
  else if (followed)
    name_contact(result, model.sticks ? "the law sticks rigidly, without presliding"
                                      : "the log is too slow or its encoder too coarse to show presliding");
  else
    judge_contact(result, fit, scales);
  if (result.find("stiffness_N_per_m") != nullptr) result.elements = fit_maxwell_slip(rows).elements;
  if (direction == 0.0) add_curve(result, rows, fit, options.fit);
  // Read off the record by hand, they know nothing of a weight that goes with the angle.
  if (rows.motions().front().constant.empty())
    result.initial = initial_values(rows);
  else
    name_gravity(result);
  result.held_out = held_out_force(rows, fit, held, followed ? std::optional(model) : std::nullopt);
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
  const Scales scales{std::abs(centre[sign]), axis.max_velocity, data.speed.cwiseAbs().maxCoeff(), INFINITY, {}};
  for (const auto& each : straight.parameters) judge(result, each, scales, data.blocks.size(), "straight line");
  if (sign == 0)
    result.not_determined.push_back(
        {"constant_force_N", "the table has speeds of one direction only, so it is a part of the Coulomb friction",
         record_speeds});
  result.not_determined.push_back({"mass_kg", "a table of steady states has no acceleration", record_accelerations});
  name_contact(result, "a table of steady states has no presliding");
  const Eigen::VectorXd left = data.force - columns * centre.transpose();
  const auto n = static_cast<double>(left.size());
  result.force_rms = data.force.norm() / std::sqrt(n);
  result.residual_rms = left.norm() / std::sqrt(n);
  return result;
}

}  // namespace stiction::host
