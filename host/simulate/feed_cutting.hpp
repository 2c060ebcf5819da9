// The parts of the experiment feed-cutting: each adds its figures and charts. Sources named in expectations: the paper
// (Kudoyarov, Perevertailo, Fetsak), which prints no parameters, and docs/prototype_figures.md, 7, with solutions of
// its equations for a plausible lathe.
#pragma once

#include "sim/experiment/experiment_result.hpp"
#include "sim/plant/feed/stick_slip_relations.hpp"

namespace stiction::host {

inline constexpr const char* feed_study = "prototype (docs/prototype_figures.md, 7)";
constexpr double mm_per_min = 1e-3 / 60.0;  // m/s

// Whether carriage and friction step are those of the prototype's lathe (300 kg, 1.33e7 N/m, 2000 N, 0.05): only then
// its figures in micrometres and seconds say something of this drive.
bool is_lathe_of_the_study(const machine::FeedDrive& drive);

// The drive with the static friction of a long standstill from the first instant on, as the relations assume it.
machine::FeedDrive without_dwell(machine::FeedDrive drive);

// `value` within `percent` of `expected`.
sim::Expectation study_within(double expected, double percent = 1.0);

// Jump, slip time, period, first slip, feed per revolution of an ideal drive: what the source's equations say.
void add_feed_relations(sim::ExperimentResult& result, const machine::FeedDrive& drive);

// What the printed damping term and the printed stick condition do.
void add_printed_equations(sim::ExperimentResult& result, const machine::FeedDrive& drive);

// The critical feed by formula and by bisection, over stiffness, friction step and loop gain.
void add_critical_feed(sim::ExperimentResult& result, const machine::FeedDrive& drive);

}  // namespace stiction::host
