// Residual vibration behind an electronic cam, measured in each cycle of the master: the record of the dwell, its
// quality number and the vibration in it, and by how much two pulses within the rise have to change to cancel it
// (Dostrasil 2014, 6.2; docs/residual_vibration.md).
//
// The frequency and the damping of the load are known (pole p). A tick turns a phasor by z = e^(p T) and adds to nine
// sums, those of the normal equations of
//   load - set-point = a Re z^n + b Im z^n + o
// so that the fit is one of least squares over whatever window there was, and only three of its sums hold the record.
// The constant o is fitted beside the vibration, as friction leaves the dwell off by more than what is to be left. The
// phasor begins where the rise ends, between two ticks, so that a and b hold there. Each n-th deviation is kept: the
// quality number is the area between them and o, over the master.
//
// A tick has bounded work (step()). The fit at the end of the dwell is beside the ticks: who makes it, takes the record
// that is full (State::stage) and gives it back by release(). Nothing here identifies anything.
#pragma once

#include <array>
#include <cstdint>

#include "stiction/motion/bridge.hpp"
#include "stiction/motion/master_position.hpp"
#include "stiction/number/product.hpp"

namespace stiction {

// Why a record is none that can be tuned from. Nothing changes for it.
enum class CamTuningRefusal : std::uint8_t {
  none,
  short_dwell,   // less than a period of the load within the window
  moving,        // the set-point moved in the window, or what is recorded is for the most part no vibration
  limited,       // a current or a voltage at its limit in the cycle: such a drive does not follow
  saturated,     // the load farther from its place than the record holds
  speed,         // a master that did not turn at the speed that the pulses are made for
  encoder_lost,  // no position of the load
  amplitude,     // a pulse larger than the configuration allows
  axis_limits,   // a table that takes more than the limits or the travel of the axis
  relative,  // a curve that was scaled, or begun where the axis or the master was: the pulses are made for none such
  worse,     // of what was tried none was better: the last better one is kept
  no_table,  // the axis does not follow the table that is tuned
  off        // tuning is not configured
};
inline constexpr int cam_tuning_refusals = 13;

class CamTuning {
 public:
  static constexpr int phasor_bits = 30;
  static constexpr int pulse_bits = 24;
  static constexpr std::size_t record_size = 1024;
  static constexpr std::int32_t most_ticks = 1 << 15;  // of a window
  static constexpr std::int32_t most_deviation = (1 << 23) - 1;

  struct Config {
    // In 2^-32 cycles of the master as the curve sees it: the rise, and behind it up to where the window begins and
    // ends. Between the end of the window and the next rise is a tick at least.
    std::uint32_t rise_begin = 0, rise_length = 0;
    std::uint32_t settling = 0, window_end = 0;  // from the end of the rise
    std::uint32_t ticks_a_phase = 0;             // ticks in 2^-16 for each 2^-32 of a cycle, in 2^-32
    std::int32_t turn_re = 1 << phasor_bits;     // of the phasor in a tick
    std::int32_t turn_im = 0;
    std::int8_t shift = 16;                // a deviation counts 2^(shift - 40) units
    std::int16_t every = 1;                // ticks from one deviation that is kept to the next
    std::int32_t least_ticks = 1;          // of a window: a period
    std::int64_t speed = 0;                // of the master, 2^-52 cycles a tick
    std::int64_t speed_tolerance = 0;      // the same
    std::int64_t noise = 0;                // of the encoder, a deviation's square in 2^-8: not called motion
    std::array<std::int32_t, 4> pulses{};  // change of each pulse for a and -b, in 2^-24
  };

  struct Input {
    MasterPosition master{};     // as the curve sees it
    std::int64_t velocity = 0;   // of it, 2^-52 cycles a tick
    std::int64_t load = 0;       // 2^-40 units
    std::int64_t set_point = 0;  // the same
    bool valid = true;           // a position of the load is known
    bool follows = true;         // in sync, with no other motion on top
    bool limited = false;        // current or voltage at its limit
  };

  enum class Stage : std::uint8_t { away, ready, rise, dwell, full };

  struct State {
    Stage stage = Stage::away;
    bool moved = false, limited = false, saturated = false, off_speed = false, lost = false;
    std::int16_t left = 0;                // ticks until the next deviation is kept
    std::int32_t re = 0, im = 0;          // the phasor
    std::int32_t ticks = 0;               // of the window
    std::int64_t wanted = 0;              // where the load should be
    std::int64_t d = 0, dd = 0;           // sums: deviation and its square,
    std::int64_t dc = 0, ds = 0;          // times both parts of the phasor in 2^-22,
    std::int64_t c = 0, s = 0;            // of these,
    std::int64_t cc = 0, cs = 0, ss = 0;  // and of their products
    std::uint32_t kept = 0;
    std::array<std::int32_t, record_size> record{};
  };

  struct Fit {
    CamTuningRefusal refusal = CamTuningRefusal::none;
    std::int64_t re = 0, im = 0;         // a and -b, 2^-40 units: the vibration where the rise ends
    std::int64_t offset = 0;             // o, the same
    std::int64_t quality = 0;            // area about o in 2^-40 units, times cycles of the master
    std::int64_t deviation = 0;          // the same about the set-point
    std::int64_t first = 0, second = 0;  // by how much the pulses change, 2^-40 units
  };

  // One tick of `config` and `state` with the `in` of it.
  static constexpr void step(const Config& config, State& state, const Input& in) {
    if (state.stage == Stage::full) return;
    const std::uint32_t behind = in.master.coarse() - config.rise_begin;
    const std::uint32_t past = behind - config.rise_length;
    if (behind < config.rise_length) {
      if (state.stage == Stage::ready) begin(state);
      if (state.stage == Stage::dwell) state.stage = Stage::away;  // the master turned back
    } else if (past < config.window_end) {
      if (state.stage == Stage::rise) enter_dwell(config, state, in, past);
    } else {
      state.stage = state.stage == Stage::dwell ? Stage::full : Stage::ready;
      return;
    }
    if (state.stage < Stage::rise) return;
    const std::int64_t off = in.velocity - config.speed;
    state.off_speed |= off > config.speed_tolerance || off < -config.speed_tolerance;
    state.limited |= in.limited;
    state.moved |= !in.follows;
    state.lost |= !in.valid;
    if (state.stage != Stage::dwell) return;
    if (past >= config.settling) add(config, state, in);
    turn(config, state);
  }

  // Gives back a record that is full; the next one begins with the next rise.
  static constexpr void release(State& state) { state.stage = Stage::away; }

  // Of the full record of `state`; its work grows with the record.
  static constexpr Fit evaluate(const Config& config, const State& state) {
    Fit fit;
    fit.refusal = refusal_of(config, state);
    if (state.ticks == 0) return fit;
    const Span n = Span::of(state.ticks);
    // Means: those of phasors in 2^-40, of deviations in 2^-16 of themselves.
    const auto mean = [&n](std::int64_t sum, int up) { return n.divide(sum, up); };
    const std::int64_t c = mean(state.c, 18), s = mean(state.s, 18), d = mean(state.d, 16);
    const std::int64_t cc = mean(state.cc, -4) - product<40>(c, c), cs = mean(state.cs, -4) - product<40>(c, s);
    const std::int64_t ss = mean(state.ss, -4) - product<40>(s, s);
    const std::int64_t dc = mean(state.dc, -6) - product<40>(d, c), ds = mean(state.ds, -6) - product<40>(d, s);
    const std::int64_t determinant = product<40>(cc, ss) - product<40>(cs, cs);
    // Over a period it is about 1/4; far below, a part of one was recorded.
    if (determinant < std::int64_t{1} << 30) {
      if (fit.refusal == CamTuningRefusal::none) fit.refusal = CamTuningRefusal::short_dwell;
      return fit;
    }
    const Span by = Span::of(determinant);
    const std::int64_t a = by.divide(product<40>(dc, ss) - product<40>(ds, cs), 40);
    const std::int64_t b = by.divide(product<40>(ds, cc) - product<40>(dc, cs), 40);
    const std::int64_t offset = d - product<40>(a, c) - product<40>(b, s);
    const std::int64_t explained = product<24>(a, dc) + product<24>(b, ds);  // 2^-8 of a deviation's square
    const std::int64_t left = mean(state.dd, 8) - product<24>(d, d) - explained;
    if (fit.refusal == CamTuningRefusal::none && left > config.noise && left > explained)
      fit.refusal = CamTuningRefusal::moving;
    const auto in_units = [&config](std::int64_t x) { return product_shifted(x, std::int64_t{1} << config.shift, 16); };
    fit.re = in_units(a);
    fit.im = in_units(-b);
    fit.offset = in_units(offset);
    areas(config, state, offset, fit);
    change(config, fit);
    return fit;
  }

  // By how much the pulses of `fit` change for its vibration, 2^-40 units: the map of `config`. Of a cycle behind which
  // the vibration of the cycle before still rings, the fit's own part is to be given.
  static constexpr void change(const Config& config, Fit& fit) {
    fit.first = product<pulse_bits>(config.pulses[0], fit.re) + product<pulse_bits>(config.pulses[1], fit.im);
    fit.second = product<pulse_bits>(config.pulses[2], fit.re) + product<pulse_bits>(config.pulses[3], fit.im);
  }

 private:
  static constexpr int factor_bits = 22;  // of the phasor in a sum

  static constexpr void begin(State& state) {
    state.stage = Stage::rise;
    state.moved = state.limited = state.saturated = state.off_speed = state.lost = false;
    state.left = 0;
    state.ticks = 0;
    state.d = state.dd = state.dc = state.ds = state.c = state.s = state.cc = state.cs = state.ss = 0;
    state.kept = 0;
  }

  // The phasor was 1 where the rise ended, `past` before: 1 + f (z - 1) in the share f of a tick, since when its angle
  // is below a hundredth.
  static constexpr void enter_dwell(const Config& config, State& state, const Input& in, std::uint32_t past) {
    state.stage = Stage::dwell;
    const std::int64_t share = static_cast<std::int64_t>(std::uint64_t{past} * config.ticks_a_phase >> 32);  // 2^-16
    constexpr std::int32_t one = 1 << phasor_bits;
    const std::int64_t bounded = share > 1 << 16 ? 1 << 16 : share;
    state.re = static_cast<std::int32_t>(one + ((bounded * (config.turn_re - one)) >> 16));
    state.im = static_cast<std::int32_t>((bounded * config.turn_im) >> 16);
    state.wanted = in.set_point;
  }

  [[gnu::always_inline]] static constexpr void add(const Config& config, State& state, const Input& in) {
    if (state.ticks == most_ticks) return;
    // In steps of the record: a table rests to what rounding leaves.
    const std::int64_t way = (in.set_point - state.wanted) >> config.shift;
    state.moved |= way != 0 && way != -1;
    const std::int64_t off = (in.load - state.wanted) >> config.shift;
    const bool beyond = off > most_deviation || off < -most_deviation;
    state.saturated |= beyond;
    const std::int32_t d = beyond ? 0 : static_cast<std::int32_t>(off);
    const std::int32_t re = state.re >> (phasor_bits - factor_bits), im = state.im >> (phasor_bits - factor_bits);
    state.d += d;
    state.dd += std::int64_t{d} * d;
    state.dc += std::int64_t{d} * re;
    state.ds += std::int64_t{d} * im;
    state.c += re;
    state.s += im;
    state.cc += std::int64_t{re} * re;
    state.cs += std::int64_t{re} * im;
    state.ss += std::int64_t{im} * im;
    ++state.ticks;
    if (state.left > 0) {
      --state.left;
    } else if (state.kept < record_size) {
      state.record[state.kept++] = d;
      state.left = static_cast<std::int16_t>(config.every - 1);
    }
  }

  [[gnu::always_inline]] static constexpr void turn(const Config& config, State& state) {
    constexpr std::int64_t half = std::int64_t{1} << (phasor_bits - 1);
    const std::int64_t re = std::int64_t{state.re} * config.turn_re - std::int64_t{state.im} * config.turn_im + half;
    const std::int64_t im = std::int64_t{state.re} * config.turn_im + std::int64_t{state.im} * config.turn_re + half;
    state.re = static_cast<std::int32_t>(re >> phasor_bits);
    state.im = static_cast<std::int32_t>(im >> phasor_bits);
  }

  static constexpr CamTuningRefusal refusal_of(const Config& config, const State& state) {
    if (state.lost) return CamTuningRefusal::encoder_lost;
    if (state.limited) return CamTuningRefusal::limited;
    if (state.off_speed) return CamTuningRefusal::speed;
    if (state.moved) return CamTuningRefusal::moving;
    if (state.saturated) return CamTuningRefusal::saturated;
    return state.ticks < config.least_ticks ? CamTuningRefusal::short_dwell : CamTuningRefusal::none;
  }

  // Of what was kept, about `offset` in 2^-16 of a deviation and about 0.
  static constexpr void areas(const Config& config, const State& state, std::int64_t offset, Fit& fit) {
    if (state.kept == 0) return;
    std::int64_t about_offset = 0, about_zero = 0;
    for (std::uint32_t k = 0; k < state.kept; ++k) {
      const std::int64_t d = std::int64_t{state.record[k]} * (1 << 16);
      about_offset += static_cast<std::int64_t>(magnitude(d - offset));
      about_zero += static_cast<std::int64_t>(magnitude(d));
    }
    const Span kept = Span::of(state.kept);
    const auto window = static_cast<std::int64_t>(config.window_end - config.settling);
    const auto area = [&](std::int64_t sum) {
      return product_shifted(product_shifted(kept.divide(sum, 0), window, 32), std::int64_t{1} << config.shift, 16);
    };
    fit.quality = area(about_offset);
    fit.deviation = area(about_zero);
  }
};

}  // namespace stiction
