// Values of a machine file as fractions, without a rounding: what an endless axis needs, whose turns add up for years.
#pragma once

#include <toml++/toml.h>

#include <optional>
#include <string_view>

#include "firmware/machine/model/fraction.hpp"

namespace stiction::machine {

// Of either number of a fraction that a file gives. Below 2^53, so that its double is rounded once, in the division.
inline constexpr std::int64_t largest_in_file = 1'000'000'000'000'000;
inline constexpr std::string_view largest_in_file_words = "1000000000000000 (10^15)";

// What "355/113" and "3.25" say; none for anything else than a positive number of such a form whose numerator and
// denominator, in lowest terms, are at most largest_in_file. "1e-3" has that form.
std::optional<Fraction> exact_number(std::string_view text);

// The same of a node: a text, a whole number, or the shortest decimal that gives its double.
std::optional<Fraction> exact_number(const toml::node& node);

// A quantity such as "120 deg" or "0.5 um" in the base unit: turns where `si_unit` is "rad", else m. None for what is
// no such quantity, and for an angle in radians, of which a turn has no fraction.
std::optional<Fraction> exact_quantity(const toml::node& node, std::string_view si_unit);

}  // namespace stiction::machine
