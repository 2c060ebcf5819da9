#include "firmware/stictiond/fault_page.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>

#include "stiction/drive/faults.hpp"

namespace stiction::drive {
namespace {

constexpr std::array<std::string_view, 5> detectors{"axis", "supervision", "bus", "programme", "protection"};
constexpr std::array<std::string_view, 3> reactions{"power off in the same tick", "controlled stop, then power off",
                                                    "nothing is enabled"};

// The test that injects the fault: those of motor and power stage have tests of their own, all others one for the
// table.
const char* injection(const FaultDescription& row) {
  switch (row.fault) {
    case Fault::commutation_not_found:
      return "CommutationOf.AJammedAxis*, Commutation.NoHallSignal*";
    case Fault::commutation_offset:
      return "CommutationOf.AWrongStoredOffset*";
    case Fault::motor_overload:
    case Fault::stage_overload:
      return "I2t.*";
    case Fault::torque_off_channels:
      return "SafeTorqueOff.*";
    case Fault::brake_slips:
      return "BrakeTest.*";
    default:
      return row.detector == Detector::protection ? "ProtectionOf.*" : "FaultOfTheTable.*";
  }
}

std::string detection(const FaultDescription& row, std::int64_t period_ns) {
  if (row.detection_ticks == 0) return "depends on the signal";
  return fmt::format("{} tick{}, {:g} µs", row.detection_ticks, row.detection_ticks == 1 ? "" : "s",
                     static_cast<double>(row.detection_ticks * period_ns) * 1e-3);
}

// As a cell of a table, in which a bar would begin the next one.
std::string cell(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

}  // namespace

std::string fault_page(std::int64_t period_ns) {
  std::string page =
      "# Faults of the drive\n\nNumbers are stable: logs, buses and the Modbus registers carry them. A fault is "
      "latched; "
      "a reset is accepted only after its cause has gone, and the axis must then be enabled again. The other axes of a "
      "machine make a controlled stop. A second fault during a controlled stop switches the power off at once. "
      "Detection times count in ticks of the fast loop from the first sample that violates the condition. 603Fh is the "
      "error code of CiA 402; codes from FF00h are the manufacturer's, FF00h plus the number. A fault that loses the "
      "reference leaves an axis that has to be homed before it takes an absolute target. A controlled stop is made as "
      "`drive.axis.NAME.stops.fault_reaction` says (605Eh).\n\n"
      "| number | 603Fh | fault | condition | seen by | within | reaction | reference | injected by |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
  for (const auto& row : fault_table)
    page += fmt::format(
        "| {} | {:04X}h | {} | {} | {} | {} | {} | {} | `{}` |\n", static_cast<int>(row.fault), row.error_code,
        row.name, cell(row.condition), detectors[static_cast<std::size_t>(row.detector)], detection(row, period_ns),
        reactions[static_cast<std::size_t>(row.reaction)], row.loses_reference ? "lost" : "kept", injection(row));
  return page;
}

}  // namespace stiction::drive
