// The keys of [[expected]], each described once: the reader, its messages and the reference page are made from this
// table. A value has the unit of its figure, which only the experiment knows, so that these
// rows have a table of their own kind.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <variant>

#include "firmware/machine/file/parameters.hpp"

namespace stiction::machine {

inline constexpr std::string_view expected_key = "expected";
inline constexpr std::string_view expected_text =
    "a figure that an experiment is expected to show on this machine; printed next to its result, for this machine "
    "only";

struct ExpectedText {
  std::string_view key;
  std::variant<std::string ExpectedFigure::*, std::optional<std::string> ExpectedFigure::*> member;
  std::string_view text;
};
inline constexpr std::array<ExpectedText, 5> expected_texts{{
    {"experiment", &ExpectedFigure::experiment, "the experiment, or identify-reference"},
    {"axis", &ExpectedFigure::axis, "the axis that the figure is of; left out: the machine has one, or it is of none"},
    {"friction", &ExpectedFigure::friction, "the friction model that acts; left out: every model"},
    {"figure", &ExpectedFigure::figure, "name as in the experiment's results, without model and unit"},
    {"source", &ExpectedFigure::source, "document and place"},
}};

struct ExpectedQuantity {
  std::string_view key;
  std::string ExpectedFigure::*member;
  std::string_view text;
};
inline constexpr std::array<ExpectedQuantity, 2> expected_quantities{{
    {"value", &ExpectedFigure::value, "value that is expected, in any unit of the figure's dimension"},
    {"tolerance", &ExpectedFigure::tolerance, "how far the figure may be off, at least 0, in a unit of that dimension"},
}};

inline constexpr std::string_view when_key = "when";
inline constexpr std::string_view when_text =
    "overrides as for --set, and options of the experiment (l-shape: jerk); the row is in force in runs with these and "
    "no "
    "others, apart from overrides of other axes and of other friction models";

// Options of experiments that a row may be for.
struct ExperimentOption {
  std::string_view experiment, option, unit;
};
inline constexpr std::array<ExperimentOption, 1> experiment_options{{{"l-shape", "jerk", "m/s^3"}}};

// A row may name this one in addition to the experiments that have overrides.
inline constexpr std::string_view identification_of_references = "identify-reference";

}  // namespace stiction::machine
