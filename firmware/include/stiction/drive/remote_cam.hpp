// The modes of cam and gear of an axis that others command (remote_axis.hpp): there only where the drive has a master.
// A halt, and a different mode that is asked for, leave the curve to standstill within the axis' limits; what was
// engaged is not taken up again by itself.
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

  constexpr bool at_rest() const { return !attached() || mode_->at_rest(); }

  // The set-point of the coming tick. `stops`: to standstill; `following`: as of command().
  constexpr SetPoint<S> step(bool stops, bool following) {
    if (!attached() || !following) return {stands_, {}, {}};
    const CamStatus& status = mode_->status();
    if (stops && (status.active || status.waiting)) mode_->command(CamCommand::leave, false, false);
    const auto set = mode_->step(master_->reading());
    if (mode_->status().end_of_profile) ++ends_;
    return set;
  }

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
  CamMode* mode_ = nullptr;
  CamMaster* master_ = nullptr;
  S::Position stands_{};
  std::uint32_t ends_ = 0;
};

}  // namespace stiction
