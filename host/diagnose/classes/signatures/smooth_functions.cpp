// Smooth functions of what a record knows, which no effect of the vocabulary is: of position, speed, acceleration,
// time, time and way since the last reversal, and of two of them together (a generalised additive model: Wood 2017).
// Each is a number of cosines, all as likely: the fewer, the smoother. They take part so that a name has to be better
// than none.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/diagnose/classes/candidate.hpp"
#include "host/diagnose/record/inverse_dynamics.hpp"
#include "host/log/shown_units.hpp"

namespace stiction::host::signatures {
namespace {

using Values = std::vector<double>;

// Cosines number `first` to before `end` of `place` (0 to 1), times `size`.
void add_cosines(Columns& columns, const Values& place, const Values& size, int first, int end) {
  for (int k = first; k < end; ++k) {
    auto& column = columns.emplace_back(place.size());
    for (std::size_t i = 0; i < column.size(); ++i) column[i] = -size[i] * std::cos(std::numbers::pi * k * place[i]);
  }
}

Values ones(const Motion& motion) { return Values(motion.x.size(), 1.0); }
Values along_stroke(const SearchContext& context, const Motion& motion) {
  auto place = motion.x;
  for (double& x : place) x = std::clamp((x - context.lowest_position) / context.stroke(), 0.0, 1.0);
  return place;
}
// Fine near standstill: a hundredth of the highest speed is a seventh of the way.
constexpr double slow = 0.01;
double speed_at(const SearchContext& context, double place) {
  return context.highest_speed * slow * std::sinh(place * std::asinh(1.0 / slow));
}
constexpr double slowest_of_a_map = 1e-6;  // of the highest speed
Values along_speed(const SearchContext& context, const Motion& motion) {
  Values place(motion.v.size());
  for (std::size_t i = 0; i < place.size(); ++i)
    place[i] = std::min(std::asinh(std::abs(motion.v[i]) / context.highest_speed / slow) / std::asinh(1.0 / slow), 1.0);
  return place;
}
Values along_time(const SearchContext& context, const Motion& motion) {
  auto place = motion.t;
  for (double& t : place) t = std::clamp(t / context.duration, 0.0, 1.0);
  return place;
}
Values speed(const SearchContext& context, const Motion& motion) {
  auto size = motion.v;
  for (double& v : size) v /= context.highest_speed;
  return size;
}
double highest(const Values& values) {
  double most = 1e-12;
  for (const double each : values) most = std::max(most, std::abs(each));
  return most;
}

std::string about(const SearchContext& context, const char* what, const Eigen::VectorXd& w) {
  const auto force = ShownUnits(context.axis.coordinate).force;
  return fmt::format("{}, about {:.2g} {}", what, force(w.norm() / std::numbers::sqrt2), force.unit);
}

// As a table of the machine file: force on the carriage at these places and velocities, the velocities of a place
// together.
void describe_as_map(const SearchContext& context, Values position, Values velocity, Values force, Finding& finding) {
  effects::add_key(context, finding, "position", std::move(position), {});
  effects::add_key(context, finding, "velocity", std::move(velocity), {});
  effects::add_key(context, finding, "force", std::move(force), {});
}
// Sum of cosines number `first`, and those behind it, with weights from `w` on, at `place` (0 to 1).
double cosine_sum(const Eigen::VectorXd& w, Eigen::Index from, Eigen::Index count, int first, double place) {
  double sum = 0.0;
  for (Eigen::Index k = 0; k < count; ++k)
    sum += w[from + k] * std::cos(std::numbers::pi * static_cast<double>(first + k) * place);
  return sum;
}
constexpr int intervals_of_a_map = 40;
Values places_of(const SearchContext& context) {
  Values places;
  for (int k = 0; k <= intervals_of_a_map; ++k)
    places.push_back(context.lowest_position + context.stroke() * k / intervals_of_a_map);
  return places;
}

bool has_stroke(const SearchContext& context) { return context.stroke() > 0.0; }

// Of position.
Values numbers_of_position(const SearchContext& context) {
  return has_stroke(context) ? Values{5.0, 10.0, 18.0} : Values{};
}
Columns of_position(const SearchContext& context, const Motion& motion, double number) {
  Columns columns;
  add_cosines(columns, along_stroke(context, motion), ones(motion), 1, static_cast<int>(number) + 1);
  return columns;
}
std::string like_position(const SearchContext& context, double, const Eigen::VectorXd& w) {
  return about(context, "a force that depends on position, equal in both directions", w);
}

void position_as_map(const SearchContext& context, double, const Eigen::VectorXd& w, const Eigen::MatrixXd&,
                     Finding& finding) {
  auto places = places_of(context);
  Values force;
  for (std::size_t k = 0; k < places.size(); ++k)
    force.push_back(cosine_sum(w, 0, w.size(), 1, static_cast<double>(k) / intervals_of_a_map));
  describe_as_map(context, std::move(places), {0.0}, std::move(force), finding);
}

// Of speed: an even and an odd part.
Values numbers_of_speed(const SearchContext&) { return {3.0, 7.0}; }
Columns of_speed(const SearchContext& context, const Motion& motion, double number) {
  Columns columns;
  const auto place = along_speed(context, motion);
  add_cosines(columns, place, contact_level(context.axis, motion), 0, static_cast<int>(number) + 1);
  add_cosines(columns, place, ones(motion), 1, static_cast<int>(number) + 1);
  return columns;
}
std::string like_speed(const SearchContext& context, double, const Eigen::VectorXd& w) {
  return about(context, "a force that depends on speed and direction", w);
}

void speed_as_map(const SearchContext& context, double number, const Eigen::VectorXd& w, const Eigen::MatrixXd&,
                  Finding& finding) {
  const auto even = static_cast<Eigen::Index>(number), odd = even + 1;
  Values velocity, force;
  // Below the slow speed rows are few, and friction there is told by displacement: one value for each direction.
  const double first = std::asinh(1.0) / std::asinh(1.0 / slow);
  for (int k = -intervals_of_a_map; k <= intervals_of_a_map; ++k) {
    if (k == 0) continue;
    const double share = (std::abs(k) - 1.0) / (intervals_of_a_map - 1.0), sign = std::copysign(1.0, k);
    const double place = first + share * (1.0 - first);
    velocity.push_back(sign * (std::abs(k) == 1 ? slowest_of_a_map * context.highest_speed : speed_at(context, place)));
    force.push_back(sign * cosine_sum(w, 0, odd, 0, place) + cosine_sum(w, odd, even, 1, place));
  }
  describe_as_map(context, {0.0}, std::move(velocity), std::move(force), finding);
}

// Of acceleration beyond a mass.
Columns of_acceleration(const SearchContext&, const Motion& motion, double) {
  const double most = highest(motion.a);
  Columns columns(3, Values(motion.a.size()));
  for (std::size_t i = 0; i < motion.a.size(); ++i) {
    const double a = motion.a[i] / most;
    columns[0][i] = a * std::abs(a);
    columns[1][i] = a * a * a;
    columns[2][i] = a * a;
  }
  return columns;
}
std::string like_acceleration(const SearchContext& context, double, const Eigen::VectorXd& w) {
  return about(context, "a force that does not grow in proportion to acceleration", w);
}

// Of time in each record: any force, friction, friction that grows with speed. What all of a record has is no function
// of time.
Values numbers_of_time(const SearchContext&) { return {3.0, 8.0}; }
Columns of_time(const SearchContext& context, const Motion& motion, double number) {
  Columns columns;
  add_cosines(columns, along_time(context, motion), ones(motion), 1, static_cast<int>(number) + 1);
  return columns;
}
std::string like_time(const SearchContext& context, double, const Eigen::VectorXd& w) {
  return about(context, "a force that wanders with time, equal in both directions", w);
}
Columns friction_of_time(const SearchContext& context, const Motion& motion, double number) {
  Columns columns;
  add_cosines(columns, along_time(context, motion), contact_level(context.axis, motion), 1,
              static_cast<int>(number) + 1);
  return columns;
}
std::string like_friction_of_time(const SearchContext& context, double, const Eigen::VectorXd& w) {
  return about(context, "friction that wanders with time", w);
}
Columns viscous_of_time(const SearchContext& context, const Motion& motion, double number) {
  Columns columns;
  add_cosines(columns, along_time(context, motion), speed(context, motion), 1, static_cast<int>(number) + 1);
  return columns;
}
std::string like_viscous_of_time(const SearchContext& context, double, const Eigen::VectorXd& w) {
  return about(context, "friction in proportion to speed that wanders with time", w);
}
// From a time on, in one of the records.
constexpr int places_in_time = 24;
Values times(const SearchContext&) {
  Values all;
  for (int k = 1; k < places_in_time; ++k) all.push_back(static_cast<double>(k) / places_in_time);
  return all;
}
Columns from_time_on(const SearchContext& context, const Motion& motion, double time) {
  Columns columns{Values(motion.t.size()), contact_level(context.axis, motion)};
  for (std::size_t i = 0; i < motion.t.size(); ++i) {
    const double on = motion.t[i] > time * context.duration ? 1.0 : 0.0;
    columns[0][i] = -on;
    columns[1][i] *= on;
  }
  return columns;
}
std::string like_event(const SearchContext& context, double time, const Eigen::VectorXd& w) {
  return about(context, fmt::format("a force that changes {:.3g} s after the start", time * context.duration).c_str(),
               w);
}

// Of two coordinates.
Values numbers_of_both(const SearchContext& context) { return has_stroke(context) ? Values{4.0} : Values{}; }
Columns of_position_and_speed(const SearchContext& context, const Motion& motion, double number) {
  Columns columns;
  add_cosines(columns, along_stroke(context, motion), speed(context, motion), 1, static_cast<int>(number) + 1);
  return columns;
}
std::string like_position_and_speed(const SearchContext& context, double, const Eigen::VectorXd& w) {
  return about(context, "friction in proportion to speed that depends on position", w);
}
void position_and_speed_as_map(const SearchContext& context, double, const Eigen::VectorXd& w, const Eigen::MatrixXd&,
                               Finding& finding) {
  auto places = places_of(context);
  Values force;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const double at_highest = cosine_sum(w, 0, w.size(), 1, static_cast<double>(k) / intervals_of_a_map);
    force.insert(force.end(), {-at_highest, at_highest});
  }
  describe_as_map(context, std::move(places), {-context.highest_speed, context.highest_speed}, std::move(force),
                  finding);
}
Columns of_position_and_acceleration(const SearchContext& context, const Motion& motion, double number) {
  auto size = motion.a;
  const double most = highest(size);
  for (double& a : size) a /= most;
  Columns columns;
  add_cosines(columns, along_stroke(context, motion), size, 1, static_cast<int>(number) + 1);
  return columns;
}
std::string like_position_and_acceleration(const SearchContext& context, double, const Eigen::VectorXd& w) {
  return about(context, "a mass that depends on position", w);
}

// Since the last reversal: of the way, and of the way in proportion to how long the axis stood before.
struct SinceReversal {
  Values way, rest, direction;  // m, s, -1 to 1
};
SinceReversal since_reversal(const SearchContext& context, const Motion& motion) {
  const double creeping = 1e-3 * context.highest_speed;
  SinceReversal since;
  double way = 0.0, rest = 0.0, stood = 0.0, direction = 0.0;
  for (std::size_t i = 0; i < motion.v.size(); ++i) {
    const double v = motion.v[i];
    if (std::abs(v) < creeping) {
      stood += motion.period;
    } else {
      if (direction * v <= 0.0) way = 0.0, rest = stood, direction = std::copysign(1.0, v);
      if (stood > 0.0) way = 0.0, rest = stood;
      stood = 0.0;
      way += std::abs(v) * motion.period;
    }
    since.way.push_back(way);
    since.rest.push_back(rest);
    since.direction.push_back(direction);
  }
  return since;
}
Values ways(const SearchContext& context) {
  return context.reversals < 4 || !has_stroke(context)
             ? Values{}
             : effects::geometric(1e-5 * context.stroke(), 0.1 * context.stroke(), 7);
}
Columns after_way(const SearchContext& context, const Motion& motion, double way) {
  const auto since = since_reversal(context, motion);
  Values column(motion.v.size());
  for (std::size_t i = 0; i < column.size(); ++i) column[i] = since.direction[i] * std::exp(-since.way[i] / way);
  return {column};
}
std::string like_after_way(const SearchContext& context, double way, const Eigen::VectorXd& w) {
  const auto position = ShownUnits(context.axis.coordinate).position;
  return about(context,
               fmt::format("at reversals: a force that decays within {:.2g} {}", position(way), position.unit).c_str(),
               w);
}
Columns after_rest(const SearchContext& context, const Motion& motion, double way) {
  const auto since = since_reversal(context, motion);
  Values column(motion.v.size());
  for (std::size_t i = 0; i < column.size(); ++i)
    column[i] = since.direction[i] * std::exp(-since.way[i] / way) * std::log1p(since.rest[i] / 0.1);
  return {column};
}
std::string like_after_rest(const SearchContext& context, double, const Eigen::VectorXd& w) {
  return about(context, "at reversals: a force that grows with the time at rest before", w);
}

}  // namespace

namespace smooth_functions {

std::span<const Candidate> all() {
  static const std::array<Candidate, 11> table{{
      {.grid = numbers_of_position,
       .columns = of_position,
       .possible = effects::any,
       .describe = position_as_map,
       .looks_like = like_position},
      {.grid = numbers_of_speed,
       .columns = of_speed,
       .possible = effects::any,
       .describe = speed_as_map,
       .looks_like = like_speed},
      {.grid = effects::no_scan, .columns = of_acceleration, .possible = effects::any, .looks_like = like_acceleration},
      {.grid = numbers_of_time,
       .columns = of_time,
       .possible = effects::any,
       .per_record = true,
       .looks_like = like_time},
      {.grid = numbers_of_time,
       .columns = friction_of_time,
       .possible = effects::any,
       .per_record = true,
       .looks_like = like_friction_of_time},
      {.grid = numbers_of_time,
       .columns = viscous_of_time,
       .possible = effects::any,
       .per_record = true,
       .looks_like = like_viscous_of_time},
      {.grid = times,
       .columns = from_time_on,
       .possible = effects::any,
       .per_record = true,
       .trials = places_in_time,
       .looks_like = like_event},
      {.grid = numbers_of_both,
       .columns = of_position_and_speed,
       .possible = effects::any,
       .describe = position_and_speed_as_map,
       .looks_like = like_position_and_speed},
      {.grid = numbers_of_both,
       .columns = of_position_and_acceleration,
       .possible = effects::any,
       .looks_like = like_position_and_acceleration},
      {.grid = ways, .columns = after_way, .possible = effects::any, .looks_like = like_after_way},
      {.grid = ways, .columns = after_rest, .possible = effects::any, .looks_like = like_after_rest},
  }};
  return table;
}

}  // namespace smooth_functions
}  // namespace stiction::host::signatures
