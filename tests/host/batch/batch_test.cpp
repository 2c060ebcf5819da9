#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <random>
#include <set>
#include <vector>

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "firmware/machine/configuration/compensation_configuration.hpp"
#include "hal/control_loop.hpp"
#include "hal/simulated/simulated_backend.hpp"
#include "host/batch/batch_run.hpp"
#include "sim/effects/effects.hpp"
#include "tests/host/batch/random_members.hpp"

namespace stiction::host {
namespace {

using S = machine::DoubleSignals;

// One member by itself, as hal::ControlLoop runs it: also behind a fault.
class Alone {
 public:
  explicit Alone(const RandomMember& member)
      : machine_(member.machine),
        backend_(machine_, std::array{member.start}),
        configs_{machine::configure_axis<S>(machine_.timing, sim::drive_axis(machine_.axes.front()))},
        compensations_(machine::configure_compensations<S>(machine_)),
        loop_(backend_, std::span<const AxisConfig<S>>(configs_),
              Ticker(machine::fast_period_ns(machine_.timing),
                     static_cast<std::uint32_t>(machine::slow_ratio(machine_.timing))),
              std::span<const FrictionCompensationConfig<S>>(compensations_)) {}

  void tick(const sim::AxisSetPoint& point) { loop_.tick(std::array{sim::to_set_point<S>(point)}); }
  const AxisSignals<S>& signals() const { return loop_.signals().front(); }
  const FrictionCompensationSignals<S>* compensation() const {
    return compensations_.empty() ? nullptr : &loop_.compensation_signals().front();
  }
  sim::AxisPlant& plant() { return backend_.plant(0); }

 private:
  machine::Machine machine_;
  hal::SimulatedBackend<S> backend_;
  std::vector<AxisConfig<S>> configs_;
  std::vector<FrictionCompensationConfig<S>> compensations_;
  hal::ControlLoop<hal::SimulatedBackend<S>> loop_;
};

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) || (std::isnan(a) && std::isnan(b));
}

// The name of the first signal that differs, or nothing.
template <class Signals>
std::string first_difference(const Signals& a, const Signals& b) {
  std::vector<double> values;
  for_each_signal(a, [&](auto, auto, auto, machine::Real value) { values.push_back(value.value); });
  std::size_t k = 0;
  std::string found;
  for_each_signal(b, [&](const char* name, auto, auto, machine::Real value) {
    if (found.empty() && !same_bits(values[k], value.value)) found = name;
    ++k;
  });
  return found;
}

std::string difference(const AxisSignals<S>& a, const AxisSignals<S>& b) {
  if (a.fault != b.fault) return "fault";
  if (a.limiting.velocity != b.limiting.velocity || a.limiting.current != b.limiting.current ||
      a.limiting.voltage != b.limiting.voltage)
    return "limiting";
  return first_difference(a, b);
}

class EachSet : public testing::TestWithParam<InstructionSet> {};

TEST_P(EachSet, Gives256AxesOfAllKindsTheBitsOfEachAloneBehindFaultsToo) {
  std::mt19937_64 random(32);
  const auto members = random_members(256, random);
  std::vector<BatchRun::Member> all;
  std::vector<std::unique_ptr<Alone>> alone;
  for (const auto& member : members) {
    all.push_back({&member.machine, 0, member.start});
    alone.push_back(std::make_unique<Alone>(member));
  }
  BatchRun run(all, GetParam());
  std::vector<sim::AxisSetPoint> points(members.size());
  std::vector<double> force(members.size()), from_outside(members.size());
  std::set<Fault> faults;
  std::size_t limited = 0, learned = 0, pulsed = 0;
  for (int tick = 0; tick < 1500; ++tick) {
    for (std::size_t k = 0; k < members.size(); ++k) points[k] = set_point_of(members[k], tick);
    for (std::size_t k = 0; k < members.size(); ++k) {
      from_outside[k] = external_force_of(members[k], tick);
      alone[k]->plant().set_external_force(from_outside[k]);
    }
    run.set_external_force(from_outside);
    run.tick(points);
    run.values(Row::motor_force, force);
    for (std::size_t k = 0; k < members.size(); ++k) {
      alone[k]->tick(points[k]);
      const auto found = run.signals(k);
      ASSERT_EQ(difference(alone[k]->signals(), found), "")
          << "member " << k << " (" << members[k].machine.id << ", " << members[k].machine.axes[0].friction.use
          << ") in tick " << tick;
      ASSERT_TRUE(same_bits(force[k], alone[k]->plant().motor_force())) << "member " << k << " in tick " << tick;
      limited += found.limiting.current || found.limiting.voltage || found.limiting.velocity;
      faults.insert(found.fault);
      if (const auto* compensation = alone[k]->compensation()) {
        const auto of_batch = run.compensation(k);
        ASSERT_EQ(first_difference(*compensation, of_batch), "") << "member " << k << " in tick " << tick;
        learned += of_batch.learned.value != 0.0;
        pulsed += of_batch.pulse.value != 0.0;
      }
    }
  }
  // The axes have been through what a batch must hold apart.
  EXPECT_GT(run.vectorised(), 60u);
  EXPECT_LT(run.vectorised(), members.size());
  EXPECT_TRUE(run.any_fault());
  for (const Fault fault : {Fault::none, Fault::set_point, Fault::following_error, Fault::over_current,
                            Fault::over_speed, Fault::limit_cycle})
    EXPECT_TRUE(faults.contains(fault)) << name_of(fault);
  EXPECT_GT(limited, 1000u);
  EXPECT_GT(learned, 1000u);
  EXPECT_GT(pulsed, 1000u);
}

TEST_P(EachSet, FillsABatchWithAsManyAxesAsItSays) {
  std::mt19937_64 random(2);
  const auto member = random_members(1, random).front();
  const std::vector<BatchRun::Member> alike(lanes_of(GetParam()) + 1, {&member.machine, 0, member.start});
  EXPECT_EQ(BatchRun(std::span(alike).first(alike.size() - 1), GetParam()).batches(), 1U);
  EXPECT_EQ(BatchRun(alike, GetParam()).batches(), 2U);
}

// Message of the error that a batch of these is refused with.
std::string refused(std::span<const BatchRun::Member> members, InstructionSet set = widest_instruction_set()) {
  try {
    const BatchRun run(members, set);
  } catch (const machine::ConfigurationError& error) {
    return error.what();
  }
  return "";
}

TEST(BatchRun, SaysWhatItDoesNotRun) {
  std::mt19937_64 random(1);
  auto members = random_members(2, random);
  auto& other = members[1].machine;
  std::vector<BatchRun::Member> both{{&members[0].machine, 0, 0.0}, {&other, 0, 0.0}};
  EXPECT_EQ(refused(both), "");
  EXPECT_NE(refused({}).find("expected at least one"), std::string::npos);
  other.timing.slow_period = 2e-3;
  EXPECT_NE(refused(both).find("32 of them in a slow one; expected 62500 ns and 16"), std::string::npos)
      << refused(both);
  other.timing.slow_period = 1e-3;
  other.axes[0].controller.emplace().structure = machine::ControlStructure::pid;
  EXPECT_NE(refused(both).find("expected the cascade"), std::string::npos) << refused(both);
#if defined(__x86_64__)
  EXPECT_NE(refused(std::span(both).first(1), InstructionSet::neon).find("found NEON"), std::string::npos);
#endif
}

INSTANTIATE_TEST_SUITE_P(Batch, EachSet, testing::ValuesIn(instruction_sets().begin(), instruction_sets().end()),
                         [](const auto& set) {
                           std::string name = name_of(set.param);
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace stiction::host
