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
  // That records of the exact machine seem to have such a change, by Student's t of what they have; 1 of none.
  double p_of_exact = 1.0;
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

// Compares the terms of the `found` with what draws of the `exact` machine seem to have of them: a replay knows no
// positions between the samples. `records`: those that were searched; `commands`: their rows.
void compare_with_exact(const CommandRecords& records, const CommandRows& commands, const ExactLogs& exact,
                        CommandSearch& found);

// The log likelihood of what all parameters at `places` together leave, nats, but for a constant: what tells two ways
// to read a record apart.
double likelihood_of_rest(const CommandRows& commands, const Places& places);

}  // namespace stiction::host
