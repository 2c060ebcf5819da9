// Rows in which friction is a reaction: at a standstill, of a law without a contact, the motor's force is anything up
// to the law's jump at zero speed, and no motion tells it.
#pragma once

#include <Eigen/Dense>

#include "firmware/machine/model/machine.hpp"
#include "host/identify/log_rows.hpp"

namespace stiction::host {

// Whether friction of this axis is a reaction at standstill: a law without a contact that jumps at zero speed.
bool sticks_rigidly(const machine::AxisModel& axis);

// 1 for each of `rows` that moves, else 0; all 1 where friction of `axis` is no reaction. Slower than friction stops
// the mass within what the position's filter (`cutoff`, Hz) resolves, an axis cannot be told from one that stands; as
// far as that filter reaches, the rows on each side have a share in it.
Eigen::VectorXd moving_rows(const LogRows& rows, const machine::AxisModel& axis, double cutoff);

}  // namespace stiction::host
