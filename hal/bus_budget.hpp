// What a bus can carry, computed before anything is enabled: frame times of CAN (ISO 11898-1, classical and FD, with
// the fewest and the most stuff bits) and of Modbus RTU (Modbus over serial line V1.02: 11 bits a character, silences
// of 3.5 characters, 1.75 ms above 19200 bit/s), the load of cyclic frames, and whether it fits. SI units.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace stiction::hal {

enum class CanIdentifier { standard, extended };  // 11 or 29 bits

struct CanRates {
  double arbitration = 1e6;    // bit/s
  std::optional<double> data;  // bit/s of the data phase of FD frames; none: the bus carries classical frames only
};

// From the start of a frame to the earliest start of the next one, s.
struct FrameTime {
  double best = 0.0;   // no stuff bit but FD's fixed ones
  double worst = 0.0;  // as many stuff bits as the format can need
};

// Of `bytes` of data, 0 to 8. `identifier`: 11 or 29 bits; `bit_rate`: bit/s.
FrameTime can_frame_time(CanIdentifier identifier, int bytes, double bit_rate);

// Of at least `bytes` of data, 0 to 64, padded to the next length that FD has. The two bits in whose middle the rate
// changes count whole at the arbitration's rate, which is more than they take. `identifier`: 11 or 29 bits; `bit_rate`:
// of the arbitration, `data_bit_rate`: of the data, bit/s.
FrameTime can_fd_frame_time(CanIdentifier identifier, int bytes, double bit_rate, double data_bit_rate);

// The shortest length of an FD frame that holds `bytes`.
int can_fd_length(int bytes);

struct CyclicFrame {
  std::string name;
  CanIdentifier identifier = CanIdentifier::standard;
  int bytes = 0;
  bool fd = false;
  int per_cycle = 1;  // how many of them, one an axis for instance
  double period = 0.0;
};

// A request and its answer over Modbus.
struct ModbusExchange {
  std::string name;
  int written = 0;  // registers
  int read = 0;     // registers; both: function 23
  int per_cycle = 1;
  double period = 0.0;
};

// Of RTU: characters of request and answer and the silence after each; the slave's own time comes on top.
double modbus_rtu_exchange_time(const ModbusExchange& exchange, double baud_rate);
int modbus_rtu_characters(const ModbusExchange& exchange);
double modbus_rtu_silence(double baud_rate);

// The most exchanges of a Modbus master a second; slaves answer after milliseconds, over TCP without a bound.
inline constexpr double modbus_highest_rate = 150.0;
// The share of a bus that cyclic frames may take; the rest is for what is not cyclic and for repeated frames.
inline constexpr double highest_bus_load = 0.8;

struct BudgetRow {
  std::string name;
  std::string format;  // "CAN 8 B", "FD 48 B", "write 6, read 12 registers"
  int per_cycle = 1;
  double period = 0.0;
  FrameTime time;        // of one
  double best_load = 0;  // of all of them, share of the bus
  double worst_load = 0;
};

struct BusBudget {
  std::string bus;      // "can0, 1 Mbit/s, data 8 Mbit/s"
  bool exempt = false;  // a virtual bus has no bit times
  std::vector<BudgetRow> rows;
  std::string note;                            // what the table does not tell; empty: nothing
  std::vector<std::string> rejection_reasons;  // why the bus cannot carry it, each a sentence with its numbers

  double best_load() const;
  double worst_load() const;
};

// `is_virtual`: vcan. `interface` names the bus in the table and in objections. `rates`: bit rates of the bus;
// `frames`: all cyclic frames on it.
BusBudget can_budget(const std::string& interface, const CanRates& rates, const std::vector<CyclicFrame>& frames,
                     bool is_virtual);

// `device`: a serial device for RTU, HOST:PORT for TCP, where only the rate is checked. `baud_rate`: of RTU, bit/s;
// `exchanges`: all cyclic exchanges.
BusBudget modbus_budget(const std::string& device, double baud_rate, const std::vector<ModbusExchange>& exchanges);

// Whether the name of the device is that of a serial line: it is a path.
bool is_serial_device(const std::string& device);

// The table that `stictiond --budget` prints, with the verdict as its last line.
std::string budget_table(const BusBudget& budget);

class BusBudgetError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Throws BusBudgetError with every objection where a bus cannot carry its frames.
void check(const BusBudget& budget);

}  // namespace stiction::hal
