// Rows in which no motion tells the friction. At a standstill, of a law without a contact, it is a reaction: the
// motor's force is anything up to the law's jump at zero speed. At the start of a record a contact is as it was left
// before.
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
// m, that an `axis` gets no further than within the filter's reach when it cannot be told from one that stands;
// `cutoff` as above.
double unresolved_distance(const machine::AxisModel& axis, double cutoff);
// 1 for each sample of the `motion` that is faster than `speed` (m/s) as far as the filter (`cutoff`, Hz) reaches to
// each side, else 0.
std::vector<double> samples_faster_than(double speed, const Motion& motion, double cutoff);

// 1 for each of `rows` in which a contact of `axis` has forgotten how it was left before the record: behind the first
// slide of each log, else 0. All 1 where there is no contact, or in a log that never slides.
Eigen::VectorXd rows_after_first_slide(const LogRows& rows, const machine::AxisModel& axis);

}  // namespace stiction::host
