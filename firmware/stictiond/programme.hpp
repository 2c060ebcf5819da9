// What the programme does with the axes, tick by tick: it enables them, finds their zero where they have to, makes its
// motion, stops and takes the power off. A fault on the way ends in the drives' own reactions; the programme waits for
// them to be over. While it serves, others ask: the axes then stand, follow or move by what RemoteAxis makes of it.
// Allocates nothing after construction.
#pragma once

#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "firmware/stictiond/cam_drive.hpp"
#include "firmware/stictiond/log_ring.hpp"
#include "firmware/stictiond/motion.hpp"
#include "firmware/stictiond/trace.hpp"
#include "hal/drive_loop.hpp"
#include "stiction/drive/remote_axis.hpp"

namespace stiction::drive {

enum class Phase : std::uint8_t { enable, home, approach, motion, idle, remote, stop, faulted, over };

inline constexpr std::array<const char*, 9> phase_names{"enabling", "homing",   "approach", "motion", "holding",
                                                        "serving",  "stopping", "faulted",  "off"};
constexpr const char* name_of(Phase phase) { return phase_names[static_cast<std::size_t>(phase)]; }

struct Task {
  Motion approach, motion;       // both may be empty
  std::uint64_t idle_ticks = 0;  // to be held enabled after the motion
  CamDrive* cam = nullptr;       // a master, and tables that clients may ask for, or
  std::uint64_t cam_ticks = 0;   // that an axis follows for so long, in the place of the motion
  bool serve = false;            // none of these: others ask for what is done, until the programme is stopped
};

template <hal::Backend B>
class Programme {
 public:
  using S = typename B::Signals;

  // `remote`: one an axis. `trace`: of the motion; may be null. All must outlive this. `loop`: of all axes; `task`:
  // what to do with them; `log`: for messages.
  Programme(hal::DriveLoop<B>& loop, const Task& task, std::span<const RemoteAxisConfig> remote, LogRing& log,
            Trace* trace)
      : loop_(loop),
        task_(task),
        log_(log),
        trace_(trace),
        hold_(loop.axis_count()),
        remote_(remote.begin(), remote.end()),
        dropped_(loop.axis_count()),
        said_refusals_(loop.axis_count()) {
    if (task.serve) enter(Phase::remote);
    if (task.cam == nullptr) return;
    for (std::size_t i = 0; i < remote_.size(); ++i)
      if (task.cam->master_axis() != i) remote_[i].cam().attach(task.cam->mode(i), task.cam->master());
  }

  // A fault of every axis from the coming tick to the end: nothing is enabled.
  void keep_off(Fault fault) { kept_off_ = fault; }

  // One tick. `stop_wanted`: a controlled stop, then the end.
  void tick(bool stop_wanted) {
    if (stop_wanted && phase_ < Phase::stop) begin_stop();
    if (loop_.faulted() && phase_ != Phase::remote && phase_ < Phase::faulted) enter(Phase::faulted);
    if (phase_ != Phase::remote) choose_controlwords();
    if (task_.cam != nullptr) task_.cam->step(loop_);  // before its slaves
    const bool serves = phase_ == Phase::remote;
    const auto sets = serves ? serve() : task_.serve && phase_ == Phase::stop ? stop_served() : set_points();
    if (task_.cam != nullptr && task_.cam->tuning() != nullptr)  // behind their set-points
      task_.cam->tune(loop_, remote_[task_.cam->tuning()->axis()].cam().take_tuning());
    if (kept_off_ != Fault::none) loop_.trip(kept_off_);
    if (task_.cam != nullptr) switch_tracks();
    const std::int64_t now_ns = loop_.now_ns();
    loop_.tick(sets);
    if (phase_ == Phase::motion && trace_ != nullptr)
      trace_->add(now_ns - motion_began_ns_, loop_.loop().signals(),
                  [this](std::size_t i) { return loop_.drive(i).origin(); });
    log_events();
    ++tick_;
    advance();
    progress_.store(tick_, std::memory_order_relaxed);
  }

  // Where others ask for what the axes do while the programme serves; without it they stay off.
  std::span<RemoteAxis> remote() { return remote_; }
  // The tuner of a cam on that `axis`; null: none.
  const TunedAxis* tuning(std::size_t axis) const {
    const TunedAxis* const tuned = task_.cam != nullptr ? task_.cam->tuning() : nullptr;
    return tuned != nullptr && tuned->axis() == axis ? tuned : nullptr;
  }
  // As others see it: what serves adds its bits to the drive's, and that a bus is obeyed.
  std::uint16_t statusword(std::size_t axis) const {
    if (phase_ != Phase::remote) return loop_.statusword(axis);
    return static_cast<std::uint16_t>(remote_[axis].statusword(loop_.statusword(axis)) | statusword::remote_bit);
  }

  Phase phase() const { return phase_; }
  bool over() const { return phase_ == Phase::over; }
  bool faulted() const { return faulted_; }
  std::uint64_t progress() const { return progress_.load(std::memory_order_relaxed); }  // any thread

 private:
  // After a fault the last frames still say that the power is off.
  static constexpr std::uint64_t settling_ticks = 1600;

  void enter(Phase phase) {
    phase_ = phase;
    in_phase_ = 0;
  }

  void choose_controlwords() {
    const bool off = phase_ == Phase::stop || phase_ == Phase::over;
    for (std::size_t i = 0; i < loop_.axis_count(); ++i) {
      const bool homes = phase_ == Phase::home && !loop_.drive(i).referenced();
      loop_.set_mode(i, homes ? OperationMode::homing : OperationMode::cyclic_position);
      loop_.set_braking(i, false);
      loop_.set_along(i, false);
      std::uint16_t word = off ? controlword::shutdown : controlword_to_enable(loop_.state(i));
      if (phase_ == Phase::faulted) word = controlword::shutdown;
      if (homes) word |= controlword::homing_start_bit;
      loop_.set_controlword(i, word);
    }
  }

  // Behind the axes, which follow or do not from this tick on.
  void switch_tracks() {
    const bool runs = phase_ == Phase::motion || phase_ == Phase::remote;
    const std::uint32_t on = task_.cam->step_tracks(runs && !loop_.faulted() && kept_off_ == Fault::none);
    for (std::size_t k = 0; k < CamDrive::tracks; ++k)
      if (const std::uint32_t bit = std::uint32_t{1} << k; ((on ^ tracks_on_) & bit) != 0)
        loop_.set_output(k, (on & bit) != 0);
    tracks_on_ = on;
  }

  // What others ask for, in this tick.
  std::span<const SetPoint<S>> serve() {
    for (std::size_t i = 0; i < hold_.size(); ++i) {
      auto& remote = remote_[i];
      hold_[i] = remote.tick(loop_.drive(i));
      loop_.set_controlword(i, remote.controlword());
      loop_.set_mode(i, remote.mode());
      loop_.set_braking(i, remote.brakes());
      loop_.set_along(i, remote.along());
      loop_.set_velocity_offset(i, remote.velocity_offset());
      if (const Fault fault = remote.fault(); fault != Fault::none) loop_.trip(i, fault);
    }
    return hold_;
  }

  // The end of what others asked for: by the ramps of the drives, and along a cam where that is gentler.
  std::span<const SetPoint<S>> stop_served() {
    for (std::size_t i = 0; i < hold_.size(); ++i) {
      auto& remote = remote_[i];
      hold_[i] = {loop_.drive(i).set_position(), {}, {}};
      if (!is_coupled(remote.mode())) continue;
      hold_[i] = remote.tick(loop_.drive(i));
      loop_.set_along(i, remote.along());
      loop_.set_mode(i, remote.mode());
    }
    return hold_;
  }

  std::span<const SetPoint<S>> set_points() {
    if (phase_ == Phase::approach) return task_.approach.at(in_phase_);
    if (phase_ == Phase::motion && !follows_cam()) return task_.motion.at(in_phase_);
    // Where each axis' set-point stands; behind a motion that ended moving, the drives' ramp takes over.
    for (std::size_t i = 0; i < hold_.size(); ++i) hold_[i] = {loop_.drive(i).set_position(), {}, {}};
    if (phase_ == Phase::motion) hold_[task_.cam->own_axis()] = task_.cam->set_point();
    return hold_;
  }

  // After a tick: whether the phase is over.
  void advance() {
    ++in_phase_;
    switch (phase_) {
      case Phase::enable:
        if (loop_.all_in(DriveState::operation_enabled) && none_preparing()) enter(Phase::home);
        break;
      case Phase::home:
        if (all_referenced() && loop_.loop().slow()) begin_motion();
        break;
      case Phase::approach:
        if (in_phase_ == task_.approach.ticks()) begin_motion();
        break;
      case Phase::motion:
        if (follows_cam()) {
          if (in_phase_ == task_.cam_ticks) task_.cam->brake();
          if (task_.cam->stopped()) enter(Phase::stop);
        } else if (in_phase_ == task_.motion.ticks()) {
          enter(task_.idle_ticks > 0 ? Phase::idle : Phase::stop);
        }
        break;
      case Phase::idle:
        if (in_phase_ >= task_.idle_ticks) enter(Phase::stop);
        break;
      case Phase::remote:
        break;
      case Phase::stop:
      case Phase::faulted:
        faulted_ |= loop_.faulted();
        if (none_powered() && in_phase_ >= settled_after()) enter(Phase::over);
        break;
      case Phase::over:
        break;
    }
  }

  bool follows_cam() const { return task_.cam_ticks > 0; }

  // A controlled stop: of a cam with its master, of all else by the ramps of the drives.
  void begin_stop() {
    if (phase_ == Phase::motion && follows_cam())
      task_.cam->brake();
    else
      enter(Phase::stop);
  }

  void begin_motion() {
    if (phase_ == Phase::home && task_.approach.ticks() > 0) return enter(Phase::approach);
    if (task_.motion.ticks() == 0 && !follows_cam()) return enter(Phase::idle);
    enter(Phase::motion);
    if (follows_cam()) task_.cam->begin();
    motion_began_ns_ = loop_.now_ns();
  }

  // A fault takes the power at once and leaves the carriage coasting.
  std::uint64_t settled_after() const { return phase_ == Phase::faulted ? settling_ticks : 1; }

  bool all_referenced() const {
    for (std::size_t i = 0; i < loop_.axis_count(); ++i)
      if (!loop_.drive(i).referenced()) return false;
    return true;
  }
  // Commutation and brake are tested before a motion begins.
  bool none_preparing() const {
    for (std::size_t i = 0; i < loop_.axis_count(); ++i)
      if (loop_.drive(i).preparing()) return false;
    return true;
  }
  bool none_powered() const {
    for (std::size_t i = 0; i < loop_.axis_count(); ++i)
      if (loop_.drive(i).powered()) return false;
    return true;
  }

  void log_events() {
    hal::AxisEvent<S> event;
    while (loop_.next_event(event))
      log_.push(event.event.time_ns, LogLevel::error, "axis {}: fault {} '{}' while {} at {} nm",
                {event.axis, static_cast<int>(event.event.fault), stiction::name_of(event.event.fault), name_of(phase_),
                 nanometres(event.event.position)});
    for (std::size_t i = 0; i < remote_.size(); ++i) say_refused(i);
    const auto compensations = loop_.loop().compensations();
    for (std::size_t i = 0; i < compensations.size(); ++i) {
      if (compensations[i].dropped() && !dropped_[i])
        log_.push(
            loop_.now_ns(), LogLevel::warning,
            "axis {}: the learned table made the error grow and was dropped; the friction feedforward acts without it",
            {i});
      dropped_[i] = compensations[i].dropped();
    }
  }

  // Of the machine's coordinates, rounded.
  static std::int64_t nanometres(typename S::Position x) {
    return static_cast<std::int64_t>(std::llround(static_cast<double>(x.raw()) * (1e9 / 0x1p40)));
  }

  // At most ten a second: a controller repeats what is refused.
  void say_refused(std::size_t axis) {
    constexpr std::int64_t pause_ns = 100'000'000;
    auto& said = said_refusals_[axis];
    const auto refusal = remote_[axis].refusal();
    if (refusal == said.refusal || loop_.now_ns() - said.time_ns < pause_ns) return;
    said = {refusal, loop_.now_ns()};
    if (refusal == Refusal::none) return;
    log_.push(loop_.now_ns(), LogLevel::warning, "axis {}: {}; it is refused",
              {axis, refusal_table[static_cast<std::size_t>(refusal)].text});
  }

  struct SaidRefusal {
    Refusal refusal = Refusal::none;
    std::int64_t time_ns = INT64_MIN / 2;
  };

  hal::DriveLoop<B>& loop_;
  const Task& task_;
  LogRing& log_;
  Trace* trace_;
  std::vector<SetPoint<S>> hold_;
  std::vector<RemoteAxis> remote_;
  std::vector<char> dropped_;  // learned tables
  std::vector<SaidRefusal> said_refusals_;
  Phase phase_ = Phase::enable;
  Fault kept_off_ = Fault::none;
  std::uint64_t in_phase_ = 0;  // ticks
  std::uint64_t tick_ = 0;
  std::atomic<std::uint64_t> progress_ = 0;
  std::int64_t motion_began_ns_ = 0;
  bool faulted_ = false;
  std::uint32_t tracks_on_ = 0;  // of the cam switch
};

}  // namespace stiction::drive
