// What a machine file says to the drive about a motor and its power stage: how it is commutated, how its brake is
// tested, and what protects both ([drive.axis.NAME.commutation], .brake_test, .protection). SI units.
#pragma once

#include <optional>

namespace stiction::machine {

// Where the electrical angle at the encoder's zero comes from.
enum class CommutationSource { encoder_zero, stored, test, hall };

struct CommutationSetup {
  CommutationSource method = CommutationSource::encoder_zero;
  double offset = 0.0;                  // rad, electrical: at the encoder's zero, or where Hall signal A rises
  bool checked = true;                  // a stored offset, by the test at the first enabling
  double tolerance = 0.2617993877991;   // rad, electrical, by which two ways of knowing may differ: 15 degrees
  std::optional<double> index_offset;   // rad, electrical, at the encoder's index mark
  std::optional<double> test_current;   // A; none: half of the current limit
  std::optional<double> test_response;  // m, amplitude of the vibration; none: a 4000th of a pole pair, 4 increments
  std::optional<double> test_way;       // m; none: a fiftieth of a pole pair, at least 16 times the response
};

struct BrakeTestSetup {
  double current = 0.0;  // A, amplitude; 0: no test
  double way = 100e-6;   // m, that the brake may yield
  double time = 0.1;     // s, in which the current comes, is held, and goes, each
};

struct ProtectionSetup {
  std::optional<double> motor_current, stage_current;              // A, continuous, amplitude; none: no thermal model
  double motor_time_constant = 600.0, stage_time_constant = 10.0;  // s
  std::optional<double> dc_link_high, dc_link_low;                 // V; none: not watched
  std::optional<double> motor_temperature, stage_temperature;      // K; none: not watched
  bool torque_off = false;                                         // safe torque off is wired
};

}  // namespace stiction::machine
