// Trends of a fleet's parameters over time and alarms. Deviations of a record are counted in what the records of its
// axis and its fleet differ by without a reason (scatter.hpp), beside the error within the record.
//
// A trend is a weighted regression over the date with random effects (Thompson, Sharp 1999), its interval by Student's
// t with the moderated variance. An alarm is that of a self-starting sum (Hawkins 1987): each record is predicted from
// those before it alone, its deviation becomes a standard normal one, and sums for a slow and a fast change, upward and
// downward, alarm above thresholds that belong to the stated rate of false alarms (cusum.hpp).
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "host/fleet/cusum.hpp"
#include "host/fleet/record_estimate.hpp"
#include "host/fleet/scatter.hpp"

namespace stiction::host {

inline constexpr double days_of_month = 365.25 / 12.0;

// Deviations that a sum leaves out, in standard deviations: half of the change that it finds the soonest.
inline constexpr std::array<double, 2> alarm_references{0.5, 1.0};

// Estimates of one axis, by date.
struct AxisHistory {
  std::string name;
  std::vector<double> days;
  std::vector<RecordEstimate> records;  // of each day
};

struct Alarm {
  std::size_t record = 0;     // index in the history
  std::size_t since = 0;      // the record with which the change seems to begin
  int direction = 1;          // 1: more, -1: less
  double reference = 0.0;     // of the sum that alarmed
  double sum = 0.0;           // that it reached
  double change = 0.0;        // mean of the records since then, less that of those before; in the parameter's unit
  double change_error = 0.0;  // its standard error
};

// One parameter of one axis. Vectors are of those records that determine it.
struct CauseTrend {
  std::vector<std::size_t> records;  // indices in the history
  std::vector<double> deviation;     // of each record from those before it, standard normal without a change
  double scale = 1.0;                // what relative figures are relative to, in the parameter's unit
  double mean = 0.0;                 // weighted, in the parameter's unit
  double day = 0.0;                  // at which the trend has the mean
  double slope = 0.0;                // a month, in the parameter's unit
  double slope_half = 0.0;           // half of its 95 % interval; 0: not known
  double mean_error = 0.0;           // standard error of the mean
  double slope_error = 0.0;          // and of the slope
  double limit = 0.0;                // Student's 95 % limit of both
  double scatter = 0.0;              // between records, relative to the scale
  double freedom = 0.0;
  std::optional<Alarm> alarm;  // the first

  bool known() const { return records.size() >= 3; }  // whether there is a trend
  double surety() const { return slope_error > 0.0 ? slope / slope_error : 0.0; }
};

struct AxisTrends {
  std::size_t history = 0;  // index
  std::array<CauseTrend, fleet_causes> causes;
};

struct FleetTrends {
  double false_alarms = 0.0;    // stated, of an axis in a year, all causes together
  double records_a_year = 0.0;  // from the median distance of records
  std::array<double, alarm_references.size()> thresholds{};
  std::array<double, fleet_causes>
      between{};  // records, of the fleet, relative: standard deviation beyond their errors
  std::array<Scatter, fleet_causes> common{};  // of the fleet, in units of between and error together
  std::vector<AxisTrends> axes;                // worst first: alarms by date, then the surest trend
};

// Of the fleet whose axes have these `histories`; `false_alarms`: stated rate of an axis in a year, 1e-6 to 1.
FleetTrends trends_of(const std::vector<AxisHistory>& histories, double false_alarms);

}  // namespace stiction::host
