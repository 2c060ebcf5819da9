#include "hal/bus_budget.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

namespace stiction::hal {
namespace {

constexpr int interframe_bits = 3;
constexpr int most_classical_bytes = 8;
constexpr int most_fd_bytes = 64;

// A stuff bit follows five equal bits and counts as the first of the next five: at most one for each four bits after
// the first.
constexpr int most_stuff_bits(int bits) { return (bits - 1) / 4; }

struct IdentifierBits {
  int head;     // classical, stuffed: start of frame to DLC
  int head_fd;  // start of frame to BRS, at the arbitration's rate
};

// ISO 11898-1, figures of the frame formats. Classical, 11 bits: SOF, 11, RTR, IDE, r0, DLC 4; 29 bits: SOF, 11, SRR,
// IDE, 18, RTR, r1, r0, DLC 4. FD: SOF, 11, RRS, IDE, FDF, res, BRS; SOF, 11, SRR, IDE, 18, RRS, FDF, res, BRS.
constexpr IdentifierBits bits_of(CanIdentifier identifier) {
  return identifier == CanIdentifier::standard ? IdentifierBits{19, 17} : IdentifierBits{39, 36};
}

// After the CRC: delimiter, ACK, its delimiter, end of frame 7.
constexpr int tail_bits = 10;
constexpr int classical_crc_bits = 15;

struct FdCrc {
  int bits;         // stuff count with parity 4, CRC 17 or 21
  int fixed_stuff;  // one before them and one after each four
};
constexpr FdCrc fd_crc(int length) { return length <= 16 ? FdCrc{4 + 17, 6} : FdCrc{4 + 21, 7}; }

double period_limit() { return 1.0 / modbus_highest_rate; }

std::string rate_text(double rate) {
  return rate >= 1e6 ? fmt::format("{:g} Mbit/s", rate / 1e6) : fmt::format("{:g} kbit/s", rate / 1e3);
}

std::string time_text(double seconds) {
  return seconds >= 0.9995e-3 ? fmt::format("{:.4g} ms", seconds * 1e3) : fmt::format("{:.4g} us", seconds * 1e6);
}

// The frames of the shortest period must all go within it, behind one longer frame of the others that has just begun:
// a frame on the wire is not interrupted.
void object_to_burst(BusBudget& budget) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const auto& row : budget.rows) shortest = std::min(shortest, row.period);
  double burst = 0.0;
  double longest_other = 0.0;
  for (const auto& row : budget.rows) {
    if (row.period == shortest)
      burst += row.per_cycle * row.time.worst;
    else
      longest_other = std::max(longest_other, row.time.worst);
  }
  if (longest_other == 0.0 || burst + longest_other <= shortest) return;
  budget.rejection_reasons.push_back(
      fmt::format("found frames of the period {} that take {} behind one of {} that has begun; expected at most {}",
                  time_text(shortest), time_text(burst), time_text(longest_other), time_text(shortest)));
}

void object_to_load(BusBudget& budget) {
  const double load = budget.worst_load();
  if (load <= highest_bus_load) return;
  std::string text =
      fmt::format("found a load of {:.0f} % at worst; expected at most {:.0f} %", load * 100, highest_bus_load * 100);
  const double period = budget.rows.front().period;
  if (std::all_of(budget.rows.begin(), budget.rows.end(), [&](const auto& row) { return row.period == period; }))
    text += fmt::format(", which these frames have from a period of {} on, not {}",
                        time_text(period * load / highest_bus_load), time_text(period));
  budget.rejection_reasons.push_back(text);
}

// Why a frame cannot be on the bus at all; empty: it can.
std::string impossible(const CyclicFrame& frame, const CanRates& rates) {
  if (frame.fd && !rates.data) return "an FD frame on a bus without data_bit_rate; expected classical frames";
  const int most = frame.fd ? most_fd_bytes : most_classical_bytes;
  if (frame.bytes < 0 || frame.bytes > most)
    return fmt::format("{} bytes; expected 0 to {} in a{} frame", frame.bytes, most, frame.fd ? "n FD" : " classical");
  if (!(frame.period > 0.0)) return "no period; expected one greater than 0";
  return {};
}

BudgetRow row_of(const CyclicFrame& frame, const CanRates& rates) {
  BudgetRow row{frame.name, {}, frame.per_cycle, frame.period, {}, 0.0, 0.0};
  const bool extended = frame.identifier == CanIdentifier::extended;
  row.format = fmt::format("{} {} B{}", frame.fd ? "FD" : "CAN", frame.fd ? can_fd_length(frame.bytes) : frame.bytes,
                           extended ? ", 29-bit" : "");
  row.time = frame.fd ? can_fd_frame_time(frame.identifier, frame.bytes, rates.arbitration, *rates.data)
                      : can_frame_time(frame.identifier, frame.bytes, rates.arbitration);
  row.best_load = frame.per_cycle * row.time.best / frame.period;
  row.worst_load = frame.per_cycle * row.time.worst / frame.period;
  return row;
}

}  // namespace

FrameTime can_frame_time(CanIdentifier identifier, int bytes, double bit_rate) {
  const int stuffed = bits_of(identifier).head + 8 * bytes + classical_crc_bits;
  const int bits = stuffed + tail_bits + interframe_bits;
  return {bits / bit_rate, (bits + most_stuff_bits(stuffed)) / bit_rate};
}

FrameTime can_fd_frame_time(CanIdentifier identifier, int bytes, double bit_rate, double data_bit_rate) {
  const int length = can_fd_length(bytes);
  const int head = bits_of(identifier).head_fd;
  const int data = 1 + 4 + 8 * length;  // ESI, DLC, data
  const FdCrc crc = fd_crc(length);
  const double best =
      (head + tail_bits + interframe_bits) / bit_rate + (data + crc.bits + crc.fixed_stuff) / data_bit_rate;
  const int in_head = most_stuff_bits(head);
  const int in_data = most_stuff_bits(head + data) - in_head;
  return {best, best + in_head / bit_rate + in_data / data_bit_rate};
}

int can_fd_length(int bytes) {
  constexpr std::array<int, 8> lengths{8, 12, 16, 20, 24, 32, 48, 64};
  if (bytes <= lengths.front()) return bytes;
  return *std::lower_bound(lengths.begin(), lengths.end(), std::min(bytes, lengths.back()));
}

double modbus_rtu_silence(double baud_rate) { return baud_rate > 19200.0 ? 1.75e-3 : 3.5 * 11.0 / baud_rate; }

int modbus_rtu_characters(const ModbusExchange& exchange) {
  // Address, function and CRC frame each message; the rest by function 3 or 4, 16 or 23.
  constexpr int frame = 4;
  if (exchange.written == 0) return (frame + 4) + (frame + 1 + 2 * exchange.read);
  if (exchange.read == 0) return (frame + 5 + 2 * exchange.written) + (frame + 4);
  return (frame + 9 + 2 * exchange.written) + (frame + 1 + 2 * exchange.read);
}

double modbus_rtu_exchange_time(const ModbusExchange& exchange, double baud_rate) {
  return modbus_rtu_characters(exchange) * 11.0 / baud_rate + 2.0 * modbus_rtu_silence(baud_rate);
}

double BusBudget::best_load() const {
  return std::accumulate(rows.begin(), rows.end(), 0.0, [](double sum, const auto& r) { return sum + r.best_load; });
}

double BusBudget::worst_load() const {
  return std::accumulate(rows.begin(), rows.end(), 0.0, [](double sum, const auto& r) { return sum + r.worst_load; });
}

BusBudget can_budget(const std::string& interface, const CanRates& rates, const std::vector<CyclicFrame>& frames,
                     bool is_virtual) {
  BusBudget budget;
  budget.exempt = is_virtual;
  budget.bus = fmt::format("{}, {}{}", interface, rate_text(rates.arbitration),
                           rates.data ? ", data " + rate_text(*rates.data) : std::string{});
  if (is_virtual)
    budget.note = fmt::format(
        "{} is a virtual bus: it has no bit times and is exempt; a real bus with these bit rates would have the load "
        "shown",
        interface);
  for (const CyclicFrame& frame : frames) {
    const std::string reason = impossible(frame, rates);
    if (reason.empty())
      budget.rows.push_back(row_of(frame, rates));
    else  // not even a virtual bus takes it
      budget.rejection_reasons.push_back(fmt::format("{}: found {}", frame.name, reason));
  }
  if (is_virtual || budget.rows.empty()) return budget;
  object_to_load(budget);
  object_to_burst(budget);
  return budget;
}

bool is_serial_device(const std::string& device) { return device.starts_with('/'); }

BusBudget modbus_budget(const std::string& device, double baud_rate, const std::vector<ModbusExchange>& exchanges) {
  BusBudget budget;
  const bool serial = is_serial_device(device);
  budget.bus = serial ? fmt::format("{}, Modbus RTU, {:g} bit/s, 8E1", device, baud_rate)
                      : fmt::format("{}, Modbus TCP", device);
  budget.note = serial ? "the processing time of the slave comes on top"
                       : "an exchange over TCP takes 0.5 to 5 ms without an upper bound, so only the rate is checked";
  double rate = 0.0;
  for (const ModbusExchange& exchange : exchanges) {
    BudgetRow row{exchange.name,
                  fmt::format("write {}, read {}", exchange.written, exchange.read),
                  exchange.per_cycle,
                  exchange.period,
                  {},
                  0.0,
                  0.0};
    if (serial) row.time.best = row.time.worst = modbus_rtu_exchange_time(exchange, baud_rate);
    row.best_load = row.worst_load = exchange.per_cycle * row.time.worst / exchange.period;
    rate += exchange.per_cycle / exchange.period;
    budget.rows.push_back(row);
  }
  if (rate > modbus_highest_rate * (1.0 + 1e-9))
    budget.rejection_reasons.push_back(
        fmt::format("found {:.0f} exchanges a second; expected at most {:.0f}, a period of {} each", rate,
                    modbus_highest_rate, time_text(period_limit())));
  if (serial && !budget.rows.empty()) object_to_load(budget);
  return budget;
}

std::string budget_table(const BusBudget& budget) {
  std::string table = fmt::format("{}\n{:<20} {:<22} {:>5} {:>10} {:>21} {:>15}\n", budget.bus, "frame", "format",
                                  "count", "period", "time, best to worst", "load");
  for (const BudgetRow& row : budget.rows) {
    const std::string time =
        row.time.worst == 0.0 ? "–" : fmt::format("{} to {}", time_text(row.time.best), time_text(row.time.worst));
    table += fmt::format("{:<20} {:<22} {:>5} {:>10} {:>21} {:>15}\n", row.name, row.format, row.per_cycle,
                         time_text(row.period), time,
                         fmt::format("{:.1f} to {:.1f} %", row.best_load * 100, row.worst_load * 100));
  }
  table += fmt::format("{:<82} {:>15}\n", fmt::format("all (allowed: {:.0f} %)", highest_bus_load * 100),
                       fmt::format("{:.1f} to {:.1f} %", budget.best_load() * 100, budget.worst_load() * 100));
  if (!budget.note.empty()) table += budget.note + "\n";
  for (const auto& objection : budget.rejection_reasons) table += "refused: " + objection + "\n";
  if (budget.rejection_reasons.empty()) table += budget.exempt ? "exempt\n" : "carried\n";
  return table;
}

void check(const BusBudget& budget) {
  if (budget.rejection_reasons.empty()) return;
  std::string text = fmt::format("bus {}", budget.bus);
  for (const auto& objection : budget.rejection_reasons) text += ": " + objection;
  throw BusBudgetError(text);
}

}  // namespace stiction::hal
