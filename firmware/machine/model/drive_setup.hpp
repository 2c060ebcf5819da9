// What a machine file says to the drive's programme alone ([drive]): buses, lines, homing, plausibility. SI units. The
// simulation knows nothing of it.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "firmware/machine/model/motor_setup.hpp"

namespace stiction::machine {

struct CanSetup {
  std::string interface;                // of the network, such as can0 or vcan0
  double bit_rate = 1e6;                // 1/s, arbitration
  std::optional<double> data_bit_rate;  // 1/s, CAN FD; none: classical frames
};

// What is exchanged with it each period; each has those of the one before.
enum class ServerFrames { positions, all, torques };

// Where a motion controller on a CAN bus sends target positions (CiA 402 csp and pp).
struct CanServerSetup {
  std::string interface;                // may be that of CanSetup
  double bit_rate = 1e6;                // 1/s, arbitration
  std::optional<double> data_bit_rate;  // 1/s, CAN FD; none: classical frames
  std::optional<double> period;         // s, of the targets; none: the machine's slow period
  double position_increment = 1e-9;     // m, a unit of 607Ah and 6064h
  bool sync_followed = false;           // the controller sends SYNC, and the drive's clock follows it
  ServerFrames frames = ServerFrames::all;
  double commander_timeout = 0.5;  // s without a frame of the controller that commands; 0: not watched
  int heartbeat_node = 0;          // of the controller; 0: none
  bool motion_allowed = false;     // whether set-points and controlwords are taken
};

// An encoder on a CAN bus (CiA 406) that axes follow (--master can:NODE).
struct MasterEncoderSetup {
  std::string interface;                     // of the network
  double period = 1e-3;                      // s, from one position to the next
  double counts_per_turn = 0.0;              // of a rotary one (6001h); 0: it is none
  std::optional<double> position_increment;  // m, of a linear one
  double range = 4294967296.0;               // counts after which the value begins anew (6002h)
  double delay = 0.0;                        // s, from the measurement to the frame's arrival
};

// A track of the cam switch on the master (PLCopen: MC_DigitalCamSwitch), and the line that it drives.
enum class TrackKind { position, duration };
enum class TrackDirection { both, positive, negative };
struct TrackSetup {
  int line = -1;                                         // of the gpiochip; -1: there is no such track
  bool active_low = false;                               // the line is low while the track is on
  TrackKind kind = TrackKind::position;                  // on to `last`, or for `duration`
  TrackDirection direction = TrackDirection::both;       // of the master, in which it switches on
  double first = 0.0, last = 0.0;                        // cycles, 0 to 1
  double duration = 0.0;                                 // s
  double on_compensation = 0.0, off_compensation = 0.0;  // s, negative is earlier
  double hysteresis = 0.0;                               // cycles
};
struct CamSwitchSetup {
  TrackSetup track1, track2, track3, track4, track5, track6, track7, track8;
};
inline std::array<const TrackSetup*, 8> tracks_of(const CamSwitchSetup& s) {
  return {&s.track1, &s.track2, &s.track3, &s.track4, &s.track5, &s.track6, &s.track7, &s.track8};
}

// Residual vibration of an axis behind a table, measured and cancelled by the drive. Frequency, damping and delay are
// those that `stiction tune-cam` finds.
enum class CamTuningStart { by_hand, by_itself };
struct CamTuningSetup {
  std::optional<std::string> axis;  // none: the first one that is not the master
  int table = 1;                    // of --cam, from 1
  double frequency = 0.0;           // Hz, of the load
  double damping = 0.01;            // its ratio
  double delay = 0.0;               // s, of the load's encoder
  double speed = 0.0;               // of the master, cycles/s; 0: that of --speed
  std::optional<double> amplitude;  // m, the most of a pulse; none: a tenth of the stroke
  double quality_limit = 0.0;       // m, times cycles of the master; 0: not watched
  int steps = 6;                    // tables tried from one start on, at most
  int pause = 50;                   // cycles from one start by itself to the next, at least
  CamTuningStart start = CamTuningStart::by_hand;
};

// Of the chip's inputs, inside the chip.
enum class InputBias { as_is, pull_up, pull_down, none };

struct GpioSetup {
  std::string chip;                     // name or path of the gpiochip
  std::optional<std::string> pwm_chip;  // folder of the kernel's PWM class
  double pwm_period = 62.5e-6;          // s
  double dc_link = 0.0;                 // V between the rails of the half bridges behind the PWM
  InputBias bias = InputBias::as_is;
  int watchdog = -1;               // line of the pulse for a watchdog outside of the computer; -1: not wired
  double watchdog_period = 10e-3;  // s, from one edge of it to the next
};

// Where the drive is a Modbus client: a slow power stage or remote inputs and outputs.
struct ModbusClientSetup {
  std::string device;  // "/dev/ttyS0", or "HOST:PORT" for TCP
  int baud_rate = 115200;
  int unit = 1;
  double period = 10e-3;  // s
};

// What the drive publishes to a PLC or an operator panel.
struct ModbusServerSetup {
  std::string address;                // "HOST:PORT" to listen on, or a serial device for RTU
  int baud_rate = 115200;             // of RTU
  int unit = 1;                       // on RTU
  double commissioning_time = 900.0;  // s for which an operator lets clients write parameters; 0: never
  double commander_timeout = 1.0;     // s without a write of the client that commands; 0: not watched
  bool motion_allowed = false;        // whether commands that move an axis are taken
};

// What the loop does when it begins late.
struct RealTimeSetup {
  int priority = 80;  // of SCHED_FIFO; 0: none
  int cpu = -1;       // the loop's own; -1: any
};

enum class HomingMethod {
  none,
  here,
  limit_negative,
  limit_positive,
  home_positive,
  home_negative,
  index_negative,
  index_positive
};

// CiA 402 methods 35, 17, 18, 19, 21, 33, 34.
struct HomingSetup {
  HomingMethod method = HomingMethod::none;
  double search_speed = 0.02;  // m/s
  double creep_speed = 0.002;  // m/s, away from the switch or to the index
  double offset = 0.0;         // m, the position of the mark
};

// Option codes of CiA 402: 605Ah to 605Eh and 6007h.
struct StopSetup {
  std::int8_t quick_stop = 2, shutdown = 1, disable_operation = 1, halt = 1, fault_reaction = 2, commander_lost = 1;
};

// Which level of a line says yes.
enum class ActiveLevel { high, low };

// Lines of the gpiochip; -1: not wired.
struct LineSetup {
  int enable = -1, brake = -1, fault = -1;
  int limit_negative = -1, limit_positive = -1, home = -1, index = -1;
  int torque_off_a = -1, torque_off_b = -1;
  int hall_a = -1, hall_b = -1, hall_c = -1;
  int quadrature_a = -1, quadrature_b = -1;
  double quadrature_increment = 0.0;  // m an edge
  double quadrature_rate = 10e3;      // edges a second of both tracks, that the machine's kernel was measured to hold
  double quadrature_settle = 50e-6;   // s, by which an edge may come late out of its interrupt
  int pwm_channel = -1;               // the first of the motor's
  ActiveLevel enable_active = ActiveLevel::high, brake_active = ActiveLevel::high, fault_active = ActiveLevel::high;
  ActiveLevel limit_active = ActiveLevel::high, home_active = ActiveLevel::high, index_active = ActiveLevel::high;
  ActiveLevel torque_off_active = ActiveLevel::high, hall_active = ActiveLevel::high;
};

// Of an axis in the modes of cam and gear.
struct CamAxisSetup {
  double superposed_share = 0.1;  // of what the axis keeps, for a move or a second cam on top of what it follows
};

struct DriveAxisSetup {
  int node = 0;                                      // of the axis' power stage and encoder on the bus; 0: none
  int server_node = 0;                               // of the axis where [drive.can_server] serves it; 0: none
  double quick_stop_deceleration = 10.0;             // m/s^2
  std::optional<double> slow_down_deceleration;      // m/s^2; none: quick_stop_deceleration
  double brake_time = 0.0;                           // s, that the brake takes to open or to close
  double frozen_distance = 100e-6;                   // m
  std::optional<double> encoder_jump;                // m; none: what the motor's force can make of it, at least 5 um
  std::optional<double> current_sum;                 // A; none: a twentieth of the current limit
  std::optional<double> runaway_current;             // A; none: a fifth of the current limit
  double following_error_timeout = 0.0;              // s, 6066h
  std::optional<double> max_motor_speed;             // m/s, 6080h, in cst; none: max_velocity
  std::optional<double> torque_slope;                // A/s, 6087h, in cst; none: the current limit in 10 ms
  double target_window = 10e-6;                      // m, about a target, within which it is reached
  double profile_jerk_time = 16e-3;                  // s, by which a profile's acceleration comes and goes
  std::optional<double> negative_end, positive_end;  // m, of the travel, before the switches; none: half the travel
  HomingSetup homing;
  StopSetup stops;
  LineSetup line;
  CommutationSetup commutation;
  BrakeTestSetup brake_test;
  ProtectionSetup protection;
  CamAxisSetup cam;
};

struct DriveSetup {
  std::optional<CanSetup> can;
  std::optional<CanServerSetup> can_server;
  std::optional<MasterEncoderSetup> master_encoder;
  std::optional<GpioSetup> gpio;
  std::optional<ModbusClientSetup> modbus_client;
  std::optional<ModbusServerSetup> modbus_server;
  RealTimeSetup real_time;
  CamSwitchSetup cam_switch;
  std::optional<CamTuningSetup> cam_tuning;
  std::map<std::string, DriveAxisSetup> axes;  // of every axis of the machine, by name
};

}  // namespace stiction::machine
