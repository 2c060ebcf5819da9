#include "host/tune/tuned_machine.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "firmware/machine/file/compensation_parameters.hpp"
#include "firmware/machine/file/edited_machine.hpp"

namespace stiction::host {
namespace {

using Path = std::vector<std::string>;

class Edits {
 public:
  explicit Edits(Path at) : at_(std::move(at)) {}

  void quantity(const Path& key, double value, const std::string& unit) {
    if (unit == "1")
      add(key, value);
    else
      add(key, machine::written_quantity(value, unit));
  }
  void quantities(const Path& key, const std::vector<double>& values, const std::string& unit) {
    std::vector<std::string> written;
    for (const double value : values) written.push_back(machine::written_quantity(value, unit));
    add(key, written);
  }
  void text(const Path& key, std::string value) { add(key, std::move(value)); }
  void remove(const Path& key) { add(key, std::monostate{}); }
  const std::vector<machine::MachineEdit>& list() const { return list_; }

 private:
  void add(const Path& key, decltype(machine::MachineEdit::value) value) {
    auto path = at_;
    path.insert(path.end(), key.begin(), key.end());
    list_.push_back({std::move(path), std::move(value)});
  }
  Path at_;
  std::vector<machine::MachineEdit> list_;
};

// Every key that the machine file's tables describe (firmware/machine/file/compensation_parameters.hpp). `force_motor`:
// the motor of the axis is a force source, for which some keys have another unit.
template <class T>
void write(Edits& edits, const std::string& table, const T& values, bool force_motor) {
  for (const auto& parameter : machine::Table<T>::parameters) {
    const Path key{table, std::string(parameter.key)};
    std::visit(
        [&](auto member) {
          const auto& value = values.*member;
          using Value = std::decay_t<decltype(value)>;
          const std::string unit(force_motor && !parameter.unit_of_force_motor.empty() ? parameter.unit_of_force_motor
                                                                                       : parameter.unit);
          if constexpr (std::is_same_v<Value, std::vector<double>>)
            edits.quantities(key, value, unit);
          else if constexpr (std::is_same_v<Value, std::optional<double>>) {
            if (value) edits.quantity(key, *value, unit);
          } else
            edits.quantity(key, value, unit);
        },
        parameter.member);
  }
}

}  // namespace

std::string tuned_machine(const std::filesystem::path& file, const std::vector<std::string>& set,
                          const TunedCompensations& all, const std::vector<std::string>& logs,
                          const std::string& command) {
  std::vector<std::string> comment{fmt::format("Friction compensation tuned from {}", fmt::join(logs, ", ")),
                                   fmt::format("by {}", command),
                                   fmt::format("on the machine file {}", file.filename().string())};
  std::vector<machine::MachineEdit> edits{
      {{"timing", "set_point_delay"}, machine::written_quantity(all.machine.timing.set_point_delay, "s")}};
  for (const auto& [k, tuning] : all.tuned) {
    const auto& axis = all.machine.axes[k];
    const auto& compensation = *axis.friction_compensation;
    const bool force_motor = axis.motor.driven_by_volts();
    Edits own({"axis", axis.name, "friction_compensation"});
    own.remove({});  // what stood there was another tuning's
    own.text({"use"}, name_of(compensation.use));
    write(own, "friction", *compensation.friction, force_motor);
    write(own, "learning", *compensation.learning, force_motor);
    if (compensation.pulse) write(own, "pulse", *compensation.pulse, force_motor);
    edits.insert(edits.end(), own.list().begin(), own.list().end());
  }
  return machine::edited_machine(file, set, edits, comment);
}

}  // namespace stiction::host
