// An axis in the modes of cam and gear (6060h = -1 and -2): what a bus asks for becomes a request to CamMotion, and the
// motion a set-point in each tick. The same bits drive the axis of the machine and that of `stiction simulate cam`.
//
// What is asked for stands in values that hold until changed, and acts with a command. A curve is prepared beside the
// ticks with a scale of 1; scale, offsets and ratio of a request are put to it in the tick of the command, with fixed
// work. The curve that is followed, the one that waits and the one of the next command have a place each.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "stiction/drive/cam_master.hpp"
#include "stiction/drive/cam_set_point.hpp"
#include "stiction/drive/faults.hpp"
#include "stiction/motion/cam_motion.hpp"

namespace stiction {

enum class CamCommand : std::uint8_t {
  none,
  engage,    // MC_CamIn, MC_GearIn: with the values asked for; also to a different table, scale or offset on the run
  leave,     // MC_CamOut, to standstill or to the speed asked for
  cancel,    // deletes what waits
  phase,     // MC_Phasing: the phase asked for
  superpose  // MC_MoveSuperimposed: the displacement asked for, on top of what the axis follows or where it stands
};
inline constexpr int cam_commands = 6;

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
    SpeedRampRule superposed_ramp{};  // of these
  };

  // A table that can be asked for.
  struct Table {
    CamCurve curve{};                // prepared with a scale of 1
    std::int64_t low = 0, high = 0;  // 2^-40 m: between which its positions are in a cycle
  };

  struct Asked {
    std::uint16_t table = 1;  // from 1
    CamTrigger trigger = CamTrigger::at_once;
    CamApproach approach = CamApproach::catch_up;
    bool master_relative = false, slave_relative = false, backward = false;
    std::int64_t ticks = 16;         // of the approach by ticks
    std::int64_t distance = 1;       // of the approach by distance, 2^-40 cycles
    MasterPosition at{};             // of a trigger by position
    MotionPoint tolerance{};         // of curves that agree
    MasterPosition master_offset{};  // cam and gear
    std::int64_t slave_offset = 0;   // 2^-40 m
    std::int64_t slave_scale = std::int64_t{1} << 32;
    std::int32_t numerator = 1;  // of the ratio
    std::uint16_t denominator = 1;
    std::int64_t gear_way = 0;     // of the slave in a cycle of the master behind the ratio, 2^-40 m
    std::int64_t phase = 0;        // 2^-40 cycles
    std::int64_t leave_speed = 0;  // 2^-52 m a tick
    std::int64_t superposed = 0;   // 2^-40 m
  };

  // `config`: of the axis; `tables`: that can be asked for, by their number; both must outlive this.
  explicit constexpr CamMode(const Config& config, std::span<const Table> tables = {})
      : config_(&config), tables_(tables), motion_(config.motion), superposed_(config_->superposed) {}
  CamMode(const CamMode&) = delete;
  CamMode& operator=(const CamMode&) = delete;
  ~CamMode() = default;

  // Stands at `position` and follows nothing.
  constexpr void start(S::Position position) {
    motion_.start(position.raw());
    superposed_.start(0);
    point_ = motion_.point();
    braking_ = false;
    fault_ = Fault::none;
    table_ = 0;
    waiting_ = nullptr;
    exchanging_ = shifted_ = false;
  }

  // Stands where `curve` is at a `master` that stands, and follows it from the first tick on. `curve`: must outlive
  // this. What it returns is not none where nothing follows.
  constexpr CamRefusal begin(const CamCurve& curve, const MasterPoint& master) {
    motion_.start(curve.slopes(curve.seen(master).position).position);
    CamRequest request;
    request.curve = &curve;
    refusal_ = motion_.engage(request);
    if (refusal_ != CamRefusal::none) return refusal_;
    motion_.step(master);
    return refusal_ = motion_.status().refusal;
  }

  constexpr Asked& asked() { return asked_; }
  constexpr const Asked& asked() const { return asked_; }

  // Does `command`. `gear`: in the mode of a gear, whose curve is a line; `referenced`: the zero of the position is
  // known, as are the ends of the travel then.
  constexpr CamRefusal command(CamCommand command, bool gear, bool referenced) {
    switch (command) {
      case CamCommand::engage:
        return refusal_ = braking_ ? CamRefusal::not_enabled : engage(gear, referenced);
      case CamCommand::leave:
        return refusal_ = leave(asked_.leave_speed);
      case CamCommand::cancel:
        motion_.cancel();
        waiting_ = nullptr;
        return refusal_ = CamRefusal::none;
      case CamCommand::phase:
        motion_.phase(asked_.phase);
        return refusal_ = CamRefusal::none;
      case CamCommand::superpose:
        superposed_.go(asked_.superposed);
        return refusal_ = CamRefusal::none;
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
    if (braking_ || table_ != number || waiting_ != nullptr) return CamRefusal::not_enabled;
    const Table& next = table != nullptr ? *table : tables_[number - 1u];
    CamCurve::Config config = motion_.curve()->config();
    config.table = next.curve.config().table;
    config.rise = next.curve.config().rise;
    CamCurve& curve = free_place();
    const CamRefusal refusal = CamCurve::rescale(next.curve, config, curve);
    if (refusal != CamRefusal::none) return refusal;
    if (leaves_travel(next, curve)) return CamRefusal::beyond_travel;
    CamRequest request;
    request.curve = &curve;
    request.trigger = CamTrigger::next_cycle;
    const CamRefusal found = motion_.engage(request);
    if (found != CamRefusal::none) return found;
    waiting_ = &curve;
    waiting_table_ = number;
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
  // Whether the curve that is followed is its table as it is: not scaled, and begun neither where the axis nor where
  // the master was.
  constexpr bool as_its_table() const {
    return table_ != 0 && !shifted_ && motion_.curve()->config().slave_scale == std::int64_t{1} << 32 &&
           motion_.curve()->config().ratio.numerator() == motion_.curve()->config().ratio.denominator();
  }
  // The master as the curve that is followed sees it, in the last tick.
  constexpr MasterPoint seen() const {
    return motion_.curve() != nullptr ? motion_.curve()->seen(seen_.point) : seen_.point;
  }
  // Of a command that was not given to it.
  constexpr void refuse(CamRefusal reason) { refusal_ = reason; }

  // Deletes what waits, leaves what is followed to standstill within the limits of the axis, and ends a superposed
  // move.
  constexpr void leave_to_rest() {
    superposed_.stop(config_->superposed_ramp);
    if (!motion_.at_rest() || motion_.status().waiting) leave(0);
  }

  // Brakes along what is followed: from the coming tick on the master that this axis sees goes to standstill by itself,
  // so slowly that the axis needs no more than the deceleration of `stop` for the curve and for the braking together,
  // nor more than its limits. Three times as long as the ramp would take from the largest speed of the curve at that of
  // the master, or six times. False, and nothing changes, where no such way is found, or the axis is not in sync.
  constexpr bool brake(CamStop stop) {
    if (braking_) return true;
    const CamStatus& status = motion_.status();
    if (!status.in_sync || status.waiting || motion_.phasing().busy() || superposed_.busy()) return false;
    const Span& deceleration = config_->stops[static_cast<std::size_t>(stop)];
    const MotionLimits& slave = config_->motion.slave;
    const MasterPoint& now = seen_.point;
    const auto speed = static_cast<std::int64_t>(magnitude(now.velocity));
    const auto change = static_cast<std::int64_t>(magnitude(now.acceleration));
    const std::int64_t fastest = motion_.curve()->motion({speed, 0, 0}).velocity;
    std::int64_t ticks = 3 * deceleration.divide(fastest, MotionPoint::tick_bits) + 48;
    constexpr std::int64_t most_ticks = std::int64_t{1} << 20;
    for (int tried = 0; tried < 2 && ticks <= most_ticks; ++tried, ticks *= 2) {
      // Of the bridge of speed: at most v + a T / 4, |a| + 3/2 v / T and (4 |a| + 6 v / T) / T.
      const Span span = Span::of(ticks);
      const std::int64_t share = span.divide(speed, MotionPoint::tick_bits);
      const MotionLimits master{speed + product_shifted(change, ticks, MotionPoint::tick_bits + 2),
                                change + share + share / 2 + 1,
                                span.divide(4 * change + 6 * share, MotionPoint::tick_bits) + 1};
      const MotionLimits needed = motion_.curve()->motion(master);
      if (needed.acceleration > deceleration.length || needed.acceleration > slave.acceleration ||
          needed.velocity > slave.velocity || needed.jerk > slave.jerk)
        continue;
      stopping_master_.brake_from(now, ticks);
      return braking_ = true;
    }
    return false;
  }
  constexpr bool braking() const { return braking_; }
  // Whether the master of brake() stands.
  constexpr bool braked() const { return braking_ && stopping_master_.at_speed(); }

  // The set-point of the coming tick, at the `master` of that tick.
  constexpr SetPoint<S> step(const MasterReading& master) {
    seen_ = braking_ ? MasterReading{stopping_master_.step(), true} : master;
    point_ = motion_.step(seen_.point, seen_.valid, braking_) + superposed_.step();
    const CamStatus& status = motion_.status();
    fault_ = fault_of(status.fault);
    // Refused behind its trigger.
    const bool decided = waiting_ != nullptr && !status.waiting;
    if (decided && status.refusal != CamRefusal::none) refusal_ = status.refusal;
    if (decided && status.refusal == CamRefusal::none && status.active) {
      table_ = waiting_table_;
      shifted_ = exchanging_ ? shifted_ : waiting_shifted_;
      if (exchanging_) exchanged_ = exchange_;
    }
    if (decided) waiting_ = nullptr;
    if (waiting_ == nullptr && (status.in_sync || !status.active)) exchanging_ = false;
    if (!status.active) table_ = 0;
    return cam_set_point(point_, config_->rate);
  }

  constexpr const MotionPoint& point() const { return point_; }
  constexpr const CamStatus& status() const { return motion_.status(); }
  constexpr bool at_rest() const { return motion_.at_rest() && !superposed_.busy(); }
  constexpr bool superposes() const { return superposed_.busy(); }     // a move is on its way
  constexpr bool phasing() const { return motion_.phasing().busy(); }  // the phase is on its way
  constexpr std::uint16_t table() const { return table_; }             // that is followed; 0: none, or a gear
  // Of the last command, and of what it asked for at its trigger.
  constexpr CamRefusal refusal() const { return refusal_; }
  // As long as the axis follows set-points and no request was taken again.
  constexpr Fault fault() const { return fault_; }

  static constexpr Fault fault_of(CamFault fault) {
    switch (fault) {
      case CamFault::master_lost:
        return Fault::master_lost;
      case CamFault::master_too_fast:
        return Fault::master_too_fast;
      case CamFault::master_jumped:
        return Fault::synchronisation_lost;
      case CamFault::none:
        break;
    }
    return Fault::none;
  }

 private:
  constexpr CamRefusal leave(std::int64_t speed) {
    braking_ = false;
    waiting_ = nullptr;
    return motion_.leave(speed);
  }

  constexpr CamRefusal engage(bool gear, bool referenced) {
    if (!gear && (asked_.table == 0 || asked_.table > tables_.size())) return CamRefusal::unknown_table;
    const Table none{};
    const Table* exchanged = gear ? nullptr : this->exchanged(asked_.table);
    const Table& table = gear ? none : exchanged != nullptr ? *exchanged : tables_[asked_.table - 1u];
    exchanging_ = false;
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
    CamRequest request;
    request.curve = &curve;
    request.trigger = asked_.trigger;
    request.approach = asked_.approach;
    request.master_relative = asked_.master_relative;
    request.slave_relative = asked_.slave_relative;
    request.backward = asked_.backward;
    request.free_way = gear && asked_.slave_relative;
    request.span = Span::of(asked_.approach == CamApproach::distance ? asked_.distance : asked_.ticks);
    request.at = asked_.at;
    request.tolerance = asked_.tolerance;
    const CamRefusal found = motion_.engage(request);
    if (found != CamRefusal::none) return found;
    waiting_ = &curve;
    waiting_table_ = gear ? std::uint16_t{0} : asked_.table;
    waiting_shifted_ = asked_.master_relative || asked_.slave_relative;
    return CamRefusal::none;
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
    while (&places_[k] == motion_.curve() || &places_[k] == waiting_) ++k;
    return places_[k];
  }

  const Config* config_;
  std::span<const Table> tables_;
  CamMotion motion_;
  SmoothOffset superposed_;
  VirtualMaster stopping_master_{VirtualMaster::Config{}};  // that the axis sees while it brakes along its curve
  MasterReading seen_{{}, false};                           // in the last tick
  MotionPoint point_{};
  bool braking_ = false;
  Asked asked_{};
  std::array<CamCurve, 3> places_{};
  const CamCurve* waiting_ = nullptr;  // of a request that was not decided yet
  std::uint16_t table_ = 0, waiting_table_ = 0;
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
