// Who takes what a Modbus client writes, in the server's thread: it must not wait. What takes long, such as bringing
// parameters to a disk, is put off: its client gets the answer when it is done, and the others are served meanwhile.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "hal/modbus/register_map.hpp"
#include "hal/modbus/write_queue.hpp"

namespace stiction::hal {

struct WriteVerdict {
  std::optional<ModbusException> refused{};  // nothing was written
  std::uint64_t put_off = 0;                 // a ticket for outcome(); 0: the request is done
};

class WriteTaker {
 public:
  WriteTaker() = default;
  virtual ~WriteTaker() = default;
  WriteTaker(const WriteTaker&) = delete;
  WriteTaker& operator=(const WriteTaker&) = delete;

  // Whose request is answered now: take() and the values that are asked for are of it, until the next call. `client`:
  // number of its connection, from 1 on, of one at a time.
  virtual void begin_request([[maybe_unused]] std::uint16_t client) {}
  // A connection has ended.
  virtual void forget([[maybe_unused]] std::uint16_t client) {}
  // The writes of one request, together or not at all. `writes`: in the order of their registers.
  virtual WriteVerdict take(std::span<const RegisterWrite> writes) = 0;
  // Whether what was put off is done, and how it ended; none: not yet. `ticket`: of take().
  virtual std::optional<WriteVerdict> outcome([[maybe_unused]] std::uint64_t ticket) { return WriteVerdict{}; }
};

// Puts them into a queue that another thread empties; a full one refuses.
class QueueTaker : public WriteTaker {
 public:
  explicit QueueTaker(WriteQueue& queue) : queue_(queue) {}
  WriteVerdict take(std::span<const RegisterWrite> writes) override {
    if (queue_.push(writes)) return {};
    return {.refused = ModbusException::busy};
  }

 private:
  WriteQueue& queue_;
};

}  // namespace stiction::hal
