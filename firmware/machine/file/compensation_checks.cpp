#include "firmware/machine/file/compensation_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string_view>
#include <vector>

#include "firmware/machine/file/units.hpp"
#include "stiction/control/compensation_kind.hpp"

namespace stiction::machine {
namespace {

class Checker {
 public:
  Checker(const Document& document, const toml::table& table, std::string path, const AxisModel& axis,
          const Machine& machine)
      : document_(document),
        table_(table),
        path_(std::move(path)),
        axis_(axis),
        machine_(machine),
        timing_(machine.timing) {}

  void check() const {
    const auto& compensation = *axis_.friction_compensation;
    check_use(compensation);
    if (compensation.pulse) check_pulse(*compensation.pulse);
    if (compensation.friction) check_friction(*compensation.friction);
    if (compensation.learning) check_learning(*compensation.learning);
    if (compensation.learned) check_learned(*compensation.learned);
  }

 private:
  // Fails at `key`, a path below the compensation's table; where the key is absent, at the nearest table.
  [[noreturn]] void fail(std::string_view key, std::string_view found, std::string_view expected) const {
    const toml::node* node = table_.get("friction_compensation");
    for (std::string_view rest = key; !rest.empty();) {
      const auto dot = rest.find('.');
      const toml::node* child = node->is_table() ? node->as_table()->get(rest.substr(0, dot)) : nullptr;
      if (child == nullptr) break;
      node = child;
      rest = dot == std::string_view::npos ? std::string_view{} : rest.substr(dot + 1);
    }
    document_.fail(node->source(), join_key(join_key(path_, "friction_compensation"), key), found, expected);
  }

  void check_use(const FrictionCompensationParameters& compensation) const {
    const auto need = [&](CompensationKind kind, const char* name, const char* table, bool there) {
      if (compensation.use == kind && !there)
        fail("use", fmt::format("\"{}\", without a table '{}'", name, table),
             fmt::format("the table [{}.friction_compensation.{}] too", path_, table));
    };
    need(CompensationKind::pulse, "pulse", "pulse", compensation.pulse.has_value());
    need(CompensationKind::friction, "friction", "friction", compensation.friction.has_value());
    need(CompensationKind::learning, "learning", "friction", compensation.friction.has_value());
    need(CompensationKind::learning, "learning", "learning", compensation.learning.has_value());
  }

  void check_pulse(const PulseCompensationParameters& pulse) const {
    const auto at_most = [&](std::string_view key, double value, double most, const char* unit, const char* what) {
      if (value <= most) return;
      fail(key, format_quantity(value, unit, unit),
           fmt::format("at most {}, {}", format_quantity(most, unit, unit), what));
    };
    at_most("pulse.amplitude", pulse.amplitude, axis_.max_velocity, "m/s", "the axis' max_velocity");
    at_most("pulse.final_amplitude", pulse.final_amplitude, pulse.amplitude, "m/s", "the value of amplitude");
    rises("pulse.flat_until", pulse.flat_until, pulse.rise_until, "m/s^2", "rise_until");
    rises("pulse.fall_until", pulse.fall_until, pulse.flat_until, "m/s^2", "flat_until");
  }

  void rises(std::string_view key, double value, double below, const char* unit, const char* of) const {
    if (value > below) return;
    fail(key, format_quantity(value, unit, unit),
         fmt::format("more than {}, the value of {}", format_quantity(below, unit, unit), of));
  }

  void check_friction(const FrictionFeedforwardParameters& friction) const {
    if (friction.look_ahead > timing_.set_point_delay + 1e-12)
      fail("friction.look_ahead", format_quantity(friction.look_ahead, "s", "us"),
           fmt::format("at most {}, the value of timing.set_point_delay: the buffer of set-points that it looks into",
                       format_quantity(timing_.set_point_delay, "s", "us")));
    check_length("friction.level", friction.level, friction.distance, "distance");
    check_length("friction.forward", friction.forward, friction.speed, "speed");
    check_length("friction.backward", friction.backward, friction.speed, "speed");
    constexpr auto most = compensation_element_count;
    if (friction.distance.size() > most)
      fail("friction.distance", fmt::format("a list of {}", friction.distance.size()),
           fmt::format("a list of at most {}, as many elements as the drive has", most));
    check_rising("friction.distance", friction.distance, "m", "um");
    check_rising("friction.speed", friction.speed, "m/s", "m/s");
    check_current(friction);
  }

  void check_length(std::string_view key, const std::vector<double>& list, const std::vector<double>& other,
                    std::string_view of) const {
    if (list.size() == other.size()) return;
    fail(key, fmt::format("a list of {}", list.size()),
         fmt::format("a list of {}, as many as {} has", other.size(), of));
  }

  void check_rising(std::string_view key, const std::vector<double>& list, const char* si, const char* unit) const {
    for (std::size_t k = 1; k < list.size(); ++k)
      if (!(list[k] > list[k - 1]))
        fail(key,
             fmt::format("{} after {}", format_quantity(list[k], si, unit), format_quantity(list[k - 1], si, unit)),
             "values that increase");
  }

  void check_current(const FrictionFeedforwardParameters& friction) const {
    const double limit = current_limit();
    const double coulomb = std::accumulate(friction.level.begin(), friction.level.end(), 0.0);
    const auto check = [&](const char* key, double current, const char* what) {
      if (current <= limit) return;
      fail(key, fmt::format("{} {}", format_quantity(current, unit(), unit()), what),
           fmt::format("at most {}, the axis' {} limit", format_quantity(limit, unit(), unit()), what_limits()));
    };
    check("friction.level", coulomb, "in all");
    for (const auto& [key, list] :
         {std::pair("friction.forward", &friction.forward), std::pair("friction.backward", &friction.backward)})
      for (const double beyond : *list) check(key, coulomb + std::abs(beyond), "with the Coulomb level");
  }

  void check_learning(const QuadrantLearningParameters& learning) const {
    if (learning.limit > current_limit())
      fail("learning.limit", format_quantity(learning.limit, unit(), unit()),
           fmt::format("at most {}, the axis' {} limit", format_quantity(current_limit(), unit(), unit()),
                       what_limits()));
    if (learning.forgetting + 2.0 * learning.smoothing > 1.0)
      fail("learning.smoothing", fmt::format("{:g} with a forgetting of {:g}", learning.smoothing, learning.forgetting),
           "twice the smoothing and the forgetting at most 1 together");
  }

  void check_learned(const LearnedTable& learned) const {
    const std::string own = fmt::format("axis {} of \"{}\"", axis_.name, machine_.name);
    if (learned.machine != machine_.name)
      fail("learned.machine", fmt::format("\"{}\"", learned.machine), fmt::format("a table learned by {}", own));
    if (learned.axis != axis_.name)
      fail("learned.axis", fmt::format("\"{}\"", learned.axis), fmt::format("a table learned by {}", own));
    for (const auto& [key, list] :
         {std::pair("learned.forward", &learned.forward), std::pair("learned.backward", &learned.backward)}) {
      if (list->size() != learned_table_nodes)
        fail(key, fmt::format("a list of {}", list->size()), fmt::format("a list of {}", learned_table_nodes));
      const double limit =
          axis_.friction_compensation->learning ? axis_.friction_compensation->learning->limit : current_limit();
      for (const double current : *list)
        if (std::abs(current) > limit)
          fail(key, format_quantity(current, unit(), unit()),
               fmt::format("at most {} in magnitude, the limit of learning", format_quantity(limit, unit(), unit())));
    }
  }

  bool force_motor() const { return axis_.motor.driven_by_volts(); }
  const char* unit() const { return force_motor() ? "V" : "A"; }
  const char* what_limits() const { return force_motor() ? "voltage" : "current"; }
  double current_limit() const {
    return force_motor() ? axis_.inverter.voltage_limit : axis_.inverter.current_limit * axis_.motor.count;
  }

  const Document& document_;
  const toml::table& table_;
  std::string path_;
  const AxisModel& axis_;
  const Machine& machine_;
  const Timing& timing_;
};

}  // namespace

void check_compensation(const Document& document, const toml::table& table, const std::string& path,
                        const AxisModel& axis, const Machine& machine) {
  if (axis.friction_compensation) Checker(document, table, path, axis, machine).check();
}

}  // namespace stiction::machine
