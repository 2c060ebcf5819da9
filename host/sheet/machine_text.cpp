#include "host/sheet/machine_text.hpp"

#include <fmt/format.h>

#include <string_view>
#include <vector>

#include "host/sheet/drive_values.hpp"

namespace stiction::host {
namespace {

class Writer {
 public:
  Writer(const SheetAnswers& answers, std::string command)
      : answers_(answers),
        command_(std::move(command)),
        motor_(motor_values(answers)),
        axis_(axis_values(answers, motor_)),
        rotary_(answer_to(answers, "kind") == "rotary"),
        transmission_(answer_to(answers, "transmission")),
        shaft_(rotary_ || transmission_ != "direct") {}

  std::string text() {
    head();
    axis_table();
    if (shaft_) transmission();
    motor();
    encoder();
    controllers();
    friction();
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
    const auto entry = fmt::format("{} = \"{}\"", key, quantity);
    line(comment.empty() ? "  " + entry : fmt::format("  {:<42} # {}", entry, comment));
  }
  std::string answer(std::string_view name) const { return answer_to(answers_, name); }
  std::string of_sheet(std::string_view name) const { return fmt::format("of the sheet's {}", answer(name)); }

  void head() {
    line("# Made by: " + command_);
    line("# Values without a comment are those of the data sheets. Currents are amplitudes, windings single ones.");
    line("schema = \"stiction.machine/1\"");
    line(fmt::format("name = \"{}\"", answer("name")));
    line("\n[timing]\nfast_period = \"62.5 us\"\nslow_period = \"1 ms\"");
  }

  void axis_table() {
    line(fmt::format("\n[axis.{}]", answer("axis")));
    if (rotary_) line("  kind = \"rotary\"");
    const auto whole = fmt::format("the load alone; the whole is {:.6g} {}", axis_.mass, rotary_ ? "kg m^2" : "kg");
    given(rotary_ ? "inertia" : "mass", answer("load"), shaft_ ? whole : "");
    given("travel", answer("travel"));
    given("max_velocity", answer("max-velocity"));
    given("max_acceleration", answer("max-acceleration"));
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

  void motor() {
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
    value("voltage_limit", motor_.supply, "V");
    value("current_limit", motor_.current_limit, "A",
          motor_.ampere_factor != 1.0 ? of_sheet("current-limit") + " rms" : "");
  }

  void encoder() {
    table("encoder");
    if (transmission_ != "direct") line(fmt::format("  on = \"{}\"", answer("encoder-on")));
    if (answers_.find("increment") == answers_.end())
      line(fmt::format("  counts = {}", answer("counts")));
    else
      given("increment", answer("increment"));
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
    const auto f = friction_values(answers_, motor_, axis_);
    table("friction");
    line("  use = \"coulomb_viscous\"");
    table("friction.coulomb_viscous");
    value("coulomb", f.coulomb, rotary_ ? "N m" : "N", f.estimated ? "ESTIMATE: " + estimate_text() : "");
    value("viscous", f.viscous, rotary_ ? "N m s/rad" : "N s/m",
          "ESTIMATE: as much as Coulomb friction at the largest speed; stiction identify measures both");
  }

  std::string estimate_text() const {
    if (rotary_) return fmt::format("{} of the motor's largest torque", answer("friction-share"));
    auto text = fmt::format("{} of weight", answer("guide-coefficient"));
    if (sheet_quantity(answers_, "attraction", "N") > 0.0) text += ", attraction " + answer("attraction");
    if (sheet_quantity(answers_, "preload", "N") > 0.0) text += ", preload " + answer("preload") + " a carriage";
    text += fmt::format("; seals {} on each of {} carriages", answer("seal-drag"), answer("carriages"));
    if (axis_.screw > 0.0) text += "; drag " + answer("drag-torque");
    return text;
  }

  const SheetAnswers& answers_;
  std::string command_;
  MotorValues motor_;
  AxisValues axis_;
  bool rotary_;
  std::string transmission_;
  bool shaft_;
  std::string text_;
};

}  // namespace

std::string machine_text(const SheetAnswers& answers, const std::string& command) {
  return Writer(answers, command).text();
}

}  // namespace stiction::host
