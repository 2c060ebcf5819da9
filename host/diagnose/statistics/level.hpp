// How often a name may be given to records in which nothing is hidden.
#pragma once

namespace stiction::host {

inline constexpr double level_of_design = 0.01;            // of records
inline constexpr double normal_exceeded_at_level = 2.326;  // standard deviations of a normal variable, to one side
inline constexpr double normal_limit = 1.959964;           // exceeded by |z| with a probability of 5 %
// What a name has to be likelier than none by. Where there is none, odds that are right beforehand exceed this as often
// as the level says at most, however many names there are (Ville 1939; Royall, J. Am. Stat. Assoc. 95, 2000).
inline constexpr double loss_ratio = 1.0 / level_of_design;

}  // namespace stiction::host
