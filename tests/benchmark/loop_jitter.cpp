// How late the drive's loop begins its ticks on this machine, for a comparison with cyclictest at the same moment: the
// simulated cross table on its circle, paced by the kernel's clock, set up as the drive's programme sets itself up.
// usage: loop_jitter PERIOD_US SECONDS [PRIORITY [CPU]]
// Prints "median mean 99% 99.9% maximum" of the lateness (us), then "missed of ticks", then the time of each part.
#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <memory>
#include <string>

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "firmware/stictiond/real_time.hpp"
#include "hal/control_loop.hpp"
#include "hal/loop_timing.hpp"
#include "hal/paced_backend.hpp"
#include "hal/simulated/simulated_backend.hpp"
#include "sim/experiment/circle_path.hpp"
#include "sim/machine_file.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace {

using namespace stiction;
using S = FixedSignals;
using Simulated = hal::SimulatedBackend<S>;
using Paced = hal::PacedBackend<Simulated>;

double us(double time_ns) { return time_ns * 1e-3; }

std::string row(const hal::TimeCounts& t) {
  return fmt::format("{:.2f} {:.2f} {:.2f} {:.2f} {:.2f}", us(static_cast<double>(t.quantile(0.5))), us(t.mean),
                     us(static_cast<double>(t.quantile(0.99))), us(static_cast<double>(t.quantile(0.999))),
                     us(static_cast<double>(t.maximum)));
}

int run(std::int64_t period_ns, double seconds, const drive::RealTimeRequest& request) {
  const auto machine =
      sim::read_machine(std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/mcfv5050ln.toml", {"circle", {}});
  const sim::CirclePath path({.feed = 16.0 / 60.0});
  constexpr std::array<double, 2> start{0.09, 0.0};
  const auto timing = std::make_unique<hal::LoopTiming>();
  std::array<AxisConfig<S>, 2> configs;
  for (std::size_t i = 0; i < 2; ++i) configs[i] = machine::configure_axis<S>(machine.timing, machine.axes[i]);

  drive::RealTime real_time(request);
  real_time.prepare_process();
  real_time.prepare_thread();
  if (drive::any_refused(real_time.steps())) fmt::print(stderr, "{}", drive::text_of(real_time.steps()));

  Simulated simulated(machine, start);
  Paced paced(simulated, period_ns);
  hal::TimedBackend<Paced> timed(paced, *timing);
  hal::ControlLoop loop(
      timed, std::span<const AxisConfig<S>>(configs),
      Ticker(machine::fast_period_ns(machine.timing), static_cast<std::uint32_t>(machine::slow_ratio(machine.timing))));
  const auto ticks = static_cast<std::uint64_t>(seconds * 1e9 / static_cast<double>(period_ns));
  while (paced.clock().lateness().read().total + paced.clock().missed() < ticks) {
    // A hundred at a time: reading the histogram is not the loop's work.
    for (int i = 0; i < 100; ++i) {
      const auto point = path.at(static_cast<double>(loop.now_ns()) * 1e-9);
      const std::array set{sim::to_set_point<S>(point.axes[0]), sim::to_set_point<S>(point.axes[1])};
      timing->lap(hal::LoopPart::set_point);
      loop.tick(set);
    }
  }
  fmt::print("lateness {}\n", row(paced.clock().lateness().read()));
  fmt::print("missed {} of {}\n", paced.clock().missed(), ticks);
  for (std::size_t i = 0; i < hal::loop_part_names.size(); ++i)
    if (const auto counts = timing->part(static_cast<hal::LoopPart>(i)).read(); counts.total > 0)
      fmt::print("{} {}\n", hal::loop_part_names[i], row(counts));
  fmt::print("work {}\n", row(timing->work().read()));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    fmt::print(stderr, "usage: loop_jitter PERIOD_US SECONDS [PRIORITY [CPU]]\n");
    return 2;
  }
  drive::RealTimeRequest request;
  if (argc > 3) request.priority = std::atoi(argv[3]);
  if (argc > 4) request.cpu = std::atoi(argv[4]);
  return run(static_cast<std::int64_t>(std::atof(argv[1]) * 1e3), std::atof(argv[2]), request);
}
