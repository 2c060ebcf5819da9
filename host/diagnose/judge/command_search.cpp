#include "host/diagnose/judge/command_search.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "host/diagnose/classes/command_parameter.hpp"
#include "host/diagnose/statistics/evidence.hpp"
#include "host/diagnose/statistics/fisher.hpp"
#include "host/diagnose/statistics/level.hpp"
#include "host/diagnose/statistics/marginal.hpp"
#include "host/diagnose/statistics/most_odds.hpp"
#include "host/diagnose/statistics/noise_model.hpp"

namespace stiction::host {
namespace {

constexpr int settling = 4;     // of noise and parameters by turns
constexpr int refinements = 3;  // by slopes at the values of the last
constexpr int more_looks = 8;   // for parameters that the first ones hide, and those that they need no longer
// Of a gain: what the digits of a file and a drive's number formats leave open. On the EMPS record, whose command the
// replay meets to 1 mV, 0.02 % of the velocity gain is significant, and without any effect.
constexpr double least_change = 1e-3;
// Records of the exact machine: so many, and of fewer no spread is known. Other ones than those that price forces.
constexpr std::size_t exact_drawn = 12, fewest_exact = 4, first_exact = 3000;
// Of the strongest parameter's odds, what a further one has to be worth: so much may be left of how that one acts.
constexpr double of_strongest = 0.02;

const double worth_it = std::log(loss_ratio);  // nats

// The command about one model of the drive: what is left of it there, and what it changes by with each parameter.
class Neighbourhood {
 public:
  Neighbourhood(const CommandRows& commands, const machine::AxisModel& at, const Places& places)
      : Neighbourhood(commands, commands.logged() - commands.as_driven(at), places, commands.slopes(at, places)) {}

  Neighbourhood(const CommandRows& commands, const Eigen::VectorXd& left, const Places& places,
                const std::vector<Eigen::VectorXd>& slopes)
      : rows_(commands.rows()), places_(places), evidence_(left, blocks_for(commands.rows())) {
    for (const auto& slope : slopes) groups_.push_back(add_group(evidence_, {slope}));
    nuisances_ = add_group(evidence_, commands.nuisances());
    size_by({});
  }

  std::size_t count() const { return places_.size(); }
  std::size_t place(std::size_t parameter) const { return places_[parameter]; }
  std::size_t parameter_at(std::size_t place) const {
    return static_cast<std::size_t>(std::find(places_.begin(), places_.end(), place) - places_.begin());
  }
  const Whitening& noise() const { return evidence_.whitening(); }

  // The noise is what the parameters `chosen` leave.
  void whiten(const std::vector<std::size_t>& chosen) {
    const Eigen::VectorXd left = left_by(chosen);
    evidence_.whiten(noise_of(left, NoiseRows(rows_.logs()), Memory::of_spans));
    size_by(left);
  }
  // What those that the drive can have leave together is taken for the noise.
  void whiten_by_all() {
    std::vector<std::size_t> all(count());
    std::iota(all.begin(), all.end(), 0);
    for (int k = 0; k < settling; ++k) {
      whiten(all);
      while (const auto wrong = impossible(all)) all.erase(all.begin() + static_cast<std::ptrdiff_t>(*wrong));
    }
    whiten(all);
  }

  // The set with the highest odds, each member paying what a name has to be worth.
  std::vector<std::size_t> likeliest() const {
    std::vector<std::size_t> best;
    double most = posterior({}).nats();
    for (std::size_t subset = 1; subset < std::size_t{1} << count(); ++subset) {
      std::vector<std::size_t> members;
      for (std::size_t k = 0; k < count(); ++k)
        if (subset >> k & 1) members.push_back(k);
      const double odds = posterior(members).nats() - worth_it * static_cast<double>(members.size());
      if (odds > most && !impossible(members)) most = odds, best = members;
    }
    return best;
  }
  // Log odds of the parameter `one` beside the `others`, nats, the smallest of three: by the noise of the rows; by the
  // noise's spectrum with it and without it, since by one spectrum a parameter would be worth all that it takes off a
  // noise that wanders; and by how evenly the logs' blocks show it, which knows of wander that no spectrum has.
  double worth(std::size_t one, const std::vector<std::size_t>& others) const {
    auto with = others;
    with.push_back(one);
    const auto of_with = posterior(with), of_others = posterior(others);
    const NoiseRows rows(rows_.logs());
    const double by_own_spectrum = noise_log_likelihood(left_by(with), rows, noise()) -
                                   noise_log_likelihood(left_by(others), rows, noise()) + of_with.price() -
                                   of_others.price();
    const double by_blocks = std::log(most_odds(p_value(with, others.size())) / static_cast<double>(count()));
    return std::min({of_others.gain_of(groups_[one]).nats, by_own_spectrum, by_blocks});
  }
  void move_target(const Eigen::VectorXd& by) {
    evidence_.retarget(evidence_.target() + by);
    size_by({});
  }
  const Eigen::VectorXd& slope(std::size_t parameter) const {
    return evidence_.column(groups_[parameter].columns.front());
  }

  struct Fit {
    Eigen::VectorXd values, deviations;
    std::vector<double> p_values;
  };
  Fit fit(const std::vector<std::size_t>& chosen) const {
    const auto columns = columns_of(chosen);
    const auto all = evidence_.fit(columns);
    const Eigen::MatrixXd covariance = evidence_.interval_covariance(columns, all.coefficients);
    const auto count = static_cast<Eigen::Index>(chosen.size());
    Fit fit{all.coefficients.head(count), covariance.diagonal().head(count).cwiseMax(0.0).cwiseSqrt(), {}};
    for (std::size_t k = 0; k < chosen.size(); ++k) fit.p_values.push_back(p_value(chosen, k));
    return fit;
  }
  // That the weight of chosen[k] is zero, by Student's t of the blocks that show it.
  double p_value(const std::vector<std::size_t>& chosen, std::size_t k) const {
    const auto columns = columns_of(chosen);
    const auto weights = evidence_.fit(columns).coefficients;
    const auto [covariance, clusters] = evidence_.jackknife(columns, weights);
    const auto i = static_cast<Eigen::Index>(k);
    return student_tails(weights[i] / std::sqrt(std::max(covariance(i, i), 1e-300)), std::max(clusters[i] - 1.0, 1.0));
  }
  Eigen::VectorXd left_by(const std::vector<std::size_t>& chosen) const {
    const auto columns = columns_of(chosen);
    return evidence_.residual(columns, evidence_.fit(columns).coefficients);
  }
  static std::vector<std::size_t> without_one(std::vector<std::size_t> from, std::size_t place) {
    from.erase(from.begin() + static_cast<std::ptrdiff_t>(place));
    return from;
  }

 private:
  static std::vector<RowBlock> blocks_for(const LogRows& rows) {
    return blocks_of(rows.velocity, rows.logs(), static_cast<std::size_t>(rows.rows() / 60 + 1));
  }
  // A parameter may have any size from below the `noise` (empty: as before) to all that is left of the command.
  void size_by(const Eigen::VectorXd& noise) {
    const auto all = sizes_beside(left_by({}));
    sizes_ = {noise.size() > 0 ? sizes_beside(noise).smallest : sizes_.smallest, all.largest};
    if (!(sizes_.smallest > 0.0)) sizes_.smallest = all.smallest;
  }
  ColumnIndices columns_of(const std::vector<std::size_t>& chosen) const {
    ColumnIndices columns;
    for (const auto k : chosen) columns.push_back(groups_[k].columns.front());
    columns.insert(columns.end(), nuisances_.columns.begin(), nuisances_.columns.end());
    return columns;
  }
  Posterior posterior(const std::vector<std::size_t>& chosen) const {
    Posterior posterior(evidence_, sizes_);
    posterior.add(nuisances_);
    for (const auto k : chosen) posterior.add(groups_[k]);
    return posterior;
  }
  // The place in `chosen` of a delay that would have to be less than none.
  std::optional<std::size_t> impossible(const std::vector<std::size_t>& chosen) const {
    const auto weights = evidence_.fit(columns_of(chosen)).coefficients;
    for (std::size_t k = 0; k < chosen.size(); ++k)
      if (command_parameters()[place(chosen[k])].is_delay && weights[static_cast<Eigen::Index>(k)] < 0.0) return k;
    return std::nullopt;
  }

  const LogRows& rows_;
  const Places& places_;
  Evidence evidence_;
  std::vector<Group> groups_;
  Group nuisances_;
  Sizes sizes_;
};

double within_reach(double value, double of_file) {
  return of_file > 0.0 ? std::clamp(value, least_of_file * of_file, most_of_file * of_file) : std::max(value, 0.0);
}

// Whether `change` of the parameter at `place` is more than the drive can show; of delays all are.
bool counts(std::size_t place, double change, double of_file) {
  return command_parameters()[place].is_delay || std::abs(change) >= least_change * of_file;
}

class Search {
 public:
  Search(const CommandRows& commands, const Places& places) : commands_(commands), places_(places) {}

  CommandSearch run() {
    Neighbourhood file(commands_, commands_.axis(), places_);
    file.whiten_by_all();
    auto chosen = file.likeliest();
    for (int k = 0; k < settling; ++k) {
      file.whiten(chosen);
      auto now = file.likeliest();
      if (now == chosen) break;
      chosen = std::move(now);
    }
    for (const auto parameter : chosen) terms_.push_back({places_[parameter], value_of_file(places_[parameter])});
    refine();
    for (int look = 0; look < more_looks && !terms_.empty(); ++look)
      if (!look_again()) break;
    return result(file);
  }

 private:
  double value_of_file(std::size_t place) const { return *command_parameters()[place].value(commands_.axis()); }
  Places own_places() const {
    Places own;
    for (const auto& term : terms_) own.push_back(term.place);
    return own;
  }
  static std::vector<std::size_t> all_of(std::size_t count) {
    std::vector<std::size_t> all(count);
    std::iota(all.begin(), all.end(), 0);
    return all;
  }

  void refine() {
    const Places own = own_places();
    for (int round = 0; round < refinements && !terms_.empty(); ++round) {
      Neighbourhood local(commands_, with_terms(commands_.axis(), terms_), own);
      const auto all = all_of(own.size());
      local.whiten(all);
      local.whiten(all);
      const auto fit = local.fit(all);
      for (std::size_t k = 0; k < terms_.size(); ++k) {
        const auto i = static_cast<Eigen::Index>(k);
        terms_[k].value = within_reach(terms_[k].value + fit.values[i], value_of_file(own[k]));
        terms_[k].deviation = fit.deviations[i];
      }
    }
  }

  // At the values that were found: whether one of the terms is worth nothing, or a further parameter something.
  bool look_again() {
    Neighbourhood local(commands_, with_terms(commands_.axis(), terms_), places_);
    std::vector<std::size_t> chosen;
    for (const auto& term : terms_) chosen.push_back(local.parameter_at(term.place));
    local.whiten(chosen);
    std::vector<double> worth;
    for (std::size_t k = 0; k < terms_.size(); ++k) worth.push_back(worth_of(k, chosen, local));
    const auto weakest = std::min_element(worth.begin(), worth.end());
    if (*weakest < worth_it) {
      terms_.erase(terms_.begin() + (weakest - worth.begin()));
    } else if (const auto more = further(chosen, local, *std::max_element(worth.begin(), worth.end()))) {
      terms_.push_back({places_[*more], value_of_file(places_[*more])});
    } else {
      return false;
    }
    refine();
    return true;
  }
  // Of the term `k`, nats, where the record is as it would be without it.
  double worth_of(std::size_t k, const std::vector<std::size_t>& chosen, Neighbourhood& local) const {
    const double of_file = value_of_file(terms_[k].place), change = terms_[k].value - of_file;
    if (!counts(terms_[k].place, change, of_file)) return 0.0;
    const Eigen::VectorXd by = change * local.slope(chosen[k]);
    local.move_target(by);
    const double worth = local.worth(chosen[k], Neighbourhood::without_one(chosen, k));
    local.move_target(-by);
    return worth;
  }
  // The likeliest parameter beside the chosen ones; none where none is worth it.
  std::optional<std::size_t> further(const std::vector<std::size_t>& chosen, const Neighbourhood& local,
                                     double strongest) const {
    double most = std::max(worth_it, of_strongest * strongest);
    std::optional<std::size_t> best;
    for (std::size_t k = 0; k < local.count(); ++k)
      if (std::find(chosen.begin(), chosen.end(), k) == chosen.end())
        if (const double worth = local.worth(k, chosen); worth > most) most = worth, best = k;
    return best;
  }

  CommandSearch result(const Neighbourhood& file) {
    if (terms_.empty()) return {{}, file.noise(), file.left_by({})};
    const Places own = own_places();
    const auto all = all_of(own.size());
    Neighbourhood local(commands_, with_terms(commands_.axis(), terms_), own);
    local.whiten({});
    const auto left = local.left_by({});
    // As the file's drive would have to be changed.
    for (std::size_t k = 0; k < terms_.size(); ++k)
      local.move_target((terms_[k].value - value_of_file(own[k])) * local.slope(k));
    const auto fit = local.fit(all);
    for (std::size_t k = 0; k < terms_.size(); ++k) terms_[k].p_value = fit.p_values[k];
    return {terms_, local.noise(), left};
  }

  const CommandRows& commands_;
  const Places& places_;
  std::vector<CommandTerm> terms_;
};

}  // namespace

machine::AxisModel with_terms(machine::AxisModel axis, const std::vector<CommandTerm>& terms) {
  for (const auto& term : terms) command_parameters()[term.place].set(axis, term.value);
  return axis;
}

CommandSearch search_command(const CommandRows& commands, const Places& places) {
  return Search(commands, places).run();
}

Eigen::VectorXd whitened_without_nuisances(const CommandRows& commands, const Eigen::VectorXd& values,
                                           const Whitening& noise) {
  Evidence evidence(values, blocks_of(commands.rows().velocity, commands.rows().logs(), values.size()));
  evidence.add(commands.nuisances());
  evidence.whiten(noise.over(commands.rows().logs()));
  ColumnIndices all(commands.nuisances().size());
  std::iota(all.begin(), all.end(), 0);
  return evidence.whitening()(evidence.residual(all, evidence.fit(all).coefficients));
}

void compare_with_exact(const CommandRecords& records, const CommandRows& commands, const ExactLogs& exact,
                        CommandSearch& found) {
  auto& terms = found.terms;
  if (terms.empty()) return;
  const auto& axis = commands.axis();
  Places places;
  for (const auto& term : terms) places.push_back(term.place);
  std::vector<Eigen::VectorXd> columns = commands.slopes(axis, places);
  columns.insert(columns.end(), commands.nuisances().begin(), commands.nuisances().end());
  Evidence evidence(commands.logged(),
                    blocks_of(commands.rows().velocity, commands.rows().logs(), commands.rows().rows()));
  evidence.add(columns);
  evidence.whiten(found.noise.over(commands.rows().logs()));
  ColumnIndices all(columns.size());
  std::iota(all.begin(), all.end(), 0);
  std::vector<Eigen::VectorXd> changes;
  for (const auto& logs : exact(first_exact, first_exact + exact_drawn)) {
    const CommandRecords drawn_records{logs, records.rows, records.simulated};
    const CommandRows drawn(drawn_records, commands.timing(), axis, 0.0);
    evidence.retarget(drawn.logged() - drawn.as_driven(axis));
    changes.push_back(evidence.fit(all).coefficients.head(static_cast<Eigen::Index>(terms.size())));
  }
  const auto count = static_cast<double>(changes.size());
  if (changes.size() < fewest_exact) return;
  for (std::size_t k = 0; k < terms.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    double mean = 0.0, square = 0.0;
    for (const auto& change : changes) mean += change[i] / count;
    for (const auto& change : changes) square += (change[i] - mean) * (change[i] - mean) / (count - 1.0);
    const double change = terms[k].value - *command_parameters()[terms[k].place].value(axis);
    terms[k].p_of_exact =
        student_tails((change - mean) / std::sqrt(std::max(square * (1.0 + 1.0 / count), 1e-300)), count - 1.0);
    terms[k].deviation = std::max(terms[k].deviation, std::sqrt(square));
  }
}

double likelihood_of_rest(const CommandRows& commands, const Places& places) {
  Neighbourhood file(commands, commands.axis(), places);
  file.whiten_by_all();
  std::vector<std::size_t> all(places.size());
  std::iota(all.begin(), all.end(), 0);
  return noise_log_likelihood(file.left_by(all), NoiseRows(commands.rows().logs()));
}

}  // namespace stiction::host
