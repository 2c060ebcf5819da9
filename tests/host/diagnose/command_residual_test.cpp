// The command residual: records of a drive with other gains than the file's, its control and the carriage by arithmetic
// of the test's own.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string_view>

#include "host/diagnose/classes/command_parameter.hpp"
#include "host/diagnose/diagnose.hpp"
#include "host/diagnose/judge/command_search.hpp"
#include "host/diagnose/record/command_replay.hpp"
#include "host/diagnose/record/record.hpp"
#include "host/diagnose/record/record_rows.hpp"
#include "sim/plant/friction/coulomb_viscous.hpp"
#include "sim/plant/friction/parameters.hpp"
#include "stiction/number/fixed_signals.hpp"
#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

constexpr double tick = 62.5e-6, duration = 12.0;  // s
constexpr int ticks_a_millisecond = 16;

struct Gains {
  double position = 80.0, velocity = 300.0, integral_time = 8e-3;  // 1/s, V s/m, s
};

// A force source of 10 N/V that moves 50 kg against 20 N and 100 N s/m.
machine::Machine force_machine() {
  machine::Machine machine;
  machine.name = machine.id = "bench";
  machine::AxisModel axis;
  axis.name = "X";
  axis.mass = 50.0;
  axis.travel = 1.0;
  axis.max_velocity = 1.0;
  axis.max_acceleration = 20.0;
  axis.motor.model = machine::MotorModel::force;
  axis.motor.force_constant = 10.0;
  axis.inverter.voltage_limit = 300.0;
  axis.encoder.velocity = machine::VelocitySource::ideal;
  axis.position_controller.gain = Gains{}.position;
  axis.velocity_controller = {Gains{}.velocity, Gains{}.integral_time};
  axis.feedforward = {1.0, 1.0};
  axis.friction.use = "coulomb_viscous";
  sim::set_parameters<sim::CoulombViscous<>>(axis.friction, {20.0, 100.0});
  machine.axes = {axis};
  return machine;
}

struct Set {
  double x, v, a;
};
Set set_at(double t, double shift) {
  constexpr double pi = std::numbers::pi;
  Set set{};
  // From rest: what a record begins with in motion is not what is tested here.
  const auto add = [&](double amplitude, double frequency) {
    const double w = 2.0 * pi * frequency;
    set.x += amplitude * (1.0 - std::cos(w * t));
    set.v += amplitude * w * std::sin(w * t);
    set.a += amplitude * w * w * std::cos(w * t);
  };
  add(0.06, 0.31 + 0.07 * shift);
  add(0.01, 1.13 - 0.2 * shift);
  return set;
}

// How the axis is measured, and by how much the drive has its set-points late.
struct Measured {
  double period = 1e-3;  // s
  double encoder = 0.0;  // m rms, of each reading
  double late = 0.0;     // s
};

// P position controller each millisecond, PI velocity controller with both feedforwards each tick, then the force.
host::Log record(const Gains& gains, double shift, std::uint64_t seed, const Measured& measured = {}) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  host::Log log;
  log.source = "shift " + std::to_string(shift);
  log.period = measured.period;
  const int ticks_a_sample = static_cast<int>(std::lround(measured.period / tick));
  auto& axis = log.axes.emplace_back();
  double x = set_at(0.0, shift).x, v = 0.0, held = 0.0, integral = 0.0, disturbance = 0.0;
  for (int k = 0; k < static_cast<int>(duration / tick); ++k) {
    const auto set = set_at(std::max(k * tick - measured.late, 0.0), shift);
    const double read = x + measured.encoder * normal(random);
    if (k % ticks_a_millisecond == 0) held = set.x - read;
    const double error = gains.position * held + set.v - v;
    integral += error * tick / gains.integral_time;
    const double u = gains.velocity * (error + integral) + 50.0 / 10.0 * set.a;
    if (k % ticks_a_sample == 0) {
      log.t.push_back(k * tick);
      axis.x_set.push_back(set_at(k * tick, shift).x);
      axis.x.push_back(read);
      axis.master.push_back(k * tick);
      axis.u.push_back(u + 0.01 * normal(random));
    }
    disturbance += 0.02 * (4.0 * normal(random) - disturbance);  // N, correlated over 3 ms
    const double friction = 20.0 * std::tanh(v / 1e-4) + 100.0 * v;
    const double next = v + tick / 50.0 * (10.0 * u - friction + disturbance);
    x += 0.5 * tick * (v + next);
    v = next;
  }
  return log;
}

host::Verdict verdict_of(const Gains& gains, std::uint64_t seed, const Measured& measured = {}) {
  host::DiagnoseInput input;
  input.machine = force_machine();
  input.logs = {record(gains, 0.0, 2 * seed, measured)};
  input.held_out = {record(gains, 1.0, 2 * seed + 1, measured)};
  input.closed_loop = false;
  return host::diagnose(input);
}

const host::Finding* found(const host::Verdict& verdict, std::string_view name) {
  for (const auto& finding : verdict.findings)
    if (finding.effect.name() == name) return &finding;
  return nullptr;
}
const host::Finding* gains_in(const host::Verdict& verdict) { return found(verdict, "controller_gain_mismatch"); }

TEST(CommandResidual, the_replay_commands_what_the_recorded_controller_did) {
  const auto log = record({}, 0.5, 1);
  const auto command =
      host::replay_command<FixedSignals>(force_machine().timing, force_machine().axes.front(), log, log.axes.front());
  // Above the integrator's memory: differences over 10 ms, noise of 10 mV on each.
  double square = 0.0, size = 0.0;
  for (std::size_t k = 1000; k < command.size(); ++k) {
    const auto& u = log.axes.front().u;
    const double recorded = u[k] - u[k - 10], replayed = command[k] - command[k - 10];
    square += (recorded - replayed) * (recorded - replayed);
    size += recorded * recorded;
  }
  EXPECT_LT(std::sqrt(square / static_cast<double>(command.size())), 0.05);
  EXPECT_GT(size, 100.0 * square);
}

TEST(CommandResidual, names_nothing_where_the_gains_are_those_of_the_file) {
  int named = 0;
  for (std::uint64_t seed = 1; seed <= 2; ++seed) named += gains_in(verdict_of({}, seed)) != nullptr;
  EXPECT_EQ(named, 0);
}

// Between the samples of a slow log the encoder reads what the log does not know.
TEST(CommandResidual, names_nothing_where_slow_logs_have_the_noise_of_the_encoder) {
  int named = 0;
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const auto verdict = verdict_of({}, seed, {.period = 4e-3, .encoder = 1e-6});
    named += gains_in(verdict) != nullptr || found(verdict, "master_delay") != nullptr;
  }
  EXPECT_EQ(named, 0);
}

// A set-point that is late makes the integrator of a replay run away: what is slow says most.
TEST(CommandResidual, finds_a_tenth_of_a_microsecond_behind_the_master_in_a_slow_log) {
  constexpr double late = 1e-7;
  const auto verdict = verdict_of({}, 3, {.period = 4e-3, .encoder = 1e-7, .late = late});
  EXPECT_EQ(gains_in(verdict), nullptr);
  const auto* finding = found(verdict, "master_delay");
  ASSERT_NE(finding, nullptr);
  const double value = finding->values.at("delay").front();
  figure("command residual, delay behind the master in a log of 4 ms",
         std::to_string(1e9 * value) + " ns, true 100 ns");
  EXPECT_NEAR(value, late, 0.1 * late);
}

// What records of the exact machine seem to have as well is the replay's doing, whatever its odds.
TEST(CommandResidual, tells_a_change_that_exact_records_seem_to_have_too) {
  const auto machine = force_machine();
  const auto& axis = machine.axes.front();
  host::Record training;
  training.logs = {record({.position = 88.0}, 0.0, 1)};
  host::measure(training, axis, host::signals_in(host::RowBand::usual, training.logs));
  const host::CommandRecords records{training.logs, training.rows, {}};
  const host::CommandRows commands(records, machine.timing, axis, 0.0);
  host::Places places;
  for (std::size_t k = 0; k < host::command_parameters().size(); ++k)
    if (const auto& parameter = host::command_parameters()[k]; parameter.value(axis) && !parameter.of_master)
      places.push_back(k);
  const auto chance_if_exact_records_have = [&](double gain) {
    auto found = host::search_command(commands, places);
    EXPECT_EQ(found.terms.size(), 1u);
    const auto draws = [&](std::size_t begin, std::size_t end) {
      std::vector<std::vector<host::Log>> all;
      for (std::size_t k = begin; k < end; ++k) all.push_back({record({.position = gain}, 0.0, k)});
      return all;
    };
    host::compare_with_exact(records, commands, draws, found);
    return found.terms.front().p_of_exact;
  };
  EXPECT_GT(chance_if_exact_records_have(88.0), 0.001);
  EXPECT_LT(chance_if_exact_records_have(80.0), 1e-6);
}

struct Case {
  Gains gains;
  const char* key;
  double value;
};

TEST(CommandResidual, names_the_gain_that_differs_with_its_value_and_leaves_the_others) {
  for (const auto& c :
       {Case{{.position = 88.0}, "position_gain", 88.0}, Case{{.velocity = 285.0}, "velocity_gain", 285.0},
        Case{{.integral_time = 9e-3}, "velocity_integral_time", 9e-3}}) {
    const auto verdict = verdict_of(c.gains, 5);
    const auto* finding = gains_in(verdict);
    ASSERT_NE(finding, nullptr) << c.key;
    ASSERT_TRUE(finding->values.contains(c.key)) << c.key;
    const double value = finding->values.at(c.key).front();
    figure(std::string("command residual, ") + c.key, std::to_string(value) + ", true " + std::to_string(c.value));
    EXPECT_EQ(finding->parameters.size(), 1u) << c.key;
    EXPECT_NEAR(value, c.value, 0.001 * c.value) << c.key;
    EXPECT_EQ(finding->residual, host::Residual::command);
    EXPECT_LT(*finding->holdout.command_rms_ratio, 0.9);
    EXPECT_LT(*verdict.extended.command_rms, *verdict.baseline.command_rms);
  }
}

}  // namespace
}  // namespace stiction::test
