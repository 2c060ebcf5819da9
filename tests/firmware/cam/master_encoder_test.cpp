// The encoder of a shaft on a bus (CiA 406) as a master: what the drive makes of positions that come each so many
// ticks, against the motion of the shaft in double precision.
#include "stiction/drive/master_encoder.hpp"

#include <functional>

#include "stiction/drive/cam_master.hpp"
#include "tests/firmware/cam/cam_bench.hpp"

namespace stiction::test {
namespace {

constexpr double lines = 40'000.0;  // counts a turn
constexpr double part = 0x1p-16;    // of a tick

// A shaft whose position (turns, of the time in ticks) is measured each `period` ticks, at any time within one.
class Shaft {
 public:
  explicit Shaft(double every = 16.25, std::int64_t range = std::int64_t{1} << 32)
      : period(every), encoder(configuration(every, range)), master(configuration_of_master(every)) {}

  static MasterEncoder::Config configuration(double period, std::int64_t range) {
    MasterEncoder::Config config;
    config.range = range;
    config.cycle = static_cast<std::int64_t>(lines);
    config.period = std::llround(period / part);
    config.patience = 3 * config.period;
    config.most = 800;
    return config;
  }
  static CamMaster::Config configuration_of_master(double period) {
    CamMaster::Config config;
    config.measured = true;
    config.cycle = Span::of(static_cast<std::int64_t>(lines) << MasterEncoder::part_bits);
    config.estimator = {.bits = 6,
                        .half_count = std::llround(0x1p63 / lines),
                        .jump = std::int64_t{1} << 58,
                        .look_ahead = static_cast<std::int32_t>(std::llround(period / part))};
    return config;
  }

  // The next tick, with what was measured since the one before.
  MasterReading tick() {
    now += 1.0;
    while (next <= now) {
      const double counts = std::floor(at(next) * lines);
      const auto range = static_cast<double>(range_);
      if (hears)
        encoder.take(static_cast<std::uint32_t>(counts - range * std::floor(counts / range)),
                     std::llround((now - next) / part));
      next += period;
    }
    const auto place = encoder.step();
    return master.see(place.cycles, place.part, place.valid);
  }
  // Turns by which a reading is off.
  double off(const MasterReading& reading) const { return cycles_of(reading.point.position) - at(now); }

  std::function<double(double)> at = [](double) { return 0.0; };
  double period, now = 0.0, next = 0.5;
  bool hears = true;
  MasterEncoder encoder;
  CamMaster master;
  std::int64_t range_ = std::int64_t{1} << 32;
};

// A count is a step of the measured position, which may lie anywhere within it.
TEST(MasterEncoder, IsWhereTheShaftIsAtConstantSpeed) {
  for (const double speed : {130.0 / 60.0, -130.0 / 60.0, 0.013}) {
    constexpr int second_position = 16;
    Shaft shaft;
    shaft.at = [&](double t) { return 3.3 + speed * t / rate; };
    double worst = 0.0, worst_speed = 0.0, worst_acceleration = 0.0;
    for (int k = 0; k < 40'000; ++k) {
      const auto reading = shaft.tick();
      ASSERT_EQ(reading.valid, k >= second_position + 16 * 64 - 1) << k;
      if (k < 4'000) continue;
      worst = std::max(worst, std::abs(shaft.off(reading)));
      worst_speed = std::max(worst_speed, std::abs(velocity_of(reading.point.velocity) - speed));
      worst_acceleration = std::max(worst_acceleration, std::abs(acceleration_of(reading.point.acceleration)));
    }
    EXPECT_LT(worst, 1.0 / lines);
    const double step = 1.0 / lines / shaft.period * rate;  // of speed: a count in a period
    EXPECT_LT(worst_speed, 0.25 * step);
    EXPECT_LT(worst_acceleration, 0.1 * step / (4.0 * shaft.period / rate)) << "the filter is four periods long";
  }
}

// Between two positions the way shown is a chord, which at an acceleration a is a T^2 / 12 from the curve in the mean.
TEST(MasterEncoder, LagsByAChordAtConstantAcceleration) {
  constexpr double a = 5.0;  // turns/s^2
  Shaft shaft;
  shaft.at = [&](double t) { return 0.5 * a * t * t / rate / rate; };
  double worst = 0.0;
  MasterReading reading;
  for (int k = 0; k < 16'000; ++k) {
    reading = shaft.tick();
    if (k > 4'000) worst = std::max(worst, std::abs(shaft.off(reading)));
  }
  const double chord = a * std::pow(shaft.period / rate, 2) / 8.0;
  EXPECT_LT(worst, 0.7 / lines + chord);
  EXPECT_NEAR(velocity_of(reading.point.velocity), a * shaft.now / rate, 0.1 / lines * rate / 16.0 + a / rate);
  EXPECT_NEAR(acceleration_of(reading.point.acceleration), a, 0.3);
}

// Whole counts: what is shown is what was counted, however often the value and the cycle began anew.
TEST(MasterEncoder, DoesNotDriftOverItsRange) {
  MasterEncoder::Config config;
  config.range = (std::int64_t{1} << 24) - 3;
  config.cycle = 35'501;
  config.most = 1 << 22;
  MasterEncoder encoder(config);
  std::mt19937_64 draw(7);
  std::int64_t counted = 1000;
  MasterEncoder::Place place;
  for (int k = 0; k < 2'000'000; ++k) {
    const std::int64_t value = (counted % config.range + config.range) % config.range;
    encoder.take(static_cast<std::uint32_t>(value), 0);
    // A period is a tick: what is shown comes there in the next one.
    encoder.step();
    place = encoder.step();
    if (k % 1000 == 999) {
      const std::int64_t shown = place.cycles * config.cycle + (place.part >> MasterEncoder::part_bits);
      ASSERT_NEAR(static_cast<double>(shown), static_cast<double>(counted), 1.0);
      ASSERT_TRUE(place.valid);
    }
    // Forward in the mean: 3 * 10^11 counts in all.
    counted += static_cast<std::int64_t>(draw() % (1u << 22)) - (1 << 20);
  }
  EXPECT_GT(place.cycles, 25'000'000);
}

TEST(MasterEncoder, GoesOnWhereOnePositionIsMissing) {
  constexpr double speed = 2.0;
  Shaft shaft;
  shaft.at = [&](double t) { return speed * t / rate; };
  for (int k = 0; k < 4'000; ++k) shaft.tick();
  double worst = 0.0;
  for (int k = 0; k < 16'000; ++k) {
    // One in seven, each alone.
    shaft.hears = static_cast<int>(shaft.next / shaft.period) % 7 != 3;
    const auto reading = shaft.tick();
    ASSERT_TRUE(reading.valid) << k;
    worst = std::max(worst, std::abs(shaft.off(reading)));
  }
  EXPECT_LT(worst, 1.0 / lines);
}

TEST(MasterEncoder, IsLostBehindThreePeriodsAndHasToBeKnownAgain) {
  Shaft shaft;
  shaft.at = [](double t) { return 2.0 * t / rate; };
  for (int k = 0; k < 4'000; ++k) shaft.tick();
  shaft.hears = false;
  int ticks = 0;
  while (shaft.tick().valid && ticks < 100) ++ticks;
  EXPECT_NEAR(ticks, 3 * 16.25, 17.0) << "from the last position on, which is up to a period old";
  shaft.hears = true;
  ticks = 0;
  while (!shaft.tick().valid && ticks < 3'000) ++ticks;
  EXPECT_NEAR(ticks, 16 * 64 + 2 * 16.25, 17.0);
  EXPECT_NEAR(shaft.off(shaft.tick()), std::round(shaft.off(shaft.tick())), 1.0 / lines) << "in its cycle";
}

TEST(MasterEncoder, IsLostWhileItSaysThatItIsBroken) {
  Shaft shaft;
  for (int k = 0; k < 4'000; ++k) shaft.tick();
  shaft.encoder.say(true);
  for (int k = 0; k < 3'000; ++k) ASSERT_FALSE(shaft.tick().valid);
  shaft.encoder.say(false);
  for (int k = 0; k < 3'000; ++k) shaft.tick();
  EXPECT_TRUE(shaft.tick().valid);
}

// A twentieth of a turn at once: the slave behind it sees the place that it jumped to.
TEST(MasterEncoder, ShowsAJumpAtOnce) {
  Shaft shaft;
  double jump = 0.0;
  shaft.at = [&](double t) { return 0.5 * t / rate + jump; };
  for (int k = 0; k < 4'000; ++k) shaft.tick();
  jump = 0.05;
  double largest = 0.0, last = cycles_of(shaft.tick().point.position);
  for (int k = 0; k < 40; ++k) {
    const double here = cycles_of(shaft.tick().point.position);
    largest = std::max(largest, here - last);
    last = here;
  }
  EXPECT_NEAR(largest, 0.05, 1e-3);
}

// Where a position comes each tick, it may be nearly as old as its period, or, heard late, older.
TEST(MasterEncoder, GoesEvenlyWherePositionsAreAsOldAsTheirPeriod) {
  constexpr std::int64_t tick = std::int64_t{1} << 16;
  for (const std::int64_t age : {tick / 4, 3 * tick / 4, tick, 3 * tick}) {
    MasterEncoder::Config config;
    config.range = std::int64_t{1} << 24;
    config.cycle = std::int64_t{1} << 22;
    config.most = 800;
    config.patience = 10 * tick;
    MasterEncoder encoder(config);
    std::int64_t before = 0;
    for (int k = 0; k < 1000; ++k) {
      encoder.take(static_cast<std::uint32_t>(100 * k), age);
      const auto place = encoder.step();
      const std::int64_t counts = place.cycles * config.cycle + (place.part >> MasterEncoder::part_bits);
      if (k > 100) {
        EXPECT_TRUE(place.valid) << age;
        EXPECT_NEAR(static_cast<double>(counts - before), 100.0, 1.0) << age;
        EXPECT_NEAR(static_cast<double>(counts), 100.0 * k, 200.0) << age << ": up to two periods behind";
      }
      before = counts;
    }
  }
}

}  // namespace
}  // namespace stiction::test
