// Which of the clients of one Modbus server commands an axis, as the drive knows only that the bus does
// (command_owner.hpp): one connection at a time, which leads the idle axis to ready to switch on. A stop of any other
// one takes the axis from it and holds it until who stopped enables operation, which moves nothing. A connection that
// ends leaves what it had to the next one that commands the axis, so that a master may connect again within the time
// of its watch. Judged in the server's thread, where requests come one after the other; what the drive shows of the
// axis may be a tick old, and what it takes it judges again itself.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "firmware/stictiond/modbus_registers.hpp"
#include "firmware/stictiond/motion_mailbox.hpp"

namespace stiction::drive {

class ModbusClients {
 public:
  enum class Verdict : std::uint8_t {
    pass,
    pass_as_stop,  // of one that the axis does not belong to
    ignored,       // taken, and nothing is to be done
    refused,
  };

  // `client`: number of the connection, from 1 on; `write`: what it asks for; `shown`: the axis as the drive showed it
  // last.
  Verdict judge(std::uint16_t client, const MotionWrite& write, const PublishedAxis& shown) {
    Axis& axis = axes_[write.axis];
    look_at(axis, shown);
    const bool word = write.what == MotionWrite::What::controlword;
    if (MotionMailbox::stops(write)) return stop(axis, client, static_cast<std::uint16_t>(write.value), shown);
    if (shown.owner != CommandSource::none && shown.owner != CommandSource::modbus) return Verdict::refused;
    if (owns(axis, client)) {
      adopt(axis, client);
      return Verdict::pass;
    }
    if (axis.owner != nobody) return Verdict::refused;
    if (axis.holders.empty()) {
      // One of before this server, or of nobody; the drive knows.
      if (shown.owner == CommandSource::modbus) take(axis, client, shown);
      return Verdict::pass;
    }
    // Who resets an axis that belongs to nobody sends the mode with the word; it moves nothing.
    if (write.what == MotionWrite::What::mode && axis.holders.size() == 1 && axis.holders.front() == client)
      return Verdict::pass;
    if (!word) return Verdict::refused;
    return lift(axis, client);
  }

  void forget(std::uint16_t client) {
    for (Axis& axis : axes_) {
      if (axis.owner == client) axis.owner = anybody;
      const auto held = std::erase(axis.holders, client);
      if (held != 0 && std::find(axis.holders.begin(), axis.holders.end(), anybody) == axis.holders.end())
        axis.holders.push_back(anybody);
    }
  }

  // Number of the connection that commands an axis; 0: none. 65535: it has ended, and the next one takes its place.
  std::uint16_t owner(std::size_t axis) const { return axes_[axis].owner; }
  // Changes with each change of it.
  std::uint16_t changes(std::size_t axis) const { return axes_[axis].changes; }

 private:
  static constexpr std::uint16_t nobody = 0, anybody = 0xffff;

  struct Axis {
    std::uint16_t owner = nobody, changes = 0;
    std::uint16_t token = 0;  // of the drive, when the owner was taken
    std::vector<std::uint16_t> holders{};
  };

  // The drive has given it up, by time or because a different bus stopped it.
  static void look_at(Axis& axis, const PublishedAxis& shown) {
    if (axis.owner != nobody && shown.owner != CommandSource::modbus && shown.owner_token != axis.token)
      axis.owner = nobody;
  }
  static bool owns(const Axis& axis, std::uint16_t client) { return axis.owner == client || axis.owner == anybody; }
  static void adopt(Axis& axis, std::uint16_t client) {
    if (axis.owner == client) return;
    axis.owner = client;
    ++axis.changes;
  }
  static void take(Axis& axis, std::uint16_t client, const PublishedAxis& shown) {
    axis.owner = client;
    axis.token = shown.owner_token;
    ++axis.changes;
  }
  static std::vector<std::uint16_t>::iterator hold_of(Axis& axis, std::uint16_t client) {
    const auto own = std::find(axis.holders.begin(), axis.holders.end(), client);
    return own != axis.holders.end() ? own : std::find(axis.holders.begin(), axis.holders.end(), anybody);
  }

  static Verdict stop(Axis& axis, std::uint16_t client, std::uint16_t word, const PublishedAxis& shown) {
    if (owns(axis, client)) {
      adopt(axis, client);
      return Verdict::pass;
    }
    const bool other = axis.owner != nobody;
    const auto command = command_of(word);
    const bool leads = command == DriveCommand::shutdown || command == DriveCommand::switch_on;
    const auto own = std::find(axis.holders.begin(), axis.holders.end(), client);
    const bool free = !other && shown.owner != CommandSource::can &&
                      (axis.holders.empty() || (axis.holders.size() == 1 && own != axis.holders.end()));
    if (free && leads) {
      axis.holders.clear();
      take(axis, client, shown);
      return Verdict::pass;
    }
    if (own == axis.holders.end()) axis.holders.push_back(client);
    if (other) ++axis.changes;
    axis.owner = nobody;
    return Verdict::pass_as_stop;
  }

  // The last one lifts the hold that the drive has of this bus.
  static Verdict lift(Axis& axis, std::uint16_t client) {
    const auto own = hold_of(axis, client);
    if (own == axis.holders.end()) return Verdict::refused;
    axis.holders.erase(own);
    return axis.holders.empty() ? Verdict::pass : Verdict::ignored;
  }

  std::array<Axis, most_published_axes> axes_{};
};

}  // namespace stiction::drive
