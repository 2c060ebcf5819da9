// Which parameters of a drive differ from the file's, by its recorded command: the set of them with the highest odds
// against none, of whitened rows (statistics/marginal.hpp), each at the value where replays of it fit best.
#pragma once

#include <cstddef>
#include <vector>

#include "host/diagnose/judge/command_rows.hpp"
#include "host/diagnose/statistics/whitening.hpp"

namespace stiction::host {

using Places = std::vector<std::size_t>;  // of command_parameters()

// Times the file's: the range of a gain in which its slope says anything. What reaches an end is something else.
inline constexpr double least_of_file = 0.2, most_of_file = 5.0;

struct CommandTerm {
  std::size_t place;
  double value = 0.0, deviation = 0.0;
  double p_value = 1.0;
  double in_own_run = 0.0;  // change that the file's own runs seem to have
};

// The `axis` with the values of the terms.
machine::AxisModel with_terms(machine::AxisModel axis, const std::vector<CommandTerm>& terms);

struct CommandSearch {
  std::vector<CommandTerm> terms;
  Whitening noise;       // by what the terms leave
  Eigen::VectorXd left;  // A or V, of the rows: logged less replayed, without what the nuisances take off
};

// `commands`: of all records; `places`: the parameters that its axis has.
CommandSearch search_command(const CommandRows& commands, const Places& places);

// The part that the nuisances of `commands` have in `values` (A or V, of the rows) taken off, as it fits best through
// the `noise`; whitened.
Eigen::VectorXd whitened_without_nuisances(const CommandRows& commands, const Eigen::VectorXd& values,
                                           const Whitening& noise);

// Sets by how much each of the terms seems to differ in `own`, the file's own runs of the records, through the `noise`.
void look_at_own_runs(const CommandRows& own, const Whitening& noise, std::vector<CommandTerm>& terms);

// The log likelihood of what all parameters at `places` together leave, nats, but for a constant: what tells two ways
// to read a record apart.
double likelihood_of_rest(const CommandRows& commands, const Places& places);

}  // namespace stiction::host
