// The tuner of residual vibration in the drive: what it measures of a dwell whose vibration is known, in double
// precision and in closed form, and what it refuses.
#include "stiction/motion/cam_tuning.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <functional>
#include <memory>
#include <numbers>
#include <random>

namespace stiction {
namespace {

using Complex = std::complex<double>;
constexpr double pi = std::numbers::pi, period = 62.5e-6;

// A rise over the first half of a cycle at 130 turns a minute, and a load at 14.481 Hz with a damping ratio of 0.01367
// (Dostrasil 2014, the poles of his test rig).
struct Dwell {
  double cycles_a_second = 130.0 / 60.0, frequency = 14.481, damping = 0.01367;
  double settling = 0.05, end = 0.499;  // cycles, behind the rise
  Complex vibration{1e-3, -2e-3};       // of the load where the rise ends
  double offset = 3e-4;
  double noise = 0.0, increment = 0.0;

  Complex pole() const {
    const double w = 2.0 * pi * frequency;
    return {-damping * w, w * std::sqrt(1.0 - damping * damping)};
  }
  double at(double t) const { return (vibration * std::exp(pole() * t)).real() + offset; }
};

std::uint32_t phase(double cycles) { return static_cast<std::uint32_t>(std::llround(std::ldexp(cycles, 32))); }
std::int64_t raw(double x) { return std::llround(std::ldexp(x, 40)); }
double units(std::int64_t x) { return std::ldexp(static_cast<double>(x), -40); }

CamTuning::Config config_of(const Dwell& dwell, double frequency_factor = 1.0) {
  Dwell known = dwell;
  known.frequency *= frequency_factor;
  const Complex z = std::exp(known.pole() * period);
  CamTuning::Config config;
  config.rise_length = 0x80000000u;
  config.settling = phase(dwell.settling);
  config.window_end = phase(dwell.end);
  const double a_tick = dwell.cycles_a_second * period;
  config.ticks_a_phase = static_cast<std::uint32_t>(std::llround(0x1p16 / a_tick));
  config.turn_re = static_cast<std::int32_t>(std::llround(z.real() * 0x1p30));
  config.turn_im = static_cast<std::int32_t>(std::llround(z.imag() * 0x1p30));
  config.shift = 12;  // 4 nm; 31 mm at most
  config.every = 8;
  config.least_ticks = static_cast<std::int32_t>(1.0 / (known.frequency * period));
  config.speed = std::llround(std::ldexp(a_tick, 52));
  config.speed_tolerance = config.speed / 100;
  config.noise = 256 * 100 * 100;
  return config;
}

// What a drive sees of one cycle, from before the rise; `change`: of a tick, at the place of the master.
using Change = std::function<void(CamTuning::Input&, double place)>;
std::unique_ptr<CamTuning::State> recorded(const CamTuning::Config& config, const Dwell& dwell,
                                           const Change& change = {}, double share = 0.3) {
  auto state = std::make_unique<CamTuning::State>();
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0.0, 1.0);
  const double a_tick = dwell.cycles_a_second * period;
  // Ticks lie anywhere about the end of the rise.
  const double begin = 0.5 - (std::floor(0.52 / a_tick) + share) * a_tick;
  for (int k = 0; begin + k * a_tick < 1.02; ++k) {
    const double place = begin + k * a_tick, t = (place - 0.5) / dwell.cycles_a_second;
    double load = 0.05 + (t < 0.0 ? 0.0 : dwell.at(t)) + dwell.noise * noise(random);
    if (dwell.increment > 0.0) load = dwell.increment * std::round(load / dwell.increment);
    CamTuning::Input in;
    in.master = MasterPosition::way(std::llround(std::ldexp(place, 40)));
    in.velocity = config.speed;
    in.load = raw(load);
    in.set_point = raw(place < 0.5 ? 0.1 * std::max(0.0, place) : 0.05);
    if (change) change(in, place);
    CamTuning::step(config, *state, in);
    if (state->stage == CamTuning::Stage::full) break;
  }
  return state;
}

TEST(CamTuning, FindsTheVibrationWhereTheRiseEnds) {
  for (const double share : {0.0, 0.3, 0.99}) {
    Dwell dwell;
    const auto config = config_of(dwell);
    const auto state = recorded(config, dwell, {}, share);
    ASSERT_EQ(state->stage, CamTuning::Stage::full);
    const auto fit = CamTuning::evaluate(config, *state);
    EXPECT_EQ(fit.refusal, CamTuningRefusal::none);
    // A tick's angle is 0.0057: a phasor that began with the tick would be off by so much.
    EXPECT_NEAR(units(fit.re), dwell.vibration.real(), 1e-5 * std::abs(dwell.vibration));
    EXPECT_NEAR(units(fit.im), dwell.vibration.imag(), 1e-5 * std::abs(dwell.vibration));
    EXPECT_NEAR(units(fit.offset), dwell.offset, 1e-8);
  }
}

TEST(CamTuning, ItsQualityIsTheAreaOfTheVibrationAboutItsMean) {
  Dwell dwell;
  const auto config = config_of(dwell);
  const auto fit = CamTuning::evaluate(config, *recorded(config, dwell));
  double about_mean = 0.0, about_set_point = 0.0;
  constexpr int steps = 200000;
  for (int k = 0; k < steps; ++k) {
    const double place = dwell.settling + (dwell.end - dwell.settling) * (k + 0.5) / steps;
    const double x = dwell.at(place / dwell.cycles_a_second);
    about_mean += std::abs(x - dwell.offset);
    about_set_point += std::abs(x);
  }
  const double width = (dwell.end - dwell.settling) / steps;
  // Each eighth tick counts: 3 % of a radian.
  EXPECT_NEAR(units(fit.quality), about_mean * width, 2e-3 * about_mean * width);
  EXPECT_NEAR(units(fit.deviation), about_set_point * width, 2e-3 * about_set_point * width);
}

TEST(CamTuning, ItsPulsesAreTheConfiguredMapOfTheVibration) {
  Dwell dwell;
  auto config = config_of(dwell);
  config.pulses = {1 << 24, -(1 << 23), 3 << 22, 1 << 25};
  const auto fit = CamTuning::evaluate(config, *recorded(config, dwell));
  EXPECT_NEAR(units(fit.first), dwell.vibration.real() - 0.5 * dwell.vibration.imag(), 1e-7);
  EXPECT_NEAR(units(fit.second), 0.75 * dwell.vibration.real() + 2.0 * dwell.vibration.imag(), 1e-7);
}

TEST(CamTuning, NoiseAndResolutionOfTheEncoderAreAveraged) {
  Dwell dwell;
  // Of the test rig: 0.003 and 0.015 degrees of 30, of a stroke of 50 mm.
  dwell.noise = 5e-6;
  dwell.increment = 25e-6;
  const auto config = config_of(dwell);
  const auto fit = CamTuning::evaluate(config, *recorded(config, dwell));
  EXPECT_EQ(fit.refusal, CamTuningRefusal::none);
  // Some 3300 samples, each off by the increment over the root of 12 and by the noise: 8.8 um / sqrt(3300) is 0.15 um,
  // and twice that with a phasor's mean square of a half, three times for its error.
  EXPECT_NEAR(units(fit.re), dwell.vibration.real(), 0.7e-6);
  EXPECT_NEAR(units(fit.im), dwell.vibration.imag(), 0.7e-6);
}

TEST(CamTuning, AFrequencyThatIsWrongStillTellsThatNothingIsLeft) {
  for (const double factor : {0.95, 1.05}) {
    Dwell dwell;
    const auto config = config_of(dwell, factor);
    auto fit = CamTuning::evaluate(config, *recorded(config, dwell));
    EXPECT_EQ(fit.refusal, CamTuningRefusal::none) << factor;
    // 5 % are 0.9 rad over the window.
    const Complex found{units(fit.re), units(fit.im)};
    EXPECT_LT(std::abs(found - dwell.vibration), 0.75 * std::abs(dwell.vibration)) << factor;
    dwell.vibration = 0.0;
    fit = CamTuning::evaluate(config, *recorded(config, dwell));
    EXPECT_NEAR(units(fit.re), 0.0, 1e-9);
    EXPECT_NEAR(units(fit.im), 0.0, 1e-9);
    EXPECT_NEAR(units(fit.quality), 0.0, 1e-8);
  }
}

CamTuningRefusal refusal_with(const Change& change, const Dwell& dwell = {}) {
  const auto config = config_of(dwell);
  const auto state = recorded(config, dwell, change);
  EXPECT_EQ(state->stage, CamTuning::Stage::full);
  return CamTuning::evaluate(config, *state).refusal;
}

TEST(CamTuning, RefusesARecordThatTellsNothing) {
  using enum CamTuningRefusal;
  EXPECT_EQ(refusal_with({}), none);
  EXPECT_EQ(refusal_with([](auto& in, double x) { in.limited = x > 0.2 && x < 0.21; }), limited) << "in the rise";
  EXPECT_EQ(refusal_with([](auto& in, double x) { in.valid = x < 0.7 || x > 0.71; }), encoder_lost);
  EXPECT_EQ(refusal_with([](auto& in, double x) { in.follows = x < 0.3 || x > 0.31; }), moving);
  EXPECT_EQ(refusal_with([](auto& in, double x) { in.set_point += x > 0.7 ? raw((x - 0.7) * 1e-3) : 0; }), moving);
  EXPECT_EQ(refusal_with([](auto& in, double x) { in.velocity += x > 0.7 ? in.velocity / 50 : 0; }), speed);
  EXPECT_EQ(refusal_with([](auto& in, double x) { in.velocity -= x > 0.7 ? in.velocity / 50 : 0; }), speed);
  EXPECT_EQ(refusal_with([](auto& in, double x) { in.load += x > 0.7 && x < 0.701 ? raw(0.05) : 0; }), saturated);
  EXPECT_EQ(refusal_with([](auto& in, double x) { in.load -= x > 0.7 && x < 0.701 ? raw(0.05) : 0; }), saturated);
  EXPECT_EQ(refusal_with([](auto& in, double x) { in.set_point -= x > 0.7 ? 1 : 0; }), none) << "of rounding";
}

TEST(CamTuning, TellsNothingOfNoRecordNorOfAPartOfAPeriod) {
  auto config = config_of({});
  EXPECT_NE(CamTuning::evaluate(config, CamTuning::State{}).refusal, CamTuningRefusal::none);
  Dwell dwell;
  dwell.end = dwell.settling + 0.02;
  config = config_of(dwell);
  EXPECT_EQ(CamTuning::evaluate(config, *recorded(config, dwell)).refusal, CamTuningRefusal::short_dwell);
  config.least_ticks = 0;
  EXPECT_EQ(CamTuning::evaluate(config, *recorded(config, dwell)).refusal, CamTuningRefusal::short_dwell);
}

// What it has no room for it leaves out: sums at their end, and samples behind the last one that is kept.
TEST(CamTuning, RecordsNoMoreThanItHasRoomFor) {
  const Dwell dwell;
  auto config = config_of(dwell);
  config.every = 1;
  const auto state = recorded(config, dwell);
  EXPECT_EQ(state->kept, std::uint32_t{CamTuning::record_size});
  EXPECT_GT(state->ticks, std::int32_t{CamTuning::record_size});
  state->stage = CamTuning::Stage::dwell;
  state->ticks = CamTuning::most_ticks;
  const auto sum = state->d;
  CamTuning::Input in;
  in.master = MasterPosition::way(std::llround(std::ldexp(0.7, 40)));
  in.velocity = config.speed;
  in.load = raw(0.06);
  CamTuning::step(config, *state, in);
  EXPECT_EQ(state->d, sum);
}

TEST(CamTuning, RefusesALoadThatIsStillOnItsWay) {
  Dwell dwell;
  dwell.vibration = {1e-4, 0.0};
  const Change creeps = [](auto& in, double x) { in.load += raw(2e-3 * std::exp(-(x - 0.5) / 0.2)); };
  EXPECT_EQ(refusal_with(creeps, dwell), CamTuningRefusal::moving);
}

TEST(CamTuning, RefusesADwellOfLessThanAPeriod) {
  Dwell dwell;
  dwell.end = dwell.settling + 0.9 * dwell.cycles_a_second / dwell.frequency;
  const auto config = config_of(dwell);
  const auto fit = CamTuning::evaluate(config, *recorded(config, dwell));
  EXPECT_EQ(fit.refusal, CamTuningRefusal::short_dwell);
}

TEST(CamTuning, RecordsNoCycleThatItDidNotSeeFromItsBeginOrThatTurnedBack) {
  const Dwell dwell;
  const auto config = config_of(dwell);
  CamTuning::State state;
  CamTuning::Input in;
  in.velocity = config.speed;
  const auto see = [&](double place) {
    in.master = MasterPosition::way(std::llround(std::ldexp(place, 40)));
    CamTuning::step(config, state, in);
  };
  see(0.3);
  see(0.6);
  EXPECT_EQ(state.stage, CamTuning::Stage::away) << "its begin was not seen";
  see(0.9995);
  EXPECT_EQ(state.stage, CamTuning::Stage::ready);
  see(1.1);
  see(1.6);
  EXPECT_EQ(state.stage, CamTuning::Stage::dwell);
  see(1.4);
  EXPECT_EQ(state.stage, CamTuning::Stage::away) << "the master turned back";
  see(1.6);
  EXPECT_EQ(state.stage, CamTuning::Stage::away);
}

TEST(CamTuning, KeepsAFullRecordUntilItIsGivenBack) {
  const Dwell dwell;
  const auto config = config_of(dwell);
  const auto state = recorded(config, dwell);
  const auto sum = state->d;
  for (int k = 0; k < 20000; ++k) {
    CamTuning::Input in;
    in.master = MasterPosition::way(std::llround(std::ldexp(1.0 + k * 1e-4, 40)));
    CamTuning::step(config, *state, in);
  }
  EXPECT_EQ(state->stage, CamTuning::Stage::full);
  EXPECT_EQ(state->d, sum);
  CamTuning::release(*state);
  EXPECT_EQ(state->stage, CamTuning::Stage::away);
}

}  // namespace
}  // namespace stiction
