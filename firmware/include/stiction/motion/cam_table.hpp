// The table of an electronic cam: the slave's motion over one cycle of the master as quintic polynomials, 40 bytes
// each. `stiction cam table` makes it from a motion file; the bytes are the same on every host. All numbers are
// integers with the least significant byte first:
//
//   header, 64 bytes: "SCAM", version, kinds of master and slave, flags, scales, count of segments, cycle, rise of a
//   cycle, and the largest errors of position, speed and acceleration that whoever made it has proven;
//   segments, 40 bytes each: start in 2^-32 cycles, reciprocal of the length, position at the start, five coefficients
//   of one exponent, and by how many bits the last four are finer than that, 0 to 15 in four bits each;
//   switch tracks, 16 bytes each, and their windows, 8 bytes each;
//   the CRC-32 of everything before it, 4 bytes.
//
// Reading checks everything that evaluation relies on, so that no bytes make a shift or a sum that is not defined.
// Evaluation has fixed work: a search of as many steps as the count has bits, and the complete scheme of Horner, which
// makes a value and its derivatives from the same sums. Version 2 had no finer coefficients, and is read as well.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

#include "stiction/motion/cam_table_problem.hpp"
#include "stiction/number/crc.hpp"

namespace stiction {

// CRC-32/MPEG-2: each flipped bit is seen, and each burst of up to 32.
using Crc32 = Crc<std::uint32_t, 0x04C11DB7, 0xFFFFFFFF>;

class CamTable {
 public:
  static constexpr std::uint16_t version = 3, oldest_version = 2;
  static constexpr std::size_t header_size = 64, segment_size = 40, track_size = 16, window_size = 8, checksum_size = 4;
  // 2^-40 rad or m, of the cycle in the header.
  static constexpr int cycle_bits = 40;
  static constexpr std::uint32_t most_segments = 65536;

  // Linear or rotary: m or rad.
  enum class Kind : std::uint8_t { linear, rotary };

  struct Header {
    Kind master{}, slave{};
    bool periodic = false;
    std::int8_t position_bits = 0;      // positions are in 2^-position_bits of the slave's unit
    std::int8_t speed_bits = 0;         // the same for a cycle: 2^-speed_bits of the unit for each cycle
    std::int8_t acceleration_bits = 0;  // and for its square
    std::uint32_t count = 0;
    std::uint16_t tracks = 0, windows = 0;  // windows: of all tracks
    std::int64_t cycle = 0;                 // 2^-cycle_bits of the master's unit
    std::int64_t rise = 0;                  // of a cycle, as a position
    // Proven: no phase differs from the motion in double precision by more, in the units of the outputs.
    std::int64_t position_bound = 0, speed_bound = 0, acceleration_bound = 0;
  };

  // t = (phase - start) * reciprocal / 2^down, in 2^-32; position = c0 + (c1 t + ... + c5 t^5) / 2^shift, with the
  // coefficients in 2^-24 of themselves, of which c2 to c5 are divided by powers of two of their own.
  struct Segment {
    std::uint32_t start = 0;       // 2^-32 cycles
    std::uint32_t reciprocal = 0;  // 2^(32 + down) / length, from 2^31
    std::uint8_t down = 0;         // 0 to 31
    std::uint8_t shift = 0;        // 0 to 62
    std::uint16_t finer = 0;       // bits by which c2, c3, c4, c5 are finer than c1, the first in the lowest four
    std::int64_t c0 = 0;
    std::int32_t c[5] = {};

    // The bits by which the coefficient of t^`n` is finer, 0 to 15; `n`: 1 to 5.
    constexpr int finer_bits(int n) const { return n == 1 ? 0 : finer >> (4 * (n - 2)) & 15; }
  };

  // A cam switch (PLCopen: MC_DigitalCamSwitch): on in each of its windows.
  struct Track {
    std::uint16_t first_window = 0, windows = 0;
    std::uint32_t hysteresis = 0;      // 2^-32 cycles: by so much a window is wider while the switch is on
    std::int32_t on_compensation = 0;  // 2^-24 s; negative switches earlier
    std::int32_t off_compensation = 0;
  };

  // From `on` to before `off`, in 2^-32 cycles; around the seam where `on` is larger, always where both are equal.
  struct Window {
    std::uint32_t on = 0, off = 0;
  };

  struct Output {
    std::int64_t position = 0, speed = 0, acceleration = 0;  // in the header's scales, over the phase in cycles
  };

  // What is wrong with `bytes`; where nothing is, `table` looks at them, and they must stay as long as it does.
  static constexpr CamTableProblem read(std::span<const std::uint8_t> bytes, CamTable& table) {
    if (bytes.size() < header_size + checksum_size) return CamTableProblem::too_short;
    if (bytes[0] != 'S' || bytes[1] != 'C' || bytes[2] != 'A' || bytes[3] != 'M') return CamTableProblem::no_table;
    const std::uint64_t written = number(bytes, 4, 2);
    if (written < oldest_version || written > version) return CamTableProblem::version;
    CamTable read;
    read.bytes_ = bytes;
    Header& h = read.header_;
    h.count = static_cast<std::uint32_t>(number(bytes, 12, 4));
    h.tracks = static_cast<std::uint16_t>(number(bytes, 56, 2));
    h.windows = static_cast<std::uint16_t>(number(bytes, 58, 2));
    if (h.count == 0 || h.count > most_segments ||
        bytes.size() != read.windows_at() + window_size * h.windows + checksum_size)
      return CamTableProblem::size;
    const std::size_t end = bytes.size() - checksum_size;
    if (Crc32{}.add(bytes, end).value() != number(bytes, end, 4)) return CamTableProblem::checksum;
    if (bytes[6] > 1 || bytes[7] > 1 || bytes[8] > 1) return CamTableProblem::kind;
    read.fill_header();
    const std::uint32_t power = std::bit_floor(h.count);
    read.speed_shift_ = h.position_bits - 32 - h.speed_bits;
    read.acceleration_shift_ = h.position_bits - 64 - h.acceleration_bits;
    read.halvings_ = std::countr_zero(power);
    read.last_ = header_size + segment_size * (h.count - power);
    auto problem = read.check_segments(written);
    if (problem == CamTableProblem::none) problem = read.check_tracks();
    if (problem == CamTableProblem::none) table = read;
    return problem;
  }

  constexpr const Header& header() const { return header_; }

  constexpr Segment segment(std::uint32_t k) const { return segment_at(header_size + segment_size * k); }

  constexpr Track track(std::uint32_t k) const {
    const std::size_t at = tracks_at() + track_size * k;
    Track t;
    t.first_window = static_cast<std::uint16_t>(number(bytes_, at, 2));
    t.windows = static_cast<std::uint16_t>(number(bytes_, at + 2, 2));
    t.hysteresis = static_cast<std::uint32_t>(number(bytes_, at + 4, 4));
    t.on_compensation = static_cast<std::int32_t>(number(bytes_, at + 8, 4));
    t.off_compensation = static_cast<std::int32_t>(number(bytes_, at + 12, 4));
    return t;
  }

  constexpr Window window(std::uint32_t k) const {
    const std::size_t at = windows_at() + window_size * k;
    return {static_cast<std::uint32_t>(number(bytes_, at, 4)), static_cast<std::uint32_t>(number(bytes_, at + 4, 4))};
  }

  // Whether track `k` is on at `phase`, in 2^-32 cycles, at the master's `speed` in 2^-24 cycles/s; `was_on` before,
  // for the hysteresis. The work grows with the windows of the track.
  constexpr bool is_on(std::uint32_t k, std::uint32_t phase, std::int32_t speed, bool was_on) const {
    const Track t = track(k);
    const std::uint32_t wider = was_on ? t.hysteresis : 0;
    const auto way = [speed](std::int32_t time) {
      return static_cast<std::uint32_t>((std::int64_t{speed} * time) >> 16);
    };
    bool on = false;
    for (std::uint32_t n = 0; n < t.windows; ++n) {
      const Window w = window(std::uint32_t{t.first_window} + n);
      const std::uint32_t first = w.on + way(t.on_compensation) - wider;
      const std::uint32_t last = w.off + way(t.off_compensation) + wider;
      on = on || w.on == w.off || phase - first < last - first;
    }
    return on;
  }

  // The segment that holds `phase`, in 2^-32 cycles.
  constexpr std::uint32_t find(std::uint32_t phase) const {
    return static_cast<std::uint32_t>((place_of(phase) - header_size) / segment_size);
  }

  // Position, speed and acceleration at `phase`, in 2^-32 cycles.
  constexpr Output evaluate(std::uint32_t phase) const {
    const auto segment = segment_at(place_of(phase));
    const std::uint64_t t = std::uint64_t{phase - segment.start} * segment.reciprocal;
    return at(segment, static_cast<std::uint32_t>(t >> segment.down), 0);
  }

  // The same at `phase` in 2^-64 cycles: what is below 2^-32 cycles counts as well.
  constexpr Output evaluate_fine(std::uint64_t phase) const {
    const auto segment = segment_at(place_of(static_cast<std::uint32_t>(phase >> 32)));
    // t with 32 bits more.
    const std::uint64_t upper =
        std::uint64_t{static_cast<std::uint32_t>(phase >> 32) - segment.start} * segment.reciprocal;
    const std::uint64_t t = upper + (std::uint64_t{static_cast<std::uint32_t>(phase)} * segment.reciprocal >> 32);
    return at(segment, static_cast<std::uint32_t>(t >> segment.down),
              static_cast<std::uint32_t>(t) << 1 << (31 - segment.down));
  }

  // Of the coefficients while they are multiplied.
  static constexpr int extra_bits = 24;

 private:
  // The outputs of a `segment` at `t` and a `rest`, in 2^-32 and 2^-64 of what t goes through.
  [[gnu::always_inline]] constexpr Output at(const Segment& segment, std::uint32_t t, std::uint32_t rest) const {
    const auto c = [&segment](int n) {
#ifdef __SIZEOF_INT128__
      return std::int64_t{segment.c[n - 1]} * (1 << extra_bits) >> segment.finer_bits(n);
#else
      return std::int64_t{segment.c[n - 1]} * ((1 << extra_bits) >> segment.finer_bits(n));  // one product of words
#endif
    };
    // Written out: as a loop it takes a third more instructions on Cortex-M4.
    const std::int64_t c5 = c(5), first = high(c5, t);
    const std::int64_t b4 = first + c(4), b3 = high(b4, t) + c(3), b2 = high(b3, t) + c(2), b1 = high(b2, t) + c(1);
    const std::int64_t d4 = first + b4, d3 = high(d4, t) + b3, d2 = high(d3, t) + b2, d1 = high(d2, t) + b1;
    const std::int64_t e4 = first + d4, e3 = high(e4, t) + d3, a = 2 * (high(e3, t) + d2);
    // By the slope at t; of a bend so small a way makes nothing.
    const auto on = [rest](std::int64_t slope) {
      return std::int64_t{static_cast<std::int32_t>(slope >> 32)} * static_cast<std::int32_t>(rest >> 1) >> 31;
    };
    const std::int64_t y = high(b1, t) + on(d1), v = d1 + on(a);
    const std::int64_t speed = high(v, segment.reciprocal);
    const std::int64_t acceleration = high(high(a, segment.reciprocal), segment.reciprocal);
    const int shift = segment.shift + segment.down;
    return {segment.c0 + rounded(y, segment.shift), rounded(speed, shift + speed_shift_),
            rounded(acceleration, shift + segment.down + acceleration_shift_)};
  }

  constexpr void half(std::size_t& at, std::uint32_t phase, int power) const {
    const std::size_t next = at + (segment_size << power);
    if (start_of(next) <= phase) at = next;
  }
  constexpr std::uint32_t start_of(std::size_t at) const { return word<std::uint32_t>(bytes_, at); }

  // The place of the segment that holds `phase`: in bytes, so that no step takes a product.
  [[gnu::always_inline]] constexpr std::size_t place_of(std::uint32_t phase) const {
    // Among the last ones, as many as the largest power of two within the count, or among as many from the first one:
    // in both no step leads beyond the end.
    std::size_t at = start_of(last_) <= phase ? last_ : header_size;
    // Without a loop, whose steps would take twice the instructions.
    switch (halvings_) {
      case 16:
        half(at, phase, 15);
        [[fallthrough]];
      case 15:
        half(at, phase, 14);
        [[fallthrough]];
      case 14:
        half(at, phase, 13);
        [[fallthrough]];
      case 13:
        half(at, phase, 12);
        [[fallthrough]];
      case 12:
        half(at, phase, 11);
        [[fallthrough]];
      case 11:
        half(at, phase, 10);
        [[fallthrough]];
      case 10:
        half(at, phase, 9);
        [[fallthrough]];
      case 9:
        half(at, phase, 8);
        [[fallthrough]];
      case 8:
        half(at, phase, 7);
        [[fallthrough]];
      case 7:
        half(at, phase, 6);
        [[fallthrough]];
      case 6:
        half(at, phase, 5);
        [[fallthrough]];
      case 5:
        half(at, phase, 4);
        [[fallthrough]];
      case 4:
        half(at, phase, 3);
        [[fallthrough]];
      case 3:
        half(at, phase, 2);
        [[fallthrough]];
      case 2:
        half(at, phase, 1);
        [[fallthrough]];
      case 1:
        half(at, phase, 0);
        [[fallthrough]];
      default:
        return at;
    }
  }

  constexpr Segment segment_at(std::size_t at) const {
    const auto part = bytes_.subspan(at, segment_size);
    const auto c = [part](std::size_t n) { return word<std::int32_t>(part, 16 + 4 * n); };
    return {.start = word<std::uint32_t>(part, 0),
            .reciprocal = word<std::uint32_t>(part, 4),
            .down = part[36],
            .shift = part[37],
            .finer = word<std::uint16_t>(part, 38),
            .c0 = word<std::int64_t>(part, 8),
            .c = {c(0), c(1), c(2), c(3), c(4)}};
  }

  // `size` bytes from `at`, the least significant first.
  static constexpr std::uint64_t number(std::span<const std::uint8_t> bytes, std::size_t at, std::size_t size) {
    std::uint64_t value = 0;
    for (std::size_t k = size; k-- > 0;) value = value << 8 | bytes[at + k];
    return value;
  }
  // The same of 4 and 8, for what is read in each tick: a load, where the machine's order is that of the table.
  template <class Word>
  static constexpr Word word(std::span<const std::uint8_t> bytes, std::size_t at) {
    if (std::endian::native != std::endian::little || std::is_constant_evaluated())
      return static_cast<Word>(number(bytes, at, sizeof(Word)));
    Word value{};
    __builtin_memcpy(&value, bytes.data() + at, sizeof(Word));
    return value;
  }

  constexpr std::size_t tracks_at() const { return header_size + segment_size * header_.count; }
  constexpr std::size_t windows_at() const { return tracks_at() + track_size * header_.tracks; }

  // value * factor / 2^32, rounded down: two products of 32 bits, or one of 64 where the machine has it. |value| <
  // 2^62.
  static constexpr std::int64_t high(std::int64_t value, std::uint32_t factor) {
#ifdef __SIZEOF_INT128__
    __extension__ using Wide = __int128;
    return static_cast<std::int64_t>((static_cast<Wide>(value) * factor) >> 32);
#else
    // The upper word as one without a sign; what that is too much of a negative one goes into the upper word of the
    // sum.
    const auto upper = static_cast<std::uint32_t>(static_cast<std::uint64_t>(value) >> 32);
    const auto lower = static_cast<std::uint32_t>(value);
    const std::uint32_t sign = static_cast<std::uint32_t>(static_cast<std::int32_t>(upper) >> 31) & (0u - factor);
#ifdef __thumb2__
    // Product and sum in one instruction, which g++ makes of neither form.
    if (!std::is_constant_evaluated()) {
      auto low = static_cast<std::uint32_t>(std::uint64_t{lower} * factor >> 32);
      std::uint32_t top = sign;
      asm("umlal %0, %1, %2, %3" : "+r"(low), "+r"(top) : "r"(upper), "r"(factor));
      return static_cast<std::int64_t>(std::uint64_t{top} << 32 | low);
    }
#endif
    const std::uint64_t sum = std::uint64_t{sign} << 32 | std::uint64_t{lower} * factor >> 32;
    return static_cast<std::int64_t>(sum + std::uint64_t{upper} * factor);
#endif
  }

  // To nearest; what is shifted out of a word is nothing.
  static constexpr std::int64_t rounded(std::int64_t value, int shift) {
    return ((2 * value >> (shift < 63 ? shift : 63)) + 1) >> 1;
  }

  constexpr void fill_header() {
    Header& h = header_;
    h.master = static_cast<Kind>(bytes_[6]);
    h.slave = static_cast<Kind>(bytes_[7]);
    h.periodic = bytes_[8] == 1;
    h.position_bits = static_cast<std::int8_t>(bytes_[9]);
    h.speed_bits = static_cast<std::int8_t>(bytes_[10]);
    h.acceleration_bits = static_cast<std::int8_t>(bytes_[11]);
    h.cycle = static_cast<std::int64_t>(number(bytes_, 16, 8));
    h.rise = static_cast<std::int64_t>(number(bytes_, 24, 8));
    h.position_bound = static_cast<std::int64_t>(number(bytes_, 32, 8));
    h.speed_bound = static_cast<std::int64_t>(number(bytes_, 40, 8));
    h.acceleration_bound = static_cast<std::int64_t>(number(bytes_, 48, 8));
  }

  constexpr CamTableProblem check_segments(std::uint64_t written) const {
    constexpr std::int64_t most = std::int64_t{1} << 61;
    const auto within = [](std::int64_t value) { return value >= -most && value <= most; };
    if (header_.cycle <= 0 || !within(header_.rise)) return CamTableProblem::scale;
    for (std::uint32_t k = 0; k < header_.count; ++k)
      if (k == 0 ? segment(k).start != 0 : segment(k).start <= segment(k - 1).start)
        return CamTableProblem::segment_order;
    for (std::uint32_t k = 0; k < header_.count; ++k) {
      const Segment s = segment(k);
      const auto shifts = [](int shift) { return shift >= 0 && shift <= 127; };
      const std::uint64_t length =
          (k + 1 < header_.count ? std::uint64_t{segment(k + 1).start} : std::uint64_t{1} << 32) - s.start;
      // Up to the segment's end t stays within a word. The product is below 2^64.
      const bool in_word = s.down <= 31 && ((length * s.reciprocal - 1) >> s.down) >> 32 == 0;
      if (!in_word || !within(s.c0) || s.shift > 62 || (written == oldest_version && s.finer != 0) ||
          !shifts(s.shift + s.down + speed_shift_) || !shifts(s.shift + 2 * s.down + acceleration_shift_))
        return CamTableProblem::scale;
    }
    return CamTableProblem::none;
  }

  constexpr CamTableProblem check_tracks() const {
    std::uint32_t next = 0;
    for (std::uint32_t k = 0; k < header_.tracks; ++k) {
      const Track t = track(k);
      if (t.first_window != next || t.windows == 0) return CamTableProblem::track_windows;
      next += t.windows;
    }
    return next == header_.windows ? CamTableProblem::none : CamTableProblem::track_windows;
  }

  std::span<const std::uint8_t> bytes_{};
  Header header_{};
  std::size_t last_ = header_size;  // where the search looks first
  int halvings_ = 0;                // and how often it halves then
  // By how much the products of a segment are shifted to the outputs, its own shifts aside.
  int speed_shift_ = 0, acceleration_shift_ = 0;
};

}  // namespace stiction
