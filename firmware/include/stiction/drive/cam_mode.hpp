// An axis in the modes of cam and gear (6060h = -1 and -2): what a bus asks for becomes a request to CamMotion, and the
// motion a set-point in each tick. The same bits drive the axis of the machine and that of `stiction simulate cam`.
//
// What is asked for stands in values that hold until changed, and acts with a command. A curve is prepared beside the
// ticks with a scale of 1; scale, offsets and ratio of a request are put to it in the tick of the command, with fixed
// work. The curve that is followed, the one that waits and the one of the next command have a place each.
//
// On top of it there is a share of what the axis keeps, for either a move or a second cam: the sum of two motions
// within their shares is within the limits.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "stiction/drive/cam_asked.hpp"
#include "stiction/drive/cam_layer.hpp"
#include "stiction/drive/cam_master.hpp"
#include "stiction/drive/cam_set_point.hpp"
#include "stiction/drive/faults.hpp"
#include "stiction/motion/cam_motion.hpp"

namespace stiction {

// The ramp of the drive that a stop along a cam takes the place of.
enum class CamStop : std::uint8_t { slow_down, quick_stop };

class CamMode {
 public:
  using S = FixedSignals;

  struct Config {
    CamMotion::Config motion{};
    S::Rate rate{};
    S::Position low{}, high{};        // the ends of the travel
    std::array<Span, 2> stops{};      // decelerations of the drive's ramps by CamStop, 2^-64 m a tick, a tick
    MotionLimits superposed{};        // of superposed moves, beside those of `motion`
    CamMotion::Config second{};       // of a second cam: the same share
    SpeedRampRule superposed_ramp{};  // of these
  };

  // A table that can be asked for.
  struct Table {
    CamCurve curve{};                // prepared with a scale of 1
    std::int64_t low = 0, high = 0;  // 2^-40 m: between which its positions are in a cycle
  };

  using Asked = CamAsked;

  // `config`: of the axis; `tables`: that can be asked for, by their number; both must outlive this.
  explicit constexpr CamMode(const Config& config, std::span<const Table> tables = {})
      : config_(&config), tables_(tables), first_(config.motion), second_(config_->second) {}
  CamMode(const CamMode&) = delete;
  CamMode& operator=(const CamMode&) = delete;
  ~CamMode() = default;

  // Stands at `position` and follows nothing.
  constexpr void start(S::Position position) {
    first_.start(position.raw());
    second_.start(0);
    superposed_.start(0);
    point_ = first_.motion.point();
    braking_ = false;
    fault_ = Fault::none;
    exchanging_ = shifted_ = false;
  }

  // Stands where `curve` is at a `master` that stands, and follows it from the first tick on. `curve`: must outlive
  // this. What it returns is not none where nothing follows.
  constexpr CamRefusal begin(const CamCurve& curve, const MasterPoint& master) {
    first_.motion.start(curve.slopes(curve.seen(master).position).position);
    CamRequest request;
    request.curve = &curve;
    refusal_ = first_.motion.engage(request);
    if (refusal_ != CamRefusal::none) return refusal_;
    first_.motion.step(master);
    return refusal_ = first_.motion.status().refusal;
  }

  constexpr Asked& asked() { return asked_; }
  constexpr const Asked& asked() const { return asked_; }

  // Does `command`. `gear`: in the mode of a gear, whose curve is a line; `referenced`: the zero of the position is
  // known, as are the ends of the travel then.
  constexpr CamRefusal command(CamCommand command, bool gear, bool referenced) {
    switch (command) {
      case CamCommand::engage:
        return refusal_ = braking_ ? CamRefusal::not_enabled : engage(first_, gear, referenced);
      case CamCommand::leave:
        return refusal_ = leave(asked_.leave_speed);
      case CamCommand::cancel:
        first_.cancel();
        second_.cancel();
        return refusal_ = CamRefusal::none;
      case CamCommand::phase:
        first_.motion.phase(asked_.phase);
        second_.motion.phase(asked_.phase);
        return refusal_ = CamRefusal::none;
      case CamCommand::superpose:
        if (!second_.motion.at_rest() || second_.motion.status().waiting) return refusal_ = CamRefusal::superposes;
        superposed_.go(asked_.superposed);
        return refusal_ = CamRefusal::none;
      case CamCommand::leave_to:
        return refusal_ = braking_ ? CamRefusal::not_enabled : leave_to(asked_.leave_position, referenced);
      case CamCommand::engage_second:
        return refusal_ = braking_             ? CamRefusal::not_enabled
                          : superposed_.busy() ? CamRefusal::superposes
                                               : engage(second_, false, false);
      case CamCommand::leave_second:
        return refusal_ = braking_ ? CamRefusal::not_enabled : second_.take({.goal = CamGoal::position}, nullptr, 0);
      case CamCommand::none:
        break;
    }
    return refusal_;
  }
  // From the next begin of a cycle on `table` takes the place of the table with that `number`, which is followed: the
  // same curve but for pulses within its rise. Whoever engages that number later gets it too. `table`: must outlive
  // this or the next exchange; null: the table of the number itself.
  constexpr CamRefusal exchange(std::uint16_t number, const Table* table) {
    if (number == 0 || number > tables_.size()) return CamRefusal::unknown_table;
    if (braking_ || first_.table != number || first_.undecided) return CamRefusal::not_enabled;
    const Table& next = table != nullptr ? *table : tables_[number - 1u];
    CamCurve::Config config = first_.motion.curve()->config();
    config.table = next.curve.config().table;
    config.rise = next.curve.config().rise;
    CamCurve& curve = free_place();
    const CamRefusal refusal = CamCurve::rescale(next.curve, config, curve);
    if (refusal != CamRefusal::none) return refusal;
    if (leaves_travel(next, curve)) return CamRefusal::beyond_travel;
    CamRequest request;
    request.curve = &curve;
    request.trigger = CamTrigger::next_cycle;
    const CamRefusal found = first_.take(request, &curve, number);
    if (found != CamRefusal::none) return found;
    exchanging_ = true;
    exchange_ = {number, table};
    return CamRefusal::none;
  }
  // From an exchange() on, until the curve is followed without a bridge, or the exchange was refused or replaced.
  constexpr bool exchanging() const { return exchanging_; }
  // What is followed in the place of the table `number`; null: that table.
  constexpr const Table* exchanged(std::uint16_t number) const {
    return number == exchanged_.number ? exchanged_.table : nullptr;
  }
  // Whether the curve that is followed is its table as it is: not scaled, begun neither where the axis nor where the
  // master was, and with no second cam on top.
  constexpr bool as_its_table() const {
    const CamCurve* curve = first_.motion.curve();
    return first_.table != 0 && !shifted_ && !second_.motion.status().active && second_.motion.at_rest() &&
           curve->config().slave_scale == std::int64_t{1} << 32 &&
           curve->config().ratio.numerator() == curve->config().ratio.denominator();
  }
  // The master as the curve that is followed sees it, in the last tick.
  constexpr MasterPoint seen() const {
    const CamCurve* curve = first_.motion.curve();
    return curve != nullptr ? curve->seen(seen_.point) : seen_.point;
  }
  // Of a command that was not given to it.
  constexpr void refuse(CamRefusal reason) { refusal_ = reason; }

  // Deletes what waits, leaves what is followed to standstill within the limits of the axis, and ends a superposed
  // move. What a second cam has added stays.
  constexpr void leave_to_rest() {
    superposed_.stop(config_->superposed_ramp);
    second_.leave_to_rest();
    if (!first_.motion.at_rest() || first_.motion.status().waiting) leave(0);
  }

  // Makes this axis one of those that brake together with `other` and its like: axes behind one master. All of them
  // must stay as long as one is used.
  constexpr void join(CamMode& other) {
    next_ = other.next_;
    other.next_ = this;
  }

  // Brakes along what is followed: from the coming tick on the master that this axis sees goes to standstill by itself,
  // so slowly that the axis needs no more than the deceleration of `stop` for the curve and for the braking together,
  // nor more than its limits. Three times as long as the ramp would take from the largest speed of the curve at that of
  // the master, or six times. False, and nothing changes, where no such way is found, or the axis is not in sync.
  //
  // Axes that joined and brake from the same tick on keep their phase: the slowest decides, and all of them see their
  // masters go the same way. One that would need more than twice as long as the first to brake is not waited for, since
  // it may not have to stop at all.
  constexpr bool brake(CamStop stop) {
    if (braking_) return true;
    const std::int64_t own = ticks_to_brake(stop);
    if (own == 0) return false;
    began_ = seen_.point;
    stop_ = stop;
    braking_ticks_ = ticks_together(stop, own);
    stopping_master_.brake_from(began_, braking_ticks_);
    return braking_ = true;
  }
  constexpr bool braking() const { return braking_; }
  // Whether the master of brake() stands.
  constexpr bool braked() const { return braking_ && stopping_master_.at_speed(); }

  // The set-point of the coming tick, at the `master` of that tick.
  constexpr SetPoint<S> step(const MasterReading& master) {
    seen_ = braking_ ? MasterReading{stopping_master_.step(), true} : master;
    point_ = first_.motion.step(seen_.point, seen_.valid, braking_) +
             second_.motion.step(seen_.point, seen_.valid, braking_) + superposed_.step(config_->superposed);
    fault_ = fault_of(first_.motion.status().fault);
    if (fault_ == Fault::none) fault_ = fault_of(second_.motion.status().fault);
    // Refused behind its trigger.
    const bool waited = first_.undecided;
    for (CamLayer* layer : {&first_, &second_})
      if (const CamRefusal found = layer->decide(); found != CamRefusal::none) refusal_ = found;
    settle_exchange(waited);
    return cam_set_point(point_, config_->rate);
  }

  constexpr const MotionPoint& point() const { return point_; }
  constexpr const CamStatus& status() const { return first_.motion.status(); }
  constexpr const CamStatus& second_status() const { return second_.motion.status(); }
  constexpr bool at_rest() const { return first_.motion.at_rest() && second_.motion.at_rest() && !superposed_.busy(); }
  constexpr bool superposes() const { return superposed_.busy(); }           // a move is on its way
  constexpr bool phasing() const { return first_.motion.phasing().busy(); }  // the phase is on its way
  constexpr std::uint16_t table() const { return first_.table; }             // that is followed; 0: none, or a gear
  constexpr std::uint16_t second_table() const { return second_.table; }     // the same of the second cam
  // Of the last command, and of what it asked for at its trigger.
  constexpr CamRefusal refusal() const { return refusal_; }
  // As long as the axis follows set-points and no request was taken again.
  constexpr Fault fault() const { return fault_; }

 private:
  // Behind decide(): what a decided request or exchange has changed. `waited`: whether there was one before.
  constexpr void settle_exchange(bool waited) {
    const CamStatus& status = first_.motion.status();
    const bool decided = waited && !first_.undecided;
    if (decided && status.refusal == CamRefusal::none && status.active) {
      shifted_ = exchanging_ ? shifted_ : waiting_shifted_;
      if (exchanging_) exchanged_ = exchange_;
    }
    if (!first_.undecided && (status.in_sync || !status.active)) exchanging_ = false;
  }

  // How long it takes to brake along the curve as brake() says, which it does not do yet; 0: it does not.
  constexpr std::int64_t ticks_to_brake(CamStop stop) const {
    const CamStatus& status = first_.motion.status();
    const CamStatus& second = second_.motion.status();
    if (!status.in_sync || status.waiting || first_.motion.phasing().busy() || superposed_.busy()) return 0;
    if ((second.busy || !second_.motion.at_rest()) && (!second.in_sync || second.waiting)) return 0;
    const Span& deceleration = config_->stops[static_cast<std::size_t>(stop)];
    const auto speed = static_cast<std::int64_t>(magnitude(seen_.point.velocity));
    const std::int64_t fastest = needed_behind({speed, 0, 0}).velocity;
    const std::int64_t ticks = 3 * deceleration.divide(fastest, MotionPoint::tick_bits) + 48;
    return may_brake_in(stop, ticks) ? ticks : may_brake_in(stop, 2 * ticks) ? 2 * ticks : 0;
  }

  // What the axis needs for the curves that it follows behind a `master`.
  constexpr MotionLimits needed_behind(const MotionLimits& master) const {
    const MotionLimits needed = first_.motion.curve()->motion(master);
    if (!second_.motion.status().active) return needed;
    const MotionLimits more = second_.motion.curve()->motion(master);
    return {sum(needed.velocity, more.velocity), sum(needed.acceleration, more.acceleration),
            sum(needed.jerk, more.jerk)};
  }
  static constexpr std::int64_t sum(std::int64_t a, std::int64_t b) { return a < INT64_MAX - b ? a + b : INT64_MAX; }

  // Whether the deceleration of `stop` and the limits of the axis are enough for braking in `ticks`.
  constexpr bool may_brake_in(CamStop stop, std::int64_t ticks) const {
    constexpr std::int64_t most_ticks = std::int64_t{1} << 20;
    if (ticks > most_ticks) return false;
    const MotionLimits& slave = config_->motion.slave;
    const auto speed = static_cast<std::int64_t>(magnitude(seen_.point.velocity));
    const auto change = static_cast<std::int64_t>(magnitude(seen_.point.acceleration));
    // Of the bridge of speed: at most v + a T / 4, |a| + 3/2 v / T and (4 |a| + 6 v / T) / T.
    const Span span = Span::of(ticks);
    const std::int64_t share = span.divide(speed, MotionPoint::tick_bits);
    const MotionLimits master{speed + product_shifted(change, ticks, MotionPoint::tick_bits + 2),
                              change + share + share / 2 + 1,
                              span.divide(4 * change + 6 * share, MotionPoint::tick_bits) + 1};
    const MotionLimits needed = needed_behind(master);
    return needed.acceleration <= config_->stops[static_cast<std::size_t>(stop)].length &&
           needed.acceleration <= slave.acceleration && needed.velocity <= slave.velocity && needed.jerk <= slave.jerk;
  }

  // The same for all that joined; `own`: of this axis alone. Who brakes first in a tick decides, and the others follow.
  constexpr std::int64_t ticks_together(CamStop stop, std::int64_t own) const {
    std::int64_t ticks = own;
    for (const CamMode* other = next_; other != this; other = other->next_) {
      if (other->braking_) {
        if (other->stop_ == stop && other->began_ == began_)
          return may_brake_in(stop, other->braking_ticks_) ? other->braking_ticks_ : own;
        continue;
      }
      // One that has had this tick does not brake from it on.
      const std::int64_t needed = other->seen_.point == began_ ? other->ticks_to_brake(stop) : 0;
      if (needed > ticks && needed <= 2 * own && may_brake_in(stop, needed)) ticks = needed;
    }
    return ticks;
  }

  constexpr CamRefusal leave(std::int64_t speed) {
    // The second cam is not to see a different master.
    if (braking_) second_.leave_to_rest();
    braking_ = false;
    return first_.leave(speed);
  }

  constexpr CamRefusal leave_to(std::int64_t position, bool referenced) {
    if (referenced && (position < config_->low.raw() || position > config_->high.raw()))
      return CamRefusal::beyond_travel;
    CamRequest request = asked_.request();
    request.goal = CamGoal::position;
    request.position = position;
    exchanging_ = false;
    waiting_shifted_ = shifted_;
    return first_.take(request, nullptr, 0);
  }

  constexpr CamRefusal engage(CamLayer& layer, bool gear, bool referenced) {
    if (!gear && (asked_.table == 0 || asked_.table > tables_.size())) return CamRefusal::unknown_table;
    const Table none{};
    const Table* exchanged = gear ? nullptr : this->exchanged(asked_.table);
    const Table& table = gear ? none : exchanged != nullptr ? *exchanged : tables_[asked_.table - 1u];
    if (&layer == &first_) exchanging_ = false;
    CamCurve::Config config = table.curve.config();
    config.ratio = GearRatio(asked_.numerator, asked_.denominator);
    config.master_offset = asked_.master_offset;
    config.slave_offset = asked_.slave_offset;
    config.slave_scale = gear ? std::int64_t{1} << 32 : asked_.slave_scale;
    if (gear) config.rise = asked_.gear_way;
    CamCurve& curve = free_place();
    const CamRefusal refusal = CamCurve::rescale(table.curve, config, curve);
    if (refusal != CamRefusal::none) return refusal;
    if (referenced && !gear && !asked_.slave_relative && leaves_travel(table, curve)) return CamRefusal::beyond_travel;
    CamRequest request = asked_.request();
    request.curve = &curve;
    request.free_way = gear && asked_.slave_relative;
    const CamRefusal found = layer.take(request, &curve, gear ? std::uint16_t{0} : asked_.table);
    if (found == CamRefusal::none && &layer == &first_)
      waiting_shifted_ = asked_.master_relative || asked_.slave_relative;
    return found;
  }

  // Of a curve that comes back to where it begins.
  constexpr bool leaves_travel(const Table& table, const CamCurve& curve) const {
    if (curve.config().rise != 0) return false;
    const std::int64_t a = product_shifted(table.low, curve.config().slave_scale, 32) + curve.config().slave_offset;
    const std::int64_t b = product_shifted(table.high, curve.config().slave_scale, 32) + curve.config().slave_offset;
    const std::int64_t low = a < b ? a : b, high = a < b ? b : a;
    return low < config_->low.raw() || high > config_->high.raw();
  }

  constexpr CamCurve& free_place() {
    std::size_t k = 0;
    const auto taken = [&](const CamLayer& layer) {
      return &places_[k] == layer.motion.curve() || &places_[k] == layer.waiting;
    };
    while (taken(first_) || taken(second_)) ++k;
    return places_[k];
  }

  const Config* config_;
  std::span<const Table> tables_;
  CamLayer first_, second_;
  SmoothOffset superposed_{};
  VirtualMaster stopping_master_{VirtualMaster::Config{}};  // that the axis sees while it brakes along its curve
  MasterReading seen_{{}, false};                           // in the last tick
  MotionPoint point_{};
  MasterPoint began_{};             // from which it does
  std::int64_t braking_ticks_ = 0;  // and how long
  const CamMode* next_ = this;      // of those that brake together, in a ring
  CamStop stop_ = CamStop::slow_down;
  bool braking_ = false;
  Asked asked_{};
  std::array<CamCurve, 5> places_{};
  struct Exchange {
    std::uint16_t number = 0;
    const Table* table = nullptr;
  };
  Exchange exchange_{}, exchanged_{};  // that waits, and in force
  bool exchanging_ = false;
  bool shifted_ = false, waiting_shifted_ = false;  // relative in master or slave
  CamRefusal refusal_ = CamRefusal::none;
  Fault fault_ = Fault::none;
};

}  // namespace stiction
