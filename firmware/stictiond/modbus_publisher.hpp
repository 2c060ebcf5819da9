// The drive on a plant's network: publishes the loop's state over Modbus and takes what clients write. Four threads
// meet here and none waits for another: the loop hands over its state and takes motion commands, the server's answers
// clients and remembers parameters, the store's brings them to the disk, the service thread says what was written.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "firmware/machine/configuration/conversion.hpp"
#include "firmware/stictiond/commissioning_window.hpp"
#include "firmware/stictiond/modbus_clients.hpp"
#include "firmware/stictiond/modbus_registers.hpp"
#include "firmware/stictiond/motion_mailbox.hpp"
#include "firmware/stictiond/rate_limit.hpp"
#include "firmware/stictiond/said_lines.hpp"
#include "firmware/stictiond/store_thread.hpp"
#include "hal/modbus/server.hpp"
#include "hal/snapshot.hpp"
#include "stiction/drive/axis_signals.hpp"

namespace stiction::drive {

// Where written parameters are kept, and what checks them.
struct ModbusStore {
  std::filesystem::path file;         // of the parameter store; empty: nothing is kept
  SetCheck check;                     // of a set before it is stored; null: none
  std::optional<ParameterSet> begun;  // the set in force at the start
  bool file_holds = true;             // false: the file was refused then, and the set before it is the good one
};

class ModbusPublisher : private hal::WriteTaker {
 public:
  // What the loop does not know itself (deadlines, the trace's rows); asked in the server's thread at each request.
  using Beside = std::function<void(PublishedState&)>;
  // Whether the loop makes no progress: what it published last is then shown as a fault and no command is taken. As
  // above.
  using Stale = std::function<bool()>;
  // Requests that write parameters: as many at once, and a second.
  static constexpr double parameter_burst = 256, parameters_per_second = 50;

  // Listens when this returns. Throws ModbusError. `machine`, `setup`: as configured; `store`: files for stored
  // parameters, empty for none; `beside`: further registers of the caller; `stale`: null for a loop in its own time;
  // `moves_itself`: the programme moves the axes, and clients can only stop them.
  ModbusPublisher(const machine::Machine& machine, const machine::DriveSetup& setup, ModbusStore store,
                  Beside beside = {}, Stale stale = {}, bool moves_itself = false);

  // The loop's side, wait-free.
  // `signals` of the tick; the peaks and the mean square are kept here. `status` gives positions, statusword, mode,
  // fault and inputs of an axis: status(axis, PublishedAxis&). `now_ns`: time of the tick; `fault`: of programme or
  // bus.
  template <class S, class Status>
  void publish(std::span<const AxisSignals<S>> signals, std::int64_t now_ns, Fault fault, Status status) {
    if (first_ns_ == 0) first_ns_ = now_ns;
    ++rows_;
    PublishedState& next = loop_state_;
    next.seconds = static_cast<std::uint32_t>((now_ns - first_ns_) / 1'000'000'000);
    next.fault = fault;
    for (std::size_t i = 0; i < signals.size() && i < next.axes.size(); ++i) {
      PublishedAxis& axis = next.axes[i];
      const AxisSignals<S>& s = signals[i];
      axis.velocity = machine::to_si(s.v);
      axis.current = machine::to_si(s.i);
      axis.following_error = machine::to_si(s.e);
      axis.peak_following_error = std::max(axis.peak_following_error, std::abs(axis.following_error));
      axis.peak_current = std::max(axis.peak_current, std::abs(axis.current));
      square_sum_[i] += axis.current * axis.current;
      axis.rms_current = std::sqrt(square_sum_[i] / static_cast<double>(rows_));
      status(i, axis);
    }
    snapshot_.publish(next);
  }
  // Once a tick: `act` is called with each command of clients that is new (MotionMailbox::take); none comes where the
  // machine file does not allow motion.
  template <class Act>
  void take_motion(Act act) {
    motion_.take(act);
  }

  // By an operator: lets clients write parameters, for the time that the machine file says, or no longer. Any thread.
  void open_commissioning();
  void close_commissioning();

  // The service thread's side: a line for the log for each thing done or refused since the last call.
  std::vector<std::string> serve();

  bool motion_allowed() const { return motion_allowed_; }  // whether commands that move an axis are taken
  const hal::ModbusServer& server() const { return server_; }

 private:
  // The server's side.
  void begin_request(std::uint16_t client) override { client_ = client; }
  void forget(std::uint16_t client) override { clients_.forget(client); }
  void show_clients(PublishedState& state) const;
  hal::WriteVerdict take(std::span<const hal::RegisterWrite> writes) override;
  std::optional<hal::WriteVerdict> outcome(std::uint64_t ticket) override;
  hal::WriteVerdict ask_store();
  std::optional<hal::ModbusException> rejection_of(std::span<const ParameterWrite> parameters, bool store);
  bool judge(std::vector<MotionWrite>& motions);
  std::optional<std::vector<MotionWrite>> judged(std::span<const MotionWrite> motions);
  std::string describe(const MotionWrite& write) const;

  ModbusRegisters registers_;
  ModbusStore store_;
  Beside beside_;
  Stale stale_;
  bool moves_itself_, motion_allowed_;
  std::vector<std::string> axis_names_;
  // The loop's own.
  PublishedState loop_state_;
  std::array<double, most_published_axes> square_sum_{};
  std::uint64_t rows_ = 0;
  std::int64_t first_ns_ = 0;
  hal::Snapshot<PublishedState> snapshot_;
  MotionMailbox motion_;
  ModbusClients clients_;     // the server's own, as are the next two
  std::uint16_t client_ = 0;  // whose request it answers
  RateLimit parameter_limit_{parameter_burst, parameters_per_second};
  CommissioningWindow window_;
  // What a job of the store says of itself; it may outlive this.
  struct Stored {
    explicit Stored(bool holds) : file_holds(holds) {}
    std::atomic<StoreResult> result = StoreResult::none;
    std::atomic<bool> file_holds;
  };
  std::shared_ptr<Stored> stored_;
  std::optional<ParameterSet> kept_, asked_;  // the set on the disk; the one that was asked for last
  std::shared_ptr<SaidLines> said_ = std::make_shared<SaidLines>();
  StoreThread disk_;
  hal::ModbusServer server_;  // last: its thread uses all of the others
};

}  // namespace stiction::drive
