#include "sim/cam/segment_table.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "sim/cam/characteristics.hpp"
#include "sim/cam/check.hpp"
#include "sim/cam/segment_fit.hpp"

namespace stiction::sim::cam {
namespace {

// A part that is halved has at least so many phases.
constexpr std::uint64_t shortest_part = 4096;
constexpr std::uint64_t whole_cycle = std::uint64_t{1} << 32;

// The first phase at or behind a place: no phase then lies in a segment of the piece before it.
std::uint64_t phase_of(double place, double cycle) {
  const double scaled = place / cycle * 0x1p32;
  auto phase = static_cast<std::uint64_t>(scaled);
  if (static_cast<double>(phase) < scaled) ++phase;
  return std::min(phase, whole_cycle);
}

// The phases of a piece; where it is shorter than one, the piece has none.
std::vector<Part> pieces_of(const Motion& motion) {
  std::vector<Part> parts;
  const double begin = motion.curve.begin(), cycle = motion.cam.cycle();
  for (const Piece& piece : motion.curve.pieces()) {
    const std::uint64_t from = parts.empty() ? 0 : parts.back().end;
    const std::uint64_t to = &piece == &motion.curve.pieces().back() ? whole_cycle : phase_of(piece.end - begin, cycle);
    if (to > from) parts.push_back({&piece, from, to});
  }
  return parts;
}

// Positions use 47 bits, so that their rounding is far below that of 32-bit coefficients.
int position_bits_of(const Motion& motion) {
  const auto range = extremes(motion.curve, 0);
  const double largest = std::max({absolute(range.lowest.value), absolute(range.highest.value), 1e-9});
  int bits = 47;
  while (largest * power_of_two(bits) < 0x1p46 && bits < 100) ++bits;
  while (largest * power_of_two(bits) >= 0x1p47 && bits > 0) --bits;
  return bits;
}

void require_continuous(const Motion& motion) {
  for (const auto& found : jumps_of(motion))
    if (found.jump.order < 2)
      throw CamError(
          fmt::format("found a jump of the {} {} at the master's {}; expected a motion that a drive can follow",
                      derivative_name(found.jump.order), name_of(found.where), found.jump.place));
  if (absolute(motion.curve.begin()) > 0.0)
    throw CamError("found a cycle that does not begin at 0; expected one that does");
}

class TableWriter {
 public:
  void number(std::uint64_t value, int size) {
    for (int k = 0; k < size; ++k) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * k)));
  }
  void number(std::int64_t value, int size) { number(static_cast<std::uint64_t>(value), size); }
  std::vector<std::uint8_t> bytes;
};

// The finest scale of speed or acceleration that no segment's products are coarser than, and whose peak still fits.
int output_bits(const std::vector<FittedSegment>& fitted, int position_bits, int order) {
  int bits = 100;
  for (const auto& [segment, bound] : fitted)
    bits = std::min(bits, order == 1 ? position_bits + segment.shift + segment.down - 32
                                     : position_bits + segment.shift + 2 * segment.down - 64);
  return bits;
}

std::int64_t in_units(double bound, int bits) { return static_cast<std::int64_t>(bound * power_of_two(bits)) + 1; }

// Of a cycle.
double rise_of(const Motion& motion) {
  return motion.curve.derivative(motion.curve.end(), 0, Side::left) - motion.curve(0.0);
}

// A time in the 2^-24 s of a track's compensation.
std::int64_t compensation_of(double seconds, const Track& track) {
  const double scaled = seconds * 0x1p24;
  if (!(absolute(scaled) < 0x1p31))
    throw CamError(
        fmt::format("found a compensation of {} s of the track {}; expected less than 128 s", seconds, track.name));
  return static_cast<std::int64_t>(scaled + (scaled < 0.0 ? -0.5 : 0.5));
}

// Tracks and their windows behind the segments. A window from one place around to the same one is always on.
void write_tracks(const Cam& cam, TableWriter& out) {
  const double cycle = cam.cycle();
  std::size_t first = 0;
  for (const Track& track : cam.tracks) {
    out.number(std::uint64_t{first}, 2);
    out.number(std::uint64_t{track.windows.size()}, 2);
    out.number(std::min(phase_of(track.hysteresis, cycle), whole_cycle / 2), 4);
    out.number(compensation_of(track.on_compensation, track), 4);
    out.number(compensation_of(track.off_compensation, track), 4);
    first += track.windows.size();
  }
  for (const Track& track : cam.tracks)
    for (const Track::Window& window : track.windows)
      for (const double place : {window.first, window.last}) out.number(phase_of(place, cycle) % whole_cycle, 4);
}

SegmentTable written(const Motion& motion, const std::vector<FittedSegment>& fitted, int position_bits) {
  SegmentTable table;
  table.segments = static_cast<std::uint32_t>(fitted.size());
  const int speed_bits = std::clamp(output_bits(fitted, position_bits, 1), -100, 100);
  const int acceleration_bits = std::clamp(output_bits(fitted, position_bits, 2), -100, 100);
  for (const auto& [segment, bound] : fitted) {
    table.bound.position = std::max(table.bound.position, bound.position);
    table.bound.speed = std::max(table.bound.speed, bound.speed + power_of_two(-speed_bits));
    table.bound.acceleration =
        std::max(table.bound.acceleration, bound.acceleration + 2.0 * power_of_two(-acceleration_bits));
  }
  TableWriter out;
  for (const char c : {'S', 'C', 'A', 'M'}) out.bytes.push_back(static_cast<std::uint8_t>(c));
  out.number(std::uint64_t{CamTable::version}, 2);
  out.number(std::uint64_t{motion.cam.master == Coordinate::rotary}, 1);
  out.number(std::uint64_t{motion.cam.slave == Coordinate::rotary}, 1);
  out.number(std::uint64_t{motion.cam.periodic}, 1);
  for (const int bits : {position_bits, speed_bits, acceleration_bits}) out.number(std::int64_t{bits}, 1);
  out.number(std::uint64_t{table.segments}, 4);
  const auto nearest = [](double value) { return static_cast<std::int64_t>(value + (value < 0.0 ? -0.5 : 0.5)); };
  out.number(nearest(motion.cam.cycle() * power_of_two(CamTable::cycle_bits)), 8);
  out.number(nearest(rise_of(motion) * power_of_two(position_bits)), 8);
  out.number(in_units(table.bound.position, position_bits), 8);
  out.number(in_units(table.bound.speed, speed_bits), 8);
  out.number(in_units(table.bound.acceleration, acceleration_bits), 8);
  std::size_t windows = 0;
  for (const Track& track : motion.cam.tracks) windows += track.windows.size();
  if (std::max(motion.cam.tracks.size(), windows) > 0xffff)
    throw CamError(fmt::format("found {} windows of switch tracks; expected up to 65535", windows));
  out.number(std::uint64_t{motion.cam.tracks.size()}, 2);
  out.number(std::uint64_t{windows}, 2);
  out.number(std::uint64_t{0}, 4);
  for (const auto& [segment, bound] : fitted) {
    out.number(std::uint64_t{segment.start}, 4);
    out.number(std::uint64_t{segment.reciprocal}, 4);
    out.number(segment.c0, 8);
    for (const std::int32_t c : segment.c) out.number(std::int64_t{c}, 4);
    out.number(std::uint64_t{segment.down}, 1);
    out.number(std::uint64_t{segment.shift}, 1);
    out.number(std::uint64_t{segment.finer}, 2);
  }
  write_tracks(motion.cam, out);
  out.number(std::uint64_t{Crc32{}.add(out.bytes, out.bytes.size()).value()}, 4);
  table.bytes = std::move(out.bytes);
  return table;
}

// What the segment of parts[k] ends with: what the next one begins with, as far as the motion goes on there. That of a
// periodic motion goes on over its seam.
class Joints {
 public:
  Joints(const Motion& motion, int position_bits)
      : cycle_(motion.cam.cycle()), bits_(position_bits), periodic_(motion.cam.periodic) {
    const double unit = power_of_two(-position_bits);
    const auto units = rise_of(motion) * power_of_two(position_bits);
    rise_ = static_cast<double>(static_cast<std::int64_t>(units + (units < 0.0 ? -0.5 : 0.5))) * unit;
    // A part ends at the first phase behind a joint, and a jerk that jumps there shows in the acceleration.
    const auto sizes = derivative_sizes(motion.curve);
    near_ = {1e-7 * sizes[0] + 2.0 * unit, 1e-7 * sizes[1], 1e-6 * sizes[2], 0.0};
  }

  EndState end_of(const std::vector<Part>& parts, std::size_t k) const {
    EndState end = part_end(parts[k], cycle_);
    const bool last = k + 1 == parts.size();
    if (last && !periodic_) return end;
    const Part& next = parts[last ? 0 : k + 1];
    EndState exact = part_begin(next, cycle_), rounded = segment_begin(next, cycle_, bits_);
    if (last) exact.position += rise_, rounded.position += rise_;
    if (absolute(exact.position - end.position) <= near_.position) end.position = rounded.position;
    if (absolute(exact.speed - end.speed) <= near_.speed) end.speed = rounded.speed;
    if (absolute(exact.acceleration - end.acceleration) <= near_.acceleration) end.acceleration = rounded.acceleration;
    return end;
  }

 private:
  double cycle_;
  int bits_;
  bool periodic_;
  double rise_ = 0.0;
  EndState near_{};
};

void require_divisible(const Part& part, std::size_t parts, double tolerance) {
  if (part.end - part.begin < shortest_part || parts >= CamTable::most_segments)
    throw CamError(fmt::format("found a tolerance of {}; expected one that {} segments of 32-bit coefficients can keep",
                               tolerance, CamTable::most_segments));
}

// Halves `part` until its error is within the tolerance.
void add_within(const Part& part, double cycle, int position_bits, double tolerance, std::vector<Part>& all) {
  if (fit_segment(part, cycle, position_bits, part_end(part, cycle), tolerance).bound.position <= tolerance) {
    all.push_back(part);
    return;
  }
  require_divisible(part, all.size(), tolerance);
  const std::uint64_t middle = part.begin + (part.end - part.begin) / 2;
  add_within({part.piece, part.begin, middle}, cycle, position_bits, tolerance, all);
  add_within({part.piece, middle, part.end}, cycle, position_bits, tolerance, all);
}

struct DividedPart {
  Part part;
  TableBound smooth;
};

// What the errors of a table are compared with: a billionth of the range of positions, and 10^-5 of the largest
// acceleration over cycles, which is the harder of both where a motion is uneven.
TableBound wanted_of(const Motion& motion) {
  const auto sizes = derivative_sizes(motion.curve);
  const double cycle = motion.cam.cycle();
  return {1e-9 * sizes[0] + 1e-300, 0.0, 1e-5 * sizes[2] * cycle * cycle + 1e-300};
}

// Halves the part whose error is the largest of what is `wanted`, so that the errors of all become alike. False where
// none needs it, or it is too short for that.
bool halve_worst(std::vector<DividedPart>& parts, const TableBound& wanted, double cycle) {
  const auto error = [&](const DividedPart& part) {
    return std::max(part.smooth.position / wanted.position, part.smooth.acceleration / wanted.acceleration);
  };
  const auto worst = std::max_element(parts.begin(), parts.end(),
                                      [&](const DividedPart& a, const DividedPart& b) { return error(a) < error(b); });
  const Part whole = worst->part;
  if (whole.end - whole.begin < shortest_part || error(*worst) < 0.01) return false;
  const std::uint64_t middle = whole.begin + (whole.end - whole.begin) / 2;
  const Part second{whole.piece, middle, whole.end};
  worst->part.end = middle;
  worst->smooth = smooth_error(worst->part, cycle);
  parts.insert(worst + 1, {second, smooth_error(second, cycle)});
  return true;
}

}  // namespace

double table_tolerance(const Motion& motion, double share) {
  const auto range = extremes(motion.curve, 0);
  const double width = range.highest.value - range.lowest.value;
  return width > 0.0 ? share * width : share;
}

SegmentTable table_within(const Motion& motion, double tolerance) {
  if (!(tolerance > 0.0)) throw CamError(fmt::format("found a tolerance of {}; expected more than 0", tolerance));
  require_continuous(motion);
  const int bits = position_bits_of(motion);
  const double cycle = motion.cam.cycle();
  const Joints joints(motion, bits);
  std::vector<Part> parts;
  for (const Part& part : pieces_of(motion)) add_within(part, cycle, bits, tolerance, parts);
  std::vector<FittedSegment> fitted;
  // Joining a segment to the next one moves it by roundings: one that was at the tolerance is halved once more.
  for (std::size_t k = 0; k < parts.size();) {
    fitted.resize(k);
    fitted.push_back(fit_segment(parts[k], cycle, bits, joints.end_of(parts, k), tolerance));
    if (fitted.back().bound.position <= tolerance) {
      ++k;
      continue;
    }
    require_divisible(parts[k], parts.size(), tolerance);
    const std::uint64_t end = parts[k].end, middle = parts[k].begin + (end - parts[k].begin) / 2;
    parts[k].end = middle;
    parts.insert(parts.begin() + static_cast<std::ptrdiff_t>(k) + 1, {parts[k].piece, middle, end});
    if (k > 0) --k;  // it ends with a different begin
  }
  return written(motion, fitted, bits);
}

SegmentTable table_of_parts(const Motion& motion, int parts) {
  require_continuous(motion);
  const int bits = position_bits_of(motion);
  const double cycle = motion.cam.cycle();
  const TableBound wanted = wanted_of(motion);
  std::vector<std::vector<DividedPart>> segments(motion.segments.size());
  for (const Part& piece : pieces_of(motion)) {
    const auto at = static_cast<std::size_t>(piece.piece - motion.curve.pieces().data());
    segments[motion.segment_of(at)].push_back({piece, smooth_error(piece, cycle)});
  }
  std::vector<Part> all;
  for (std::size_t k = 0; k < segments.size(); ++k) {
    auto& of_segment = segments[k];
    while (motion.cam.segments[k].law != "linear" && of_segment.size() < static_cast<std::size_t>(parts))
      if (!halve_worst(of_segment, wanted, cycle)) break;
    for (const DividedPart& part : of_segment) all.push_back(part.part);
  }
  const Joints joints(motion, bits);
  std::vector<FittedSegment> fitted;
  for (std::size_t k = 0; k < all.size(); ++k)
    fitted.push_back(fit_segment(all[k], cycle, bits, joints.end_of(all, k)));
  return written(motion, fitted, bits);
}

}  // namespace stiction::sim::cam
