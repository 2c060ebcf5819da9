#include "firmware/machine/file/axis_rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "firmware/machine/file/description.hpp"
#include "firmware/machine/file/parameters.hpp"
#include "firmware/machine/model/motor_force.hpp"

namespace stiction::machine {
namespace {

class Rules {
 public:
  Rules(const Document& document, const toml::table& table, const std::string& path, const AxisModel& axis,
        std::size_t errors_before)
      : document_(document),
        table_(table),
        path_(path),
        axis_(axis),
        values_are_right_(document.errors() == errors_before) {}

  void check() const {
    check_structure();
    check_winding();
    check_shaft();
    check_commutation();
    check_gravity();
  }

 private:
  const toml::node* node(std::string_view key) const { return table_.at_path(key).node(); }

  void exclude(std::string_view key, std::string_view why) const {
    if (const toml::node* found = node(key))
      document_.attempt([&] {
        document_.fail(found->source(), join_key(path_, key), found->is_table() ? "a table" : describe_node(*found),
                       fmt::format("none {}", why));
      });
  }

  // "stiffness, "120 N/um" (line 16)".
  std::string at_line(std::string_view key) const {
    const toml::node& found = *node(key);
    return fmt::format("{}, {} (line {})", key, found.is_table() ? "a table" : describe_node(found),
                       found.source().begin.line);
  }

  // "with controller structure "pd" (line 24)", or how the cascade comes about.
  std::string with_structure() const {
    const toml::node* structure = node("controller.structure");
    return structure == nullptr ? "without [controller]"
                                : fmt::format("with controller structure {} (line {})", describe_node(*structure),
                                              structure->source().begin.line);
  }

  static std::string_view text_of(std::string_view key) {
    if (key == "position_controller") return Table<PositionControllerParameters>::text;
    if (key == "velocity_controller") return Table<VelocityControllerParameters>::text;
    for (const auto& p : Table<ControllerParameters>::parameters)
      if (key.substr(key.rfind('.') + 1) == p.key) return p.text;
    return "a value";
  }

  void check_structure() const {
    const auto structure = axis_.controller ? axis_.controller->structure : ControlStructure::cascade;
    const auto rule = std::find_if(structure_rules.begin(), structure_rules.end(),
                                   [&](const StructureRule& candidate) { return candidate.structure == structure; });
    for (const std::string_view key : rule->needs)
      if (node(key) == nullptr)
        document_.attempt([&] {
          const std::string whole = join_key(path_, key);
          if (axis_.cascaded())
            document_.fail(table_.source(), whole, "no such table", fmt::format("[{}] ({})", whole, text_of(key)));
          document_.fail(node("controller")->source(), whole, "no such key",
                         fmt::format("a value ({}), {}", text_of(key), with_structure()));
        });
    for (const std::string_view key : rule->excludes) exclude(key, with_structure());
  }

  // A voltage goes to one winding; three need a current loop with its commutation.
  void check_winding() const {
    if (axis_.cascaded() || is_unknown(axis_) || !axis_.controller->in_volts) return;
    exclude("current_controller", "where the controller's output is a voltage");
    if (axis_.motor.model != MotorModel::synchronous) return;
    document_.attempt([&] {
      const toml::node& model = *node("motor.model");
      document_.fail(model.source(), join_key(path_, "motor.model"), describe_node(model),
                     "\"dc\" or \"force\" where the controller's output is a voltage, or a gain in amperes");
    });
  }

  void check_shaft() const {
    if (!axis_.transmission) return;
    if (!axis_.elastic()) {
      for (const char* key : {"damping", "damping_ratio", "backlash", "stiffness_loss", "warming_time", "gear_ratio",
                              "motor_error", "gear_error", "output_error"})
        exclude(join_key("transmission", key), "without stiffness, on a stiff transmission");
      return;
    }
    const bool damping = node("transmission.damping") != nullptr, ratio = node("transmission.damping_ratio") != nullptr;
    const toml::node& stiffness = *node("transmission.stiffness");
    document_.attempt([&] {
      if (damping && ratio)
        document_.fail(node("transmission.damping_ratio")->source(), join_key(path_, "transmission.damping_ratio"),
                       fmt::format("{} together with {}", describe_node(*node("transmission.damping_ratio")),
                                   at_line("transmission.damping")),
                       "one of them");
      if (!damping && !ratio)
        document_.fail(stiffness.source(), join_key(path_, "transmission.damping"), "no such key",
                       fmt::format("damping or damping_ratio, together with {}", at_line("transmission.stiffness")));
    });
    document_.attempt([&] {
      if (!(axis_.motor_mass > 0.0))
        document_.fail(
            stiffness.source(), join_key(path_, "transmission.motor_inertia"), "none",
            fmt::format("an inertia of the motor or the screw, together with {}", at_line("transmission.stiffness")));
    });
    require_together("transmission.stiffness_loss", "transmission.warming_time");
    require_together("transmission.gear_ratio", "transmission.gear_error");
  }

  // Either of both keys says nothing without the other one.
  void require_together(std::string_view one, std::string_view other) const {
    for (const auto& [given, missing] : {std::pair{one, other}, std::pair{other, one}}) {
      if (node(given) == nullptr || node(missing) != nullptr) continue;
      document_.attempt([&, &key = given, &absent = missing] {
        document_.fail(node(key)->source(), join_key(path_, absent), "no such key",
                       fmt::format("it together with {}", at_line(key)));
      });
    }
  }

  // The windings are fed by the position of the encoder that the current loop has.
  void check_commutation() const {
    if (!axis_.elastic() || axis_.motor.model != MotorModel::synchronous) return;
    const bool by_motor = axis_.velocity_encoder && !axis_.cascaded()
                              ? axis_.velocity_encoder->on == EncoderPlace::motor
                              : axis_.encoder.on == EncoderPlace::motor;
    if (by_motor || is_unknown(axis_)) return;
    document_.attempt([&] {
      document_.fail(node("encoder")->source(), join_key(path_, "encoder.on"), "\"load\"",
                     fmt::format("\"motor\", or motor model \"dc\": a synchronous motor behind an elastic shaft ({}) "
                                 "is commutated by what sits on it",
                                 at_line("transmission.stiffness")));
    });
  }

  // What limits the motor at standstill: the force that it gives there (N), and the key of the limit.
  struct Hold {
    double force;
    std::string_view key;
  };
  Hold hold_of_motor() const {
    const double constant = acting_force_constant(axis_.motor);
    Hold least{largest_force(axis_),
               axis_.motor.driven_by_volts() ? "inverter.voltage_limit" : "inverter.current_limit"};
    const auto at_most = [&](double force, std::string_view key) {
      if (force < least.force) least = {force, key};
    };
    const bool dc = axis_.motor.model == MotorModel::dc && axis_.motor.phase_resistance > 0.0;
    const double per_volt = dc ? constant * axis_.motor.count / axis_.motor.phase_resistance
                            : axis_.motor.driven_by_volts() ? constant
                                                            : 0.0;
    if (dc) at_most(per_volt * axis_.inverter.voltage_limit, "inverter.voltage_limit");
    if (per_volt > 0.0 && axis_.controller && axis_.controller->in_volts && axis_.controller->supply)
      at_most(per_volt * *axis_.controller->supply, "controller.supply");
    return least;
  }

  // The key of the constant with which the motor acts.
  std::string constant_of_motor() const {
    for (const char* name : {"phase_force_constant", "force_constant"}) {
      const auto key = join_key("motor", axis_.motor_coordinate.own(name, "N/A").key);
      if (node(key) != nullptr && (axis_.motor.model == MotorModel::synchronous || name[0] == 'f')) return key;
    }
    return "motor";
  }

  void check_gravity() const {
    if (!axis_.gravity) return;
    const bool rotary = axis_.coordinate.rotary();
    const std::string force = rotary ? "gravity.moment" : "gravity.force";
    exclude(rotary ? "gravity.counterweight_mass" : "gravity.zero",
            rotary ? "on a rotary axis, whose inertia holds it" : "on a linear axis, whose weight does not turn");
    std::vector<std::string> given;
    for (const std::string& key :
         {force, std::string("gravity.counterweight"), std::string("gravity.counterweight_mass")})
      if (node(key) != nullptr) given.push_back(key);
    document_.attempt([&] {
      if (given.empty())
        document_.fail(node("gravity")->source(), join_key(path_, force), "no such key",
                       fmt::format("{}, counterweight or counterweight_mass", rotary ? "moment" : "force"));
    });
    if (!given.empty() && values_are_right_) check_hold(given);
  }

  // `given`: the keys of the weight.
  void check_hold(const std::vector<std::string>& given) const {
    const double held = std::abs(axis_.gravity->force - axis_.gravity->counterweight.value_or(0.0));
    const auto hold = hold_of_motor();
    if (is_unknown(axis_) || held <= hold.force) return;
    const auto own = axis_.coordinate.own("N");
    std::string weight, limit;
    for (const auto& key : given) weight += (weight.empty() ? "" : " and ") + at_line(key);
    for (const std::string& key : {constant_of_motor(), std::string(hold.key)})
      if (node(key) != nullptr && !node(key)->is_table()) limit += (limit.empty() ? "" : " and ") + at_line(key);
    document_.attempt([&] {
      document_.fail(node(given.front())->source(), join_key(path_, "gravity"),
                     fmt::format("{:.4g} {} to hold, by {}", own.from_linear(held), own.unit, weight),
                     fmt::format("at most {:.4g} {}, which the motor holds at its limit, by {}",
                                 own.from_linear(hold.force), own.unit, limit));
    });
  }

  const Document& document_;
  const toml::table& table_;
  const std::string& path_;
  const AxisModel& axis_;
  bool values_are_right_;  // none was refused: what several of them make together may be judged
};

// Coulomb, static and viscous friction of laws that add up.
struct Sum {
  double coulomb = 0.0, level = 0.0, viscous = 0.0;
};

constexpr std::string_view additive[] = {"coulomb_viscous", "classical"};

Sum sum_of(const KeyedValues& values) {
  const auto ratio = values.find("static_ratio");
  const double coulomb = values.at("coulomb").front();
  return {coulomb, coulomb * (ratio == values.end() ? 1.0 : ratio->second.front()), values.at("viscous").front()};
}

}  // namespace

bool is_unknown(const AxisModel& axis) {
  return axis.controller && axis.controller->structure == ControlStructure::unknown;
}

bool has_current_loop(const AxisModel& axis) {
  if (axis.motor.model == MotorModel::force) return false;
  return axis.cascaded() || (!is_unknown(axis) && !axis.controller->in_volts);
}

void check_axis_rules(const Document& document, const toml::table& table, const std::string& path,
                      const AxisModel& axis, std::size_t errors_before) {
  Rules(document, table, path, axis, errors_before).check();
}

void add_motor_friction(const Document& document, const toml::table& table, const std::string& path, AxisModel& axis) {
  const auto add_up = [](const std::string& law) {
    return std::count(std::begin(additive), std::end(additive), law) > 0;
  };
  const auto& motor = *axis.motor_friction;
  for (const auto& [key, use] : {std::pair{"friction", axis.friction.use}, std::pair{"motor_friction", motor.use}})
    if (!add_up(use))
      document.fail(
          table.at_path(fmt::format("{}.use", key)).node()->source(), join_key(path, fmt::format("{}.use", key)),
          fmt::format("\"{}\"", use),
          "\"coulomb_viscous\" or \"classical\" where load and motor have friction, or transmission.stiffness "
          "between them");
  const Sum added = sum_of(motor.models.at(motor.use));
  for (auto& [law, values] : axis.friction.models) {
    if (!add_up(law)) continue;
    const Sum own = sum_of(values);
    const double coulomb = own.coulomb + added.coulomb;
    values["coulomb"] = {coulomb};
    values["viscous"] = {own.viscous + added.viscous};
    if (values.contains("static_ratio") && coulomb > 0.0)
      values["static_ratio"] = {(own.level + added.level) / coulomb};
  }
}

}  // namespace stiction::machine
