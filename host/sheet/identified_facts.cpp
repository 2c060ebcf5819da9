// Mass and friction of the logs: the machine file that the answers make so far is identified as `stiction identify`
// does it, and again with what was found, since which rows count as motion follows from friction and mass.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "host/identify/identification.hpp"
#include "host/identify/own_identification.hpp"
#include "host/sheet/drive_values.hpp"
#include "host/sheet/log_facts.hpp"
#include "host/sheet/machine_text.hpp"
#include "sim/machine_file.hpp"
#include "sim/plant/friction/coulomb_viscous.hpp"

namespace stiction::host {
namespace {

constexpr int passes = 4;               // until rows and values agree
constexpr double settled = 1e-3;        // of mass and Coulomb friction from pass to pass
constexpr double first_coulomb = 1e-3;  // of the largest effort: so little that hardly a row counts as rest

// A quantity of an identification, by its name for linear axes and for rotary ones.
struct Sought {
  const char* question;
  const char *linear, *rotary;
  const char *unit, *rotary_unit;
};
constexpr std::array<Sought, 3> sought{
    {{"load", "mass_kg", "inertia_kg_m2", "kg", "kg m^2"},
     {"coulomb", "coulomb_N", "coulomb_N_m", "N", "N m"},
     {"viscous", "viscous_N_s_per_m", "viscous_N_m_s_per_rad", "N s/m", "N m s/rad"}}};

constexpr const char* record_effort = "record the motor's current i[A], its voltage u[V] or its force F[N]";

class Identifier {
 public:
  Identifier(LogFacts& facts, const SheetAnswers& answers, const std::vector<Log>& logs)
      : facts_(facts), answers_(answers), logs_(logs), motor_(motor_values(answers)) {}

  void run() {
    if (!has_effort()) return leave_open(fmt::format("it has no column of the effort; {}", record_effort));
    try {
      auto plain = converged(false);
      if (!facts_.rotary) return keep(plain, false);
      const auto weighed = converged(true);
      const bool weight = weighed.held_out && plain.held_out && weighed.held_out->fit < plain.held_out->fit;
      keep(weight ? weighed : plain, weight);
    } catch (const LogError& error) {
      leave_open(error.what());
    }
  }

 private:
  // Whether an effort is there; throws where it is not the one that the motor's constant is for.
  bool has_effort() const {
    const bool volts = facts_.effort_volts > 0.0, amperes = facts_.effort_amperes > 0.0;
    if (facts_.has_force || (motor_.per_volt ? volts : amperes)) return true;
    if (!volts && !amperes) return false;
    if (!motor_.source) return false;  // windings: a voltage is no measure of the force
    throw LogError(fmt::format("{}: found {} and a motor's constant per {}; expected a constant per {}", facts_.names,
                               volts ? "the voltage u alone" : "the current i alone",
                               motor_.per_volt ? "volt" : "ampere",
                               volts ? "volt, as \"35 N/V\"" : "ampere, as \"94 N/A\""));
  }

  bool is_given(const char* question) const {
    const auto found = answers_.find(question);
    return found != answers_.end() && !found->second.empty();
  }

  // The axis of a file with these values; 0 for a load: the first guess.
  machine::AxisModel axis_with(double load, double coulomb, bool weight) const {
    auto answers = answers_;
    if (!is_given("load"))
      answers["load"] = fmt::format("{:.17g} {}", load > 0.0 ? load : 1.0, facts_.rotary ? "kg m^2" : "kg");
    answers["coulomb"] = fmt::format("{:.17g} {}", coulomb, facts_.rotary ? "N m" : "N");
    answers["viscous"] = facts_.rotary ? "0 N m s/rad" : "0 N s/m";
    LogMarks marks;
    // Its size is what is identified; the file's stands for its presence.
    if (weight) marks.moment = MarkedValue{1e-12, ""};
    auto axis = sim::parse_machine(facts_.names, machine_text(answers, "", marks)).axes.front();
    return axis;
  }

  double transmission_mass() const {
    auto answers = answers_;
    answers["load"] = facts_.rotary ? "0 kg m^2" : "0 kg";
    return axis_values(answers, motor_).mass;
  }

  Identification identified(const machine::AxisModel& axis) const {
    const IdentifyOptions options{
        std::string(sim::CoulombViscous<>::name), Amperes::amplitude, FitSettings{}, true, {}};
    return in_own_units(identify_logs(linear_logs(logs_, axis), axis, options), axis);
  }

  const char* name(const Sought& each) const { return facts_.rotary ? each.rotary : each.linear; }
  const char* unit(const Sought& each) const { return facts_.rotary ? each.rotary_unit : each.unit; }

  Identification converged(bool weight) const {
    const double way = axis_way();
    const double effort = motor_.per_volt ? facts_.effort_volts : facts_.effort_amperes;
    const double force = motor_.constant / way * std::max(effort, 1e-6);
    double mass = 0.0,
           coulomb = is_given("coulomb") ? sheet_quantity(answers_, "coulomb", unit(sought[1])) : first_coulomb * force;
    std::optional<Identification> result;
    for (int pass = 0; pass < passes; ++pass) {
      result = identified(axis_with(mass, coulomb, weight));
      const auto* found_mass = result->find(name(sought[0]));
      const auto* found_coulomb = result->find(name(sought[1]));
      const double next_mass = found_mass ? std::max(found_mass->value - transmission_mass(), 0.0) : mass;
      const double next_coulomb = found_coulomb && !is_given("coulomb") ? found_coulomb->value : coulomb;
      const bool same = std::abs(next_mass - mass) <= settled * next_mass &&
                        std::abs(next_coulomb - coulomb) <= settled * next_coulomb;
      mass = next_mass;
      coulomb = next_coulomb;
      if (same) break;
    }
    return std::move(*result);
  }

  double axis_way() const { return way_of(answers_); }

  void keep(const Identification& result, bool weight) {
    for (const auto& each : sought) keep(each, result);
    keep_constant(result, weight);
    if (!is_given("load")) return;  // what is asked compares with the load of a sheet
    for (const auto& question : result.questions) facts_.marks.weight.push_back("QUESTION: " + question.text);
  }

  void keep(const Sought& each, const Identification& result) {
    const auto* found = result.find(name(each));
    if (found == nullptr) {
      for (const auto& n : result.not_determined)
        if (n.name == name(each)) facts_.open[each.question] = fmt::format("{}; record {}", n.why, n.record);
      return;
    }
    const bool load = std::string_view(each.question) == "load";
    const double beside = load ? transmission_mass() : 0.0, value = found->value - beside;
    const auto interval =
        fmt::format("95 % from {:.5g} to {:.5g} {}", found->ci95.low - beside, found->ci95.high - beside, unit(each));
    if (!(value > 0.0)) {
      facts_.open[each.question] = fmt::format(
          "the whole is {:.5g} {}, {}, which is no more than the {:.5g} {} of motor and transmission; check "
          "the motor's constant, or record larger accelerations",
          found->value, unit(each), interval, beside, unit(each));
      return;
    }
    facts_.facts[each.question] = {fmt::format("{:.6g} {}", value, unit(each)),
                                   facts_.source,
                                   interval,
                                   value,
                                   found->ci95.low - beside,
                                   found->ci95.high - beside};
  }

  // What acts on the axis at all times, and its weight.
  void keep_constant(const Identification& result, bool weight) {
    const char* wanted = weight ? "gravity_moment_N_m" : facts_.rotary ? "constant_torque_N_m" : "constant_force_N";
    const char* unit = facts_.rotary ? "N m" : "N";
    const char* called = weight ? "moment of the weight" : facts_.rotary ? "constant moment" : "constant force";
    auto& lines = facts_.marks.weight;
    for (const auto& n : result.not_determined)
      if (n.name == wanted)
        lines.push_back(
            fmt::format("Not determined by {}, the {}: {}; record {}.", facts_.source, called, n.why, n.record));
    const auto* found = result.find(wanted);
    if (found == nullptr) return;
    const auto interval = fmt::format("95 % from {:.5g} to {:.5g} {}", found->ci95.low, found->ci95.high, unit);
    if (found->ci95.low <= 0.0 && found->ci95.high >= 0.0) {
      lines.push_back(fmt::format("No {} is seen in {}: {}.", called, facts_.source, interval));
      return;
    }
    if (weight) {
      facts_.marks.moment = MarkedValue{found->value, fmt::format("from {}: {}", facts_.source, interval)};
      if (const auto* rise = result.find("load_coefficient"))
        facts_.marks.load_friction = MarkedValue{
            rise->value,
            fmt::format("from {}: 95 % from {:.3g} to {:.3g}", facts_.source, rise->ci95.low, rise->ci95.high)};
      return;
    }
    // What is found is the motor's force against it.
    facts_.marks.constant =
        MarkedValue{-found->value,
                    fmt::format("from {}: 95 % from {:.5g} to {:.5g} {}; a weight is better a table "
                                "[axis.{}.gravity]",
                                facts_.source, -found->ci95.high, -found->ci95.low, unit, answer_to(answers_, "axis"))};
  }

  void leave_open(const std::string& why) {
    for (const auto& each : sought) facts_.open[each.question] = why;
  }

  LogFacts& facts_;
  const SheetAnswers& answers_;
  const std::vector<Log>& logs_;
  MotorValues motor_;
};

}  // namespace

void identify_facts(LogFacts& facts, const SheetAnswers& answers, const std::vector<Log>& logs) {
  Identifier(facts, answers, logs).run();
}

}  // namespace stiction::host
