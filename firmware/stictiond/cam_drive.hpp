// The electronic cam of the drive: the tables of --cam, the master of --master, and a cam mode an axis. Built and
// checked before anything is enabled; allocates nothing after construction.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "firmware/stictiond/configuration.hpp"
#include "firmware/stictiond/options.hpp"
#include "firmware/stictiond/tuned_axis.hpp"
#include "hal/can/frames.hpp"
#include "hal/drive_loop.hpp"
#include "stiction/drive/cam_mode.hpp"
#include "stiction/drive/master_encoder.hpp"
#include "stiction/motion/cam_switch.hpp"

namespace stiction::drive {

class CamDrive {
 public:
  using S = FixedSignals;

  // Throws StartRefused where a table is damaged, of a different kind or cycle, not continuous, or beyond the limits of
  // every axis. `options`: of the command line, with a --master; `configuration`: of the drive.
  CamDrive(const DriveOptions& options, const DriveConfiguration& configuration);
  CamDrive(const CamDrive&) = delete;
  CamDrive& operator=(const CamDrive&) = delete;
  ~CamDrive() = default;

  // The master of the coming tick, before its axes. `loop`: of all axes.
  template <hal::Backend B>
  void step(const hal::DriveLoop<B>& loop) {
    if (encoder_) {
      const auto place = encoder_->step();
      master_.see(place.cycles, place.part, place.valid);
    } else if (!master_axis_) {
      master_.step();
    } else {
      // That of the tick before; the estimator looks a tick ahead.
      const auto& drive = loop.drive(*master_axis_);
      master_.see(drive.set_position().raw(), drive.powered());
    }
  }

  // The tracks of the cam switch that are on, by the master of the coming tick: while an axis follows a curve, without
  // a fault. `wanted`: false where the programme stops. Behind step(), once a tick.
  std::uint32_t step_tracks(bool wanted);
  static constexpr std::size_t tracks = 8;
  bool has_tracks() const { return has_tracks_; }

  // A frame of the encoder's bus that came for the coming tick; any other is left alone. `age_ns`: since it came.
  void take(const hal::can::Frame& frame, std::int64_t age_ns);
  int encoder_node() const { return encoder_node_; }  // 0: the master is none

  static constexpr double longest_stop = 2.0;  // s

  // Of [drive.cam_tuning]; null: none.
  TunedAxis* tuning() { return tuning_.get(); }
  // Behind the set-points of a tick, before loop.tick(). `loop`: of all axes; `asked`: by a client, a number of
  // CamTuningCommand.
  template <hal::Backend B>
  void tune(hal::DriveLoop<B>& loop, std::uint8_t asked) {
    if (asked != 0) tuning_->ask(static_cast<CamTuningCommand>(asked));
    const std::size_t axis = tuning_->axis();
    const auto& limiting = loop.loop().signals()[axis].limiting;
    tuning_->step(modes_[axis], loop.load(axis, tuning_->own_encoder()), limiting.current || limiting.voltage);
  }

  std::optional<std::size_t> master_axis() const { return master_axis_; }
  CamMaster& master() { return master_; }
  CamMode& mode(std::size_t axis) { return modes_[axis]; }

  // A motion of the programme's own: the first axis that is not the master follows the first table.
  std::size_t own_axis() const { return own_axis_; }
  // Where it begins, m.
  double start() const { return start_; }
  // Stands there, and follows a virtual master to its largest speed from the coming tick on.
  void begin();
  // The set-point of that axis, behind step().
  SetPoint<S> set_point() { return modes_[own_axis_].step(master_.reading()); }
  // A controlled stop: along the cam, with the master, where that takes no longer than longest_stop; else the axis
  // leaves the cam within its limits.
  void brake() {
    if (braking_) return;
    braking_ = true;
    master_.run(0);
    if (!short_stop_) modes_[own_axis_].leave_to_rest();
  }
  bool stopped() const { return braking_ && (short_stop_ ? master_.at_rest() : modes_[own_axis_].at_rest()); }

 private:
  struct LoadedTable {
    std::vector<std::uint8_t> bytes;
    CamTable table;
  };

  void load(const std::string& file);
  void check_kinds(const std::string& file, const CamTable::Header& header) const;
  void set_up_tracks(const DriveConfiguration& configuration);
  void find_master(const DriveOptions& options, const DriveConfiguration& configuration);
  void set_up_encoder(const DriveConfiguration& configuration, CamMaster::Config& config);
  void set_up_master(const DriveOptions& options, const DriveConfiguration& configuration);
  void set_up_axes(const DriveConfiguration& configuration, bool serves);
  void check_limits(const DriveConfiguration& configuration, bool serves) const;
  void set_up_tuning(const DriveConfiguration& configuration, bool serves);

  std::vector<std::string> files_;
  std::deque<LoadedTable> loaded_;  // their addresses stay
  std::vector<CamMode::Table> tables_;
  CamTable::Kind master_kind_ = CamTable::Kind::rotary;
  double cycle_ = 0.0;          // of the master, rad or m
  double speed_ = 0.0;          // largest, cycles/s
  std::int64_t run_speed_ = 0;  // the same, 2^-64 cycles a tick
  std::optional<std::size_t> master_axis_;
  int encoder_node_ = 0;
  std::optional<MasterEncoder> encoder_;
  double ticks_a_ns_ = 0.0;
  std::size_t own_axis_ = 0;
  double start_ = 0.0;
  bool short_stop_ = true, braking_ = false;
  MotionLimits master_limits_{}, phasing_limits_{};
  std::deque<CamMode::Config> configs_;
  CamMaster master_{CamMaster::Config{}};
  std::deque<CamMode> modes_;
  std::array<CamSwitch::Track, tracks> tracks_{};
  CamSwitch::State track_state_{};
  CamSwitch::Forces track_forces_{};
  bool has_tracks_ = false;
  std::unique_ptr<TunedAxis> tuning_;
};

}  // namespace stiction::drive
