// What the encoders of an axis see: the load or the motor, which differ behind an elastic shaft, as they are or as they
// were a while ago.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "firmware/machine/model/machine.hpp"

namespace stiction::sim {

class Encoders {
 public:
  // Of what an encoder sits on: m, m/s.
  struct Body {
    double position, velocity;
  };

  // At rest at `position` (m). `step`: of the plant, `tick`: of the drive, s; `axis`: its encoders.
  Encoders(const machine::AxisModel& axis, double step, double tick, double position)
      : tick_(tick),
        source_(axis.encoder.velocity),
        encoder_{axis.encoder.on, axis.encoder.increment, axis.encoder.noise, axis.encoder.delay / step},
        elastic_(axis.elastic()) {
    const auto further = [&](const std::optional<machine::FurtherEncoderParameters>& given) {
      return given ? std::optional(Encoder{given->on, given->increment, given->noise, given->delay / step})
                   : std::nullopt;
    };
    velocity_encoder_ = further(axis.velocity_encoder);
    second_encoder_ = further(axis.second_encoder);
    double longest = 0.0;
    for (const auto* encoder :
         {&encoder_, velocity_encoder_ ? &*velocity_encoder_ : nullptr, second_encoder_ ? &*second_encoder_ : nullptr})
      if (encoder != nullptr) longest = std::max(longest, encoder->delay);
    late_ = longest > 0.0;
    if (late_) past_.assign(static_cast<std::size_t>(std::ceil(longest)) + 2, {{position, 0.0}, {position, 0.0}});
    load_ = motor_ = {position, 0.0};
    last_ = before_ = velocity_encoder_ ? rounded(*velocity_encoder_, position) : 0.0;
  }

  // Whether there is more than an encoder that sees the load as it is.
  bool any() const {
    return late_ || velocity_encoder_ || second_encoder_ || (elastic_ && encoder_.on == machine::EncoderPlace::motor);
  }
  bool late() const { return late_; }

  // Where both are at the end of a step; of late encoders, in every step.
  void record(const Body& load, const Body& motor) {
    newest_ = newest_ + 1 == past_.size() ? 0 : newest_ + 1;
    past_[newest_] = {load, motor};
  }

  // Once a tick, with `load` and `motor` where they are: what the position controller's encoder shows, before its
  // increment, and the velocity of the velocity loop's. `random`: of its noise.
  Body sample(const Body& load, const Body& motor, std::mt19937_64& random) {
    load_ = load;
    motor_ = motor;
    Body shown = seen(encoder_);
    if (velocity_encoder_) shown.velocity = velocity_of(*velocity_encoder_, random);
    return shown;
  }

  // m, with increment and noise; none without that encoder. `random`: of the noise.
  std::optional<double> read_velocity_encoder(std::mt19937_64& random) { return read(velocity_encoder_, random); }
  std::optional<double> read_second_encoder(std::mt19937_64& random) { return read(second_encoder_, random); }

 private:
  struct Encoder {
    machine::EncoderPlace on = machine::EncoderPlace::load;
    double increment = 0.0;  // m; 0: none
    double noise = 0.0;      // m
    double delay = 0.0;      // steps of the plant
  };

  // Beyond 2^51 increments there is nothing to round.
  static double rounded(const Encoder& encoder, double position) {
    if (encoder.increment == 0.0) return position;
    const double counts = position / encoder.increment;
    return std::abs(counts) < 0x1p51 ? encoder.increment * std::round(counts) : position;
  }

  Body seen(const Encoder& encoder) const {
    const auto on = [&](const std::pair<Body, Body>& both) {
      return encoder.on == machine::EncoderPlace::load ? both.first : both.second;
    };
    if (encoder.delay == 0.0) return on({load_, motor_});
    const auto steps = static_cast<std::size_t>(encoder.delay);
    const double share = encoder.delay - static_cast<double>(steps);
    const auto ago = [&](std::size_t k) { return on(past_[(newest_ + past_.size() - k) % past_.size()]); };
    const Body late = ago(steps);
    if (share == 0.0) return late;
    const Body later = ago(steps + 1);
    return {late.position + share * (later.position - late.position),
            late.velocity + share * (later.velocity - late.velocity)};
  }

  double velocity_of(const Encoder& encoder, std::mt19937_64& random) {
    const Body body = seen(encoder);
    const double position = *read(velocity_encoder_, random);
    const double one = (position - last_) / tick_, mean = (position - before_) / (2.0 * tick_);
    before_ = std::exchange(last_, position);
    switch (source_) {
      case machine::VelocitySource::ideal:
        return body.velocity;
      case machine::VelocitySource::estimated:
        return one;
      case machine::VelocitySource::mean_difference:
        return mean;
    }
    return body.velocity;
  }

  std::optional<double> read(const std::optional<Encoder>& encoder, std::mt19937_64& random) const {
    if (!encoder) return std::nullopt;
    double position = seen(*encoder).position;
    if (encoder->noise > 0.0) position += std::normal_distribution<double>(0.0, encoder->noise)(random);
    return rounded(*encoder, position);
  }

  double tick_;
  machine::VelocitySource source_;
  Encoder encoder_;
  bool elastic_;
  std::optional<Encoder> velocity_encoder_, second_encoder_;
  bool late_ = false;
  std::vector<std::pair<Body, Body>> past_;  // ring, one a step
  std::size_t newest_ = 0;
  Body load_{}, motor_{};
  double last_, before_;  // m, of the velocity encoder, one and two ticks ago
};

}  // namespace stiction::sim
