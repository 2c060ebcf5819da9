// The simulated machine's own side of a bus: when its faults come, what its options refuse, where its marks are, and
// the folder in the PWM class' place.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <map>

#include "hal/simulated/simulated_backend.hpp"
#include "host/plant/fault_schedule.hpp"
#include "host/plant/gpio_sim.hpp"
#include "host/plant/plant_options.hpp"
#include "host/plant/pwm_folder.hpp"
#include "tests/support/shipped_machine.hpp"

namespace stiction::test {
namespace {

using host::FaultSchedule;
using host::PlantFault;
using ::testing::HasSubstr;

PlantFault fault_of(std::string_view name, std::uint64_t from = 0, std::uint64_t ticks = 1) {
  for (const auto& kind : host::plant_faults)
    if (kind.name == name) return {.kind = &kind, .axis = 0, .from_tick = from, .ticks = ticks};
  throw std::invalid_argument(std::string(name));
}

// Ticks at which a fault begins, and which.
std::vector<std::pair<std::uint64_t, std::string_view>> begins_of(FaultSchedule schedule, std::uint64_t ticks) {
  std::vector<std::pair<std::uint64_t, std::string_view>> begins;
  for (std::uint64_t tick = 1; tick <= ticks; ++tick) {
    schedule.advance(tick);
    for (const auto& fault : schedule.faults())
      if (fault.from_tick == tick) begins.emplace_back(tick, fault.kind->name);
  }
  return begins;
}

TEST(FaultSchedule, DrawsTheSameFaultsFromTheSameSeedSoFarApartInTheMeanAndNeverTooClose) {
  const std::vector<PlantFault> choice{fault_of("frame-lost", 7, 100), fault_of("encoder-jump", 9, 100)};
  constexpr double mean = 1000.0;
  const auto begins = begins_of({choice, mean, 3}, 1'000'000);
  EXPECT_EQ(begins, begins_of({choice, mean, 3}, 1'000'000));
  EXPECT_NE(begins, begins_of({choice, mean, 4}, 1'000'000));
  // The random three quarters of the mean scatter by themselves: 750 / sqrt(1000) = 24 ticks, three times that.
  EXPECT_NEAR(1e6 / static_cast<double>(begins.size()), mean, 72.0);
  std::map<std::string_view, int> drawn;
  std::uint64_t before = 0;
  for (const auto& [tick, name] : begins) {
    EXPECT_GE(tick - before, 250u);
    before = tick;
    ++drawn[name];
  }
  EXPECT_EQ(drawn.size(), 2u);
}

TEST(FaultSchedule, BreaksAPartThatAnyOfItsFaultsBreaks) {
  const FaultSchedule schedule({fault_of("encoder-jump", 10, 5), fault_of("encoder-jump", 20, 5)});
  hal::AxisFaults faults;
  hal::MotorSignals signals;
  const auto shift_at = [&](std::uint64_t tick) {
    schedule.break_parts(
        tick, [&](std::size_t) -> hal::AxisFaults& { return faults; },
        [&](std::size_t) -> hal::MotorSignals& { return signals; });
    return faults.encoder_shift;
  };
  EXPECT_EQ(shift_at(9), 0.0);
  EXPECT_EQ(shift_at(12), 50e-6);
  EXPECT_EQ(shift_at(15), 0.0);
  EXPECT_EQ(shift_at(24), 50e-6);
  EXPECT_EQ(shift_at(25), 0.0);
}

TEST(PlantOptions, RefuseWhatCannotBeAndSayWhatWasExpected) {
  const auto machine = cross_table();
  struct Refused {
    host::PlantOptions options;
    const char* text;
  };
  const auto with = [](const char* bus, std::vector<std::string> faults, const char* every = "") {
    host::PlantOptions options;
    options.bus = bus;
    options.faults = std::move(faults);
    options.fault_every = every;
    return options;
  };
  for (const auto& [options, text] :
       {Refused{with("gpio", {"frame-lost"}), "--fault: found 'frame-lost' on the bus gpio; expected one of tracks-"},
        Refused{with("can:vcan0", {"tracks-together"}), "--fault: found 'tracks-together' on the bus can; expected"},
        Refused{with("can:vcan0", {"bus-off,at=-1 s"}), "--fault: found '-1 s'; expected a time from 0 on"},
        Refused{with("can:vcan0", {}, "60 s"), "--fault-every: found no --fault"},
        Refused{with("can:vcan0", {"bus-off,ticks=16000"}, "4 s"), "expected less than a quarter of '4 s', 64000"},
        Refused{with("gpio:chip", {}), "--bus: found 'gpio:chip'; expected can:INTERFACE"}})
    try {
      host::faults_of(options, machine);
      ADD_FAILURE() << text;
    } catch (const host::PlantOptionError& error) {
      EXPECT_THAT(error.what(), HasSubstr(text));
    }
  host::PlantOptions marks;
  for (const char* text : {"X.index", "X.middle=0 mm", "Z.index=0 mm", "X.index=1 s"}) {
    marks.marks = {text};
    EXPECT_THROW(host::marks_of(marks, machine), host::PlantOptionError) << text;
  }
  marks.marks = {"Y.limit_positive=3 mm"};
  EXPECT_EQ(host::marks_of(marks, machine)[1].limit_positive, 3e-3);
}

// A carriage that is pushed past marks every 100 um, there and back.
TEST(FaultyBackend, PassesEveryIndexMarkOfAScaleWhereItIs) {
  const auto machine = cross_table({"axis.*.friction.use=coulomb_viscous"});
  hal::SimulatedBackend<FixedSignals> simulated(machine, std::array{0.0, 0.0});
  hal::FaultyBackend faulty(simulated, 62'500, 1e-9);
  faulty.marks(0).index = 0.05e-3;
  faulty.marks(0).index_every = 0.1e-3;
  std::array<Feedback<FixedSignals>, 2> feedback;
  std::array<DigitalInputs<FixedSignals>, 2> inputs;
  std::vector<double> passed;
  double before = 0.0, furthest = 0.0;
  for (int i = 0; i < 4000; ++i) {
    simulated.plant(0).set_external_force(i < 1000 ? 3000.0 : i < 3000 ? -3000.0 : 3000.0);
    faulty.wait_for_tick();
    faulty.read(feedback);
    faulty.read_inputs(inputs);
    const double x = machine::to_si(feedback[0].position);
    furthest = std::max(furthest, x);
    if (inputs[0].index) {
      const double mark = machine::to_si(inputs[0].index_position);
      passed.push_back(mark);
      EXPECT_LE(std::min(before, x) - 1e-9, mark);
      EXPECT_GE(std::max(before, x) + 1e-9, mark);
      EXPECT_NEAR(std::remainder(mark - 0.05e-3, 0.1e-3), 0.0, 1e-9);
    }
    before = x;
  }
  EXPECT_GT(furthest, 1e-3);
  EXPECT_GT(passed.size(), 20u);
  EXPECT_GT(passed.front(), 0.0);
  EXPECT_LT(passed.back(), passed[passed.size() / 2]);
}

TEST(PwmFolder, IsMadeReadAndRemovedAgainAndOneThatIsThereStays) {
  const auto path = std::filesystem::temp_directory_path() / ("stiction_pwm_folder_" + std::to_string(::getpid()));
  std::filesystem::remove_all(path);
  {
    const plant::PwmFolder made(path, 2);
    EXPECT_EQ(made.duty_ns(1), 0);
    std::ofstream(path / "pwm1" / "duty_cycle") << "31250\n99";
    EXPECT_EQ(made.duty_ns(1), 31250);
    { const plant::PwmFolder found(path, 2); }
    EXPECT_EQ(made.duty_ns(1), 31250) << "still there";
    EXPECT_THROW(plant::PwmFolder(path, 3), plant::GpioSimError);
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace stiction::test
