// The modes of cam and gear of an axis that others command (remote_axis.hpp): there only where the drive has a master.
// A halt, a different mode that is asked for, and a stop of the drive that is none for a fault of the axis brake along
// the curve, where that takes no more than the deceleration of the drive's ramp (CamMode::brake()). Else the first two
// leave it to standstill within the axis' limits, and the drive stops by its ramp. What was engaged is not taken up
// again by itself.
#pragma once

#include <cstdint>

#include "stiction/drive/cam_mode.hpp"
#include "stiction/drive/state_machine.hpp"

namespace stiction {

class RemoteCam {
 public:
  using S = FixedSignals;

  // `mode`: of the axis; `master`: what it follows, new in each tick before the axis; both must outlive this.
  constexpr void attach(CamMode& mode, CamMaster& master) {
    mode_ = &mode;
    master_ = &master;
  }
  constexpr bool attached() const { return mode_ != nullptr; }
  constexpr CamMode& mode() { return *mode_; }
  constexpr const CamMode& mode() const { return *mode_; }
  constexpr CamMaster& master() { return *master_; }
  constexpr const CamMaster& master() const { return *master_; }

  // Stands at `position`, and follows nothing.
  constexpr void start(S::Position position) {
    stands_ = position;
    if (attached()) mode_->start(position);
  }

  // Gives the command `asked`. `shown`: the mode of the axis; `following`: the drive follows its set-points;
  // `referenced`: its zero is known.
  constexpr void command(CamCommand asked, OperationMode shown, bool following, bool referenced) {
    if (!attached()) return;
    if (!following || !is_coupled(shown)) return mode_->refuse(CamRefusal::not_enabled);
    mode_->command(asked, shown == OperationMode::gear, referenced);
  }

  // What the programme's tuner of a cam is asked for by a client, until it is taken; 0: nothing.
  constexpr void ask_tuning(std::uint8_t command) { tuning_ = command; }
  constexpr std::uint8_t take_tuning() {
    const std::uint8_t asked = tuning_;
    tuning_ = 0;
    return asked;
  }

  constexpr bool at_rest() const { return !attached() || mode_->at_rest(); }

  // The set-point of the coming tick. `stops`: to standstill; `following`: as of command(); `ramp`: that of the stop;
  // `by_drive`: it is the drive that stops, and takes the ramp where along() is false.
  constexpr SetPoint<S> step(bool stops, bool following, CamStop ramp = CamStop::slow_down, bool by_drive = false) {
    along_ = false;
    if (!attached() || !following) return {stands_, {}, {}};
    const bool brakes = stops && mode_->brake(ramp);
    const bool waits = mode_->status().waiting;
    if (stops && !by_drive && !brakes && (waits || !mode_->at_rest())) leave_once();
    if (!stops) leaving_ = false;
    if (mode_->braked()) mode_->leave_to_rest();
    along_ = by_drive ? mode_->braking() : mode_->status().in_sync;
    const auto set = mode_->step(master_->reading());
    if (mode_->status().end_of_profile) ++ends_;
    return set;
  }

  // Whether a stop of the drive is to take the set-points: one that begins, in this tick; one under way, on to
  // standstill.
  constexpr bool along() const { return along_; }

  constexpr bool refused() const { return attached() && mode_->refusal() != CamRefusal::none; }
  constexpr Fault fault() const { return attached() ? mode_->fault() : Fault::none; }
  // Of the statusword: in sync, and following.
  constexpr std::uint16_t bits() const {
    std::uint16_t bits = 0;
    if (attached() && mode_->status().in_sync) bits |= statusword::target_bit;
    if (attached() && mode_->status().active) bits |= statusword::follows_bit;
    return bits;
  }
  constexpr std::uint32_t ends() const { return ends_; }  // of a profile, that were passed

 private:
  // Where it leaves already, what it does is not to begin again in each tick.
  constexpr void leave_once() {
    if (leaving_ && !mode_->status().waiting && !mode_->status().active) return;
    leaving_ = true;
    mode_->leave_to_rest();
  }

  CamMode* mode_ = nullptr;
  CamMaster* master_ = nullptr;
  S::Position stands_{};
  std::uint32_t ends_ = 0;
  std::uint8_t tuning_ = 0;
  bool along_ = false, leaving_ = false;
};

}  // namespace stiction
