// Texts that several descriptors have in common.
#pragma once

#include <string_view>

namespace stiction::sim::effects {

// Experiments that separate.
namespace experiments {
inline constexpr std::string_view frequency_response =
    "frequency response: a delay has a phase linear in frequency, friction none, an elastic mount a step of 180 deg";
inline constexpr std::string_view known_mass = "accelerations at several levels, with a known added mass";
}  // namespace experiments

// Why rows of two numbers, the largest error and current of a circle, do not show an effect.
namespace rows {
inline constexpr std::string_view both_directions =
    "not identifiable: a row has only the largest value of both directions; record one lap with separate directions";
inline constexpr std::string_view no_position =
    "not identifiable: a row has no position; record position and current over one stroke at constant speed";
inline constexpr std::string_view no_time =
    "not identifiable: a row has no time; record set-points, position and current";
}  // namespace rows

}  // namespace stiction::sim::effects
