// The format of a recording: what went into the axes of a closed loop and a digest of what came out, tick by tick.
// A sequence of 64-bit little-endian words: magic, axes, ticks, fast period (ns), ticks per slow tick; the
// configuration of each axis; then for every tick and axis its set-point, feedback and digest.
#pragma once

#include <array>
#include <bit>
#include <concepts>
#include <cstdint>
#include <type_traits>

#include "stiction/drive/axis.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::targets {

static_assert(std::endian::native == std::endian::little);

inline constexpr std::int64_t recording_magic = 0x316e6f6974636974;  // "tiction1"
inline constexpr std::size_t axis_count = 2;

struct Header {
  std::int64_t magic = recording_magic;
  std::int64_t axes = axis_count;
  std::int64_t ticks = 0;
  std::int64_t period_ns = 0;
  std::int64_t slow_ratio = 0;
};

struct Sample {
  SetPoint<FixedSignals> set;
  Feedback<FixedSignals> feedback;
  std::uint64_t digest = 0;  // of the signals of this tick
};

// each_field(record, field) calls field(x) for every scalar of a record, in the order of the file. Every member is
// named, so that a new one does not compile until it is listed here too.
template <class Field>
void each_field(Header& header, Field&& field) {
  auto& [magic, axes, ticks, period_ns, slow_ratio] = header;
  field(magic), field(axes), field(ticks), field(period_ns), field(slow_ratio);
}

template <class Field>
void each_field(AxisConfig<FixedSignals>& config, Field&& field) {
  const auto pi = [&](auto& controller) {
    auto& [proportional, integral, tracking] = controller;
    field(proportional), field(integral), field(tracking);
  };
  auto& [period_ns, inverse_period, quantizer, position_gain, velocity_feedforward, velocity_feedback, velocity, notch,
         current_feedforward, current_loop, current, inverse_pole_pair_pitch, velocity_limit, current_limit,
         voltage_limit, following_error_fault, over_current_fault, over_speed_fault, limit_cycle_window] = config;
  auto& [quantizer_enabled, per_metre, increment] = quantizer;
  auto& [notch_enabled, b0, b1, b2, a1, a2] = notch;
  field(period_ns), field(inverse_period), field(quantizer_enabled), field(per_metre), field(increment);
  field(position_gain), field(velocity_feedforward), field(velocity_feedback), pi(velocity);
  field(notch_enabled), field(b0), field(b1), field(b2), field(a1), field(a2);
  field(current_feedforward), field(current_loop), pi(current), field(inverse_pole_pair_pitch);
  field(velocity_limit), field(current_limit), field(voltage_limit), field(following_error_fault);
  field(over_current_fault), field(over_speed_fault), field(limit_cycle_window);
}

template <class Field>
void each_field(Sample& sample, Field&& field) {
  auto& [set, feedback, digest] = sample;
  auto& [set_position, set_velocity, acceleration, set_valid, injection, by_current, limits_current, most_current] =
      set;
  auto& [position, position_time_ns, position_valid, velocity, current, fault] = feedback;
  field(set_position), field(set_velocity), field(acceleration), field(set_valid), field(injection);
  field(by_current), field(limits_current), field(most_current);
  field(position), field(position_time_ns), field(position_valid), field(velocity);
  for (auto& i : current) field(i);
  field(fault), field(digest);
}

template <class T>
std::int64_t to_word(const T& x) {
  if constexpr (FixedPoint<T>)
    return x.raw();
  else
    return static_cast<std::int64_t>(x);
}

template <class T>
void from_word(std::int64_t word, T& x) {
  if constexpr (FixedPoint<T>)
    x = T::from_bounded_raw(word);
  else
    x = static_cast<T>(word);
}

// Reads records from a source with `bool read(void*, std::size_t)`.
template <class Source, class Record>
bool read_record(Source& source, Record& record) {
  bool complete = true;
  each_field(record, [&](auto& x) {
    std::int64_t word = 0;
    complete = complete && source.read(&word, sizeof word);
    from_word(word, x);
  });
  return complete;
}

// Writes records to a sink with `void write(const void*, std::size_t)`.
template <class Sink, class Record>
void write_record(Sink& sink, Record record) {
  each_field(record, [&](const auto& x) {
    const std::int64_t word = to_word(x);
    sink.write(&word, sizeof word);
  });
}

// The beginning of a recording.
struct Opening {
  Header header;
  std::array<AxisConfig<FixedSignals>, axis_count> configs;
};

template <class Source>
bool read_opening(Source& source, Opening& opening) {
  if (!read_record(source, opening.header)) return false;
  if (opening.header.magic != recording_magic || opening.header.axes != std::int64_t{axis_count}) return false;
  for (auto& config : opening.configs)
    if (!read_record(source, config)) return false;
  return true;
}

}  // namespace stiction::targets
