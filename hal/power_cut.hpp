// Power off by a path that needs neither the control loop nor the heap: for a loop that stands still, an exception that
// nobody catches, and a signal that ends the process. A backend that drives a power stage enters what takes its power;
// whoever finds that the loop is lost cuts, from any thread or signal handler. From then on the gate before the backend
// (gated_backend.hpp) lets no enabling command through until the loop itself has taken note and releases it.
#pragma once

#include <array>
#include <atomic>
#include <concepts>
#include <cstddef>
#include <stdexcept>

namespace stiction::hal {

// A backend that can take the power off its stages beside its loop: system calls alone that do not wait, in a signal
// handler too.
template <class B>
concept PowerCutting = requires(B backend) {
  { backend.cut_power() }
  noexcept->std::same_as<void>;
};

class PowerCut {
 public:
  using Act = void (*)(void* backend) noexcept;
  static constexpr std::size_t most_backends = 4;

  constexpr PowerCut() = default;
  PowerCut(const PowerCut&) = delete;
  PowerCut& operator=(const PowerCut&) = delete;

  // Takes the power off all that is entered and closes the gate. Async-signal-safe; any thread, as often as it likes.
  void cut() noexcept {
    cut_.store(true, std::memory_order_release);
    for (Slot& slot : slots_)
      if (const Act act = slot.act.load(std::memory_order_acquire); act != nullptr) act(slot.backend);
  }

  bool is_cut() const noexcept { return cut_.load(std::memory_order_acquire); }

  // By the loop, once it has switched every axis off itself.
  void release() noexcept { cut_.store(false, std::memory_order_release); }

 private:
  struct Slot {
    void* backend = nullptr;
    std::atomic<Act> act{nullptr};  // none: the slot is free
  };

 public:
  // Enters a backend for as long as this lives; one that cannot cut is left alone, as it has no wires. By the thread
  // that makes the backends.
  class Entry {
   public:
    template <class B>
    Entry(PowerCut& cut, B& backend) {
      if constexpr (PowerCutting<B>) {
        for (Slot& slot : cut.slots_) {
          if (slot.act.load(std::memory_order_relaxed) != nullptr) continue;
          slot_ = &slot;
          slot.backend = &backend;
          slot.act.store([](void* entered) noexcept { static_cast<B*>(entered)->cut_power(); },
                         std::memory_order_release);
          return;
        }
        throw std::length_error("more backends than places in the power cut");
      }
    }
    ~Entry() {
      if (slot_ != nullptr) slot_->act.store(nullptr, std::memory_order_release);
    }
    Entry(const Entry&) = delete;
    Entry& operator=(const Entry&) = delete;

   private:
    Slot* slot_ = nullptr;
  };

 private:
  std::atomic<bool> cut_{false};
  std::array<Slot, most_backends> slots_{};
};

// That of the process: signals know no other.
inline constinit PowerCut power_cut;

}  // namespace stiction::hal
