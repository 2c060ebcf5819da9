// What terms gain on data that took no part in finding them. Each record's nuisances are estimated anew, the same in
// baseline and extension: a constant force, today's Coulomb level, and of a ripple the home position; never what a term
// names. What is known along the recorded stroke alone is judged in the rows within it.
#pragma once

#include <span>
#include <vector>

#include "host/diagnose/judge/held_out_amplitude.hpp"
#include "host/diagnose/record/effect_response.hpp"
#include "host/diagnose/search/search.hpp"

namespace stiction::host {

struct HeldOutFigures {
  double force_baseline = 0.0, force_extended = 0.0;  // N rms, without nuisances
  std::vector<HoldoutGain> gains;                     // of each term beside the others; force only
  // Of each term's force beside the others', and of all together: what these rows show of it. Of terms that were found
  // on whitened rows the less favourable of that as they are and whitened.
  std::vector<HeldOutAmplitude> held_out_amplitudes;
  HeldOutAmplitude together;
};

// The `target` (N, residual force of the held-out `rows`) less what the named `terms` of a search make there, a
// ripple's phase as it fits each record best. `context`: of the search.
Eigen::VectorXd without_terms(const LogRows& rows, const Eigen::VectorXd& target, const SearchContext& context,
                              std::span<const Term> terms);

// Held-out data with what a search was over.
struct HeldOutData {
  const LogRows& rows;
  const Eigen::VectorXd& target;        // N, their residual force
  const SearchContext& context;         // of the search
  std::span<EffectResponse> responses;  // of these records; none where they cannot run
  std::uint64_t seed;                   // of the bootstrap
};

// Of the `terms` that a search over other records found; the force of one that runs describe (Term::in_runs) is that of
// runs of these records. Intervals: bootstrap over blocks of rows.
HeldOutFigures evaluate_held_out(const HeldOutData& data, std::span<const Term> terms);

// N rms, the residual force of the same data where of the `terms` those that are `counted` act alone; with the
// nuisances of all of them.
double held_out_force(const HeldOutData& data, std::span<const Term> terms, const std::vector<bool>& counted);

// 95 % interval of the ratio of two residuals' rms, from a bootstrap over blocks of rows. `after` and `before`:
// residual force in the `rows` (N) with the causes and without them; `seed` of the bootstrap.
std::array<double, 2> ratio_interval(const Eigen::VectorXd& after, const Eigen::VectorXd& before, const LogRows& rows,
                                     std::uint64_t seed);

}  // namespace stiction::host
