// The electronic cam of an axis: set-points that follow a master along a curve, and every way into it, from one curve
// to the next, and out. Nothing ever jumps. There is one motion at a time that is aimed at, a curve or a free one
// (standing or at constant speed), and a bridge to it from the one before, which begins with just the position, speed
// and acceleration that the slave has in that tick (bridge.hpp). Engaging, switching tables, scales and offsets,
// leaving, the end of a once-only cam and faults are all this one step: a different aim, and what it leaves is bridged.
//
// A bridge begins only where its own largest velocity, acceleration and jerk, and those of the new curve at the
// master's largest speed, keep the slave's limits together; else it is refused, and the motion before goes on. A stop
// is always possible: SpeedRampRule gives its length for any motion within the limits.
//
// The master is to be taken before its slaves in a tick; two of them then see the same place.
#pragma once

#include <cstdint>

#include "stiction/motion/bridge.hpp"
#include "stiction/motion/cam_curve.hpp"
#include "stiction/motion/cam_request.hpp"
#include "stiction/motion/master_position.hpp"
#include "stiction/motion/motion_point.hpp"
#include "stiction/motion/smooth_offset.hpp"

namespace stiction {

class CamMotion {
 public:
  struct Config {
    MotionLimits slave{};       // what the axis keeps
    MotionLimits master{};      // what the master keeps, in cycles; beyond it, it is a fault
    MotionLimits phasing{};     // of the master's phase as the slave sees it
    std::int64_t jump = 1024;   // 2^-40 cycles: farther from where its speed leads no master may be
    SpeedRampRule ramp{};       // of `slave`
    MotionLimits master_sum{};  // master and phasing together

    // `slave`: limits of the axis; `master`, `phasing`: in cycles; `jump`: 2^-40 cycles, of which a quantised master
    // needs more.
    static constexpr Config of(const MotionLimits& slave, const MotionLimits& master, const MotionLimits& phasing,
                               std::int64_t jump) {
      return {
          slave,
          master,
          phasing,
          jump,
          SpeedRampRule::of(slave),
          {master.velocity + phasing.velocity, master.acceleration + phasing.acceleration, master.jerk + phasing.jerk}};
    }
  };

  // `config`: of the axis; it must stay as long as the motion does.
  explicit constexpr CamMotion(const Config& config) : config_(&config) {}

  // Stands at `position`, 2^-40 units, and follows nothing.
  constexpr void start(std::int64_t position) {
    point_ = {position, 0, 0};
    free_ = {position, 0, 0};
    follows_ = waits_ = seen_ = false;
    bridge_.clear();
    phasing_.start(0);
    status_ = {};
  }

  // Takes `request` in the place of one that waits. What it returns is also in the status, where a request is refused
  // later.
  constexpr CamRefusal engage(const CamRequest& request) {
    status_.command_aborted = waits_;
    waits_ = false;
    status_.refusal = take(request);
    if (status_.refusal != CamRefusal::none) return status_.refusal;
    request_ = request;
    waits_ = true;
    triggered_ = request.trigger == CamTrigger::at_once;
    watched_ = false;
    tried_ = 0;
    status_.fault = CamFault::none;
    return CamRefusal::none;
  }

  // Deletes what waits.
  constexpr void cancel() {
    status_.command_aborted = waits_;
    waits_ = false;
  }

  // Leaves the curve, from wherever it is, to `speed`, 2^-52 units a tick: 0 is a stop.
  constexpr CamRefusal leave(std::int64_t speed) {
    if (magnitude(speed) > static_cast<std::uint64_t>(config_->slave.velocity))
      return status_.refusal = CamRefusal::speed;
    cancel();
    go_free(point_, speed);
    return status_.refusal = CamRefusal::none;
  }

  // Moves the master's phase as the slave sees it to `offset`, 2^-40 cycles, within the limits of phasing.
  constexpr void phase(std::int64_t offset) { phasing_.go(offset); }

  // The set-point of the coming tick. `measured`: the master of this tick; `valid`: whether it is known; `own`: it is
  // made for this slave alone, which keeps its limits behind it, whatever those of the master are.
  constexpr MotionPoint step(const MasterPoint& measured, bool valid = true, bool own = false) {
    status_.end_of_profile = false;
    const MotionPoint offset = phasing_.advance();
    const MasterPoint master{measured.position + MasterPosition::way(offset.position),
                             measured.velocity + offset.velocity, measured.acceleration + offset.acceleration};
    const CamFault fault = own     ? CamFault::none
                           : seen_ ? fault_of(measured, valid)
                           : valid ? CamFault::none
                                   : CamFault::master_lost;
    if (fault != CamFault::none && (follows_ || waits_)) end_by(fault);
    advance(master);
    // A tick has one way tried: both take turns.
    const bool tried = waits_ && !(planned_ && triggered_ && phasing_.plans()) && try_request(measured, master);
    if (!tried) phasing_.plan(config_->phasing);
    planned_ = tried;
    expected_ = measured.position +
                MasterPosition::way((measured.velocity + measured.acceleration / (2 << MotionPoint::tick_bits)) >>
                                    MotionPoint::tick_bits);
    seen_ = valid;
    status_.active = follows_;
    status_.waiting = waits_;
    status_.in_sync = follows_ && !bridge_.active();
    status_.busy = follows_ || waits_ || bridge_.active();
    return point_;
  }

  constexpr const CamStatus& status() const { return status_; }
  constexpr const MotionPoint& point() const { return point_; }
  // The curve that is followed, or was last.
  constexpr const CamCurve* curve() const { return curve_; }
  constexpr const SmoothOffset& phasing() const { return phasing_; }
  // Whether it stands and nothing will move it but a request.
  constexpr bool at_rest() const { return !follows_ && !bridge_.active() && free_.speed == 0; }
  // Ticks that are left of a bridge over ticks.
  constexpr std::int64_t ticks_left() const {
    return bridge_.active() && bridge_.over() == Bridge::Over::ticks ? bridge_.length() - bridge_.gone() : 0;
  }

 private:
  // A free motion: standing, or at a constant speed, whose part below 2^-40 is kept.
  struct Free {
    std::int64_t position = 0;
    std::int64_t speed = 0;  // 2^-52 units a tick
    std::int64_t rest = 0;   // 2^-52 units
  };

  // What a relative begin adds to a curve.
  struct Shift {
    MasterPosition master{};  // as the curve sees it
    std::int64_t slave = 0;   // 2^-40 units
  };

  static constexpr MasterPoint seen(const CamCurve& curve, const Shift& shift, const MasterPoint& master) {
    MasterPoint x = curve.seen(master);
    x.position = x.position + shift.master;
    return x;
  }

  constexpr CamFault fault_of(const MasterPoint& now, bool valid) const {
    if (!valid) return CamFault::master_lost;
    const auto beyond = [](std::int64_t x, std::int64_t most) {
      return magnitude(x) > static_cast<std::uint64_t>(most) + 1;
    };
    if (beyond(now.velocity, config_->master.velocity) || beyond(now.acceleration, config_->master.acceleration))
      return CamFault::master_too_fast;
    return beyond((now.position - expected_).raw(), config_->jump) ? CamFault::master_jumped : CamFault::none;
  }

  constexpr void end_by(CamFault fault) {
    status_.fault = fault;
    status_.command_aborted = true;
    waits_ = false;
    if (follows_) go_free(point_, 0);
  }

  // Aims at a free motion of `speed` from where the slave is at `now`; the place is what the bridge makes it.
  constexpr void go_free(const MotionPoint& now, std::int64_t speed) {
    const std::int64_t difference = now.velocity - speed;
    follows_ = false;
    if (difference == 0 && now.acceleration == 0) {
      free_ = {now.position, speed, 0};
      bridge_.clear();
      return;
    }
    const Span span = Span::of(config_->ramp.ticks(difference));
    free_ = {now.position - bridge_.start_speed(span, difference, now.acceleration), speed, 0};
  }

  // The motion that is aimed at and its bridge, a tick on.
  constexpr void advance(const MasterPoint& master) {
    if (!follows_) {
      free_.rest += free_.speed;
      free_.position += free_.rest >> MotionPoint::tick_bits;
      free_.rest &= (std::int64_t{1} << MotionPoint::tick_bits) - 1;
      bridge_.tick();
      point_ = MotionPoint{free_.position, free_.speed, 0} + bridge_.point();
      return;
    }
    const MasterPoint x = seen(*curve_, shift_, master);
    CamSlopes slopes = curve_->slopes(x.position);
    slopes.position += shift_.slave;
    const bool over_distance = bridge_.active() && bridge_.over() == Bridge::Over::distance;
    if (over_distance) {
      const std::int64_t gone = (x.position - begin_).raw(), ahead = backward_ ? -gone : gone;
      if (ahead <= 0) {
        // At its begin and before it the slave stands, as it did.
        point_ = {free_.position, 0, 0};
        cycles_ = x.position.cycles;
        return;
      }
      bridge_.go_to(ahead);
      const MotionPoint deviation = bridge_.point();
      slopes.position += deviation.position;
      slopes.slope += backward_ ? -deviation.velocity : deviation.velocity;
      slopes.bend += deviation.acceleration;
    }
    point_ = CamCurve::chained(slopes, x);
    if (!over_distance) {
      bridge_.tick();
      point_ = point_ + bridge_.point();
    }
    if (x.position.cycles != cycles_) status_.end_of_profile = true;
    cycles_ = x.position.cycles;
    if (curve_->outside(x.position)) {
      status_.end_of_profile = true;
      go_free(point_, 0);
    }
  }

  // What is wrong with a request from the beginning; where nothing is, what it leaves of the limits for a bridge is
  // kept.
  constexpr CamRefusal take(const CamRequest& request) {
    if (request.goal == CamGoal::position) {
      if (request.approach == CamApproach::distance) return CamRefusal::moving;
      room_ = config_->slave;
      return CamRefusal::none;
    }
    if (request.curve == nullptr) return CamRefusal::scale;
    const MotionLimits needed = request.curve->motion(config_->master_sum);
    if (!within(needed)) return CamRefusal::beyond_limits;
    room_ = {config_->slave.velocity - needed.velocity, config_->slave.acceleration - needed.acceleration,
             config_->slave.jerk - needed.jerk};
    return CamRefusal::none;
  }
  constexpr bool within(const MotionLimits& needed) const {
    return needed.velocity <= config_->slave.velocity && needed.acceleration <= config_->slave.acceleration &&
           needed.jerk <= config_->slave.jerk;
  }

  // Whether the master passes the place of the request's trigger; `x`: the master as its curve sees it.
  constexpr bool passed(const MasterPoint& measured, const MasterPoint& x) {
    const auto passes = [this](std::int64_t side) {
      const bool passed = watched_ && ((side >= 0) != (side_ >= 0)) && near(side);
      side_ = side;
      watched_ = true;
      return passed;
    };
    if (request_.trigger == CamTrigger::master_position) return passes((measured.position - request_.at).raw());
    if (request_.trigger == CamTrigger::cam_position)
      return passes(static_cast<std::int64_t>(x.position.phase - request_.at.phase));
    const std::int64_t cycles = follows_ ? cycles_ : x.position.cycles;
    const bool begins = watched_ && cycles != side_;
    side_ = cycles;
    watched_ = true;
    return begins;
  }
  // Whether what the slave is `off` the new motion is within the tolerance of the request.
  constexpr bool agrees(const MotionPoint& off) const {
    const auto within = [](std::int64_t d, std::int64_t most) { return magnitude(d) <= magnitude(most); };
    return within(off.position, request_.tolerance.position) && within(off.velocity, request_.tolerance.velocity) &&
           within(off.acceleration, request_.tolerance.acceleration);
  }
  // Half a cycle on the other side the sign changes too.
  static constexpr bool near(std::int64_t side) { return magnitude(side) < std::uint64_t{1} << 62; }
  // Aims at what waits, once its trigger is reached and there is room; whether a way was tried.
  constexpr bool try_request(const MasterPoint& measured, const MasterPoint& master) {
    return request_.goal == CamGoal::position ? try_position(measured, master) : try_curve(measured, master);
  }

  constexpr bool try_position(const MasterPoint& measured, const MasterPoint& master) {
    const MotionPoint off = point_ - MotionPoint{request_.position, 0, 0};
    triggered_ = triggered_ || (request_.trigger == CamTrigger::curves_agree ? agrees(off) : passed(measured, master));
    if (!triggered_) return false;
    if (bridge_to(off)) {
      free_ = {request_.position, 0, 0};
      follows_ = false;
    }
    return true;
  }

  constexpr bool try_curve(const MasterPoint& measured, const MasterPoint& master) {
    const CamCurve& next = *request_.curve;
    Shift shift{};
    MasterPoint x = next.seen(master);
    const bool by_place = request_.trigger != CamTrigger::curves_agree;
    if (by_place && !triggered_) triggered_ = passed(measured, x);
    if (by_place && !triggered_) return false;
    // A relative begin is that of the tick in which it comes to it, tried again where there was no room.
    if (triggered_ && request_.master_relative) {
      shift.master = next.config().master_offset - x.position;
      x.position = next.config().master_offset;
    }
    const CamSlopes slopes = next.slopes(x.position);
    // From standstill over a distance the place alone is needed.
    const bool over_distance = triggered_ && request_.approach == CamApproach::distance;
    MotionPoint off = point_ - (over_distance ? MotionPoint{slopes.position, 0, 0} : CamCurve::chained(slopes, x));
    if (!triggered_) {
      // A curve is looked at once a tick: one that begins where the master is does so in the tick behind.
      triggered_ = agrees(off);
      if (!triggered_ || request_.master_relative) return false;
    }
    if (next.outside(x.position)) {
      refuse(CamRefusal::outside_profile);
      return false;
    }
    if (request_.slave_relative) {
      shift.slave = off.position;
      off.position = 0;
    }
    if (request_.approach == CamApproach::distance) {
      begin_distance(shift, x, slopes, off.position);
    } else if (bridge_to(off)) {
      if (request_.free_way) shift.slave += off.position - bridge_.point().position;
      follow(shift, x);
    }
    return true;
  }

  constexpr void refuse(CamRefusal reason) {
    status_.refusal = reason;
    waits_ = false;
  }

  constexpr void follow(const Shift& shift, const MasterPoint& x) {
    curve_ = request_.curve;
    shift_ = shift;
    follows_ = true;
    waits_ = false;
    cycles_ = x.position.cycles;
  }

  // Begins the bridge of the request from `off`, where it keeps within the room that there is; a length a tick.
  constexpr bool bridge_to(const MotionPoint& off) {
    const bool given = request_.approach == CamApproach::ticks;
    const std::int64_t ticks = given ? request_.span.length : BridgeLengths::ticks(tried_);
    const Span span = given ? request_.span : BridgeLengths::span(tried_);
    const bool free_way = request_.free_way && request_.goal == CamGoal::curve;
    if (free_way ? Bridge::fits_speed(off.velocity, off.acceleration, ticks, room_) : Bridge::fits(off, ticks, room_)) {
      if (free_way)
        bridge_.start_speed(span, off.velocity, off.acceleration);
      else
        bridge_.start(span, off, Bridge::Over::ticks);
      waits_ = false;
      return true;
    }
    try_next(given);
    return false;
  }
  constexpr void try_next(bool given) {
    // A bridge that still runs may be what leaves no room.
    const bool again = !given && bridge_.active();
    if (given || ++tried_ == BridgeLengths::count) {
      tried_ = 0;
      if (!again) refuse(CamRefusal::no_bridge);
    }
  }

  // Begins a bridge over a distance of the master, which the curve of the request sees at `x`, from standstill; the
  // slave is `off` the curve, whose slopes are `slopes`.
  constexpr void begin_distance(const Shift& shift, const MasterPoint& x, const CamSlopes& slopes, std::int64_t off) {
    if (follows_ || bridge_.active() || free_.speed != 0) return refuse(CamRefusal::moving);
    const MotionPoint from{off, request_.backward ? slopes.slope : -slopes.slope, -slopes.bend};
    const CamPeaks& peaks = request_.curve->peaks();
    const CamPeaks of_bridge = Bridge::peaks(from, request_.span);
    const CamPeaks sum{peaks.slope + of_bridge.slope, peaks.bend + of_bridge.bend, peaks.third + of_bridge.third};
    if (!within(sum.motion(request_.curve->behind_ratio(config_->master_sum)))) return refuse(CamRefusal::no_bridge);
    begin_ = x.position;
    backward_ = request_.backward;
    bridge_.start(request_.span, from, Bridge::Over::distance);
    follow(shift, x);
  }

  const Config* config_;
  MotionPoint point_{};              // the set-point of the last tick
  Free free_{};                      // of a bridge over a distance, the standstill before it
  const CamCurve* curve_ = nullptr;  // followed, where follows_
  Shift shift_{};                    // by which
  Bridge bridge_{};
  SmoothOffset phasing_{};
  CamRequest request_{};       // where waits_
  MotionLimits room_{};        // for its bridge
  MasterPosition expected_{};  // where the master's speed of the last tick leads
  MasterPosition begin_{};
  std::int64_t cycles_ = 0;  // of the master as seen, in the last tick
  std::int64_t side_ = 0;    // of the trigger, in the last tick
  std::int8_t tried_ = 0;    // number of the next length
  bool follows_ = false, waits_ = false, triggered_ = false, watched_ = false, seen_ = false, backward_ = false,
       planned_ = false;
  CamStatus status_{};
};

}  // namespace stiction
