// The tuner of one axis (cam_tuner.hpp) between two threads. The loop records dwells into two places in turn and takes
// a table at the seam of the cycle; the thread beside it evaluates what is full, writes the next table and offers it.
// Neither waits for the other. Two tables take turns beside that of the file, so that none is written that is followed.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "firmware/stictiond/cam_tuner.hpp"
#include "firmware/stictiond/log_ring.hpp"
#include "firmware/stictiond/modbus_registers.hpp"
#include "stiction/drive/cam_mode.hpp"
#include "stiction/drive/exchange.hpp"

namespace stiction::drive {

// As a message or a page has it.
const char* words_of(CamTuningRefusal refusal);
const char* name_of(CamTuningState state);

class TunedAxis {
 public:
  using S = FixedSignals;

  struct Config {
    CamTuner::Config tuner{};
    std::string name;                     // of the axis
    std::size_t axis = 0;                 // its number
    std::uint16_t number = 1;             // of the table, from 1
    std::span<const std::uint8_t> bytes;  // of the table; they must stay
    bool own_encoder = false;             // the load is where the axis' own encoder sees it
  };

  // Throws machine::CamTuningError.
  explicit TunedAxis(const Config& config);
  TunedAxis(const TunedAxis&) = delete;
  TunedAxis& operator=(const TunedAxis&) = delete;
  ~TunedAxis() = default;

  std::size_t axis() const { return config_.axis; }
  bool own_encoder() const { return config_.own_encoder; }

  // By the loop, once a tick behind the set-point of `mode`: the `load` of this tick, and whether current or voltage
  // are `limited`. Wait-free.
  void step(CamMode& mode, const LoadReading<S>& load, bool limited);
  // By the loop: what a client asks for; the newest counts.
  void ask(CamTuningCommand command) { asked_.store(command, std::memory_order_release); }
  // By the loop, for clients.
  void show(PublishedCamTuning& shown) const;

  // Beside the loop, some times in a cycle of the master. `say`: where events go.
  void round(const LogSink& say);
  const CamTuner& tuner() const { return tuner_; }

 private:
  // A record on its way: the loop's until it is full, then the other thread's until that says that it is not.
  struct Slot {
    CamTuning::Config config{};
    CamTuning::State state{};
    std::int64_t cycle = 0;
    std::uint64_t tick = 0;  // of the end of the rise
    std::uint32_t serial = 0;
    bool as_its_table = true;
    std::atomic<bool> full = false;
  };
  struct Place {
    std::vector<std::uint8_t> bytes;
    CamTable table;
    CamMode::Table made;
  };
  // A table that is offered: its place, 0 for that of the file, and its serial number; as one word.
  static constexpr std::uint32_t offer_of(std::uint32_t serial, std::uint32_t place) { return serial << 2 | place; }

  void record(const CamMode& mode, const LoadReading<S>& load, bool limited);
  void exchange(CamMode& mode);
  const CamMode::Table* table_of(std::uint32_t place) const { return place == 0 ? nullptr : &places_[place - 1].made; }

  void take_command(const LogSink& say);
  void take_answer(const LogSink& say);
  void take_records(const LogSink& say);
  void offer(const LogSink& say);
  bool write(std::uint32_t place);
  void say_state(const LogSink& say);
  void publish();

  Config config_;
  double period_;
  // The loop's.
  std::array<Slot, 2> slots_{};
  std::size_t at_ = 0;
  std::uint64_t ticks_ = 0;
  std::uint32_t taking_ = 0;    // an offer
  std::uint32_t in_force_ = 0;  // the same
  // Between both.
  std::array<Place, 2> places_{};
  std::atomic<std::uint32_t> offered_ = 0, taken_ = 0;  // offers; taken_: in force
  std::atomic<CamRefusal> refused_ = CamRefusal::none;  // of the last offer
  std::atomic<bool> follows_ = false;
  std::atomic<CamTuningCommand> asked_ = CamTuningCommand::none;
  std::atomic<CamTuningState> state_ = CamTuningState::idle;
  std::atomic<CamTuningRefusal> refusal_ = CamTuningRefusal::none;
  std::atomic<double> quality_ = 0.0, before_ = 0.0, frequency_ = 0.0;
  std::atomic<std::uint16_t> steps_ = 0;
  // Of the thread beside the loop.
  CamTuner tuner_;
  static constexpr std::size_t kept_pulses = 8;
  std::array<PulseAmplitudes, kept_pulses> pulses_{};  // by serial number
  std::uint32_t serial_ = 0, waiting_ = 0, next_slot_ = 0;
  CamTuningState said_state_ = CamTuningState::idle;
  CamTuningRefusal said_refusal_ = CamTuningRefusal::none;
  int said_grown_ = 0;
};

}  // namespace stiction::drive
