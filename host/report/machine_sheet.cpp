// A machine's parameters as a report prints them: see machine_sheet.hpp.
#include "host/report/machine_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string_view>

namespace stiction::host {
namespace {

using sim::Axis;

// Six digits show every figure of a machine file and no digit of a conversion.
std::string number(double value) { return fmt::format("{:.6g}", value); }

// The unit a report prints for an SI unit of the friction models' parameters, and what one SI unit makes of it.
struct Engineering {
  std::string_view unit;
  double factor;
};

Engineering engineering(std::string_view si) {
  if (si == "1") return {"", 1.0};
  if (si == "m") return {"µm", 1e6};
  if (si == "s") return {"ms", 1e3};
  if (si == "m/s") return {"mm/s", 1e3};
  if (si == "N/m") return {"N/µm", 1e-6};
  return {si, 1.0};
}

using Value = std::function<std::optional<double>(const Axis&)>;
using Text = std::function<std::string(const Axis&)>;  // empty: the axis does not have it

class Sheet {
 public:
  explicit Sheet(const sim::Machine& machine) : machine_(machine) {}

  Sheet& section(std::string title) {
    sections_.push_back({std::move(title), {}});
    return *this;
  }

  Sheet& text(std::string label, const Text& value) { return add(std::move(label), "", value); }

  // `scale`: what one SI unit is in `unit`.
  Sheet& quantity(std::string label, std::string unit, double scale, const Value& value) {
    return add(std::move(label), std::move(unit), [&](const Axis& axis) {
      const auto given = value(axis);
      return given ? number(*given * scale) : std::string();
    });
  }

  Sheet& add(std::string label, std::string unit, const Text& value) {
    SheetRow row{std::move(label), std::move(unit), {}};
    for (const auto& axis : machine_.axes) row.values.push_back(value(axis));
    const bool given = std::any_of(row.values.begin(), row.values.end(), [](const auto& v) { return !v.empty(); });
    if (given) sections_.back().rows.push_back(std::move(row));
    return *this;
  }

  std::vector<SheetSection> take() {
    std::erase_if(sections_, [](const auto& section) { return section.rows.empty(); });
    return std::move(sections_);
  }

 private:
  const sim::Machine& machine_;
  std::vector<SheetSection> sections_;
};

bool is_force(const Axis& axis) { return axis.motor.model == sim::MotorModel::force; }

std::optional<double> unless_force(const Axis& axis, double value) {
  return is_force(axis) ? std::nullopt : std::optional(value);
}

// A unit that depends on the motor: one row for each kind, of which an axis fills one.
Sheet& by_motor(Sheet& sheet, const std::string& label, const std::string& current_unit, const std::string& force_unit,
                const std::function<double(const Axis&)>& value) {
  sheet.quantity(label, current_unit, 1.0, [&](const Axis& a) { return unless_force(a, value(a)); });
  return sheet.quantity(label, force_unit, 1.0,
                        [&](const Axis& a) { return is_force(a) ? std::optional(value(a)) : std::nullopt; });
}

void add_drive(Sheet& sheet) {
  sheet.section("Mechanics")
      .quantity("moving mass", "kg", 1.0, [](const Axis& a) { return a.mass; })
      .quantity("travel", "mm", 1e3, [](const Axis& a) { return a.travel; })
      .quantity("largest velocity", "m/min", 60.0, [](const Axis& a) { return a.max_velocity; })
      .quantity("largest acceleration", "m/s²", 1.0, [](const Axis& a) { return a.max_acceleration; });
  sheet.section("Motor").text("model", [](const Axis& a) { return motor_model_text(a.motor.model); });
  by_motor(sheet, "force constant", "N/A", "N/V", [](const Axis& a) { return a.motor.force_constant; });
  sheet
      .quantity("force constant, one winding", "N/A", 1.0,
                [](const Axis& a) { return unless_force(a, a.motor.phase_force_constant); })
      .quantity("EMF constant, one winding", "V s/m", 1.0,
                [](const Axis& a) { return unless_force(a, a.motor.emf_constant); })
      .quantity("phase resistance", "Ω", 1.0, [](const Axis& a) { return unless_force(a, a.motor.phase_resistance); })
      .quantity("phase inductance", "mH", 1e3, [](const Axis& a) { return unless_force(a, a.motor.phase_inductance); })
      .quantity("mutual inductance", "mH", 1e3,
                [](const Axis& a) { return unless_force(a, a.motor.mutual_inductance); })
      .quantity("pole-pair pitch", "mm", 1e3, [](const Axis& a) { return unless_force(a, a.motor.pole_pair_pitch); })
      .quantity("motors in parallel", "", 1.0, [](const Axis& a) { return static_cast<double>(a.motor.count); });
  sheet.section("Inverter")
      .quantity("dead time", "µs", 1e6, [](const Axis& a) { return a.inverter.dead_time; })
      .quantity("voltage limit", "V", 1.0, [](const Axis& a) { return a.inverter.voltage_limit; })
      .quantity("current limit, one motor", "A", 1.0,
                [](const Axis& a) { return unless_force(a, a.inverter.current_limit); });
  sheet.section("Encoder")
      .text("increment",
            [](const Axis& a) {
              return a.encoder.increment > 0.0 ? number(a.encoder.increment * 1e9) + " nm" : "continuous";
            })
      .quantity("noise, rms", "nm", 1e9, [](const Axis& a) { return a.encoder.noise; })
      .text("velocity feedback", [](const Axis& a) { return velocity_source_text(a.encoder.velocity); });
  const auto mount = [](double sim::EncoderMount::*member) {
    return
        [member](const Axis& a) { return a.encoder.mount ? std::optional((*a.encoder.mount).*member) : std::nullopt; };
  };
  sheet.text("mount", [](const Axis& a) { return a.encoder.mount ? "elastic" : "rigid"; })
      .quantity("mount: mass", "kg", 1.0, mount(&sim::EncoderMount::mass))
      .quantity("mount: natural frequency", "Hz", 1.0, mount(&sim::EncoderMount::natural_frequency))
      .quantity("mount: damping ratio", "", 1.0, mount(&sim::EncoderMount::damping_ratio));
}

void add_control(Sheet& sheet) {
  sheet.section("Position controller")
      .quantity("gain K_v", "1/s", 1.0, [](const Axis& a) { return a.position_controller.gain; })
      .quantity("gain K_v", "(m/min)/mm", 0.06, [](const Axis& a) { return a.position_controller.gain; })
      .text("increment of the error", [](const Axis& a) {
        const double increment = a.position_controller.increment;
        return increment > 0.0 ? number(increment * 1e6) + " µm" : "none";
      });
  sheet.section("Velocity controller");
  by_motor(sheet, "gain", "A s/m", "V s/m", [](const Axis& a) { return a.velocity_controller.gain; });
  sheet.text("integral time", [](const Axis& a) {
    const auto time = a.velocity_controller.integral_time;
    return time ? number(*time * 1e3) + " ms" : "none";
  });
  const auto notch = [](double sim::Notch::*member) {
    return [member](const Axis& a) { return a.notch ? std::optional((*a.notch).*member) : std::nullopt; };
  };
  sheet.section("Notch filter of the current set-point")
      .text("filter", [](const Axis& a) { return a.notch ? "on" : "none"; })
      .quantity("frequency", "Hz", 1.0, notch(&sim::Notch::frequency))
      .quantity("damping, numerator", "", 1.0, notch(&sim::Notch::numerator_damping))
      .quantity("damping, denominator", "", 1.0, notch(&sim::Notch::denominator_damping));
  const auto current = [](const Axis& a) { return a.current_controller; };
  sheet.section("Current controller")
      .quantity("gain", "V/A", 1.0,
                [&](const Axis& a) { return current(a) ? std::optional(current(a)->gain) : std::nullopt; })
      .quantity("integral time", "ms", 1e3,
                [&](const Axis& a) { return current(a) ? current(a)->integral_time : std::nullopt; });
  sheet.section("Feedforward")
      .quantity("velocity K_wv", "%", 100.0, [](const Axis& a) { return a.feedforward.velocity; })
      .quantity("current K_wi", "%", 100.0, [](const Axis& a) { return a.feedforward.current; });
  const auto limit = [](const std::optional<double>& given, double scale, const std::string& unit,
                        const std::string& otherwise) {
    return given ? number(*given * scale) + " " + unit : otherwise;
  };
  sheet.section("Supervision (faults)")
      .text("following error",
            [&](const Axis& a) { return limit(a.supervision.following_error, 1e3, "mm", "2 mm (default)"); })
      .text("over-current, whole axis",
            [&](const Axis& a) { return limit(a.supervision.over_current, 1.0, "A", "1.2 × limit (default)"); })
      .text("over-speed",
            [&](const Axis& a) { return limit(a.supervision.over_speed, 60.0, "m/min", "1.2 × largest (default)"); });
}

template <class Parameters>
std::optional<std::string> parameter_text(const sim::Parameter<Parameters>& parameter, const Parameters& values) {
  const double factor = engineering(parameter.unit).factor;
  return std::visit(
      [&]<class M>(M Parameters::*member) -> std::optional<std::string> {
        if constexpr (std::is_same_v<M, std::vector<double>>) {
          std::string list;
          for (const double value : values.*member) list += (list.empty() ? "" : ", ") + number(value * factor);
          return list;
        } else if constexpr (std::is_same_v<M, std::optional<double>>) {
          return values.*member ? std::optional(number(*(values.*member) * factor)) : std::nullopt;
        } else {
          return number(static_cast<double>(values.*member) * factor);
        }
      },
      parameter.member);
}

void add_friction(Sheet& sheet) {
  sheet.section("Friction").text("acting model", [](const Axis& a) { return a.friction.use; });
  sim::for_each_friction_model([&]<class Model>() {
    using Parameters = typename Model::Parameters;
    sheet.section("Friction: " + std::string(Model::label));
    for (const auto& parameter : Model::parameters)
      sheet.add(std::string(parameter.text), std::string(engineering(parameter.unit).unit), [&](const Axis& axis) {
        const auto given = axis.friction.models.find(std::string(Model::name));
        if (given == axis.friction.models.end()) return std::string();
        return parameter_text<Parameters>(parameter, std::get<Parameters>(given->second)).value_or("");
      });
  });
}

}  // namespace

std::string motor_model_text(sim::MotorModel model) {
  switch (model) {
    case sim::MotorModel::synchronous:
      return "synchronous, three phases";
    case sim::MotorModel::dc:
      return "DC equivalent";
    case sim::MotorModel::force:
      return "ideal force source";
  }
  return "?";
}

std::string velocity_source_text(sim::VelocitySource source) {
  switch (source) {
    case sim::VelocitySource::ideal:
      return "ideal";
    case sim::VelocitySource::estimated:
      return "estimated";
    case sim::VelocitySource::mean_difference:
      return "mean difference";
  }
  return "?";
}

std::vector<SheetSection> machine_sheet(const sim::Machine& machine) {
  Sheet sheet(machine);
  add_drive(sheet);
  add_control(sheet);
  add_friction(sheet);
  return sheet.take();
}

}  // namespace stiction::host
