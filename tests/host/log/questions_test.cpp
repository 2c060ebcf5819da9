#include "host/log/questions.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/host/log/drawn_record.hpp"
#include "tests/support/figure.hpp"

namespace stiction::host {
namespace {

using About = Question::About;

// The constants of questions.cpp were set with the records of seeds 1 to 200 and 1001 to 1200; those reported here
// begin at 9001.
constexpr unsigned first_seed = 9001;
constexpr int records = 200;

struct Count {
  int asked = 0, of = 0;
  std::string text() const {
    const double n = of, p = asked / n, z = 1.96, d = 1.0 + z * z / n;
    const double middle = (p + z * z / (2.0 * n)) / d;
    const double half = z / d * std::sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n));  // Wilson
    return fmt::format("{} of {}, {:.1f} % (95 % interval {:.1f} to {:.1f} %)", asked, of, 100.0 * p,
                       100.0 * std::max(0.0, middle - half), 100.0 * std::min(1.0, middle + half));
  }
};

bool asks(const std::vector<Question>& questions, About about) {
  return std::ranges::any_of(questions, [&](const auto& q) { return q.about == about; });
}

TEST(Questions, AreAskedOfWrongRecordsAndNotOfSoundOnes) {
  const auto* from = std::getenv("STICTION_QUESTION_SEED");
  const unsigned seed = from != nullptr ? static_cast<unsigned>(std::atoi(from)) : first_seed;
  const bool verbose = from != nullptr;
  Count sound, amperes, length, sign, shift;
  for (int k = 0; k < records; ++k) {
    const auto r = test::draw_record(seed + static_cast<unsigned>(k));
    std::mt19937 random(seed + static_cast<unsigned>(k) + 100000u);
    const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
    const KnownAxis known{r.machine.mass / uniform(0.85, 1.15), r.machine.force_constant, {}, {}, {}};
    const auto what = fmt::format("seed {} {} friction {} {:.0f} Hz {:.1e} m", seed + static_cast<unsigned>(k),
                                  r.machine.name, static_cast<int>(r.friction), r.rate, r.increment);
    const auto log = test::written(r);
    const auto& axis = log.axes[0];
    const auto told = questions_of(log, axis, known);
    ++sound.of;
    sound.asked += !told.empty();
    const auto effort = axis.i.empty() ? axis.u : axis.i;
    const auto motion = rigid_motion(log, axis, effort);
    if (verbose) {
      fmt::print("{}: {}", what, motion ? "" : "no mass\n");
      if (motion)
        fmt::print("mass {:.3f} +- {:.3f}, delay {:.2f} +- {:.2f} ms, explained {:.4f}, window {:.2f} rest {:.2f}\n",
                   motion->mass * r.machine.force_constant / r.machine.mass,
                   motion->mass_error * r.machine.force_constant / r.machine.mass, 1e3 * motion->delay,
                   1e3 * motion->delay_error, motion->explained, motion->window, motion->rest_ratio);
      for (const auto& q : told) fmt::print("   FALSE {}\n", q.text);
    }
    // Where the record gives no mass within the 15 % of the file, a ratio cannot be asked about.
    const bool determined = motion && motion->mass > 0.0 && 1.96 * motion->mass_error < 0.15 * motion->mass;
    if (determined) {
      if (!r.machine.voltage) {
        auto rms = log;
        for (double& i : rms.axes[0].i) i /= std::numbers::sqrt2 * uniform(0.97, 1.03);
        ++amperes.of;
        amperes.asked += asks(questions_of(rms, rms.axes[0], known), About::amperes);
      }
      auto other = log;
      const double factor = uniform(0.0, 1.0) < 0.5 ? 1e3 : 1e-3;
      for (auto* values : {&other.axes[0].x, &other.axes[0].x_set})
        for (double& value : *values) value *= factor;
      ++length.of;
      length.asked += asks(questions_of(other, other.axes[0], known), About::length);
      auto swapped = log;
      for (auto* values : {&swapped.axes[0].i, &swapped.axes[0].u})
        for (double& value : *values) value = -value;
      ++sign.of;
      sign.asked += asks(questions_of(swapped, swapped.axes[0], known), About::sign);
      const auto late = test::written(r, (uniform(0.0, 1.0) < 0.5 ? 1.0 : -1.0) * uniform(5e-3, 20e-3));
      ++shift.of;
      const auto asked = asks(questions_of(late, late.axes[0], known), About::shift);
      shift.asked += asked;
      if (verbose && !asked) {
        const auto m = rigid_motion(late, late.axes[0], late.axes[0].i.empty() ? late.axes[0].u : late.axes[0].i);
        if (m)
          fmt::print("   SHIFT NOT ASKED {:.2f} +- {:.2f} ms, explained {:.2f} rest {:.2f}\n", 1e3 * m->delay,
                     1e3 * m->delay_error, m->explained, m->rest_ratio);
      }
    }
  }
  test::figure("false questions on sound records", sound.text() + " (bound 2 %)");
  test::figure("asked: rms amperes", amperes.text());
  test::figure("asked: length in another unit", length.text());
  test::figure("asked: swapped sign", sign.text());
  test::figure("asked: effort 5 to 20 ms late or early", shift.text());
  EXPECT_LE(sound.asked, records * 2 / 100);
  EXPECT_GE(length.of, records / 2);
  // A mass at the end of its 15 % and a scale 3 % off leave no gap to a sound record, and a delay of 5 ms on a record
  // of 20 ms a sample may be found as 3: three in a hundred may be missed.
  for (const auto* count : {&amperes, &length, &sign, &shift}) EXPECT_GE(100 * count->asked, 97 * count->of);
}

// A pendulum on a motor: i = (J phi'' + b phi' + m g l sin(phi - rest))/K, in closed form for a swing.
TEST(Questions, AKnownWeightThatTurnsPassesForNoMassAndNoDelay) {
  constexpr double inertia = 0.6, damping = 0.5, moment = 12.0, rest = 0.2, constant = 20.0, rate = 6.0;
  Log log;
  log.source = "swing";
  log.period = 1e-3;
  auto& axis = log.axes.emplace_back();
  axis.rotary = true;
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 2e-3);
  for (int k = 0; k < 12000; ++k) {
    const double t = k * log.period, x = 1.1 * std::sin(rate * t), v = 1.1 * rate * std::cos(rate * t);
    log.t.push_back(t);
    axis.x.push_back(std::round(x / 1.5e-5) * 1.5e-5);
    axis.i.push_back((-inertia * rate * rate * x + damping * v + moment * std::sin(x - rest)) / constant +
                     noise(random));
  }
  KnownAxis known;
  known.mass = inertia;
  known.force_constant = constant;
  EXPECT_FALSE(questions_of(log, axis, known).empty());  // the weight goes with the way, as the acceleration does
  known.weight = TurningWeight{moment, rest};
  for (const auto& question : questions_of(log, axis, known)) ADD_FAILURE() << question.text;
}

// A contact that yields, with a loss, in two sines of micrometres: its force goes with the position, which a mass of
// the other sign would explain. Friction takes power in it, so no channel has the wrong sign; where one has, both are
// negative.
TEST(Questions, AContactThatYieldsIsNoMassOfTheWrongSign) {
  constexpr double mass = 200.0, stiffness = 8e5, damping = 4e3, constant = 90.0, low = 12.0, high = 31.0;  // rad/s
  Log log;
  log.source = "reversals";
  log.period = 1e-3;
  auto& axis = log.axes.emplace_back();
  std::mt19937 random(11);
  std::normal_distribution<double> noise(0.0, 2e-4);
  for (int k = 0; k < 12000; ++k) {
    const double t = k * log.period;
    const double x = 40e-6 * std::sin(low * t) + 10e-6 * std::sin(high * t);
    const double v = 40e-6 * low * std::cos(low * t) + 10e-6 * high * std::cos(high * t);
    const double a = -40e-6 * low * low * std::sin(low * t) - 10e-6 * high * high * std::sin(high * t);
    log.t.push_back(t);
    axis.x.push_back(std::round(x / 1e-8) * 1e-8);
    axis.i.push_back((mass * a + damping * v + stiffness * x) / constant + noise(random));
  }
  KnownAxis known;
  known.mass = mass;
  known.force_constant = constant;
  for (const auto& question : questions_of(log, axis, known)) ADD_FAILURE() << question.text;
  for (double& i : axis.i) i = -i;
  EXPECT_FALSE(questions_of(log, axis, known).empty());
}

}  // namespace
}  // namespace stiction::host
