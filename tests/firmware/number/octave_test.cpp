// Places in tables with two nodes an octave.
#include "stiction/number/octave.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stiction {
namespace {

constexpr int lowest = 16;

double node_value(int node) {
  if (node == 0) return 0.0;
  const double octave = std::ldexp(1.0, lowest + (node - 1) / 2);
  return (node - 1) % 2 == 0 ? octave : 1.5 * octave;
}

TEST(Octave, place_and_fraction_give_the_magnitude_back) {
  for (std::uint64_t raw = 0; raw < (1u << 31); raw += 1 + raw / 997) {
    const auto [node, fraction] = octave_place<lowest>(static_cast<std::uint32_t>(raw));
    const double low = node_value(node), high = node_value(node + 1);
    const double back = low + (high - low) * std::ldexp(fraction, -octave_fraction_bits);
    // Exact but for the bits of a magnitude that lie below the fraction's 28.
    ASSERT_NEAR(back, static_cast<double>(raw), 4.0) << raw;
    ASSERT_GE(fraction, 0);
    ASSERT_LT(fraction, 1 << octave_fraction_bits);
  }
}

TEST(Octave, the_highest_place_is_within_the_table) {
  const auto place = octave_place<lowest>(0x7fffffffu);
  EXPECT_EQ(place.node + 2, octave_nodes<lowest>);
  EXPECT_EQ(octave_place<20>(0x7fffffffu).node + 2, octave_nodes<20>);
}

TEST(Octave, nodes_are_where_they_are_said_to_be) {
  for (int node = 1; node + 1 < octave_nodes<lowest>; ++node) {
    const auto place = octave_place<lowest>(static_cast<std::uint32_t>(node_value(node)));
    EXPECT_EQ(place.node, node);
    EXPECT_EQ(place.fraction, 0);
  }
}

}  // namespace
}  // namespace stiction
