// Who may command an axis that several can reach. One owner at a time: who leads an idle axis to ready to switch on
// (shutdown or switch on) becomes it, and stays it until it disables the voltage or is not heard any more. A stop is
// obeyed from everybody: one of who is not the owner takes the ownership away and holds the axis until its sender
// enables operation itself, which lifts the hold and moves nothing. So a stop wins over any enabling word of others,
// before it, in its tick or behind it. The owner is watched (6007h): where it is not heard for its time while the axis
// has power, or its connection ends, the axis stops.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "stiction/drive/faults.hpp"
#include "stiction/drive/state_machine.hpp"

namespace stiction {

enum class CommandSource : std::uint8_t { none, can, modbus };
inline constexpr const char* command_source_names[]{"none", "CAN", "Modbus"};
constexpr const char* name_of(CommandSource source) { return command_source_names[static_cast<std::size_t>(source)]; }

// Abort connection option code 6007h.
enum class AbortReaction : std::int8_t {
  none = 0,
  fault = 1,  // commander_lost: a controlled stop and a reset before the axis is enabled again
  disable_voltage = 2,
  quick_stop = 3,
};

class CommandOwner {
 public:
  struct Config {
    std::array<std::uint32_t, 3> timeout_ticks{};  // by source; 0: it is not watched
    AbortReaction reaction = AbortReaction::fault;
  };

  explicit constexpr CommandOwner(const Config& config) : config_(config) {}

  // Takes a controlword. False: it is refused, as it would enable an axis that is not the source's own. `source`: who
  // gives it; `word`: 6040h; `of_other`: the source has several commanders, and this one is not the one that the axis
  // belongs to; it can stop it alone.
  constexpr bool command(CommandSource source, std::uint16_t word, bool of_other = false) {
    hear(source);
    lost_ = false;
    const auto command = command_of(word);
    const auto at = static_cast<std::size_t>(source);
    if (source == owner_ && !of_other) {
      word_ = word;
      return true;
    }
    const bool idle = owner_ == CommandSource::none;
    if (command == DriveCommand::enable_operation) {
      holds_[at].holds = false;
      // Of the word a reset counts, whoever gives it.
      if (idle) word_ = static_cast<std::uint16_t>(word & controlword::fault_reset_bit);
      return false;
    }
    const bool leads = !of_other && (command == DriveCommand::shutdown || command == DriveCommand::switch_on);
    if (idle && leads && others_hold(source)) return false;
    holds_[at] = {word, !(idle && leads)};
    word_ = idle && leads ? word : controlword::disable_voltage;
    if (!idle || leads) change_owner(idle ? source : CommandSource::none);
    return true;
  }

  // Something came of a source: a heartbeat, or a value.
  constexpr void hear(CommandSource source) { age_ticks_[static_cast<std::size_t>(source)] = 0; }

  // The connection over which it commanded is gone: as if it had not been heard for its time, in the next tick.
  // `source`: whose.
  constexpr void disconnect(CommandSource source) {
    gone_ = gone_ || (source == owner_ && source != CommandSource::none);
  }

  // Whether targets, modes and speeds of a source count.
  constexpr bool accepts(CommandSource source) const { return owner_ == CommandSource::none || owner_ == source; }

  // Once a tick. `powered`: the axis has power.
  constexpr void tick(bool powered) {
    if (owner_ != CommandSource::none && !powered && command_of(word_) == DriveCommand::disable_voltage)
      change_owner(CommandSource::none);
    const auto at = static_cast<std::size_t>(owner_);
    const std::uint32_t most = config_.timeout_ticks[at];
    if (owner_ == CommandSource::none || (most == 0 && !gone_) || config_.reaction == AbortReaction::none) return;
    if (!gone_ && age_ticks_[at] < most) {
      ++age_ticks_[at];
      return;
    }
    lost_ = powered;
    word_ = powered && config_.reaction != AbortReaction::disable_voltage ? controlword::quick_stop
                                                                          : controlword::disable_voltage;
    change_owner(CommandSource::none);
  }

  // The controlword that the axis obeys: of several that hold it the one that stops most.
  constexpr std::uint16_t word() const {
    std::uint16_t word = word_;
    bool held = false;
    for (const auto& hold : holds_) {
      if (!hold.holds || (held && !(command_of(hold.word) < command_of(word)))) continue;
      word = hold.word;
      held = true;
    }
    return word;
  }

  constexpr CommandSource owner() const { return owner_; }
  constexpr std::uint16_t token() const { return token_; }  // changes with each change of the owner
  // The first source that holds the axis by a stop.
  constexpr CommandSource held_by() const {
    for (std::size_t i = 1; i < holds_.size(); ++i)
      if (holds_[i].holds) return static_cast<CommandSource>(i);
    return CommandSource::none;
  }
  // As long as nobody is heard after the loss.
  constexpr Fault fault() const {
    return lost_ && config_.reaction == AbortReaction::fault ? Fault::commander_lost : Fault::none;
  }

 private:
  struct Hold {
    std::uint16_t word = 0;
    bool holds = false;
  };

  constexpr bool others_hold(CommandSource source) const {
    for (std::size_t i = 1; i < holds_.size(); ++i)
      if (holds_[i].holds && static_cast<CommandSource>(i) != source) return true;
    return false;
  }
  constexpr void change_owner(CommandSource owner) {
    owner_ = owner;
    gone_ = false;
    ++token_;
  }

  Config config_;
  CommandSource owner_ = CommandSource::none;
  std::uint16_t word_ = controlword::disable_voltage, token_ = 0;
  std::array<std::uint32_t, 3> age_ticks_{};
  std::array<Hold, 3> holds_{};
  bool lost_ = false, gone_ = false;
};

}  // namespace stiction
