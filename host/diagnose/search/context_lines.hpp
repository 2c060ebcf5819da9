// The lines that periodic candidates are tried at: what stands out of a residual over position, over position in
// proportion to the force and to the speed, over time, and over the encoder's signal; and the places of local ones.
#pragma once

#include <Eigen/Dense>
#include <span>

#include "host/diagnose/classes/candidate.hpp"
#include "host/diagnose/statistics/whitening.hpp"
#include "host/identify/log_rows.hpp"

namespace stiction::host {

// Sets the scene's lines and adds to its places, from `residual` (N, of the rows), looked at through `whitening`; the
// motor's pole pitches are always among them. `context`: whose lines are set.
void find_lines(const LogRows& rows, const Eigen::VectorXd& residual, const Whitening& whitening,
                SearchContext& context);
// Only those among which one of `names` (of candidates()) is looked for; `rows`, `residual`, `whitening` and `context`:
// as above.
void find_lines_of(std::span<const std::size_t> names, const LogRows& rows, const Eigen::VectorXd& residual,
                   const Whitening& whitening, SearchContext& context);

}  // namespace stiction::host
