// What is wrong with a cam table or a request, in words: one list for the log, for refused starts and for pages.
#pragma once

#include <array>
#include <cstddef>

#include "stiction/motion/cam_curve.hpp"
#include "stiction/motion/cam_table.hpp"

namespace stiction {

inline constexpr std::array<const char*, 10> words_of_table_problems{
    "a whole table",
    "fewer bytes than a table has",
    "a file of a different kind",
    "a table of a different version of the format",
    "a table with bytes missing or added",
    "a table with a changed byte",
    "a table for an unknown kind of axis",
    "a table with scales that no drive can use",
    "a table whose segments do not follow each other",
    "a table whose switch tracks do not share their windows",
};

// What a table with that `problem` is, as a sentence part: "a table with a changed byte".
constexpr const char* words_of(CamTableProblem problem) {
  return words_of_table_problems[static_cast<std::size_t>(problem)];
}

inline constexpr std::array<const char*, cam_refusals> words_of_refusals{
    "nothing is refused",
    "numbers of a table, a ratio or a scale that the formats do not hold",
    "a table whose position, speed or acceleration jumps",
    "a curve that takes more than the limits of the axis at the largest speed of the master",
    "no way to the curve within the limits, in the time or distance asked for",
    "a start over a distance of the master from an axis that moves",
    "a master outside of the cycle of a cam that runs once",
    "a speed to leave with that is above the limit",
    "a table that was not given",
    "an axis that is not enabled in a mode of cam or gear",
    "a track of positions that leaves the travel",
    "a move on top of a second cam, or a second cam on top of a move",
};

// Why a request with that `refusal` is not taken, as a sentence part: what was found.
constexpr const char* words_of(CamRefusal refusal) { return words_of_refusals[static_cast<std::size_t>(refusal)]; }

}  // namespace stiction
