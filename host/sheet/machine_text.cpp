#include "host/sheet/machine_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "host/sheet/drive_values.hpp"

namespace stiction::host {
namespace {

constexpr std::size_t widest = 120;                              // characters of a line
constexpr double shortest_period = 33e-6, longest_period = 0.1;  // s, of a control loop

class Writer {
 public:
  Writer(const SheetAnswers& answers, std::string command, const LogMarks& marks)
      : answers_(answers),
        command_(std::move(command)),
        marks_(marks),
        motor_(motor_values(answers)),
        axis_(axis_values(answers, motor_)),
        rotary_(answer_to(answers, "kind") == "rotary"),
        transmission_(answer_to(answers, "transmission")),
        shaft_(rotary_ || transmission_ != "direct"),
        at_axis_(motor_.source && transmission_ == "direct") {}

  std::string text() {
    head();
    axis_table();
    weight();
    if (shaft_ && !at_axis_) transmission();
    motor();
    encoder();
    if (motor_.source)
      no_controller();
    else
      controllers();
    friction();
    constant();
    load_friction();
    return text_;
  }

 private:
  void line(const std::string& text = {}) { text_ += text + "\n"; }
  void table(std::string_view name) { line(fmt::format("\n  [axis.{}.{}]", answer("axis"), name)); }
  // KEY = "VALUE UNIT", with a comment.
  void value(std::string_view key, double number, std::string_view unit, const std::string& comment = {}) {
    given(key, fmt::format("{:.12g} {}", number, unit), comment);
  }
  // A quantity as the sheet gives it.
  void given(std::string_view key, const std::string& quantity, const std::string& comment = {}) {
    entry(fmt::format("{} = \"{}\"", key, quantity), comment);
  }
  // KEY = VALUE with its comment, before it where both are too long for a line.
  void entry(const std::string& text, const std::string& comment, std::size_t column = 42) {
    const auto together = fmt::format("  {:<{}} # {}", text, column, comment);
    if (comment.empty()) return line("  " + text);
    if (together.size() <= widest) return line(together);
    remark(comment);
    line("  " + text);
  }
  // The answer to a question of the sheet, with what logs say of it; `comment`: where they do not.
  void answered(std::string_view key, std::string_view question, const std::string& comment = {}) {
    remarks(question);
    given(key, answer(question), mark(question, comment));
  }
  std::string mark(std::string_view question, const std::string& comment = {}) const {
    const auto found = marks_.comments.find(question);
    if (found == marks_.comments.end()) return comment;
    return comment.empty() ? found->second : found->second + "; " + comment;
  }
  void remarks(std::string_view question) {
    if (const auto found = marks_.remarks.find(question); found != marks_.remarks.end())
      for (const auto& each : found->second) remark(each);
  }
  // Lines of comment of a sentence.
  void remark(const std::string& sentence, const std::string& indent = "  ") {
    std::string here = indent + "#";
    for (std::size_t at = 0; at < sentence.size();) {
      const auto end = std::min(sentence.find(' ', at), sentence.size());
      const auto word = sentence.substr(at, end - at);
      if (here.size() + word.size() >= widest && here.size() > indent.size() + 1) {
        line(here);
        here = indent + "#";
      }
      here += " " + word;
      at = end + 1;
    }
    line(here);
  }
  std::string answer(std::string_view name) const { return answer_to(answers_, name); }
  std::string of_sheet(std::string_view name) const { return fmt::format("of the sheet's {}", answer(name)); }

  void head() {
    line("# Made by: " + command_);
    line("# Values without a comment are those of the data sheets. Currents are amplitudes, windings single ones.");
    line("schema = \"stiction.machine/1\"");
    line(fmt::format("name = \"{}\"", answer("name")));
    line("\n[timing]");
    const double period = marks_.period ? std::round(1e9 * marks_.period->value) * 1e-9 : 0.0;
    if (!motor_.source || period < shortest_period || period > longest_period) {
      if (marks_.period)
        remark(fmt::format("{:.6g} ms is {}.", 1e3 * marks_.period->value, marks_.period->comment), "");
      line("fast_period = \"62.5 us\"\nslow_period = \"1 ms\"");
      return;
    }
    remark(marks_.period->comment, "");
    line(fmt::format("fast_period = \"{0:.9g} ms\"\nslow_period = \"{0:.9g} ms\"", 1e3 * period));
  }

  void axis_table() {
    line(fmt::format("\n[axis.{}]", answer("axis")));
    if (rotary_) entry("kind = \"rotary\"", mark("kind"));
    const auto whole = fmt::format("the load alone; the whole is {:.6g} {}", axis_.mass, rotary_ ? "kg m^2" : "kg");
    answered(rotary_ ? "inertia" : "mass", "load", shaft_ && !at_axis_ ? whole : "");
    answered("travel", "travel");
    answered("max_velocity", "max-velocity");
    answered("max_acceleration", "max-acceleration");
  }

  // Of logs alone: the moment of a load about the axis, from its rest below.
  void weight() {
    for (const auto& each : marks_.weight) remark(each);
    if (!marks_.moment) return;
    table("gravity");
    value("moment", std::abs(marks_.moment->value), "N m", marks_.moment->comment);
    const bool above = marks_.moment->value < 0.0;
    given("zero", above ? "180 deg" : "0 deg",
          above ? "the weight acts away from 0: its rest is at half a turn" : "taken as the zero of the log");
  }

  void constant() {
    if (!marks_.constant) return;
    line(fmt::format("\n  [[axis.{}.effect]]\n  name = \"constant_force\"", answer("axis")));
    value("force", marks_.constant->value, rotary_ ? "N m" : "N", marks_.constant->comment);
  }

  void load_friction() {
    if (!marks_.load_friction) return;
    line(fmt::format("\n  [[axis.{}.effect]]\n  name = \"load_dependent_friction\"", answer("axis")));
    entry(fmt::format("coefficient = {:.6g}", marks_.load_friction->value), marks_.load_friction->comment);
  }

  void transmission() {
    table("transmission");
    line(fmt::format("  ratio = \"{}\"", ratio_text()));
    if (transmission_ == "screw") given("lead", answer("lead"));
    if (transmission_ == "belt") given("pulley_circumference", answer("pulley"));
    given("motor_inertia", answer("motor-inertia"));
    if (axis_.screw > 0.0) given("screw_inertia", answer("screw-inertia"));
  }

  std::string ratio_text() const {
    if (transmission_ == "direct") return "1/1";
    const auto text = answer("ratio");
    return text.find('/') == std::string::npos && text.find('.') == std::string::npos ? text + "/1" : text;
  }

  // Drive and motor as one source, which volts or amperes drive.
  void source() {
    table("motor");
    remarks(shaft_ ? "torque-constant" : "force-constant");
    line("  model = \"force\"                       # drive and motor as one source");
    const auto question = shaft_ ? "torque-constant" : "force-constant";
    const auto key = shaft_ ? "torque_constant" : "force_constant";
    if (motor_.per_volt || motor_.ampere_factor == 1.0)
      given(key, answer(question), mark(question));
    else
      value(key, motor_.constant, shaft_ ? "N m/A" : "N/A", of_sheet(question) + " rms");
    const auto limit = motor_.per_volt ? "supply" : "current-limit";
    if (!(motor_.per_volt ? motor_.supply > 0.0 : motor_.current_limit > 0.0)) return;
    table("inverter");
    given("dead_time", "0 us");
    remarks(limit);
    if (motor_.per_volt) return value("voltage_limit", motor_.supply, "V", mark(limit));
    value("current_limit", motor_.current_limit, "A", mark(limit));
    value("voltage_limit", motor_.current_limit, "V", "required, and not used by a source of amperes");
  }

  void motor() {
    if (motor_.source) return source();
    table("motor");
    line("  model = \"synchronous\"");
    const bool between_lines = motor_.line_factor != 1.0;
    const auto winding = [&](const char* name) {
      return between_lines ? fmt::format("half of the sheet's {}, which is between two lines", answer(name)) : "";
    };
    value("phase_resistance", motor_.resistance, "Ohm", winding("resistance"));
    value("phase_inductance", motor_.inductance, "H", winding("inductance"));
    line("  mutual_inductance = \"0 H\"                # contained in the inductance of the sheet");
    const char* per_speed = shaft_ ? "V s/rad" : "V s/m";
    const char* per_ampere = shaft_ ? "N m/A" : "N/A";
    value("emf_constant", motor_.emf, per_speed,
          answer("voltage-constant").empty() || !shaft_ ? "two thirds of the whole motor's constant"
                                                        : of_sheet("voltage-constant"));
    value(shaft_ ? "phase_torque_constant" : "phase_force_constant", motor_.constant / 1.5, per_ampere,
          "two thirds of the whole motor's");
    value(shaft_ ? "torque_constant" : "force_constant", motor_.constant, per_ampere,
          motor_.ampere_factor != 1.0 ? of_sheet(shaft_ ? "torque-constant" : "force-constant") + " rms" : "");
    if (shaft_)
      line(fmt::format("  pole_pairs = {}", answer("pole-pairs")));
    else
      given("pole_pair_pitch", answer("pole-pair-pitch"));
    table("inverter");
    given("dead_time", "125 us", "usual: two ticks");
    remarks("supply");
    value("voltage_limit", motor_.supply, "V", mark("supply"));
    remarks("current-limit");
    value("current_limit", motor_.current_limit, "A",
          mark("current-limit", motor_.ampere_factor != 1.0 ? of_sheet("current-limit") + " rms" : ""));
  }

  void encoder() {
    table("encoder");
    if (transmission_ != "direct") line(fmt::format("  on = \"{}\"", answer("encoder-on")));
    remarks("counts");
    if (answers_.find("increment") == answers_.end())
      entry(fmt::format("counts = {}", answer("counts")), mark("counts"));
    else
      answered("increment", "increment");
  }

  void no_controller() {
    table("controller");
    remark("Nothing is known of the controller. A replay needs its structure and its gains.");
    line("  structure = \"unknown\"");
  }

  void controllers() {
    const auto c = controller_values(motor_, axis_);
    line("\n  # Controllers by rules from the values above, a start for tuning: magnitude and symmetrical optimum.");
    table("position_controller");
    value("gain", c.position_gain, "1/s");
    table("velocity_controller");
    value("gain", c.velocity_gain, rotary_ ? "A s/rad" : "A s/m");
    value("integral_time", c.velocity_time, "s");
    table("current_controller");
    value("gain", c.current_gain, "V/A");
    value("integral_time", c.current_time, "s");
    table("feedforward");
    line("  velocity = 1.0\n  current = 1.0");
  }

  void friction() {
    const auto f = friction_values(answers_, motor_, axis_, marks_.effort);
    table("friction");
    line("  use = \"coulomb_viscous\"");
    table("friction.coulomb_viscous");
    remarks("coulomb");
    value("coulomb", f.coulomb, rotary_ ? "N m" : "N", f.estimated ? "ESTIMATE: " + estimate_text() : mark("coulomb"));
    remarks("viscous");
    value("viscous", f.viscous, rotary_ ? "N m s/rad" : "N s/m",
          f.estimated_viscous
              ? "ESTIMATE: as much as Coulomb friction at the largest speed; stiction identify measures both"
              : mark("viscous"));
  }

  std::string estimate_text() const {
    if (rotary_) {
      const bool known = motor_.per_volt ? motor_.supply > 0.0 : motor_.current_limit > 0.0;
      return fmt::format("{} of the {} largest torque", answer("friction-share"), known ? "motor's" : "log's");
    }
    auto text = fmt::format("{} of weight", answer("guide-coefficient"));
    if (sheet_quantity(answers_, "attraction", "N") > 0.0) text += ", attraction " + answer("attraction");
    if (sheet_quantity(answers_, "preload", "N") > 0.0) text += ", preload " + answer("preload") + " a carriage";
    text += fmt::format("; seals {} on each of {} carriages", answer("seal-drag"), answer("carriages"));
    if (axis_.screw > 0.0) text += "; drag " + answer("drag-torque");
    return text;
  }

  const SheetAnswers& answers_;
  std::string command_;
  const LogMarks& marks_;
  MotorValues motor_;
  AxisValues axis_;
  bool rotary_;
  std::string transmission_;
  bool shaft_;
  bool at_axis_;  // a source whose constant is that at the axis
  std::string text_;
};

}  // namespace

std::string machine_text(const SheetAnswers& answers, const std::string& command, const LogMarks& marks) {
  return Writer(answers, command, marks).text();
}

}  // namespace stiction::host
