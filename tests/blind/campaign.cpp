#include "tests/blind/campaign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <set>
#include <stdexcept>
#include <thread>

#include "sim/effects/effects.hpp"
#include "sim/effects/force_map/force_map.hpp"
#include "sim/plant/friction/maxwell_slip.hpp"
#include "sim/plant/friction/parameters.hpp"

namespace stiction::blind {
namespace {

constexpr std::array<Kind, 8> all_kinds{{
    {"null", "nothing hidden", 0, false, false, 0.0, 10},
    {"one10", "one effect, share 10 %", 1, false, false, 0.10, 10},
    {"one50", "one effect, share 50 %", 1, false, false, 0.50, 0},
    {"one5", "one effect, share 5 %", 1, false, false, 0.05, 6},
    {"one2", "one effect, share 2 %", 1, false, false, 0.02, 4},
    {"two10", "two effects, 10 % each", 2, false, false, 0.10, 5},
    {"outside10", "one outside the vocabulary, 10 %", 0, true, false, 0.10, 4},
    {"off", "parameters slightly off", 0, false, true, 0.0, 1},
}};

std::vector<std::string> names_of(bool in_vocabulary) {
  std::vector<std::string> names;
  for (const auto& row : hideables())
    if (row.in_vocabulary == in_vocabulary) names.emplace_back(row.name);
  return names;
}

// Exact aliases (docs/effects): a half difference of Coulomb friction is a constant force. That a force constant is
// mass, Coulomb and viscous friction together is an alias that a finding must name itself.
bool same_class(const std::string& a, const std::string& b) {
  const std::set<std::string> offset{"constant_force", "friction_asymmetry"};
  return a == b || (offset.contains(a) && offset.contains(b));
}

// What may be named for a hidden one.
bool right_for(const std::string& named, const std::string& hidden) {
  return same_class(named, hidden) || named == hideable(hidden).accepted;
}
bool right(const std::string& named, const CaseOrder& order) {
  if (order.slightly_off) return named == "mass_mismatch" || named == "coulomb_mismatch" || named == "viscous_mismatch";
  return std::any_of(order.hidden.begin(), order.hidden.end(), [&](const auto& h) { return right_for(named, h); });
}

// The machine file's own value of what a *_mismatch changes; 0 for others.
double value_of_file(const machine::AxisModel& axis, const std::string& effect) {
  const auto& friction = sim::parameters_of<sim::MaxwellSlip<>>(axis.friction);
  if (effect == "mass_mismatch") return axis.mass;
  if (effect == "viscous_mismatch") return friction.viscous;
  if (effect == "force_constant_mismatch") return axis.motor.force_constant;
  if (effect != "coulomb_mismatch") return 0.0;
  double sum = 0.0;
  for (const double level : friction.level) sum += level;
  return sum;
}

double scale_of(const machine::Effect& truth, const std::string& key) {
  if (key == "neutral") return 0.1;
  if (key == "cosine" || key == "sine")
    return std::hypot(truth.values.at("cosine").front(), truth.values.at("sine").front());
  return std::abs(truth.values.at(key).front());
}

// A profile is found with other knots: the rms difference at places along those that were found.
ParameterScore score_profile(const machine::Effect& truth, const machine::Effect& found) {
  const auto level = [](const machine::Effect& effect, double x) {
    const auto &at = effect.values.at("position"), &of = effect.values.at("force");
    const auto k = static_cast<std::size_t>(std::upper_bound(at.begin(), at.end(), x) - at.begin());
    if (k == 0 || k == at.size()) return k == 0 ? of.front() : of.back();
    return of[k - 1] + (of[k] - of[k - 1]) * (x - at[k - 1]) / (at[k] - at[k - 1]);
  };
  constexpr int places = 60;
  const auto& ends = found.values.at("position");
  double off = 0.0, of = 0.0;
  for (int i = 0; i <= places; ++i) {
    const double x = ends.front() + (ends.back() - ends.front()) * i / places, true_level = level(truth, x);
    off += (level(found, x) - true_level) * (level(found, x) - true_level);
    of += true_level * true_level;
  }
  return {truth.name, "profile", std::sqrt(off / of), 0.0, false, 0.0};
}

std::vector<ParameterScore> score_parameters(const machine::AxisModel& file, const machine::Effect& truth,
                                             const host::Finding& finding) {
  std::vector<ParameterScore> scores;
  if (truth.name == "position_dependent_friction") return {score_profile(truth, finding.row())};
  for (const auto& [key, values] : truth.values) {
    const auto found = finding.values.find(key);
    if (found == finding.values.end() || found->second.empty()) continue;
    const double off = found->second.front() - values.front(), base = value_of_file(file, truth.name);
    ParameterScore each{truth.name, key, std::abs(off) / std::max(scale_of(truth, key), 1e-12), 0.0, false, 0.0};
    if (base != 0.0) each.of_change = std::abs(off / (values.front() - base));
    for (const auto& parameter : finding.parameters)
      if (parameter.key == key && !parameter.standard_errors.empty()) {
        each.interval = true;
        each.deviations = off / std::max(parameter.standard_errors.front(), 1e-300);
      }
    scores.push_back(each);
  }
  return scores;
}

}  // namespace

std::span<const Kind> kinds() { return all_kinds; }

std::vector<PlannedCase> plan(int count, std::uint64_t seed, const std::string& only) {
  if (!only.empty() && std::none_of(all_kinds.begin(), all_kinds.end(), [&](const Kind& k) { return only == k.name; }))
    throw std::out_of_range("no kind '" + only + "'");
  const auto inside = names_of(true), outside = names_of(false);
  std::array<int, all_kinds.size()> made{};
  std::vector<PlannedCase> cases;
  for (int n = 0; n < count; ++n) {
    // The kind that is furthest behind its weight.
    std::size_t next = all_kinds.size();
    for (std::size_t k = 0; k < all_kinds.size(); ++k) {
      if (!only.empty() && only != all_kinds[k].name) continue;
      const auto load = [&](std::size_t i) { return (made[i] + 0.5) / all_kinds[i].weight; };
      if (next == all_kinds.size() || load(k) < load(next)) next = k;
    }
    const Kind& kind = all_kinds[next];
    const auto turn = static_cast<std::size_t>(made[next]++);
    CaseOrder order{{}, kind.share, kind.slightly_off, seed * 100000 + static_cast<std::uint64_t>(n)};
    const std::size_t first = (turn + seed) % inside.size();
    if (kind.effects > 0) order.hidden.push_back(inside[first]);
    if (kind.effects > 1) {
      // A step of 1 to 11, so that every pair comes up; exact aliases of each other are no pair.
      std::size_t step = 1 + (turn / inside.size() * 5 + turn) % (inside.size() - 1);
      if (same_class(inside[first], inside[(first + step) % inside.size()])) step = step % (inside.size() - 1) + 1;
      order.hidden.push_back(inside[(first + step) % inside.size()]);
    }
    if (kind.outside) order.hidden.push_back(outside[(turn + seed) % outside.size()]);
    cases.push_back({&kind, order});
  }
  return cases;
}

Outcome score(const PlannedCase& planned, const BlindCase& blind, const host::Verdict& verdict) {
  Outcome outcome;
  outcome.kind = planned.kind;
  outcome.order = planned.order;
  const auto& order = planned.order;
  std::set<std::string> explained;
  for (const auto& finding : verdict.findings) {
    if (sim::is_a<sim::ForceMap>(finding.effect)) continue;  // it names no cause
    const auto name = finding.effect.name();
    const bool hit = right(name, order);
    const bool alias = !hit && std::any_of(finding.confused_with.begin(), finding.confused_with.end(),
                                           [&](const auto& c) { return right(c.effect.name(), order); });
    if (outcome.named.empty()) outcome.first_right = hit, outcome.first_aliased = alias;
    outcome.wrong += !hit && !alias;
    outcome.named.push_back(name);
    for (const auto& hidden : order.hidden)
      if (right_for(name, hidden)) explained.insert(hidden);
    for (const auto& truth : blind.truth)
      if (truth.name == name) {
        const auto scores = score_parameters(blind.machine.axes.front(), truth, finding);
        outcome.parameters.insert(outcome.parameters.end(), scores.begin(), scores.end());
      }
  }
  outcome.exact_set = explained.size() == order.hidden.size() && outcome.named.size() == order.hidden.size();
  outcome.signature = verdict.unexplained.signature.value_or("");
  for (const auto& rejected : verdict.rejected)
    if (right(rejected.effect.name(), order) && !explained.contains(rejected.effect.name()))
      outcome.why += fmt::format("{}{}: {}", outcome.why.empty() ? "" : "; ", rejected.effect.name(), rejected.why);
  const auto square = [](double x) { return x * x; };
  outcome.gain = square(verdict.baseline.force_rms) - square(verdict.extended.force_rms);
  outcome.oracle_gain = blind.oracle_cut;
  return outcome;
}

std::vector<Outcome> run(const machine::Machine& shipped, const std::vector<PlannedCase>& plan, const Judge& judge,
                         int threads, const std::function<void(std::size_t)>& done) {
  std::vector<Outcome> outcomes(plan.size());
  std::atomic<std::size_t> next{0}, finished{0};
  const auto work = [&] {
    for (std::size_t n = next++; n < plan.size(); n = next++) {
      const auto begin = std::chrono::steady_clock::now();
      try {
        const auto blind = make_case(shipped, plan[n].order);
        const auto made = std::chrono::steady_clock::now();
        const auto verdict = judge(blind);
        outcomes[n] = score(plan[n], blind, verdict);
        outcomes[n].judge_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - made).count();
      } catch (const std::exception& error) {
        outcomes[n].kind = plan[n].kind;
        outcomes[n].order = plan[n].order;
        outcomes[n].error = error.what();
        outcomes[n].judge_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      }
      if (done) done(++finished);
    }
  };
  std::vector<std::thread> pool;
  for (int k = 0; k < threads; ++k) pool.emplace_back(work);
  for (auto& thread : pool) thread.join();
  return outcomes;
}

}  // namespace stiction::blind
