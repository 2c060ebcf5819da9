#include "firmware/stictiond/tuned_table.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace stiction::drive {
namespace {

// Joints nearer than this are one: a pulse differs there by the cube of it over its length.
constexpr std::uint64_t nearest_joints = 1 << 16;

using machine::TablePoint;

struct Part {
  std::uint64_t begin, end;
  TablePoint from, to;
};

// The 3-4-5 polynomial from 0 to 1 over `length` from `begin` on, and its derivatives over cycles.
TablePoint pulse_at(std::uint64_t phase, std::uint64_t begin, std::uint64_t length) {
  if (phase <= begin) return {};
  if (phase >= begin + length) return {1.0, 0.0, 0.0};
  const double x = static_cast<double>(phase - begin) / static_cast<double>(length);
  const double over = 0x1p32 / static_cast<double>(length);
  return {x * x * x * (10.0 + x * (6.0 * x - 15.0)), 30.0 * x * x * (1.0 - x) * (1.0 - x) * over,
          60.0 * x * (1.0 - x) * (1.0 - 2.0 * x) * over * over};
}

void put(std::vector<std::uint8_t>& bytes, std::size_t at, std::uint64_t value, int size) {
  for (int k = 0; k < size; ++k) bytes[at + static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(value >> (8 * k));
}

// The quintic through both ends of `part` as a segment of a table of that `version` whose positions have
// `position_bits`.
bool segment_of(const Part& part, int version, int position_bits, CamTable::Segment& made) {
  const std::uint64_t length = part.end - part.begin;
  const double h = static_cast<double>(length) * 0x1p-32, scale = std::ldexp(1.0, position_bits);
  const double y = part.to.position - part.from.position, v0 = part.from.slope * h, v1 = part.to.slope * h;
  const double a0 = part.from.bend * h * h, a1 = part.to.bend * h * h;
  const double d = y - v0 - 0.5 * a0, e = v1 - v0 - a0, f = a1 - a0;
  const double c[5]{v0, 0.5 * a0, 10.0 * d - 4.0 * e + 0.5 * f, -15.0 * d + 7.0 * e - f, 6.0 * d - 3.0 * e + 0.5 * f};
  made.start = static_cast<std::uint32_t>(part.begin);
  int down = 0;
  while (down < 31 && (std::uint64_t{1} << (down + 1)) < length) ++down;
  // Rounded down: t stays below 1 up to the last phase.
  const std::uint64_t exact =
      length == std::uint64_t{1} << 32 ? std::uint64_t{1} << 31 : (std::uint64_t{1} << (32 + down)) / length;
  made.down = static_cast<std::uint8_t>(down);
  made.reciprocal = static_cast<std::uint32_t>(std::min<std::uint64_t>(exact, UINT32_MAX));
  if (!(std::abs(part.from.position * scale) < 0x1p60)) return false;
  made.c0 = std::llround(part.from.position * scale);
  double largest = 0.0;
  for (const double each : c) largest = std::max(largest, std::abs(each * scale));
  // As fine as 32 bits have it, and no finer than 2^-8 of a position's unit, as the tables of the desk.
  int shift = CamTable::extra_bits + 8;
  while (shift >= 0 && largest * std::ldexp(1.0, shift - CamTable::extra_bits) >= 2147483647.0) --shift;
  if (shift < 0) return false;
  made.shift = static_cast<std::uint8_t>(shift);
  for (int n = 1; n < 6; ++n) {
    const double value = c[n - 1] * scale * std::ldexp(1.0, shift - CamTable::extra_bits);
    int finer = 0;
    while (version > CamTable::oldest_version && n > 1 && finer < 15 &&
           std::abs(std::ldexp(value, finer + 1)) < 2147483647.0)
      ++finer;
    if (n > 1) made.finer = static_cast<std::uint16_t>(made.finer | finer << (4 * (n - 2)));
    made.c[n - 1] = static_cast<std::int32_t>(std::llround(std::ldexp(value, finer)));
  }
  return true;
}

// The joints of the rise: those of the table, and where a pulse begins or ends.
std::vector<std::uint64_t> joints_of(const CamTable& table, std::uint64_t begin, std::uint64_t end,
                                     const machine::PulsePlaces& places) {
  std::vector<std::uint64_t> joints{begin, end};
  for (std::uint32_t k = 0; k < table.header().count; ++k)
    if (const std::uint64_t at = table.segment(k).start; at > begin && at < end) joints.push_back(at);
  const auto add = [&](std::uint64_t at) {
    for (const std::uint64_t each : joints)
      if (std::max(at, each) - std::min(at, each) < nearest_joints) return;
    joints.push_back(at);
  };
  for (const std::uint64_t at : {places.first, places.second}) {
    add(at);
    add(std::min<std::uint64_t>(at + places.length, end));
  }
  std::sort(joints.begin(), joints.end());
  return joints;
}

}  // namespace

std::vector<std::uint8_t> with_pulses(const CamTable& table, std::span<const std::uint8_t> bytes,
                                      const machine::TunedRise& rise, const machine::PulsePlaces& places,
                                      const PulseAmplitudes& amplitudes) {
  const auto& h = table.header();
  const std::uint64_t begin = rise.begin, end = begin + rise.length;
  const double share = 1.0 - (amplitudes.first + amplitudes.second) / rise.stroke;
  const auto point = [&](std::uint64_t phase, bool before) {
    TablePoint sum = machine::table_point(table, phase, before);
    sum = {rise.start + share * (sum.position - rise.start), share * sum.slope, share * sum.bend};
    const std::pair<std::uint32_t, double> pulses[]{{places.first, amplitudes.first},
                                                    {places.second, amplitudes.second}};
    for (const auto& [place, amplitude] : pulses) {
      const TablePoint pulse = pulse_at(phase, place, places.length);
      sum.position += amplitude * pulse.position;
      sum.slope += amplitude * pulse.slope;
      sum.bend += amplitude * pulse.bend;
    }
    return sum;
  };
  std::vector<CamTable::Segment> segments;
  for (std::uint32_t k = 0; k < h.count && table.segment(k).start < begin; ++k) segments.push_back(table.segment(k));
  const auto joints = joints_of(table, begin, end, places);
  for (std::size_t k = 0; k + 1 < joints.size(); ++k) {
    const Part part{joints[k], joints[k + 1], point(joints[k], false), point(joints[k + 1], true)};
    if (!segment_of(part, bytes[4], h.position_bits, segments.emplace_back())) return {};
  }
  for (std::uint32_t k = 0; k < h.count; ++k)
    if (table.segment(k).start >= end) segments.push_back(table.segment(k));
  if (segments.size() > CamTable::most_segments) return {};

  int speed_bits = 100, acceleration_bits = 100;
  for (const auto& segment : segments) {
    speed_bits = std::min(speed_bits, h.position_bits + segment.shift + segment.down - 32);
    acceleration_bits = std::min(acceleration_bits, h.position_bits + segment.shift + 2 * segment.down - 64);
  }
  const std::size_t behind = CamTable::header_size + CamTable::segment_size * h.count;  // tracks and windows
  std::vector<std::uint8_t> made(bytes.begin(), bytes.begin() + CamTable::header_size);
  made.resize(CamTable::header_size + CamTable::segment_size * segments.size());
  put(made, 10, static_cast<std::uint64_t>(std::max(speed_bits, -100)), 1);
  put(made, 11, static_cast<std::uint64_t>(std::max(acceleration_bits, -100)), 1);
  put(made, 12, segments.size(), 4);
  for (std::size_t k = 0; k < segments.size(); ++k) {
    const std::size_t at = CamTable::header_size + CamTable::segment_size * k;
    const auto& segment = segments[k];
    put(made, at, segment.start, 4);
    put(made, at + 4, segment.reciprocal, 4);
    put(made, at + 8, static_cast<std::uint64_t>(segment.c0), 8);
    for (std::size_t n = 0; n < 5; ++n) put(made, at + 16 + 4 * n, static_cast<std::uint32_t>(segment.c[n]), 4);
    made[at + 36] = segment.down;
    made[at + 37] = segment.shift;
    put(made, at + 38, segment.finer, 2);
  }
  made.insert(made.end(), bytes.begin() + static_cast<std::ptrdiff_t>(behind), bytes.end() - CamTable::checksum_size);
  const std::uint32_t checksum = Crc32{}.add(made, made.size()).value();
  made.resize(made.size() + CamTable::checksum_size);
  put(made, made.size() - CamTable::checksum_size, checksum, 4);
  return made;
}

}  // namespace stiction::drive
