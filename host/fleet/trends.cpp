#include "host/fleet/trends.hpp"

#include <algorithm>
#include <cmath>

#include "host/diagnose/statistics/fisher.hpp"
#include "host/sweep/samples.hpp"

namespace stiction::host {
namespace {

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// One parameter of one axis, relative to its scale.
struct Course {
  std::vector<std::size_t> records;
  std::vector<double> months, values, errors;
  double scale = 1.0;
};

std::vector<double> determined(const AxisHistory& history, FleetCause cause) {
  std::vector<double> values;
  for (const auto& record : history.records) {
    const double value = record.causes[static_cast<std::size_t>(cause)].value;
    if (std::isfinite(value)) values.push_back(value);
  }
  return values;
}

// A constant force may be zero; it is compared with the friction.
double scale_of(const AxisHistory& history, FleetCause cause) {
  const auto of = cause == FleetCause::constant_force ? FleetCause::coulomb : cause;
  const double scale = std::abs(median(determined(history, of)));
  return scale > 0.0 ? scale : 1.0;
}

Course course_of(const AxisHistory& history, FleetCause cause) {
  Course course;
  course.scale = scale_of(history, cause);
  for (std::size_t k = 0; k < history.records.size(); ++k) {
    const auto& estimate = history.records[k].causes[static_cast<std::size_t>(cause)];
    if (!std::isfinite(estimate.value) || !std::isfinite(estimate.error)) continue;
    course.records.push_back(k);
    course.months.push_back(history.days[k] / days_of_month);
    course.values.push_back(estimate.value / course.scale);
    course.errors.push_back(estimate.error / course.scale);
  }
  return course;
}

// A weighted straight line over the months.
struct Line {
  double weight = 0.0, month = 0.0, mean = 0.0, slope = 0.0;
  double spread = 0.0;  // sum of weights times squared months from the mean one
  double square = 0.0;  // sum of weighted squared deviations
  double excess = 0.0;  // by which that grows, for each unit of variance that the weights do not know of
};

Line line_of(const Course& course, const std::vector<double>& weights) {
  Line line;
  const auto count = weights.size();
  for (std::size_t k = 0; k < count; ++k) {
    line.weight += weights[k];
    line.month += weights[k] * course.months[k];
    line.mean += weights[k] * course.values[k];
  }
  line.month /= line.weight;
  line.mean /= line.weight;
  double product = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    const double from = course.months[k] - line.month;
    line.spread += weights[k] * from * from;
    product += weights[k] * from * (course.values[k] - line.mean);
  }
  line.slope = line.spread > 0.0 ? product / line.spread : 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    const double from = course.months[k] - line.month;
    const double left = course.values[k] - line.mean - line.slope * from;
    line.square += weights[k] * left * left;
    const double leverage = 1.0 / line.weight + (line.spread > 0.0 ? from * from / line.spread : 0.0);
    line.excess += weights[k] * (1.0 - weights[k] * leverage);
  }
  return line;
}

constexpr std::size_t line_parameters = 2;

std::vector<double> weights_of(const Course& course, double between) {
  std::vector<double> weights;
  for (const double error : course.errors) weights.push_back(1.0 / (error * error + between * between + 1e-18));
  return weights;
}

// The variance between records of one axis that its errors do not explain, by moments (DerSimonian, Laird 1986); below
// zero where the errors explain more.
double variance_between(const Course& course) {
  const auto line = line_of(course, weights_of(course, 0.0));
  const auto freedom = static_cast<double>(course.values.size() - line_parameters);
  return line.excess > 0.0 ? (line.square - freedom) / line.excess : 0.0;
}

// What all axes say of a cause.
struct CauseScatter {
  double between = 0.0;
  Scatter common;
};

CauseScatter scatter_of(const std::vector<Course>& courses) {
  CauseScatter result;
  std::vector<double> variances;
  // A median: an axis that changes must not tell what axes do that do not.
  for (const auto& course : courses)
    if (course.values.size() > line_parameters) variances.push_back(variance_between(course));
  result.between = std::sqrt(std::max(median(variances), 0.0));
  std::vector<Scatter> axes;
  for (const auto& course : courses) {
    if (course.values.size() <= line_parameters) continue;
    const auto freedom = static_cast<double>(course.values.size() - line_parameters);
    axes.push_back({line_of(course, weights_of(course, result.between)).square / freedom, freedom});
  }
  result.common = common_scatter(axes);
  return result;
}

// The weighted mean of earlier records, and how they differ from it.
struct Before {
  double weight = 0.0, mean = 0.0, square = 0.0;
  std::size_t count = 0;
  void add(double value, double own) {
    const double from = value - mean;
    weight += own;
    mean += own / weight * from;
    square += own * from * (value - mean);
    ++count;
  }
};

// Of each record from those before it; 0 where they say nothing yet.
std::vector<double> deviations_of(const Course& course, const std::vector<double>& weights, const Scatter& common) {
  std::vector<double> deviations;
  Before before;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    double deviation = 0.0;
    if (before.count > 0) {
      const auto own_freedom = static_cast<double>(before.count - 1);
      const auto scatter = moderated({own_freedom > 0.0 ? before.square / own_freedom : 0.0, own_freedom}, common);
      const double error = std::sqrt(scatter.variance * (1.0 / weights[k] + 1.0 / before.weight));
      if (scatter.freedom >= 1.0 && error > 0.0) {
        const double t = (course.values[k] - before.mean) / error;
        const double tail = std::max(0.5 * student_tails(t, scatter.freedom), 1e-100);
        deviation = std::copysign(normal_quantile(std::min(tail, 0.5)), t);
      }
    }
    deviations.push_back(deviation);
    before.add(course.values[k], weights[k]);
  }
  return deviations;
}

// Means of the records before and since the first of the change.
void describe_change(Alarm& alarm, const Course& course, const std::vector<double>& weights, std::size_t first,
                     std::size_t last, double variance) {
  Before before, since;
  for (std::size_t k = 0; k < first; ++k) before.add(course.values[k], weights[k]);
  for (std::size_t k = first; k <= last; ++k) since.add(course.values[k], weights[k]);
  alarm.change = (since.mean - before.mean) * course.scale;
  alarm.change_error = std::sqrt(variance * (1.0 / before.weight + 1.0 / since.weight)) * course.scale;
}

std::optional<Alarm> first_alarm(const Course& course, const std::vector<double>& weights,
                                 const std::vector<double>& deviations, const FleetTrends& fleet, double variance) {
  struct Sum {
    Cusum sum;
    double reference, threshold;
    int direction;
  };
  std::vector<Sum> sums;
  for (std::size_t r = 0; r < alarm_references.size(); ++r)
    for (const int direction : {1, -1})
      sums.push_back({Cusum(alarm_references[r]), alarm_references[r], fleet.thresholds[r], direction});
  for (std::size_t k = 0; k < deviations.size(); ++k) {
    const Sum* most = nullptr;
    for (auto& each : sums) {
      each.sum.add(each.direction * deviations[k], k);
      if (each.sum.sum() <= each.threshold) continue;
      if (most == nullptr || each.sum.sum() / each.threshold > most->sum.sum() / most->threshold) most = &each;
    }
    if (most == nullptr) continue;
    // The first record is compared with none, so that a change never begins with it.
    const auto since = std::max<std::size_t>(most->sum.since(), 1);
    Alarm alarm{course.records[k], course.records[since], most->direction, most->reference, most->sum.sum(), 0.0, 0.0};
    describe_change(alarm, course, weights, since, k, variance);
    return alarm;
  }
  return std::nullopt;
}

CauseTrend trend_of(const Course& course, const CauseScatter& cause, const FleetTrends& fleet) {
  CauseTrend trend;
  trend.records = course.records;
  trend.scale = course.scale;
  if (course.values.empty()) return trend;
  const auto weights = weights_of(course, cause.between);
  const auto line = line_of(course, weights);
  trend.mean = line.mean * course.scale;
  trend.day = line.month * days_of_month;
  Scatter own;
  if (course.values.size() > line_parameters) {
    own.freedom = static_cast<double>(course.values.size() - line_parameters);
    own.variance = line.square / own.freedom;
  }
  const auto scatter = moderated(own, cause.common);
  trend.freedom = scatter.freedom;
  if (scatter.freedom >= 1.0) {
    trend.limit = student_limit(scatter.freedom);
    trend.mean_error = std::sqrt(scatter.variance / line.weight) * course.scale;
    trend.scatter = std::sqrt(scatter.variance * static_cast<double>(weights.size()) / line.weight);
  }
  if (trend.known() && line.spread > 0.0 && scatter.freedom >= 1.0) {
    trend.slope = line.slope * course.scale;
    trend.slope_error = std::sqrt(scatter.variance / line.spread) * course.scale;
    trend.slope_half = trend.limit * trend.slope_error;
  }
  trend.deviation = deviations_of(course, weights, cause.common);
  trend.alarm = first_alarm(course, weights, trend.deviation, fleet, scatter.variance);
  return trend;
}

double usual_distance(const std::vector<AxisHistory>& histories) {
  std::vector<double> distances;
  for (const auto& history : histories)
    for (std::size_t k = 1; k < history.days.size(); ++k) distances.push_back(history.days[k] - history.days[k - 1]);
  return distances.empty() ? days_of_month : median(distances);
}

// The surest of its trends in standard errors, with an alarm above all that have none.
double badness(const AxisTrends& axis) {
  double worst = 0.0;
  bool alarmed = false;
  for (const auto& cause : axis.causes) {
    worst = std::max(worst, std::abs(cause.surety()));
    if (!cause.alarm) continue;
    alarmed = true;
    worst = std::max(worst, std::abs(cause.alarm->change) / std::max(cause.alarm->change_error, 1e-300));
  }
  return alarmed ? 1e6 + worst : worst;
}

}  // namespace

FleetTrends trends_of(const std::vector<AxisHistory>& histories, double false_alarms) {
  FleetTrends fleet;
  fleet.false_alarms = false_alarms;
  fleet.records_a_year = 365.25 / usual_distance(histories);
  // All sums of an axis share its rate.
  constexpr double sums = fleet_causes * alarm_references.size() * 2.0;
  for (std::size_t r = 0; r < alarm_references.size(); ++r)
    fleet.thresholds[r] =
        cusum_threshold(alarm_references[r], std::min(false_alarms / (fleet.records_a_year * sums), 0.1));
  fleet.axes.resize(histories.size());
  for (std::size_t c = 0; c < fleet_causes; ++c) {
    std::vector<Course> courses;
    for (const auto& history : histories) courses.push_back(course_of(history, static_cast<FleetCause>(c)));
    const auto cause = scatter_of(courses);
    fleet.between[c] = cause.between;
    fleet.common[c] = cause.common;
    for (std::size_t k = 0; k < histories.size(); ++k) {
      fleet.axes[k].history = k;
      fleet.axes[k].causes[c] = trend_of(courses[k], cause, fleet);
    }
  }
  std::stable_sort(fleet.axes.begin(), fleet.axes.end(),
                   [](const AxisTrends& a, const AxisTrends& b) { return badness(a) > badness(b); });
  return fleet;
}

}  // namespace stiction::host
