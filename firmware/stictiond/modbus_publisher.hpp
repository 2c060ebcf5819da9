// The drive on a plant's network: publishes the loop's state over Modbus and takes what clients write. Four threads
// meet here and none waits for another: the loop hands over its state and takes motion commands, the server's answers
// clients and remembers parameters, the store's brings them to the disk, the service thread says what was written.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "firmware/stictiond/loop_exchange.hpp"
#include "firmware/stictiond/modbus_clients.hpp"
#include "firmware/stictiond/modbus_registers.hpp"
#include "firmware/stictiond/parameter_desk.hpp"
#include "hal/modbus/server.hpp"

namespace stiction::drive {

class ModbusPublisher : private hal::WriteTaker {
 public:
  // What the loop does not know itself (deadlines, the trace's rows); asked in the server's thread at each request.
  using Beside = std::function<void(PublishedState&)>;
  // Whether the loop makes no progress: what it published last is then shown as a fault and no command is taken. As
  // above.
  using Stale = std::function<bool()>;
  // Listens when this returns. Throws ModbusError. `machine`, `setup`: as configured; `desk`: for parameters, also of
  // other servers; `beside`: further registers of the caller; `stale`: null for a loop in its own time; `moves_itself`:
  // the programme moves the axes, and clients can only stop them.
  ModbusPublisher(std::shared_ptr<ParameterDesk> desk, const machine::Machine& machine,
                  const machine::DriveSetup& setup, Beside beside = {}, Stale stale = {}, bool moves_itself = false);
  // The same with a desk of its own. `kept`: files for stored parameters, empty for none; `machine`, `setup`, `beside`,
  // `stale`, `moves_itself`: as above.
  ModbusPublisher(const machine::Machine& machine, const machine::DriveSetup& setup, KeptParameters kept,
                  Beside beside = {}, Stale stale = {}, bool moves_itself = false)
      : ModbusPublisher(std::make_shared<ParameterDesk>(machine, setup, std::move(kept)), machine, setup,
                        std::move(beside), std::move(stale), moves_itself) {}

  // The loop's side, wait-free.
  // As of LoopExchange. `signals`, `now_ns`, `fault`, `status`: as there.
  template <class S, class Status>
  void publish(std::span<const AxisSignals<S>> signals, std::int64_t now_ns, Fault fault, Status status) {
    loop_.publish(signals, now_ns, fault, status);
  }
  // None comes where the machine file does not allow motion.
  template <class Act>
  void take_motion(Act act) {
    loop_.take_motion(act);
  }

  // By an operator: lets clients write parameters, for the time that the machine file says, or no longer. Any thread.
  void open_commissioning() { desk_->open_commissioning(); }
  void close_commissioning() { desk_->close_commissioning(); }

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
  bool judge(std::vector<MotionWrite>& motions);
  std::optional<std::vector<MotionWrite>> judged(std::span<const MotionWrite> motions);
  std::string describe(const MotionWrite& write) const;

  std::shared_ptr<ParameterDesk> desk_;
  Beside beside_;
  Stale stale_;
  bool moves_itself_, motion_allowed_;
  std::vector<std::string> axis_names_;
  LoopExchange loop_;
  ModbusClients clients_;     // the server's own, as is the next
  std::uint16_t client_ = 0;  // whose request it answers
  hal::ModbusServer server_;  // last: its thread uses all of the others
};

}  // namespace stiction::drive
