// Records with a known test signal: the simulation that is judged beside them has it too, or is not judged.
#include "host/simulate/injection.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "host/diagnose/judge/closed_loop.hpp"
#include "host/diagnose/record/command_replay.hpp"
#include "host/diagnose/record/replay_setup.hpp"
#include "host/simulate/control_run.hpp"
#include "host/simulate/replay_result.hpp"
#include "sim/experiment/shuttle_path.hpp"
#include "sim/plant/friction/friction.hpp"
#include "stiction/number/fixed_signals.hpp"
#include "tests/support/figure.hpp"
#include "tests/support/shipped_machine.hpp"

namespace stiction::host {
namespace {

// The measured ball-screw axis: a force source that is driven by a voltage.
machine::Machine voltage_machine() {
  return sim::read_machine(std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/emps.toml");
}
// One axis of the cross table: a synchronous motor behind a current controller.
machine::Machine current_machine() {
  auto machine = test::cross_table();
  machine.axes.resize(1);
  return machine;
}

// Sines of 3 to 97 Hz.
double test_signal(double amplitude, double t) {
  double sum = 0.0;
  for (const double hertz : {3.0, 7.0, 11.0, 19.0, 31.0, 53.0, 97.0})
    sum += amplitude * std::cos(2.0 * std::numbers::pi * hertz * t + hertz * hertz);
  return sum;
}

// A record of `machine` going to and fro at 0.05 m/s for 6 s: every `stride`-th tick, with a test signal of that
// amplitude (A, V of a force source). The control runs here, not through a replay.
Log record(const machine::Machine& machine, double amplitude, std::int64_t stride) {
  const bool voltage = machine.axes.front().motor.model == machine::MotorModel::force;
  const sim::ShuttlePath path(0.05, 1.0, 20.0, 1.2);
  Log log;
  log.source = "shuttle";
  log.period = static_cast<double>(stride) * machine.timing.fast_period;
  log.axes.resize(1);
  auto& axis = log.axes.front();
  std::vector<sim::AxisSetPoint> set(1);
  ControlRun<FixedSignals> run(machine, std::vector<double>{0.0});
  for (std::int64_t tick = 0; run.time() < 6.0; ++tick) {
    const double t = run.time();
    set[0] = path.at(t);
    set[0].injection = test_signal(amplitude, t);
    run.tick(set);
    if (tick % stride != 0) continue;
    const auto& s = run.signals(0);
    log.t.push_back(t);
    axis.x_set.push_back(machine::to_si(s.x_set));
    axis.v_set.push_back(machine::to_si(s.v_set));
    axis.a_set.push_back(machine::to_si(s.a_set));
    axis.x.push_back(machine::to_si(s.x));
    (voltage ? axis.u : axis.i).push_back(machine::to_si(voltage ? s.i_set : s.i));
    if (amplitude != 0.0) (voltage ? axis.u_inject : axis.i_inject).push_back(set[0].injection);
  }
  return log;
}

double closed_loop_error(const machine::Machine& judged, const Log& log) {
  Verdict verdict;
  judge_in_closed_loop(verdict, judged, 0, {log});
  EXPECT_EQ(verdict.closed_loop_withheld, "");
  return verdict.baseline.position_error_rms.value_or(NAN);
}

struct Case {
  const char* name;
  machine::Machine machine;
  double amplitude;
  std::int64_t stride;  // ticks in a sample of the log
};
std::vector<Case> cases() {
  return {{"voltage at 1 kHz", voltage_machine(), 0.2, 1},
          {"current at 16 kHz", current_machine(), 0.4, 1},
          {"current at 1 kHz", current_machine(), 0.4, 16}};
}

// The machine file that is judged has 5 % less Coulomb friction than the machine that made the record, as a real file
// is always a little wrong: the test signal must not add to that.
machine::Machine file_of(machine::Machine machine) {
  auto& friction = machine.axes.front().friction;
  sim::set_coulomb(friction, 0.95 * sim::coulomb_of(friction));
  return machine;
}

TEST(TestSignals, LeaveTheClosedLoopErrorAsItIsWithout) {
  for (const auto& c : cases()) {
    const auto file = file_of(c.machine);
    const auto with = record(c.machine, c.amplitude, c.stride);
    const double without = closed_loop_error(file, record(c.machine, 0.0, c.stride));
    const double injected = closed_loop_error(file, with);
    auto hidden = with;
    hidden.axes.front().i_inject.clear();
    hidden.axes.front().u_inject.clear();
    const double ignored = closed_loop_error(file, hidden);
    test::figure(fmt::format("closed loop of a record with a test signal, {}", c.name),
                 fmt::format("{:.3g} um rms injected, {:.3g} um without any (bound 1.2 times), {:.3g} um ignored",
                             injected * 1e6, without * 1e6, ignored * 1e6));
    EXPECT_LE(injected, 1.2 * without) << c.name;
    EXPECT_GT(ignored, 3.0 * injected) << c.name << ": the test signal is too small to test anything";
  }
}

// With the true machine file a replay repeats the run: nothing of the signal is left over.
TEST(TestSignals, AreInTheReplaysOfDiagnosis) {
  for (const auto& c : cases()) {
    const auto log = record(c.machine, c.amplitude, c.stride);
    const auto silent = without_noise(c.machine, 0, {log});
    ASSERT_EQ(silent.replayed.size(), 1u) << c.name;
    const auto d = compare_replay(log, silent.replayed.front(), 0, 0.0);
    EXPECT_LT(d.position, 0.3e-6) << c.name;
    EXPECT_LT(d.effort, 0.02 * d.measured_effort) << c.name;
  }
}

TEST(TestSignals, AreInTheReplayOfTheCommand) {
  for (const auto& c : cases()) {
    const auto log = record(c.machine, c.amplitude, c.stride);
    const auto& channels = log.axes.front();
    const auto known = recorded_command(channels, c.machine.axes.front());
    ASSERT_TRUE(known) << c.name;
    const auto command = replay_command<FixedSignals>(c.machine.timing, c.machine.axes.front(), log, channels);
    double off = 0.0, size = 0.0;
    for (std::size_t k = 500; k < command.size(); ++k) {
      off += std::pow(command[k] - (channels.*known->values)[k], 2);
      size += std::pow((channels.*known->values)[k], 2);
    }
    EXPECT_LT(std::sqrt(off / size), 0.02) << c.name;
  }
}

TEST(TestSignals, BetweenSamplesFollowASineOfATenthOfTheirRate) {
  Log log;
  log.period = 1e-3;
  log.axes.resize(1);
  auto& axis = log.axes.front();
  for (int k = 0; k < 200; ++k) {
    log.t.push_back(1.0 + k * 1e-3);
    axis.i_inject.push_back(std::sin(2.0 * std::numbers::pi * 100.0 * log.t.back()));
  }
  const auto machine = current_machine();
  const Injection injection(log, axis, machine.axes.front());
  for (std::size_t k = 0; k < log.t.size(); ++k) EXPECT_EQ(injection.at(log.t[k]), axis.i_inject[k]);
  for (double t = 1.01; t < 1.19; t += 0.13e-3)
    EXPECT_NEAR(injection.at(t), std::sin(2.0 * std::numbers::pi * 100.0 * t), 0.01);
  EXPECT_EQ(injection.at(0.99), 0.0);
  EXPECT_EQ(injection.at(1.21), 0.0);
}

// Behind the current controller the simulation has no input.
TEST(TestSignals, ThatCannotActWithholdTheFigures) {
  const auto machine = current_machine();
  auto log = record(machine, 0.4, 16);
  auto& axis = log.axes.front();
  axis.u_inject.swap(axis.i_inject);
  Verdict verdict;
  judge_in_closed_loop(verdict, machine, 0, {log});
  EXPECT_FALSE(verdict.baseline.position_error_rms.has_value());
  EXPECT_EQ(verdict.closed_loop_withheld,
            "shuttle: found u_inject[V], a test signal behind the current controller of axis X, where the simulation "
            "has no input; expected i_inject[A], which is added to the set current");
  EXPECT_TRUE(without_noise(machine, 0, {log}).motion.empty());
  EXPECT_FALSE(recorded_command(axis, machine.axes.front()));
  const std::vector<ReplayCase> replays{{"file", machine, log}};
  EXPECT_NE(withheld_replay(log, replays.front(), 0, "X"), "");
  const auto result = replay_result(log, replays, "fixed", "X");
  for (const auto& figure : result.figures) EXPECT_EQ(figure.text.find("simulated"), std::string::npos) << figure.text;
  ASSERT_FALSE(result.findings.empty());
  EXPECT_NE(result.findings.front().find("the figures of the simulation are withheld"), std::string::npos);

  // A signal that is zero all the time is none.
  axis.u_inject.assign(log.t.size(), 0.0);
  EXPECT_EQ(refused_injection(axis, machine.axes.front()), "");
  // A force source has no current.
  axis.i_inject.assign(log.t.size(), 1.0);
  EXPECT_NE(refused_injection(axis, voltage_machine().axes.front()), "");
}

}  // namespace
}  // namespace stiction::host
