// The cam table as the drive reads and evaluates it, on tables that are written by hand: what is refused, and numbers
// that can be computed on paper.
#include "stiction/motion/cam_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace stiction {
namespace {

struct HandMade {
  CamTable::Header header;
  std::vector<CamTable::Segment> segments;
  std::vector<CamTable::Track> tracks{};
  std::vector<CamTable::Window> windows{};
};

void put(std::vector<std::uint8_t>& bytes, std::uint64_t value, int size) {
  for (int k = 0; k < size; ++k) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * k)));
}

std::vector<std::uint8_t> bytes_of(const HandMade& table) {
  std::vector<std::uint8_t> bytes{'S', 'C', 'A', 'M'};
  const auto& h = table.header;
  put(bytes, CamTable::version, 2);
  for (const auto value : {static_cast<int>(h.master), static_cast<int>(h.slave), static_cast<int>(h.periodic),
                           int{h.position_bits}, int{h.speed_bits}, int{h.acceleration_bits}})
    put(bytes, static_cast<std::uint64_t>(value), 1);
  put(bytes, table.segments.size(), 4);
  for (const auto value : {h.cycle, h.rise, h.position_bound, h.speed_bound, h.acceleration_bound})
    put(bytes, static_cast<std::uint64_t>(value), 8);
  put(bytes, table.tracks.size(), 2);
  put(bytes, table.windows.size(), 2);
  put(bytes, 0, 4);
  for (const auto& s : table.segments) {
    put(bytes, s.start, 4);
    put(bytes, s.reciprocal, 4);
    put(bytes, static_cast<std::uint64_t>(s.c0), 8);
    for (const std::int32_t c : s.c) put(bytes, static_cast<std::uint64_t>(std::int64_t{c}), 4);
    put(bytes, s.down, 1);
    put(bytes, s.shift, 1);
    put(bytes, s.finer, 2);
  }
  for (const auto& t : table.tracks) {
    put(bytes, t.first_window, 2);
    put(bytes, t.windows, 2);
    put(bytes, t.hysteresis, 4);
    put(bytes, static_cast<std::uint32_t>(t.on_compensation), 4);
    put(bytes, static_cast<std::uint32_t>(t.off_compensation), 4);
  }
  for (const auto& w : table.windows) put(bytes, w.on, 4), put(bytes, w.off, 4);
  put(bytes, Crc32{}.add(bytes, bytes.size()).value(), 4);
  return bytes;
}

// Two halves of a cycle: a line from 0 to 1, and 1 - t^2. Positions in 2^-30, so that a coefficient of 2^30 is 1.
HandMade line_and_parabola() {
  HandMade table;
  table.header.master = table.header.slave = CamTable::Kind::rotary;
  table.header.periodic = true;
  table.header.position_bits = 30;
  table.header.speed_bits = 20;
  table.header.acceleration_bits = 10;
  table.header.cycle = std::int64_t{6} << CamTable::cycle_bits;
  table.segments.resize(2);
  for (auto& s : table.segments) {
    s.reciprocal = 0x80000000u;  // 2^62 / 2^31
    s.down = 30;
    s.shift = CamTable::extra_bits;
  }
  table.segments[0].c[0] = 1 << 30;
  table.segments[1].start = 0x80000000u;
  table.segments[1].c0 = std::int64_t{1} << 30;
  table.segments[1].c[1] = -(1 << 30);
  return table;
}

CamTableProblem problem_of(const HandMade& table) {
  CamTable read;
  return CamTable::read(bytes_of(table), read);
}

TEST(CamTable, EvaluatesItsPolynomials) {
  const auto bytes = bytes_of(line_and_parabola());
  CamTable table;
  ASSERT_EQ(CamTable::read(bytes, table), CamTableProblem::none);
  EXPECT_EQ(table.header().cycle, std::int64_t{6} << CamTable::cycle_bits);
  for (const double share : {0.0, 0.125, 0.25, 0.4999}) {
    const auto out = table.evaluate(static_cast<std::uint32_t>(share * 0x1p32));
    EXPECT_NEAR(static_cast<double>(out.position) * 0x1p-30, 2 * share, 2e-9);
    EXPECT_NEAR(static_cast<double>(out.speed) * 0x1p-20, 2.0, 2e-6);  // over the cycle
    EXPECT_EQ(out.acceleration, 0);
  }
  for (const double share : {0.5, 0.625, 0.75, 0.9999}) {
    const double t = 2 * share - 1.0;
    const auto out = table.evaluate(static_cast<std::uint32_t>(share * 0x1p32));
    EXPECT_NEAR(static_cast<double>(out.position) * 0x1p-30, 1.0 - t * t, 2e-9);
    EXPECT_NEAR(static_cast<double>(out.speed) * 0x1p-20, -4.0 * t, 2e-6);
    EXPECT_NEAR(static_cast<double>(out.acceleration) * 0x1p-10, -8.0, 2e-3);
  }
}

TEST(CamTable, FindsTheSegmentOfEachPhase) {
  const auto first = line_and_parabola().segments[0];
  std::mt19937_64 random(5);
  // Each count of halvings, at a power of two and beside it.
  for (std::uint32_t power = 1; power <= CamTable::most_segments; power *= 2)
    for (const std::uint32_t count : {power, std::min(power + power / 3 + 1, CamTable::most_segments)}) {
      SCOPED_TRACE(count);
      HandMade table = line_and_parabola();
      table.segments.clear();
      const std::uint64_t share = (std::uint64_t{1} << 32) / count;
      // Segments of uneven lengths, constant each.
      for (std::uint32_t k = 0; k < count; ++k) {
        auto segment = first;
        segment.start = k == 0 ? 0 : static_cast<std::uint32_t>(k * share + random() % (share / 2));
        segment.c[0] = 0;
        segment.c0 = k;
        // At least as long as the longest is here: t stays below 1.
        segment.down = 31;
        segment.reciprocal = 0x80000000u;
        table.segments.push_back(segment);
      }
      const auto bytes = bytes_of(table);
      CamTable read;
      ASSERT_EQ(CamTable::read(bytes, read), CamTableProblem::none);
      for (std::uint32_t k = 0; k < count; k += 1 + count / 5000) {
        const std::uint32_t start = table.segments[k].start;
        ASSERT_EQ(read.find(start), k);
        ASSERT_EQ(read.evaluate(start + 5).position, k);
        if (k > 0) {
          ASSERT_EQ(read.find(start - 1), k - 1);
        }
      }
      EXPECT_EQ(read.find(UINT32_MAX), count - 1);
    }
}

TEST(CamTable, RefusesWhatEvaluationCannotDo) {
  EXPECT_EQ(problem_of(line_and_parabola()), CamTableProblem::none);
  const auto with = [](auto&& change) {
    HandMade table = line_and_parabola();
    change(table);
    return problem_of(table);
  };
  EXPECT_EQ(with([](auto& t) { t.segments.clear(); }), CamTableProblem::size);
  EXPECT_EQ(with([](auto& t) { t.header.master = static_cast<CamTable::Kind>(2); }), CamTableProblem::kind);
  EXPECT_EQ(with([](auto& t) { t.header.slave = static_cast<CamTable::Kind>(9); }), CamTableProblem::kind);
  EXPECT_EQ(with([](auto& t) { t.header.cycle = 0; }), CamTableProblem::scale);
  EXPECT_EQ(with([](auto& t) { t.header.rise = INT64_MAX; }), CamTableProblem::scale);
  EXPECT_EQ(with([](auto& t) { t.header.rise = INT64_MIN; }), CamTableProblem::scale);
  EXPECT_EQ(with([](auto& t) { t.segments[0].start = 1; }), CamTableProblem::segment_order);
  EXPECT_EQ(with([](auto& t) { t.segments[1].start = 0; }), CamTableProblem::segment_order);
  EXPECT_EQ(with([](auto& t) { t.segments[1].down = 32; }), CamTableProblem::scale);
  EXPECT_EQ(with([](auto& t) { t.segments[1].down = 20; }), CamTableProblem::scale);  // t beyond a word
  EXPECT_EQ(with([](auto& t) { t.segments[1].shift = 63; }), CamTableProblem::scale);
  EXPECT_EQ(with([](auto& t) { t.segments[1].c0 = INT64_MIN; }), CamTableProblem::scale);
  EXPECT_EQ(with([](auto& t) { t.segments[1].c0 = INT64_MAX; }), CamTableProblem::scale);
  EXPECT_EQ(with([](auto& t) { t.header.speed_bits = 100; }), CamTableProblem::scale);
  EXPECT_EQ(with([](auto& t) { t.header.acceleration_bits = 100; }), CamTableProblem::scale);
  EXPECT_EQ(with([](auto& t) { t.header.speed_bits = -100; }), CamTableProblem::scale);
  EXPECT_EQ(with([](auto& t) { t.header.acceleration_bits = -100; }), CamTableProblem::scale);
}

// The problem of line_and_parabola() with other bytes: `change` takes them without their checksum, which is then made.
template <class Change>
CamTableProblem problem_of_bytes(Change change) {
  auto bytes = bytes_of(line_and_parabola());
  bytes.resize(bytes.size() - CamTable::checksum_size);
  change(bytes);
  put(bytes, Crc32{}.add(bytes, bytes.size()).value(), 4);
  CamTable read;
  return CamTable::read(bytes, read);
}

TEST(CamTable, RefusesBytesThatAreNoTable) {
  EXPECT_EQ(problem_of_bytes([](auto&) {}), CamTableProblem::none);
  EXPECT_EQ(problem_of_bytes([](auto& b) { b.resize(CamTable::header_size - 1); }), CamTableProblem::too_short);
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_EQ(problem_of_bytes([k](auto& b) { b[k] ^= 1; }), CamTableProblem::no_table) << k;
  EXPECT_EQ(problem_of_bytes([](auto& b) { b[4] = 1; }), CamTableProblem::version);  // an older one
  EXPECT_EQ(problem_of_bytes([](auto& b) { b[5] = 1; }), CamTableProblem::version);
  EXPECT_EQ(problem_of_bytes([](auto& b) { b[8] = 2; }), CamTableProblem::kind);
  EXPECT_EQ(problem_of_bytes([](auto& b) { b.push_back(0); }), CamTableProblem::size);
  EXPECT_EQ(problem_of_bytes([](auto& b) { b[12] = 3; }), CamTableProblem::size);
  EXPECT_EQ(problem_of_bytes([](auto& b) { b[14] = 2; }), CamTableProblem::size);  // 131074 segments
  auto bytes = bytes_of(line_and_parabola());
  bytes[70] ^= 4;
  CamTable read;
  EXPECT_EQ(CamTable::read(bytes, read), CamTableProblem::checksum);
}

// 1/2 - 3 t^2 + 5/2 t^3, each coefficient in a unit of its own: 2^-30 / 2^finer.
TEST(CamTable, TakesCoefficientsThatAreFinerThanTheFirst) {
  HandMade table = line_and_parabola();
  auto& s = table.segments[1];
  s.c0 = std::int64_t{1} << 29;
  s.shift = CamTable::extra_bits - 4;
  s.finer = 3 | 1 << 4 | 15 << 8 | 7 << 12;
  s.c[1] = -3 * (1 << (30 - 4 + 3));
  s.c[2] = 5 << (29 - 4 + 1);
  const auto bytes = bytes_of(table);
  CamTable read;
  ASSERT_EQ(CamTable::read(bytes, read), CamTableProblem::none);
  EXPECT_EQ(read.segment(1).finer_bits(1), 0);
  EXPECT_EQ(read.segment(1).finer_bits(2), 3);
  EXPECT_EQ(read.segment(1).finer_bits(5), 7);
  for (const double t : {0.0, 0.25, 0.5, 0.9999}) {
    const auto out = read.evaluate(static_cast<std::uint32_t>((0.5 + t / 2) * 0x1p32));
    EXPECT_NEAR(static_cast<double>(out.position) * 0x1p-30, 0.5 - 3 * t * t + 2.5 * t * t * t, 2e-9) << t;
    EXPECT_NEAR(static_cast<double>(out.speed) * 0x1p-20, 2 * (-6 * t + 7.5 * t * t), 2e-6) << t;
    EXPECT_NEAR(static_cast<double>(out.acceleration) * 0x1p-10, 4 * (-6 + 15 * t), 2e-3) << t;
  }
}

// What is below 2^-32 cycles of a phase: the line of slope 2 goes on, the parabola's acceleration stays.
TEST(CamTable, EvaluatesPhasesBetweenTheWordsOfItsStarts) {
  HandMade table = line_and_parabola();
  for (auto& s : table.segments) s.shift -= 14;  // positions in 2^-44
  table.header.position_bits = 44;
  table.segments[1].c0 = std::int64_t{1} << 44;
  const auto bytes = bytes_of(table);
  CamTable read;
  ASSERT_EQ(CamTable::read(bytes, read), CamTableProblem::none);
  for (const std::uint64_t phase : {0x12345678'00000000u, 0x12345678'80000000u, 0x12345678'fffff000u}) {
    const auto out = read.evaluate_fine(phase);
    EXPECT_NEAR(static_cast<double>(out.position), std::ldexp(static_cast<double>(phase), -19), 1.0) << phase;
    EXPECT_EQ(out.speed, 2 << 20);
  }
  const auto coarse = read.evaluate(0xc0000000u), fine = read.evaluate_fine(0xc0000000'00000000u);
  EXPECT_EQ(coarse.position, fine.position);
  EXPECT_EQ(coarse.speed, fine.speed);
  EXPECT_EQ(coarse.acceleration, fine.acceleration);
  // Speed -4 t, and t goes by 2^-32 for half a word of the phase.
  const auto later = read.evaluate_fine(0xc0000000'80000000u);
  EXPECT_NEAR(static_cast<double>(later.position - fine.position), -2.0 * 0x1p44 * 0x1p-33, 1.0);
}

// A table of version 2, whose coefficients had one exponent: as it was, but not with bytes that version 2 left 0.
TEST(CamTable, ReadsTheVersionBefore) {
  EXPECT_EQ(problem_of_bytes([](auto& b) { b[4] = 2; }), CamTableProblem::none);
  EXPECT_EQ(problem_of_bytes([](auto& b) { b[CamTable::header_size + 38] = 1; }), CamTableProblem::none);
  EXPECT_EQ(problem_of_bytes([](auto& b) { b[4] = 2, b[CamTable::header_size + 38] = 1; }), CamTableProblem::scale);
  EXPECT_EQ(problem_of_bytes([](auto& b) { b[4] = 4; }), CamTableProblem::version);
}

// Two tracks of a cycle of 2^32: one on from 100 to 200 and around the seam, one that is always on. A compensation of
// -2^-10 s at 2^-10 cycles/s is -2^-20 cycles, so 4096 phases earlier.
HandMade with_tracks() {
  HandMade table = line_and_parabola();
  table.tracks = {{0, 2, 10, 0, 0}, {2, 1, 0, 0, 0}, {3, 1, 0, -(1 << 14), 1 << 14}};
  table.windows = {{100, 200}, {0xfffffff0u, 8}, {7, 7}, {100'000, 200'000}};
  return table;
}

TEST(CamTable, SwitchesItsTracks) {
  const auto bytes = bytes_of(with_tracks());
  CamTable table;
  ASSERT_EQ(CamTable::read(bytes, table), CamTableProblem::none);
  EXPECT_EQ(table.header().tracks, 3);
  EXPECT_EQ(table.segment(1).start, 0x80000000u);
  for (const std::uint32_t on : {100u, 199u, 0xfffffff0u, 0u, 7u}) EXPECT_TRUE(table.is_on(0, on, 0, false)) << on;
  for (const std::uint32_t off : {99u, 200u, 0xffffffefu, 8u}) EXPECT_FALSE(table.is_on(0, off, 0, false)) << off;
  for (const std::uint32_t kept : {90u, 209u, 0xffffffe6u, 17u}) EXPECT_TRUE(table.is_on(0, kept, 0, true)) << kept;
  for (const std::uint32_t left : {89u, 210u, 18u}) EXPECT_FALSE(table.is_on(0, left, 0, true)) << left;
  for (const std::uint32_t any : {0u, 7u, 0x80000000u}) EXPECT_TRUE(table.is_on(1, any, 0, false));
  constexpr std::int32_t speed = 1 << 14;
  EXPECT_FALSE(table.is_on(2, 100'000 - 4097, speed, false));
  EXPECT_TRUE(table.is_on(2, 100'000 - 4096, speed, false));
  EXPECT_TRUE(table.is_on(2, 200'000 + 4095, speed, false));
  EXPECT_FALSE(table.is_on(2, 200'000 + 4096, speed, false));
  EXPECT_FALSE(table.is_on(2, 100'000, -speed, false));  // backwards the switch is late where it was early
}

TEST(CamTable, RefusesTracksThatDoNotShareTheWindows) {
  EXPECT_EQ(problem_of(with_tracks()), CamTableProblem::none);
  const auto with = [](auto&& change) {
    HandMade table = with_tracks();
    change(table);
    return problem_of(table);
  };
  EXPECT_EQ(with([](auto& t) { t.tracks[1].windows = 0; }), CamTableProblem::track_windows);
  EXPECT_EQ(with([](auto& t) { t.tracks[1].first_window = 1; }), CamTableProblem::track_windows);
  EXPECT_EQ(with([](auto& t) { t.windows.pop_back(); }), CamTableProblem::track_windows);
  EXPECT_EQ(with([](auto& t) { t.windows.push_back({}); }), CamTableProblem::track_windows);
}

TEST(CamTable, APolynomialWithoutAShiftKeepsAllItsBits) {
  HandMade table = line_and_parabola();
  for (auto& s : table.segments) s.shift = 0;
  table.segments[0].c[0] = 1;
  const auto bytes = bytes_of(table);
  CamTable read;
  ASSERT_EQ(CamTable::read(bytes, read), CamTableProblem::none);
  EXPECT_EQ(read.evaluate(0x40000000u).position, 1 << (CamTable::extra_bits - 1));  // half of the first segment
}

TEST(CamTable, AnOutputThatIsShiftedOutOfAWordIsZero) {
  HandMade table = line_and_parabola();
  table.header.speed_bits = -20;  // shifts by 72
  table.header.acceleration_bits = -10;
  const auto bytes = bytes_of(table);
  CamTable read;
  ASSERT_EQ(CamTable::read(bytes, read), CamTableProblem::none);
  EXPECT_EQ(read.evaluate(7).speed, 0);
}

TEST(CamTable, LargestCoefficientsDoNotOverflow) {
  HandMade table = line_and_parabola();
  for (auto& s : table.segments)
    for (auto& c : s.c) c = INT32_MIN;
  const auto bytes = bytes_of(table);
  CamTable read;
  ASSERT_EQ(CamTable::read(bytes, read), CamTableProblem::none);
  const auto out = read.evaluate(0x7fffffffu);
  EXPECT_NEAR(static_cast<double>(out.position), -5.0 * 0x1p31, 100.0);
  EXPECT_LT(out.speed, 0);
  EXPECT_LT(out.acceleration, 0);
}

}  // namespace
}  // namespace stiction
