// What a log says of the motion and of the force on the carriage, filtered: the position through a zero-phase lowpass
// and twice differentiated at the log's rate; every regressor and the force through one anti-aliasing filter and down
// to the rate of the rows that regressions work on (Janot, Gautier, Brunot 2019; Gautier 1997).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/identify/filter.hpp"
#include "host/log/log.hpp"

namespace stiction::host {

struct SignalSettings {
  double cutoff = 100.0;    // Hz, of the position's Butterworth filter of order 4; at most `highest` of the log's rate
  double row_rate = 100.0;  // Hz; the rows hold frequencies up to 0.4 of it, and to half of `highest` of the log's rate
  int difference_points = 7;
  double skip_start = 0.05;  // s, dropped at the log's start: the filter's transient
  double skip_end = 0.05;    // s
  // Hz, where the rows end, for a band that follows the data (host/identify/band.hpp); 0: by the rates above. Then
  // the position is filtered only where the log is five times as fast as `cutoff`, and its derivatives are those of 11
  // points, so that rows may reach to 0.3 of the log's rate.
  double band = 0.0;
  // The position's filter acts on the position alone. Rows that end at half of its edge have lost 0.4 % to it, and, at
  // a tenth of the log's rate, 0.04 % to the differences. Rows that reach further compare a filtered motion with a
  // force that still has everything: then the jumps of friction at reversals have no motion to belong to.
  double highest = 0.2;
};

// The recipe of the published EMPS model (data: Janot, Gautier, Brunot 2019): differences of 3 points, the first 49 ms
// dropped and nothing at the end.
SignalSettings published_recipe();

// One log at its full rate. The vectors are equally long.
struct Motion {
  std::string source;
  double period = 0.0;             // s
  std::vector<double> t, x, v, a;  // s, m, m/s, m/s^2; filtered
  std::vector<double> force;       // N, of the motor and from outside; as logged
  std::vector<double> current;     // A, as logged; empty when the log has force or voltage only
  std::vector<double> x_set;       // m; empty when the log has none
  bool force_is_current = false;   // `force` is the current or voltage times the file's force constant
  std::vector<double> other_a{};   // m/s^2, of the other axis; empty when the log does not have exactly two
  // Of a band that follows the data; empty otherwise.
  std::vector<double> weight{};          // 0 to 1, of each sample in every column; empty: all 1
  std::vector<double> level{};           // of the friction, -1 to 1
  std::vector<double> set_v{}, set_a{};  // m/s, m/s^2; derivatives of the set position, filtered as the position
  double speed_noise = 0.0, acceleration_noise = 0.0;  // m/s, m/s^2 rms in the rows, of the encoder
  bool recorded_speed = false;                         // v and a are of the recorded speed
  std::vector<double> constant{};                      // what the constant force goes with, -1 to 1; empty: 1
  // m, at each sample as the encoder had it: not filtered, and of the record where `x` is a simulation's; empty: as
  // `x`.
  std::vector<double> read{};
  // m, from the sample before to each one, where it is not the difference of `x`: two motions that are one from place
  // to place meet in their displacements, not in their positions. Empty: of `x`.
  std::vector<double> moved{};
  std::string speed_objection{};  // what spoke against a recorded speed that would be quieter; empty: nothing
};

// How the amperes of a record are to be read.
enum class Amperes { amplitude, rms };

// The force (N) on the carriage by what `log` holds: F, else i times the force constant, else (of a force source) u
// times it; and F_ext. Throws LogError when it has none of them for this motor. `channels`: of the axis in `log`;
// `axis`: of the machine; `amperes`: convention of its currents.
std::vector<double> force_of(const Log& log, const AxisLog& channels, const machine::AxisModel& axis, Amperes amperes);

// Filtered motion and force of an axis. `log`, `channels`, `axis`, `amperes`: as for force_of(); `settings`: of the
// filters. Throws LogError.
Motion motion_of(const Log& log, const AxisLog& channels, const machine::AxisModel& axis, Amperes amperes,
                 const SignalSettings& settings);

// What the constant force of an axis goes with at the positions `x` (m): of a rotary axis that has a weight the sine of
// its angle, else empty, 1 everywhere.
std::vector<double> shape_of_constant(const machine::AxisModel& axis, const std::vector<double>& x);

// Takes columns of a motion at its full rate to rows.
class RowFilter {
 public:
  RowFilter(const Motion& motion, const SignalSettings& settings);

  std::size_t rows() const { return rows_; }
  double period() const { return period_; }  // s, from row to row
  // The column's rows: without the skipped ends, filtered, every n-th value.
  std::vector<double> operator()(std::span<const double> column) const;
  // Those of several columns at once, which takes less time.
  std::vector<std::vector<double>> operator()(const std::vector<std::vector<double>>& columns) const;
  // The transpose of that but at the ends, which are at rest: weights of samples from those of rows.
  std::vector<double> transposed(std::span<const double> rows) const;
  // The column filtered at the log's own rate.
  std::vector<double> whole(std::span<const double> column) const {
    return filter_both_ways(lowpass_, kept(column), padding_);
  }
  // The values at the rows, not filtered: of the time.
  std::vector<double> sampled(std::span<const double> column) const;

 private:
  std::span<const double> kept(std::span<const double> column) const;

  std::size_t samples_, begin_, end_, ratio_, padding_ = 0, rows_ = 0;
  double period_;
  Lowpass lowpass_;  // of every column, at every rate
};

}  // namespace stiction::host
