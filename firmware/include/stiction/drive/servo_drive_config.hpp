// What one axis as a drive (servo_drive.hpp) is configured with, what is asked of it in a tick, and what it tells of a
// fault.
#pragma once

#include <array>
#include <cstdint>

#include "stiction/drive/axis.hpp"
#include "stiction/drive/brake_test.hpp"
#include "stiction/drive/commutation_search.hpp"
#include "stiction/drive/homing.hpp"
#include "stiction/drive/protection.hpp"
#include "stiction/drive/state_machine.hpp"
#include "stiction/drive/stop_options.hpp"
#include "stiction/drive/supervision.hpp"
#include "stiction/motion/velocity_ramp.hpp"

namespace stiction {

template <class S>
struct ServoDriveConfig {
  StopCodes stops{};
  typename VelocityRamp<S>::Config ramp{};  // of quick stops and of homing
  typename S::Velocity slow_down{};         // change of the speed in a tick of the slow-down ramp; at most that of ramp
  typename S::Velocity most_change{};       // of the set speed in a tick, offset and all; at least that of ramp
  SupervisionConfig<S> supervision{};
  HomingConfig<S> homing{};
  typename S::Velocity standstill_speed{};  // of the measured speed, below which a stop is over
  // Way in self_test_ticks, up to which an axis is at rest and may be enabled. Not by a speed: 50 nm of noise are 1
  // mm/s in a tick, and a coarse encoder stands still for most ticks.
  typename S::Position standstill_way{};
  // 6065h and 6066h: the following error that is a fault when it has been exceeded for more than so many ticks; 0: not
  // watched. That fault ends in a stop by 605Eh, as the encoder is trusted; the limit of the cascade, AxisConfig::
  // following_error_fault, is for what no stop can end and is to be larger.
  typename S::Distance following_error{};
  std::uint32_t following_error_ticks = 0;
  std::uint32_t stop_margin_ticks = 1600;  // 100 ms at 62.5 us
  std::uint32_t brake_ticks = 0;           // that the brake takes to open or to close; 0: none
  CommutationConfig<S> commutation{};
  BrakeTestConfig<S> brake_test{};
  ProtectionConfig<S> protection{};  // for who runs it beside the drive, as hal/drive_loop.hpp does
};

// What is asked of an axis in a tick.
template <class S>
struct DriveDemand {
  std::uint16_t controlword = 0;
  OperationMode mode = OperationMode::cyclic_position;
  SetPoint<S> set_point{};                 // csp and pp, of the machine's coordinates
  typename S::Velocity velocity_offset{};  // 60B1h, added to the set speed while the drive follows
  std::array<Fault, 4> causes{};           // what programme, clock, backend and protection see in this tick
  bool brake = false;                      // to standstill under power, whatever set_point says
  bool quick_stop = false;                 // another axis has a fault
  bool along = false;                      // a stop by a word may follow set_point to standstill in place of a ramp
  bool torque_off = false;                 // a channel of safe torque off is open: nothing is enabled
};

// A fault as it was seen. `following`: it came on top of another one, or during its stop.
template <class S>
struct DriveEvent {
  Fault fault = Fault::none;
  bool following = false;
  std::int64_t time_ns = 0;
  typename S::Position position{};  // measured, the machine's coordinates
  typename S::Velocity set_velocity{};
};

}  // namespace stiction
