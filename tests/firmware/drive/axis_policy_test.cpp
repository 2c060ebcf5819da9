// The firmware's cascade against the same cascade in double precision, open loop: what rounding costs each signal.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <string>

#include "tests/firmware/drive/axis_bench.hpp"
#include "tests/firmware/number/exact.hpp"

namespace stiction {
namespace {

using Fix = FixedSignals;
using Dbl = machine::DoubleSignals;
using test::si;

constexpr int ticks = 320;  // 20 ms

// Last bits of the formats, SI.
constexpr double bit_x = 0x1p-40, bit_e = 0x1p-32, bit_v = 0x1p-28, bit_i = 0x1p-20, bit_u = 0x1p-18;

// The largest difference that rounding can make, from the input to the voltage. Inputs of both sides are equal, and
// gains are numbers that their formats hold exactly.
struct Bounds {
  double speed;  // largest |v|, m/s
  // x_set - v * age - x: the age in s is off by 8e-8 of 60 us and half a bit, two roundings to x, one to e.
  double e = speed * (60e-6 * 8e-8 + 0.5 * bit_x) + bit_x + 0.5 * bit_e;
  // motion * rate: motion is exact, the rate of at least 7000 1/s is off by 2^-11 1/s and 2^-29 of it.
  double v = speed * (0x1p-11 / 7000.0 + 0x1p-29) + 0.5 * bit_v;
  // The delay is off by 2^-29 ticks and its inverse period's rounding, small against the two roundings.
  double v_set_delayed = 1.5 * bit_v;
  double v_ref = 83.0 * e + v_set_delayed + 0.5 * bit_v;
  double v_error = v_ref + v + 0.5 * bit_v;
  // Proportional part, and an integral part that has summed the error of every tick so far.
  double i_integral = ticks * 600.0 * 0.0125 * v_error + 0.5 * bit_i;
  double i_pi = 600.0 * v_error + i_integral + bit_i;
  double i_set = i_pi + bit_i;
  double u = 35.0 * (i_set + bit_i) + ticks * 35.0 * 0.03125 * (i_set + bit_i) + bit_u;
};

std::map<std::string, double> bounds_of(double speed) {
  const Bounds b{speed};
  return {{"x_set", 0.0},
          {"v_set", 0.0},
          {"a_set", 0.0},
          {"x", 0.0},
          {"v", b.v},
          {"i", 2.0 * bit_i},
          {"i_set", b.i_set},
          {"e", b.e},
          {"e_held", b.e},
          {"v_ref", b.v_ref},
          {"v_set_delayed", b.v_set_delayed},
          {"v_error", b.v_error},
          {"i_integral", b.i_integral},
          {"i_pi", b.i_pi},
          {"i_notch", b.i_pi},
          {"i_feedforward", 0.5 * bit_i},
          {"i_A", 0.0},
          {"i_B", 0.0},
          {"i_C", 0.0},
          {"u_A", b.u},
          {"u_B", b.u},
          {"u_C", b.u}};
}

template <class S>
AxisConfig<S> config(CurrentLoop loop) {
  auto c = test::bench_config<S>();
  c.current_loop = loop;
  c.voltage_limit = si<typename S::Voltage>(8000.0);
  c.current_limit = si<typename S::Current>(1000.0);
  c.over_current_fault = si<typename S::Current>(1000.0);
  return c;
}

// A value on the fixed format's grid, given to both sides.
template <class T>
double on_grid(double value) {
  return machine::to_si(si<T>(value));
}

struct Inputs {
  double x_set, v_set, a_set, x, i[3];
  std::int64_t age_ns;
};

template <class S>
void feed(test::Bench<S>& b, const Inputs& in) {
  b.set = {si<typename S::Position>(in.x_set), si<typename S::Velocity>(in.v_set),
           si<typename S::Acceleration>(in.a_set), true};
  b.feedback.position = si<typename S::Position>(in.x);
  for (std::size_t k = 0; k < 3; ++k) b.feedback.current[k] = si<typename S::Current>(in.i[k]);
  b.tick(in.age_ns);
}

// A start from rest, so that neither side meets a limit: x = v/omega (1 - cos omega t), with an error swinging in.
void compare(CurrentLoop loop) {
  const double speed = 1e-3 * static_cast<double>(test::drawn_between(10, 1200));        // m/s
  const double acceleration = 1e-3 * static_cast<double>(test::drawn_between(1, 4000));  // m/s^2
  const double deviation = 1e-9 * static_cast<double>(test::drawn_between(0, 20000));    // m
  std::mt19937_64 random(static_cast<std::uint64_t>(test::drawn_between(0, UINT32_MAX)));
  std::uniform_int_distribution<std::int64_t> ages(0, 20000);
  const double omega = acceleration / speed;
  test::Bench<Fix> fixed(config<Fix>(loop));
  test::Bench<Dbl> real(config<Dbl>(loop));
  std::map<std::string, double> values;
  const auto bounds = bounds_of(speed + 0.01);
  for (int n = 0; n < ticks; ++n) {
    const double t = test::tick * n;
    Inputs in{};
    in.age_ns = n == 0 ? 0 : ages(random);
    const double then = t - 1e-9 * static_cast<double>(in.age_ns);
    in.x_set = on_grid<Fix::Position>(speed / omega * (1.0 - std::cos(omega * t)));
    in.v_set = on_grid<Fix::Velocity>(speed * std::sin(omega * t));
    in.a_set = on_grid<Fix::Acceleration>(acceleration * std::cos(omega * t));
    in.x = on_grid<Fix::Position>(speed / omega * (1.0 - std::cos(omega * then)) +
                                  deviation * (1.0 - std::cos(300.0 * then)));
    for (int k = 0; k < 3; ++k)
      in.i[k] = on_grid<Fix::Current>(5.0 * std::sin(200.0 * t + k * 2.0 * std::numbers::pi / 3.0));
    feed(fixed, in);
    feed(real, in);
    RC_ASSERT(fixed.axis.fault() == Fault::none);
    RC_ASSERT(real.axis.fault() == Fault::none);
    RC_ASSERT(!real.signals.limiting.velocity && !real.signals.limiting.current && !real.signals.limiting.voltage);
    for_each_signal(real.signals, [&](auto name, auto, auto, auto value) { values[name] = machine::to_si(value); });
    for_each_signal(fixed.signals, [&](auto name, auto, auto, auto value) {
      const double difference = std::abs(machine::to_si(value) - values.at(name));
      if (difference > bounds.at(name))
        RC_FAIL(std::string(name) + " at tick " + std::to_string(n) + ": off by " +
                std::to_string(difference / bounds.at(name)) + " times its bound");
    });
  }
}

RC_GTEST_PROP(AxisPolicy, FixedPointStaysWithinItsRoundingOfDoubleWithADcMotor, ()) { compare(CurrentLoop::direct); }

// Three phases add the commutation: sine within 6e-9 and the angle's truncation (inverse pitch * 2^-32 m of a turn) act
// on 40 A and less, 1e-6 A; it is within the bound that the velocity loop leaves.
RC_GTEST_PROP(AxisPolicy, FixedPointStaysWithinItsRoundingOfDoubleWithThreePhases, ()) {
  compare(CurrentLoop::three_phase);
}

}  // namespace
}  // namespace stiction
