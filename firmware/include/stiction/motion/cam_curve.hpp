// A curve that a slave follows: a cam table, or the straight line of a gear, with what is set between master and table
// and between table and slave:
//   X = ratio * master + master offset,   slave = scale * y(X) + rise * cycles of X + slave offset,
//   velocity = scale y' X',   acceleration = scale (y'' X'^2 + y' X'').
// Before it is followed, its largest slopes are bounded for every phase by the control points of its polynomials
// (Bernstein form: a polynomial lies between the least and the largest), and its joints are looked at, so that what the
// slave may have to do is known before it moves.
#pragma once

#include <cstddef>
#include <cstdint>

#include "stiction/motion/cam_peaks.hpp"
#include "stiction/motion/cam_table.hpp"
#include "stiction/motion/gear.hpp"
#include "stiction/motion/motion_point.hpp"
#include "stiction/number/product.hpp"

namespace stiction {

// Why a request was refused. Nothing moved for it.
enum class CamRefusal : std::uint8_t {
  none,
  scale,            // numbers of a table, a ratio or a scale that the formats do not hold
  not_continuous,   // a table whose position, speed or acceleration jumps at a joint or at its seam
  beyond_limits,    // a curve that takes more than the slave's limits at the master's largest speed
  no_bridge,        // no way to it from the motion before, within the limits and in the time or distance asked for
  moving,           // a start over a distance of the master from a slave that does not stand
  outside_profile,  // a master outside of the cycle of a once-only cam
  speed,            // a speed to leave with that is beyond the limit
  unknown_table,    // a number that no table has
  not_enabled,      // an axis that does not follow set-points in a mode of cam or gear
  beyond_travel,    // a curve whose positions leave the travel, or a position beyond it
  superposes        // a move or a second cam on top, where the other one is under way
};
inline constexpr std::size_t cam_refusals = 12;

// How a slave's position changes over the master's: 2^-40 of its unit, for each cycle of the master, and for its
// square.
struct CamSlopes {
  std::int64_t position = 0, slope = 0, bend = 0;
};

class CamCurve {
 public:
  struct Config {
    const CamTable* table = nullptr;                   // it must stay as long as it is followed; none: a line
    GearRatio ratio{};                                 // of the master
    MasterPosition master_offset{};                    // added behind the ratio
    std::int64_t slave_scale = std::int64_t{1} << 32;  // 2^-32
    std::int64_t slave_offset = 0;                     // 2^-40 units
    std::int64_t rise = 0;                             // of a line: 2^-40 units each cycle
    bool periodic = true;                              // a line is; a cam that is not ends with its cycle
  };

  // Master scaling and offset of `config` as CODESYS writes them, X = scaling * master + offset: the `ratio` is the
  // scaling.
  static constexpr void scale_then_add(Config& config, const GearRatio& ratio, const MasterPosition& offset) {
    config.ratio = ratio;
    config.master_offset = offset;
  }
  // The same of `config` as TwinCAT 3 writes them, X = (master - offset) / scaling: `ratio` is 1 / scaling, `offset`
  // the master's.
  static constexpr void subtract_then_divide(Config& config, const GearRatio& ratio, const MasterPosition& offset) {
    config.ratio = ratio;
    config.master_offset = -ratio.position(offset);
  }

  constexpr CamCurve() = default;

  // Makes `curve` that of `config`, with the bounds of its slopes; its work grows with the table's segments, so that it
  // belongs beside the ticks. Where the result is not none, `curve` stays as it was.
  static constexpr CamRefusal prepare(const Config& config, CamCurve& curve) {
    CamCurve made;
    made.config_ = config;
    const std::int64_t scale = static_cast<std::int64_t>(magnitude(config.slave_scale));
    if (magnitude(config.slave_scale) > std::uint64_t{1} << 48 || magnitude(config.rise) > std::uint64_t{1} << 60)
      return CamRefusal::scale;
    if (config.table == nullptr) {
      made.config_.periodic = true;
      made.config_.rise = product_shifted(config.rise, config.slave_scale, scale_bits);
      if (magnitude(made.config_.rise) > std::uint64_t{1} << 60) return CamRefusal::scale;
      made.peaks_.slope = static_cast<std::int64_t>(magnitude(made.config_.rise)) + 1;
    } else {
      const CamTable& table = *config.table;
      const auto& h = table.header();
      if (h.position_bits < least_bits || h.speed_bits < least_bits || h.acceleration_bits < least_bits)
        return CamRefusal::scale;
      made.config_.rise = product_shifted(h.rise, config.slave_scale, h.position_bits - least_bits);
      const CamPeaks of_table = peaks_of(table);
      made.peaks_ = {scaled(of_table.slope, scale), scaled(of_table.bend, scale), scaled(of_table.third, scale)};
    }
    if (!made.within_a_word()) return CamRefusal::scale;
    if (config.table != nullptr) {
      made.set_factors();
      if (!made.continuous()) return CamRefusal::not_continuous;
    }
    curve = made;
    return CamRefusal::none;
  }

  // Makes `curve` what `config` says of the table of `base`, which was prepared with a scale of 1; its work is fixed,
  // so that a tick may do it. A cam that runs once stays one. Where the result is not none, `curve` stays as it
  // was.
  static constexpr CamRefusal rescale(const CamCurve& base, const Config& config, CamCurve& curve) {
    if (config.table == nullptr) return prepare(config, curve);
    if (config.table != base.config_.table || magnitude(config.slave_scale) > std::uint64_t{1} << 48)
      return CamRefusal::scale;
    CamCurve made;
    made.config_ = config;
    made.config_.periodic = config.periodic && base.config_.periodic;
    made.config_.rise = product_shifted(base.config_.rise, config.slave_scale, scale_bits);
    const std::int64_t scale = static_cast<std::int64_t>(magnitude(config.slave_scale));
    made.peaks_ = {scaled(base.peaks_.slope, scale), scaled(base.peaks_.bend, scale), scaled(base.peaks_.third, scale)};
    if (!made.within_a_word()) return CamRefusal::scale;
    made.set_factors();
    curve = made;
    return CamRefusal::none;
  }

  constexpr const Config& config() const { return config_; }
  constexpr const CamPeaks& peaks() const { return peaks_; }

  // Bounds of the slave's motion behind a master that keeps `master`, in cycles before the ratio.
  constexpr MotionLimits motion(const MotionLimits& master) const { return peaks_.motion(behind_ratio(master)); }
  // Those of the master behind the ratio.
  constexpr MotionLimits behind_ratio(const MotionLimits& master) const {
    const auto factor = static_cast<std::int64_t>(magnitude(config_.ratio.factor())) + 1;
    return {product<32>(master.velocity, factor) + 1, product<32>(master.acceleration, factor) + 1,
            product<32>(master.jerk, factor) + 1};
  }

  // The master as the table sees it.
  constexpr MasterPoint seen(const MasterPoint& master) const {
    MasterPoint x = config_.ratio.of(master);
    x.position = x.position + config_.master_offset;
    return x;
  }

  // Whether `x`, as seen, is before or behind the cycle of a cam that is not periodic.
  constexpr bool outside(const MasterPosition& x) const { return !config_.periodic && x.cycles != 0; }

  // Position and slopes at `x`, as seen. Outside of the cycle of a cam that is not periodic they go on with the
  // acceleration of its end.
  constexpr CamSlopes slopes(const MasterPosition& x) const {
    if (!outside(x)) return inside(x);
    const MasterPosition at = x.cycles > 0 ? MasterPosition{0, UINT64_MAX} : MasterPosition{};
    CamSlopes out = inside(at);
    const std::int64_t way = (x - at).raw(), change = product_shifted(out.bend, way, 40);
    out.position += product_shifted(out.slope, way, 40) + product_shifted(change, way, 41);
    out.slope += change;
    return out;
  }

  // The motion that `slopes` make of a master `x`, as seen.
  static constexpr MotionPoint chained(const CamSlopes& slopes, const MasterPoint& x) {
    const std::int64_t square = product_within(x.velocity, x.velocity, 40);
    return {slopes.position, product_within(slopes.slope, x.velocity, 40),
            product_within(slopes.bend, square, 40) + product_within(slopes.slope, x.acceleration, 40)};
  }

 private:
  static constexpr int scale_bits = 32, factor_bits = 62;
  // Of a table's numbers, so that with the 32 of the scale at least 40 are left.
  static constexpr int least_bits = 8;

  // The same within the cycle.
  constexpr CamSlopes inside(const MasterPosition& x) const {
    CamSlopes out{};
    if (config_.table == nullptr) {
      out.slope = config_.rise;
      out.position = product_shifted(config_.rise, static_cast<std::int64_t>(x.phase >> 1), 63);
    } else {
      const auto& h = config_.table->header();
      const CamTable::Output y = config_.table->evaluate_fine(x.phase);
      if (quick_)
        out = {product_within(y.position, factors_[0], factor_bits), product_within(y.speed, factors_[1], factor_bits),
               product_within(y.acceleration, factors_[2], factor_bits)};
      else
        out = {times_scale(y.position, h.position_bits), times_scale(y.speed, h.speed_bits),
               times_scale(y.acceleration, h.acceleration_bits)};
    }
    const auto turns = static_cast<std::uint64_t>(x.cycles) * static_cast<std::uint64_t>(config_.rise);
    out.position = static_cast<std::int64_t>(static_cast<std::uint64_t>(out.position + config_.slave_offset) + turns);
    return out;
  }

  // A value of the table in its 2^-`bits`, behind the scale.
  constexpr std::int64_t times_scale(std::int64_t value, int bits) const {
    return product_shifted(value, config_.slave_scale, bits - least_bits);
  }
  // The scale with the bits of each value of the table, where 2^-62 holds them.
  constexpr void set_factors() {
    const auto& h = config_.table->header();
    const int bits[] = {h.position_bits, h.speed_bits, h.acceleration_bits};
    quick_ = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const int up = factor_bits + least_bits - bits[k];
      const bool holds = up >= 0 && magnitude(config_.slave_scale) <= (std::uint64_t{1} << factor_bits) >> up;
      quick_ = quick_ && holds;
      factors_[k] = holds ? config_.slave_scale * (std::int64_t{1} << up) : 0;
    }
  }

  // A peak behind the magnitude of a scale, rounded up.
  static constexpr std::int64_t scaled(std::int64_t peak, std::int64_t scale) {
    const std::int64_t rounded = product_shifted(peak, scale, scale_bits);
    return rounded < INT64_MAX ? rounded + 1 : rounded;
  }
  constexpr bool within_a_word() const {
    constexpr std::int64_t most = std::int64_t{1} << 61;
    return magnitude(config_.rise) <= std::uint64_t{1} << 60 && peaks_.slope <= most && peaks_.bend <= most &&
           peaks_.third <= most;
  }

  // Of a table by itself.
  static constexpr CamPeaks peaks_of(const CamTable& table) {
    CamPeaks peaks;
    for (std::uint32_t k = 0; k < table.header().count; ++k) {
      const CamTable::Segment s = table.segment(k);
      // In the unit of the finest that there can be.
      constexpr int finest = 15;
      std::int64_t c[5] = {};
      for (int n = 1; n <= 5; ++n) c[n - 1] = std::int64_t{s.c[n - 1]} * (1 << (finest - s.finer_bits(n)));
      const std::int64_t first[5] = {c[0], 2 * c[1], 3 * c[2], 4 * c[3], 5 * c[4]};
      const std::int64_t second[4] = {2 * c[1], 6 * c[2], 12 * c[3], 20 * c[4]};
      const std::int64_t third[3] = {6 * c[2], 24 * c[3], 60 * c[4]};
      // b_j = sum over i of C(j, i) / C(n, i) a_i, times 12, 3 and 2 to be whole.
      std::int64_t b1 = 0, b2 = 0, b3 = 0;
      for (int j = 0; j <= 4; ++j)
        widen(b1, 12 * first[0] + 3 * j * first[1] + j * (j - 1) * first[2] + j * (j - 1) * (j - 2) / 2 * first[3] +
                      (j == 4 ? 12 : 0) * first[4]);
      for (int j = 0; j <= 3; ++j)
        widen(b2, 3 * second[0] + j * second[1] + j * (j - 1) / 2 * second[2] + (j == 3 ? 3 : 0) * second[3]);
      for (int j = 0; j <= 2; ++j) widen(b3, 2 * third[0] + j * third[1] + (j == 2 ? 2 : 0) * third[2]);
      const int shift =
          s.shift + finest - CamTable::extra_bits + table.header().position_bits - MotionPoint::position_bits;
      const auto over = [&s](std::int64_t x) {
        const std::int64_t rounded = product_shifted(x, s.reciprocal, s.down);
        return rounded < INT64_MAX ? rounded + 1 : rounded;
      };
      larger(peaks.slope, over(in_units(b1 / 12 + 1, shift)));
      larger(peaks.bend, over(over(in_units(b2 / 3 + 1, shift))));
      larger(peaks.third, over(over(over(in_units(b3 / 2 + 1, shift)))));
    }
    return peaks;
  }
  static constexpr void larger(std::int64_t& largest, std::int64_t x) { largest = x > largest ? x : largest; }
  static constexpr void widen(std::int64_t& largest, std::int64_t x) { larger(largest, x < 0 ? -x : x); }
  // x * 2^-shift, rounded up; `x` below 2^58; the shift of a table that was read is -41 to 140.
  static constexpr std::int64_t in_units(std::int64_t x, int shift) {
    if (shift > 127) return 1;
    return shift < 0 ? product_shifted(x, std::int64_t{1} << -shift, 0) : product_shifted(x, 1, shift) + 1;
  }

  // Whether position, slope and bend are the same on both sides of each joint and of the seam, as far as what their
  // largest slopes make of the last phase, and rounding: 2^-32 units of the position, 2^-20 of the largest slope,
  // 2^-14 of the largest bend (of a table of version 2 within 1e-10, coefficients of one exponent leave up to 2^-16).
  constexpr bool continuous() const {
    const CamTable& table = *config_.table;
    constexpr std::int64_t near = std::int64_t{1} << (MotionPoint::position_bits - 32);
    const auto of_phase = [](std::int64_t peak) { return (peak >> 32) + 2; };
    for (std::uint32_t k = 0; k < table.header().count; ++k) {
      const bool seam = k == 0;
      if (seam && !config_.periodic) continue;
      const std::uint64_t start = std::uint64_t{table.segment(k).start} << 32;
      const CamSlopes after = slopes({seam ? 1 : 0, start}), before = slopes({0, start - 1});
      if (magnitude(after.position - before.position) > static_cast<std::uint64_t>(2 * near + of_phase(peaks_.slope)) ||
          magnitude(after.slope - before.slope) >
              static_cast<std::uint64_t>((peaks_.slope >> 20) + of_phase(peaks_.bend)) ||
          magnitude(after.bend - before.bend) >
              static_cast<std::uint64_t>((peaks_.bend >> 14) + of_phase(peaks_.third)))
        return false;
    }
    return true;
  }

  Config config_{};
  CamPeaks peaks_{};
  std::int64_t factors_[3] = {};  // of position, speed and acceleration of the table, where the way is quick
  bool quick_ = false;
};

}  // namespace stiction
