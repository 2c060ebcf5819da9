#include "host/diagnose/search/dictionary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/diagnose/classes/candidate_columns.hpp"
#include "host/diagnose/search/context_lines.hpp"
#include "host/diagnose/search/price.hpp"
#include "host/diagnose/statistics/noise_model.hpp"

namespace stiction::host {
namespace {

constexpr double less_disturbed = 0.7;
constexpr double cluster_lengths = 6.0;   // correlation lengths of the whitened residual in a cluster
constexpr std::ptrdiff_t most_waves = 4;  // of one candidate
constexpr int settling_rounds = 3;
constexpr int refining_steps = 9;  // of a golden section: to 2 % of the grid's step

std::vector<RowBlock> blocks_for(const LogRows& rows, double correlation) {
  const auto n = static_cast<double>(rows.rows());
  const double shortest = std::clamp(6.0 * correlation, n / 200.0, n / 30.0);
  return blocks_of(rows.velocity, rows.logs(), static_cast<std::size_t>(shortest) + 1);
}

}  // namespace

Dictionary::Dictionary(const LogRows& rows, const Eigen::VectorXd& target, SearchContext& context)
    : rows_(rows),
      scene_(context),
      counts_(rows.counts()),
      correlation_(correlation_length(target, rows.logs())),
      evidence_(target, blocks_for(rows, std::min(correlation_, 0.1 / rows.period(0)))),
      plain_(target, evidence_.row_blocks()),
      sizes_(sizes_beside(target)),
      disturbance_(target.squaredNorm()) {
  add_options(false);
  on_grid_ = options_.size();
}

// The values of the candidate's nonlinear parameter that are known from the start, or those that the scan of a residual
// found last.
// An axis that has an effect already cannot have a second one of those that act but once.
std::vector<double> Dictionary::values_of(const Candidate& candidate, bool scanned) const {
  if (candidate.effect && !(*candidate.effect)->several &&
      std::any_of(scene_.axis.effects.begin(), scene_.axis.effects.end(),
                  [&](const machine::Effect& known) { return known.name == (*candidate.effect)->name; }))
    return {};
  if (candidate.periodic == scanned) return candidate.grid(scene_);
  std::vector<double> found;
  if (scanned && candidate.places != nullptr)
    for (std::size_t k = candidate.places(scene_).first_new; k < candidate.places(scene_).places.size(); ++k)
      found.push_back(PlaceScan::value_of(k));
  return found;
}

void Dictionary::add_options(bool scanned) {
  std::vector<Atom*> added;
  for (std::size_t c = 0; c < candidates().size(); ++c)
    for (const double value : values_of(candidates()[c], scanned))
      added.push_back(
          options_.emplace_back(std::make_unique<Atom>(Atom{c, value, {}, log_prior_of(scene_, c, value)})).get());
  give_columns(added);
}

void Dictionary::give_columns(const std::vector<Atom*>& options) {
  std::vector<CandidateAt> trials;
  for (const auto* option : options) trials.push_back({&candidates()[option->candidate], option->shape});
  const auto groups = group_columns(rows_, scene_, trials);
  for (std::size_t k = 0; k < groups.size(); ++k) {
    options[k]->group = add_group(evidence_, groups[k]);
    plain_.add(groups[k]);
  }
}

// Replays anew where the force that disturbs them turned out to be a good deal less: causes were found in it.
void Dictionary::respond_under(const Eigen::VectorXd& noise) {
  if (!scene_.disturb || noise.squaredNorm() > less_disturbed * disturbance_) return;
  disturbance_ = noise.squaredNorm();
  scene_.disturb(noise);
  std::vector<Atom*> replayed;
  for (const auto& option : options_)
    if (const auto& c = candidates()[option->candidate];
        c.replays && !(c.coarse != nullptr && c.coarse(scene_, option->shape)))
      replayed.push_back(option.get());
  give_columns(replayed);
}

Eigen::VectorXd Dictionary::residual(const ActiveSet& set) const {
  const auto of_set = posterior(set);
  return evidence_.residual(of_set.columns(), of_set.weights());
}

// What the first and the last member of each candidate are needed for.
Eigen::VectorXd Dictionary::absorbed_by_all(const ActiveSet& set) const {
  auto of_set = posterior(set);
  for (std::size_t k = 0; k < on_grid_; ++k) {
    const auto& candidate = candidates()[options_[k]->candidate];
    if (candidate.replays || has(set, options_[k]->candidate)) continue;
    const bool first = k == 0 || options_[k - 1]->candidate != options_[k]->candidate;
    const bool last = k + 1 == on_grid_ || options_[k + 1]->candidate != options_[k]->candidate;
    if (first || last) of_set.add(options_[k]->group);
  }
  return evidence_.residual(of_set.columns(), of_set.weights());
}

// Weights and noise tell each other: by the noise of a set that is not in it yet its weights are too small. Where slow
// noise hides what is slow they stay so, or fast rows alone tell weights that leave more of what is slow; so that they
// are also begun from the least squares of the force as it is. The likelier end counts.
Eigen::VectorXd Dictionary::settled_residual(const ActiveSet& set) const {
  Evidence own(evidence_.target(), evidence_.row_blocks());
  std::vector<Group> groups;
  for (const auto* atom : set) {
    std::vector<Eigen::VectorXd> columns;
    for (const auto column : atom->group.columns) columns.push_back(evidence_.column(column));
    groups.push_back(add_group(own, columns));
  }
  struct Settled {
    Eigen::VectorXd left;
    double likelihood;
  };
  const auto settled_from = [&](Eigen::VectorXd left) -> Settled {
    double price = 0.0;
    for (int round = 0; round < settling_rounds; ++round) {
      own.whiten(noise_in(left));
      Posterior of_set(own, sizes_);
      for (const auto& group : groups) of_set.add(group);
      left = own.residual(of_set.columns(), of_set.weights());
      price = of_set.price();
    }
    const double likelihood = noise_log_likelihood(left.cwiseProduct(counts_), rows_) + price;
    return {std::move(left), likelihood};
  };
  const auto columns = columns_of(set);
  auto by_noise = settled_from(residual(set));
  auto as_it_is = settled_from(plain_.residual(columns, plain_.fit(columns).coefficients));
  return as_it_is.likelihood > by_noise.likelihood ? as_it_is.left : by_noise.left;
}

// By the noise of the rows that count; those of a log that is left out weigh nothing, so that nothing is learned there.
Whitening Dictionary::noise_in(const Eigen::VectorXd& left) const {
  auto noise = noise_of(left.cwiseProduct(counts_), rows_);
  if (left_out_) noise.weigh(noise.weight().cwiseProduct(counts_));
  return noise;
}

void Dictionary::leave_out(const ActiveSet& set, std::size_t part, std::size_t parts) {
  take_all();
  left_out_ = true;
  for (std::size_t log = part; log < rows_.logs().size(); log += parts) {
    const auto begin = static_cast<Eigen::Index>(rows_.logs()[log]);
    counts_.segment(begin, static_cast<Eigen::Index>(rows_.end(log)) - begin).setZero();
  }
  whiten(set, false);
}

void Dictionary::take_all() {
  left_out_ = false;
  counts_ = rows_.counts();
}

void Dictionary::whiten(const ActiveSet& set, bool absorbed) {
  if (!evidence_.whitening() || set.empty()) evidence_.whiten(noise_in(evidence_.target()));
  const Eigen::VectorXd noise = absorbed      ? absorbed_by_all(set)
                                : set.empty() ? evidence_.target()
                                              : settled_residual(set);
  const auto whitening = noise_in(noise);
  correlation_ = correlation_length(whitening(noise), rows_.logs());
  evidence_.whiten(whitening, static_cast<std::size_t>(std::ceil(cluster_lengths * correlation_)));
  if (!left_out_) respond_under(noise);
}

void Dictionary::scan_lines(const ActiveSet& set, const ActiveSet& known) {
  auto kept = set;
  kept.insert(kept.end(), known.begin(), known.end());
  drop_all_but(kept);
  find_lines(rows_, residual(set), evidence_.whitening(), scene_);
  add_options(true);
}

ColumnIndices Dictionary::columns_of(const ActiveSet& set) {
  ColumnIndices all;
  for (const auto* option : set) all.insert(all.end(), option->group.columns.begin(), option->group.columns.end());
  return all;
}

// Whether the candidate is in the set, or another of its name or a shape that looks alike: two of them would describe
// one thing twice.
// Of waves there may be several: harmonics, two pitches, two tones.
bool Dictionary::has(const ActiveSet& set, std::size_t candidate) {
  if (candidates()[candidate].periodic)
    return std::count_if(set.begin(), set.end(), [&](const auto* o) { return o->candidate == candidate; }) >=
           most_waves;
  return std::any_of(set.begin(), set.end(), [&, alike = candidates()[candidate].looks_like](const auto* o) {
    const bool both_split = candidates()[o->candidate].two_bodies && candidates()[candidate].two_bodies;
    return one_cause(o->candidate, candidate) || both_split ||
           (alike != nullptr && candidates()[o->candidate].looks_like == alike);
  });
}

Dictionary::ActiveSet Dictionary::without(ActiveSet set, std::size_t term) {
  set.erase(set.begin() + static_cast<std::ptrdiff_t>(term));
  return set;
}

Posterior Dictionary::posterior(const ActiveSet& set) const {
  Posterior of_set(evidence_, sizes_);
  for (const auto* atom : set) of_set.add(atom->group);
  return of_set;
}

double Dictionary::with_own_noise(const ActiveSet& set) const {
  const auto of_set = posterior(set);
  const Eigen::VectorXd left = evidence_.residual(of_set.columns(), of_set.weights()).cwiseProduct(counts_);
  double odds = noise_log_likelihood(left, rows_) + of_set.price();
  for (const auto* atom : set) odds += atom->log_prior;
  return odds;
}

double Dictionary::with_own_spectrum(const ActiveSet& set) const {
  const auto of_set = posterior(set);
  const Eigen::VectorXd left = evidence_.residual(of_set.columns(), of_set.weights()).cwiseProduct(counts_);
  double odds = noise_log_likelihood(left, rows_, evidence_.whitening()) + of_set.price();
  for (const auto* atom : set) odds += atom->log_prior;
  return odds;
}

double Dictionary::score(const ActiveSet& set) const {
  double odds = posterior(set).nats();
  for (const auto* atom : set) odds += atom->log_prior;
  return odds;
}

// Whether its force is larger than what the inverse dynamics is off by.
bool Dictionary::resolved(const Atom& atom, const Eigen::VectorXd& weights) const {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(rows_.rows());
  for (std::size_t c = 0; c < atom.group.columns.size(); ++c)
    force += weights[static_cast<Eigen::Index>(c)] * evidence_.column(atom.group.columns[c]);
  return rms(force) > scene_.resolved_force;
}

// Whether the weights of all have signs and sizes that the effects can have.
bool Dictionary::possible(const Atom& atom, const ActiveSet& beside, const Posterior& of_beside, double size) const {
  const auto weights = of_beside.weights_with(atom.group, size);
  Eigen::Index at = 0;
  const auto holds = [&](const Atom& each) {
    const auto count = static_cast<Eigen::Index>(each.group.columns.size());
    at += count;
    const auto& of = candidates()[each.candidate];
    const Eigen::VectorXd own = weights.segment(at - count, count);
    return of.possible(scene_, each.shape, own) && (!of.like_dynamics || resolved(each, own));
  };
  return std::all_of(beside.begin(), beside.end(), [&](const Atom* each) { return holds(*each); }) && holds(atom);
}

std::optional<Dictionary::Option> Dictionary::best_of(std::size_t candidate, const ActiveSet& beside,
                                                      const Posterior& of_beside) const {
  std::optional<Option> best;
  for (const auto& option : options_) {
    if (option->candidate != candidate || std::find(beside.begin(), beside.end(), option.get()) != beside.end())
      continue;
    const auto gain = of_beside.gain_of(option->group);
    const double odds = gain.nats + option->log_prior;
    if (best && odds <= best->score) continue;
    if (possible(*option, beside, of_beside, gain.size)) best = Option{option.get(), odds};
  }
  return best;
}

// What is tried of a candidate in a record other than that of the search: the options that are there, or, where lines
// and places are looked for in what is left or it goes along `other` rows, trials of its own behind all columns.
std::vector<Atom> Dictionary::tried_in(const LogRows* other, std::size_t candidate) {
  const auto& of = candidates()[candidate];
  const bool scanned = of.scan != nullptr || of.places != nullptr;
  std::vector<Atom> tried;
  for (const auto& option : options_)
    if (option->candidate == candidate && !scanned) tried.push_back(*option);
  if (!scanned && (other == nullptr || of.replays)) return tried;
  if (scanned)
    for (const double value : of.grid(scene_)) tried.push_back({candidate, value, {}, 0.0});
  if (of.places != nullptr)
    for (std::size_t k = of.places(scene_).first_new; k < of.places(scene_).places.size(); ++k)
      tried.push_back({candidate, PlaceScan::value_of(k), {}, 0.0});
  std::vector<CandidateAt> trials;
  for (const auto& atom : tried) trials.push_back({&of, atom.shape});
  const auto groups = group_columns(other != nullptr ? *other : rows_, scene_, trials);
  for (std::size_t k = 0; k < tried.size(); ++k) {
    tried[k].group = add_group(evidence_, groups[k]);
    tried[k].log_prior = log_prior_of(scene_, candidate, tried[k].shape);
  }
  return tried;
}

std::vector<double> Dictionary::names_in(const ExactRecord& record, const std::vector<std::size_t>& names,
                                         Weights allowed) {
  const Eigen::VectorXd own = evidence_.target();
  evidence_.retarget(record.target);
  const auto of_none = posterior({});
  const Scans scanned = scene_;
  const auto of_reading = [](std::size_t name) { return candidates()[name].of_reading; };
  std::optional<LogRows> reading;
  if (!record.read.empty() && std::any_of(names.begin(), names.end(), of_reading)) {
    reading = rows_;
    reading->read_as(record.read);
  }
  const LogRows* other = record.regressors ? &*record.regressors : reading ? &*reading : nullptr;
  find_lines_of(names, other != nullptr ? *other : rows_, record.target, evidence_.whitening(), scene_);
  std::vector<double> odds;
  for (const auto c : names) {
    odds.push_back(-std::numeric_limits<double>::infinity());
    const auto first = evidence_.columns();
    for (const auto& atom : tried_in(record.regressors || of_reading(c) ? other : nullptr, c)) {
      const auto gain = of_none.gain_of(atom.group);
      if (gain.nats + atom.log_prior > odds.back() &&
          (allowed == Weights::all || possible(atom, {}, of_none, gain.size)))
        odds.back() = gain.nats + atom.log_prior;
    }
    evidence_.truncate(first);
  }
  evidence_.retarget(own);
  static_cast<Scans&>(scene_) = scanned;
  return odds;
}

void Dictionary::begin_again(const ActiveSet& known) {
  drop_all_but(known);
  for (const auto& option : options_) option->log_prior = log_prior_of(scene_, option->candidate, option->shape);
}

// The options of the grids stay, with their columns, which may lie behind those that are dropped where they are of
// replays.
void Dictionary::drop_all_but(const ActiveSet& kept) {
  const auto found = options_.begin() + static_cast<std::ptrdiff_t>(on_grid_);
  options_.erase(
      std::remove_if(found, options_.end(),
                     [&](const auto& each) { return std::find(kept.begin(), kept.end(), each.get()) == kept.end(); }),
      options_.end());
  ColumnIndices columns;
  for (const auto& option : options_)
    for (auto& column : option->group.columns) {
      columns.push_back(column);
      column = static_cast<Eigen::Index>(columns.size()) - 1;
    }
  for (auto* evidence : {&evidence_, &plain_}) evidence->keep(columns);
}

std::optional<Dictionary::Option> Dictionary::at_shape(std::size_t candidate, double shape, const ActiveSet& beside,
                                                       const Posterior& of_beside) {
  auto atom = std::make_unique<Atom>(Atom{candidate, shape, {}, log_prior_of(scene_, candidate, shape)});
  const auto first = evidence_.columns();
  give_columns({atom.get()});
  const auto gain = of_beside.gain_of(atom->group);
  if (!possible(*atom, beside, of_beside, gain.size)) {
    evidence_.truncate(first);
    plain_.truncate(first);
    return std::nullopt;
  }
  return Option{options_.emplace_back(std::move(atom)).get(), gain.nats + options_.back()->log_prior};
}

// Of a law that is linearised the place of the slope moves to the weight that the slope gives; of others a golden
// section within a step of the grid to either side.
Dictionary::Option Dictionary::refined(Option option, const ActiveSet& beside, const Posterior& of_beside) {
  const auto& candidate = candidates()[option.atom->candidate];
  if (candidate.replays) return option;
  const auto keep_better = [&](const std::optional<Option>& tried) {
    if (!tried) return -1e300;
    if (tried->score > option.score) {
      option = *tried;
    } else {
      evidence_.truncate(options_.back()->group.columns.front());
      plain_.truncate(options_.back()->group.columns.front());
      options_.pop_back();
    }
    return tried->score;
  };
  if (candidate.at_weight) {
    for (int k = 0; k < 3; ++k) {
      const auto& group = option.atom->group;
      const double weight = of_beside.weights_with(group, of_beside.gain_of(group).size).tail(1)[0];
      if (weight == 0.0 || std::abs(weight - option.atom->shape) < 0.02 * std::abs(weight)) break;
      const double before = option.score;
      if (keep_better(at_shape(option.atom->candidate, weight, beside, of_beside)) <= before) break;
    }
    return option;
  }
  if (!candidate.shape) return option;
  constexpr double golden = 0.6180339887498949;
  const std::size_t index = option.atom->candidate;
  const double value = option.atom->shape;
  const double factor = candidate.periodic
                            ? 1.0 / (1.0 - std::min(0.2 * value / std::max(candidate.scan(scene_).extent, 1e-6), 0.5))
                            : 1.6;
  double low = value / factor, high = value * factor;
  if (!candidate.periodic) {
    // A class ends where its grid does: beyond, it is another one's member, as a bend is a line.
    const auto grid = candidate.grid(scene_);
    const auto [least, most] = std::minmax_element(grid.begin(), grid.end());
    low = std::max(low, *least), high = std::min(high, *most);
    if (!(low < high)) return option;
  }
  const auto score_at = [&](double shape) { return keep_better(at_shape(index, shape, beside, of_beside)); };
  double a = high * std::pow(low / high, golden), b = low * std::pow(high / low, golden);
  double score_a = score_at(a), score_b = score_at(b);
  for (int i = 0; i < refining_steps; ++i) {
    if (score_a > score_b) {
      high = b, b = a, score_b = score_a;
      score_a = score_at(a = high * std::pow(low / high, golden));
    } else {
      low = a, a = b, score_a = score_b;
      score_b = score_at(b = low * std::pow(high / low, golden));
    }
  }
  return option;
}

}  // namespace stiction::host
