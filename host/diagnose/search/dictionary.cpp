#include "host/diagnose/search/dictionary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "host/diagnose/classes/candidate_columns.hpp"
#include "host/diagnose/search/context_lines.hpp"

namespace stiction::host {
namespace {

constexpr double strong_evidence = 6.0;  // twice the logarithm of a Bayes factor (Kass, Raftery 1995)
// The same, of a nonlinear parameter on a grid: positive evidence. At 6, a drift hidden by itself was called Coulomb
// friction six times at seven blind seeds and a bend viscous friction five times, and never the other way about.
constexpr double price_of_nonlinear = 4.0;
constexpr double less_disturbed = 0.7;
constexpr double cluster_lengths = 6.0;  // correlation lengths of the whitened residual in a cluster

std::vector<RowBlock> blocks_for(const LogRows& rows, double correlation) {
  const auto n = static_cast<double>(rows.rows());
  const double shortest = std::clamp(6.0 * correlation, n / 200.0, n / 30.0);
  return blocks_of(rows.velocity, rows.logs(), static_cast<std::size_t>(shortest) + 1);
}

}  // namespace

Dictionary::Dictionary(const LogRows& rows, const Eigen::VectorXd& target, SearchContext& context,
                       std::span<const std::size_t> refuted)
    : rows_(rows),
      scene_(context),
      correlation_(correlation_length(target, rows.logs())),
      evidence_(target, blocks_for(rows, std::min(correlation_, 0.1 / rows.period(0)))),
      plain_(target, evidence_.row_blocks()),
      refuted_(refuted),
      disturbance_(target.squaredNorm()) {
  add_options(false);
}

// The options of all candidates that are periodic, or that are not.
void Dictionary::add_options(bool periodic) {
  std::vector<Atom*> added;
  for (std::size_t c = 0; c < candidates().size(); ++c) {
    if (candidates()[c].periodic != periodic || std::find(refuted_.begin(), refuted_.end(), c) != refuted_.end())
      continue;
    for (const double value : candidates()[c].grid(scene_))
      added.push_back(options_.emplace_back(std::make_unique<Atom>(Atom{c, value, {}})).get());
  }
  give_columns(added);
}

void Dictionary::give_columns(const std::vector<Atom*>& options) {
  std::vector<CandidateAt> trials;
  for (const auto* option : options) trials.push_back({&candidates()[option->candidate], option->shape});
  const auto groups = group_columns(rows_, scene_, trials);
  for (std::size_t k = 0; k < groups.size(); ++k) {
    options[k]->columns.resize(groups[k].size());
    std::iota(options[k]->columns.begin(), options[k]->columns.end(), evidence_.add(groups[k]));
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
  const auto columns = columns_of(set);
  return evidence_.residual(columns, evidence_.fit(columns).coefficients);
}

void Dictionary::whiten(const ActiveSet& set) {
  const Eigen::VectorXd noise = residual(set);
  const Whitening whitening(noise, rows_.logs());
  correlation_ = correlation_length(whitening(noise), rows_.logs());
  evidence_.whiten(whitening, static_cast<std::size_t>(std::ceil(cluster_lengths * correlation_)));
  respond_under(noise);
}

void Dictionary::scan_lines(const ActiveSet& set) {
  find_lines(rows_, residual(set), evidence_.whitening(), scene_);
  add_options(true);
}

ColumnIndices Dictionary::columns_of(const ActiveSet& set) {
  ColumnIndices all;
  for (const auto* option : set) all.insert(all.end(), option->columns.begin(), option->columns.end());
  return all;
}

// Whether the candidate is in the set, or another shape that looks alike: two of them would describe one thing twice.
bool Dictionary::has(const ActiveSet& set, std::size_t candidate) {
  return std::any_of(set.begin(), set.end(), [&, alike = candidates()[candidate].looks_like](const auto* o) {
    return o->candidate == candidate || (alike != nullptr && candidates()[o->candidate].looks_like == alike);
  });
}

double Dictionary::trials(std::size_t candidate) const {
  if (const auto scan = candidates()[candidate].scan)
    return static_cast<double>(std::max<std::size_t>(scan(scene_).trials, 1));
  return std::max(candidates()[candidate].trials, candidates()[candidate].shape ? 3.0 : 1.0);
}

double Dictionary::effective_rows() const {
  return std::max(static_cast<double>(evidence_.rows()) / correlation_, 20.0);
}

// A nonlinear parameter on a grid must show: a drift that settles at once is a level. One that is looked for in a scan
// costs its trials. What no name fits must show strongly beside what has one.
double Dictionary::penalty(std::size_t candidate, std::size_t columns) const {
  const bool fitted = candidates()[candidate].shape && candidates()[candidate].scan == nullptr;
  return static_cast<double>(columns) * std::log(effective_rows()) +
         (fitted ? price_of_nonlinear : 2.0 * std::log(trials(candidate))) +
         (candidates()[candidate].outside() ? strong_evidence : 0.0);
}

double Dictionary::score(const ActiveSet& set) const {
  const auto columns = columns_of(set);
  double price = 0.0;
  for (const auto* option : set) price += penalty(option->candidate, option->columns.size());
  return effective_rows() * std::log(std::max(evidence_.fit(columns).left, 1e-300)) + price;
}

bool Dictionary::all_possible(const ActiveSet& set) const {
  const auto coefficients = evidence_.fit(columns_of(set)).coefficients;
  Eigen::Index at = 0;
  for (const auto* option : set) {
    const auto count = static_cast<Eigen::Index>(option->columns.size());
    if (!candidates()[option->candidate].possible(scene_, option->shape, coefficients.segment(at, count))) return false;
    at += count;
  }
  return true;
}

const Atom* Dictionary::best_of(std::size_t candidate, const ActiveSet& beside) const {
  const Atom* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& option : options_) {
    if (option->candidate != candidate) continue;
    auto set = beside;
    set.push_back(option.get());
    const double left = score(set);  // options of one candidate may differ in columns
    if (left >= least || !all_possible(set)) continue;
    least = left;
    best = option.get();
  }
  return best;
}

void Dictionary::profile(ActiveSet& set) const {
  for (int round = 0; round < 2; ++round)
    for (std::size_t k = 0; k < set.size(); ++k) {
      auto others = set;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
      if (const auto* better = best_of(set[k]->candidate, others)) set[k] = better;
    }
}

}  // namespace stiction::host
