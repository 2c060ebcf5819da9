// The table of lift laws. A new law is one header in laws/ and one row in the table of its task: the motion file, the
// command line, checks, ranking, tables and docs/cam.md take everything from there.
#pragma once

#include <string_view>
#include <vector>

#include "sim/cam/law.hpp"

namespace stiction::sim::cam {

// All laws in the order of their numbers.
const std::vector<Law>& laws();

// The law of that name or alias, without regard to case, blanks, hyphens and underscores; null where there is none.
const Law* find_law(std::string_view name);

// The default of every parameter of `law`.
LawValues default_values(const Law& law);

// The curve of `law` on [0, 1] with `values` for some of its parameters, the others at their defaults, and the
// modifications of VDI 2143 where the law takes them. Throws machine::ValueError for a key that the law has not and a
// value out of its range, CamError for values that do not fit together.
Curve unit_curve(const Law& law, const LawValues& values = {});

// The task of one end with `values`: a slope given to an end at rest makes it one of constant speed.
End start_of(const Law& law, const LawValues& values);
End end_of(const Law& law, const LawValues& values);

namespace detail {
// The parts of the table, a source each.
std::vector<Law> rest_laws();
std::vector<Law> one_sided_laws();
std::vector<Law> return_laws();
std::vector<machine::ValueKey> modifications(double c = 1.0, double lambda = 0.5, double start_slope = 0.0,
                                             double end_slope = 0.0);
}  // namespace detail

}  // namespace stiction::sim::cam
