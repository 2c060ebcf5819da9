// What one record says of its axis: mass, constant force, Coulomb and viscous friction with standard errors, by the
// identification of that record alone.
#pragma once

#include <array>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/machine/model/machine.hpp"

namespace stiction::host {

// What a month changes of an axis; also the order of all arrays below.
enum class FleetCause : std::uint8_t { mass, constant_force, coulomb, viscous };
inline constexpr std::size_t fleet_causes = 4;

// A cause's name in files: "mass", "constant_force", "coulomb", "viscous".
std::string_view cause_name(FleetCause cause);
// And for readers: "Coulomb friction".
std::string_view cause_words(FleetCause cause);
// The unit of its parameter, of `axis`: "kg", or "kg m^2" of a rotary one.
std::string cause_unit(FleetCause cause, const machine::AxisModel& axis);

struct CauseEstimate {
  double value = std::numeric_limits<double>::quiet_NaN();  // in cause_unit(); NaN: the record does not determine it
  double error = std::numeric_limits<double>::quiet_NaN();  // its standard error within the record
};

struct RecordEstimate {
  std::array<CauseEstimate, fleet_causes> causes;
  std::string message;  // why the record could not be judged; empty: it was

  bool judged() const { return message.empty(); }
};

// The estimates of the record in `log` for the axis `axis` (index) of `machine`. What makes a record unfit is its
// message: a log that cannot be read or identified, one of a different machine, one without motion.
RecordEstimate estimate_record(const machine::Machine& machine, std::size_t axis, const std::filesystem::path& log);

// Names of the effects that a full diagnosis of the record finds, with the part of the residual force that each
// explains: "coulomb_mismatch 0.92". `machine`, `axis` and `log` as above. Throws LogError.
std::vector<std::string> diagnose_record(const machine::Machine& machine, std::size_t axis,
                                         const std::filesystem::path& log);

}  // namespace stiction::host
