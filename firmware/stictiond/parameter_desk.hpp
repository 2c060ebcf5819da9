// Where clients of all servers write parameters: within the commissioning window, no limit looser than it is, so many
// requests a second, and stored as a whole that a start would take. One for the programme, used from the threads of its
// servers.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "firmware/stictiond/commissioning_window.hpp"
#include "firmware/stictiond/modbus_registers.hpp"
#include "firmware/stictiond/rate_limit.hpp"
#include "firmware/stictiond/said_lines.hpp"
#include "firmware/stictiond/store_thread.hpp"
#include "hal/modbus/write_taker.hpp"

namespace stiction::drive {

// Where written parameters are kept, and what checks them.
struct KeptParameters {
  std::filesystem::path file{};         // of the parameter store; empty: nothing is kept
  SetCheck check{};                     // of a set before it is stored; null: none
  std::optional<ParameterSet> begun{};  // the set in force at the start
  bool file_holds = true;               // false: the file was refused then, and the set before it is the good one
};

class ParameterDesk {
 public:
  // Requests that write parameters: as many at once, and a second.
  static constexpr double parameter_burst = 256, parameters_per_second = 50;

  // `machine`, `setup`: as configured; `kept`: files for stored parameters, empty for none.
  ParameterDesk(const machine::Machine& machine, const machine::DriveSetup& setup, KeptParameters kept);

  const ModbusRegisters& registers() const { return registers_; }
  SaidLines& said() { return *said_; }
  // Window and store, as clients see them.
  void show(PublishedState& state) const;

  // By an operator: lets clients write parameters, for the time that the machine file says, or no longer.
  void open_commissioning();
  void close_commissioning();

  // Why a request is refused; none: it may be taken. `parameters`: that it writes; `store`: whether it stores; `bus`:
  // over which, for the log.
  std::optional<hal::ModbusException> rejection_of(std::span<const ParameterWrite> parameters, bool store,
                                                   const char* bus);
  // Takes what was not refused. `parameters`, `store`, `bus`: as above.
  hal::WriteVerdict take(std::span<const ParameterWrite> parameters, bool store, const char* bus);
  // How a store has ended; none: not yet. `ticket`: of take().
  std::optional<hal::WriteVerdict> outcome(std::uint64_t ticket);

 private:
  // What a job of the store says of itself; it may outlive this.
  struct Stored {
    explicit Stored(bool holds) : file_holds(holds) {}
    std::atomic<StoreResult> result = StoreResult::none;
    std::atomic<bool> file_holds;
  };

  hal::WriteVerdict ask_store(const char* bus);

  ModbusRegisters registers_;
  KeptParameters kept_parameters_;
  CommissioningWindow window_;
  std::shared_ptr<Stored> stored_;
  std::shared_ptr<SaidLines> said_ = std::make_shared<SaidLines>();
  std::mutex mutex_;  // of what follows
  RateLimit limit_{parameter_burst, parameters_per_second};
  std::optional<ParameterSet> kept_, asked_;  // the set on the disk; the one that was asked for last
  StoreThread disk_;
};

}  // namespace stiction::drive
