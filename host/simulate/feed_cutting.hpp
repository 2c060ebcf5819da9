// The parts of the experiment feed-cutting: each adds its figures and charts. The paper (Kudoyarov, Perevertailo,
// Fetsak) prints no parameters. The figures that a drive is expected to show are in its machine file.
#pragma once

#include "sim/experiment/experiment_result.hpp"
#include "sim/plant/feed/stick_slip_relations.hpp"

namespace stiction::host {

constexpr double mm_per_min = 1e-3 / 60.0;  // m/s

// The drive with the static friction of a long standstill from the first instant on, as the relations assume it.
machine::FeedDrive without_dwell(machine::FeedDrive drive);

// Jump, slip time, period, first slip, feed per revolution of an ideal drive: what the source's equations say.
void add_feed_relations(sim::ExperimentResult& result, const machine::FeedDrive& drive);

// What the printed damping term and the printed stick condition do.
void add_printed_equations(sim::ExperimentResult& result, const machine::FeedDrive& drive);

// The critical feed by formula and by bisection, over stiffness, friction step and loop gain.
void add_critical_feed(sim::ExperimentResult& result, const machine::FeedDrive& drive);

}  // namespace stiction::host
