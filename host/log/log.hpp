// A measured or simulated log in memory: uniform samples, SI units, one record of channels an axis. Readers fill it
// from the files of docs/formats.md; everything that judges data works on it. A record with gaps is several of these,
// one a stretch.
#pragma once

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace stiction::host {

// A log that cannot be used. what() is "FILE:LINE: what was found; what was expected" (without the line where the
// format has none).
class LogError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The channels of one axis; each as long as the log's time, or empty when the log does not have it.
struct AxisLog {
  std::string axis;                    // "X"; empty in a log without prefixes
  std::vector<double> x_set;           // m
  std::vector<double> v_set;           // m/s
  std::vector<double> a_set;           // m/s^2
  std::vector<double> x;               // m, measured; always there
  std::vector<double> v;               // m/s
  std::vector<double> i;               // A, amplitude
  std::vector<double> i_set;           // A
  std::vector<double> force;           // N, of the motor
  std::vector<double> u;               // V, drive voltage
  std::vector<double> temperature;     // degC
  std::vector<double> external_force;  // N, on the carriage, positive in +x
  std::vector<double> i_inject;        // A, test signal, contained in i
  std::vector<double> u_inject;        // V, test signal, contained in u
  std::vector<double> x_load;          // m, of the second encoder
  std::vector<double> supply;          // V, of the inverter
  std::vector<double> motor_torque;    // N m, at the motor, before the transmission
  std::vector<double> master;          // rad, of the axis that this one follows
  std::vector<double> master_speed;    // rad/s
  std::vector<double> table;           // number of the cam table, a whole number
  std::vector<double> fault;           // number of the drive's fault, a whole number
  // Of an endless axis in a simulated log: the part of a turn beyond whole ones. It is written and not read, and is no
  // channel: between two samples there is nothing to interpolate.
  std::vector<std::uint32_t> phase;  // 2^-32 turns
  double turn = 0.0;                 // deg of a rotary axis, else mm: what the column shows for a whole turn
  // A rotary axis has rad, rad/s, rad/s^2 and N m in place of m, m/s, m/s^2 and N.
  bool rotary = false;
  // Samples that no fit may use: a channel stands at its limit, a cell was blank. Empty: none.
  std::vector<bool> left_out;
  // Of each of log_channels the increment that it was written with, before any sample was interpolated, in its unit; 0:
  // none found (resolution.hpp). Empty: not from a reader.
  std::vector<double> increments;
};

// The one list of an axis' channels: the column's name, the unit of the values, and where they are kept. `name` and
// `unit` are those of a linear axis; a rotary one has `rotary_name` and `rotary_unit` (null: it has no such channel).
struct LogChannel {
  const char* name;
  const char* unit;
  std::vector<double> AxisLog::*values;
  const char* text;
  const char* rotary_name;
  const char* rotary_unit;
  bool shared = false;  // may stand without prefix beside prefixed channels, for all axes
  bool whole = false;   // its values are whole numbers
};
inline constexpr std::array<LogChannel, 20> log_channels{{
    {"x_set", "m", &AxisLog::x_set, "set position", "x_set", "rad"},
    {"v_set", "m/s", &AxisLog::v_set, "set velocity", "v_set", "rad/s"},
    {"a_set", "m/s^2", &AxisLog::a_set, "set acceleration", "a_set", "rad/s^2"},
    {"x", "m", &AxisLog::x, "measured position", "x", "rad"},
    {"v", "m/s", &AxisLog::v, "measured velocity", "v", "rad/s"},
    {"i", "A", &AxisLog::i, "motor current, amplitude", "i", "A"},
    {"i_set", "A", &AxisLog::i_set, "set current", "i_set", "A"},
    {"F", "N", &AxisLog::force, "motor force", "T", "N m"},
    {"u", "V", &AxisLog::u, "drive voltage", "u", "V"},
    {"temperature", "degC", &AxisLog::temperature, "temperature", "temperature", "degC", true},
    {"F_ext", "N", &AxisLog::external_force, "external force", "T_ext", "N m"},
    {"i_inject", "A", &AxisLog::i_inject, "test signal on the current", "i_inject", "A"},
    {"u_inject", "V", &AxisLog::u_inject, "test signal on the voltage", "u_inject", "V"},
    {"x_load", "m", &AxisLog::x_load, "position of the second encoder", "x_load", "rad"},
    {"supply", "V", &AxisLog::supply, "supply voltage of the inverter", "supply", "V", true},
    {"T_motor", "N m", &AxisLog::motor_torque, "torque at the motor", "T_motor", "N m"},
    {"master", "rad", &AxisLog::master, "position of the master", "master", "rad", true},
    {"master_speed", "rad/s", &AxisLog::master_speed, "speed of the master", "master_speed", "rad/s", true},
    {"table", "1", &AxisLog::table, "number of the cam table", "table", "1", true, true},
    {"fault", "1", &AxisLog::fault, "number of the fault", "fault", "1", true, true},
}};

// The clock of a record as it was written, before its samples were made even.
struct Clock {
  double jitter = 0.0;     // s, rms deviation of the stamps from even ones, beyond what their digits explain
  bool resampled = false;  // the samples are interpolated
  std::size_t stretch = 0, stretches = 1;  // which part of the record this log is, and of how many
};

struct Log {
  std::string source;                                         // the file's name, for messages
  std::vector<std::pair<std::string, std::string>> comments;  // "# key: value"
  std::vector<double> t;                                      // s, uniform
  double period = 0.0;                                        // s, the mean step of t
  Clock clock;
  std::vector<AxisLog> axes;         // at least one
  std::vector<std::string> ignored;  // headers of columns that have no meaning here
  std::vector<std::string> notes;    // sentences on what the reading step made of the record
  std::vector<Log> others;           // the other stretches of the record, in its order; empty in each of them
};

}  // namespace stiction::host
