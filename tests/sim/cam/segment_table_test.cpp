// The drive's table against the motion in double precision, and what of its bytes is refused.
#include "sim/cam/segment_table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/cam/characteristics.hpp"
#include "sim/cam/laws.hpp"
#include "tests/sim/cam/random_motion.hpp"
#include "tests/sim/cam/table_bytes.hpp"
#include "tests/sim/cam/table_errors.hpp"

namespace stiction::sim::cam {
namespace {

// 64 segments a rise: position 1e-9 of the stroke, speed 1e-7 and acceleration 1e-5 of their peaks; the proven bound is
// above what is measured, and by at most a factor of 8. 10^7 phases over all laws; print_table_errors does them for
// each.
TEST(CamSegmentTable, IsWithinTheWantedErrorsAndItsBoundForEveryLaw) {
  for (const Law& law : laws()) {
    const LawTable of_law = law_table(law, 120'000);
    EXPECT_LE(of_law.position, 1e-9) << law.name;
    EXPECT_LE(of_law.speed, 1e-7) << law.name;
    EXPECT_LE(of_law.acceleration, 1e-5) << law.name;
    EXPECT_GE(of_law.least_excess, 1.0) << law.name;
    EXPECT_LE(of_law.most_excess, 8.0) << law.name;
  }
}

TEST(CamSegmentTable, KeepsTheToleranceThatItIsAskedFor) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    RandomMotion random(seed);
    const Motion motion = compose(seed % 2 == 0 ? random.rests(4) : random.septics(4));
    std::uint32_t segments = 0;
    for (const double tolerance : {1e-5, 1e-7, 1e-9}) {
      const SegmentTable table = table_within(motion, tolerance);
      EXPECT_LE(table.bound.position, tolerance);
      EXPECT_LE(measured(motion, opened(table), 20'000).position, table.bound.position);
      EXPECT_GE(table.segments, segments);
      segments = table.segments;
    }
  }
}

TEST(CamSegmentTable, OfA345IsTwoSegmentsForItsTwoPieces) {
  Cam cam{.name = "a", .periodic = false};
  cam.segments = {{.length = 1.0, .stroke = 1.0, .law = "3-4-5"}};
  EXPECT_EQ(table_within(compose(cam), 1e-8).segments, 2u);
}

TEST(CamSegmentTable, SaysForWhomItIs) {
  Cam cam{.name = "a", .slave = Coordinate::linear, .modulo = 0.5};
  cam.segments = {{.length = 2.0, .stroke = 1.0, .law = "modified_sine"}, {.length = 1.0}};
  const auto table = table_within(compose(cam), 1e-9);
  const auto h = opened(table).header();
  EXPECT_EQ(h.master, CamTable::Kind::rotary);
  EXPECT_EQ(h.slave, CamTable::Kind::linear);
  EXPECT_TRUE(h.periodic);
  EXPECT_NEAR(static_cast<double>(h.cycle) * std::ldexp(1.0, -CamTable::cycle_bits), 3.0, 1e-12);
  EXPECT_NEAR(static_cast<double>(h.rise) * std::ldexp(1.0, -h.position_bits), 1.0, 1e-12);
  EXPECT_NEAR(static_cast<double>(h.position_bound) * std::ldexp(1.0, -h.position_bits), table.bound.position, 1e-12);
}

// The table's switches against those of the motion, at every phase but those within a rounding of a switching place.
TEST(CamSegmentTable, SwitchesItsTracksAsTheMotionDoes) {
  Cam cam{.name = "a"};
  cam.segments = {{.length = 4.0, .stroke = 1.0, .law = "modified_sine"},
                  {.length = 2.0, .stroke = -1.0, .law = "3-4-5"}};
  cam.tracks = {{"gate", {{1.0, 2.0}, {5.0, 0.5}}, -0.1, 0.05, 0.01}, {"always", {{0.0, 6.0}}, 0.0, 0.0, 0.0}};
  const auto bytes = table_within(compose(cam), 1e-6).bytes;
  CamTable table;
  ASSERT_EQ(CamTable::read(bytes, table), CamTableProblem::none);
  for (const double speed : {0.0, 1.0, -2.5})
    for (const bool was_on : {false, true})
      for (int k = 0; k < 6000; ++k) {
        const double x = (k + 0.37) * 1e-3;
        const auto phase = static_cast<std::uint32_t>(x / 6.0 * 0x1p32);
        const auto rate = static_cast<std::int32_t>(std::lround(speed / 6.0 * 0x1p24));
        for (std::uint32_t track = 0; track < 2; ++track)
          ASSERT_EQ(table.is_on(track, phase, rate, was_on), is_on(cam.tracks[track], x, 6.0, speed, was_on))
              << track << " at " << x << ", speed " << speed;
      }
}

// The bytes of 100 motions, as one checksum. It is a constant: whatever compiler and processor this test runs on must
// make the same tables.
TEST(CamSegmentTable, HasTheSameBytesEverywhere) {
  Crc32 checksum;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    RandomMotion random(9000 + seed);
    const auto table = table_within(compose(seed % 2 == 0 ? random.rests(6) : random.septics(5)), 1e-8);
    checksum.add(table.bytes, table.bytes.size());
  }
  EXPECT_EQ(checksum.value(), 0x3699d37du);
}

// The same of motion files, read from their text.
TEST(CamSegmentTable, OfAMotionFileHasTheSameBytesEverywhere) {
  std::uint32_t sum = 0;
  for (std::uint64_t seed = 1; seed <= drawn_files; ++seed) sum = sum * 31 + table_checksum(seed);
  EXPECT_EQ(sum, 0xabb0045du);
}

TEST(CamSegmentTable, RefusesEachFlippedBitAndEachLength) {
  Cam cam{.name = "a", .periodic = false};
  cam.segments = {{.length = 2.0, .stroke = 1.0, .law = "modified_sine"}, {.length = 1.0}};
  const auto table = table_within(compose(cam), 1e-6);
  CamTable read;
  auto bytes = table.bytes;
  for (std::size_t k = 0; k < bytes.size(); ++k)
    for (int bit = 0; bit < 8; ++bit) {
      bytes[k] ^= static_cast<std::uint8_t>(1u << bit);
      ASSERT_NE(CamTable::read(bytes, read), CamTableProblem::none) << "byte " << k << ", bit " << bit;
      bytes[k] ^= static_cast<std::uint8_t>(1u << bit);
    }
  for (std::size_t size = 0; size < bytes.size(); ++size)
    ASSERT_NE(CamTable::read(std::span(bytes).first(size), read), CamTableProblem::none) << size;
  bytes.push_back(0);
  EXPECT_EQ(CamTable::read(bytes, read), CamTableProblem::size);
  bytes.pop_back();
  bytes[4] = 1;  // an older version
  EXPECT_EQ(CamTable::read(bytes, read), CamTableProblem::version);
  bytes[0] = 'x';
  EXPECT_EQ(CamTable::read(bytes, read), CamTableProblem::no_table);
}

TEST(CamSegmentTable, RefusesMotionsThatNoDriveCanFollow) {
  Cam cam{.name = "a", .periodic = false};
  cam.segments = {{.length = 2.0, .stroke = 1.0, .law = "linear"}};
  EXPECT_THROW(table_within(compose(cam), 1e-6), CamError);
  cam.segments[0].law = "modified_sine";
  EXPECT_THROW(table_within(compose(cam), 0.0), CamError);
  EXPECT_THROW(table_within(compose(cam), 1e-18), CamError);
}

}  // namespace
}  // namespace stiction::sim::cam
