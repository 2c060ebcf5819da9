// Records that cannot be diagnosed from, told before any cause is looked for. What is refused is a LogError.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/identify/log_rows.hpp"
#include "host/log/log.hpp"

namespace stiction::host {

// Questions to be answered before any result: amperes, lengths, signs and shifts of the channels of `axis` in `logs`
// (host/log/questions.hpp), as sentences that name the log.
std::vector<std::string> questions_before(std::span<const Log> logs, const machine::AxisModel& axis);

// A held-out log that is one of the training logs, or overlaps one. `held_out`: the logs against which the others are
// held; `axis`: the name of the axis.
void refuse_same_record(std::span<const Log> logs, std::span<const Log> held_out, const machine::AxisModel& axis);

// Set-points faster or further than the machine file allows.
void refuse_unreachable_set_points(const Log& log, const machine::AxisModel& axis);

// `expected`: the force (N) that the machine file gives for the motion of `rows`. A force of the other sign, or in
// effective amperes.
void refuse_other_units(const LogRows& rows, const Eigen::VectorXd& expected);

// A sentence where the file leaves more of the force's variance than a known effect causes; else empty. `rows` and
// `expected` as above.
std::string suspected_file(const LogRows& rows, const Eigen::VectorXd& expected);

}  // namespace stiction::host
