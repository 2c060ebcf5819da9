#include "tests/benchmark/axis_run.hpp"

#include <valgrind/callgrind.h>

#include <array>
#include <cmath>

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "hal/control_loop.hpp"
#include "hal/simulated/simulated_backend.hpp"
#include "sim/experiment/circle_path.hpp"
#include "sim/machine_file.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::benchmark {
namespace {

const machine::Machine& machine() {
  static const machine::Machine one_axis = [] {
    auto m = sim::read_machine(std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/mcfv5050ln.toml",
                               {"circle", {"axis.X.motor.model=dc", "axis.X.friction.use=lugre"}});
    m.axes.resize(1);
    return m;
  }();
  return one_axis;
}

template <class S>
double run(double seconds) {
  const auto& m = machine();
  sim::CircleSettings settings;
  settings.feed = 16.0 / 60.0;
  const sim::CirclePath path(settings);
  const std::array<double, 1> start{settings.radius};
  hal::SimulatedBackend<S> backend(m, start);
  const std::array<AxisConfig<S>, 1> configs{machine::configure_axis<S>(m.timing, m.axes[0])};
  hal::ControlLoop loop(
      backend, std::span<const AxisConfig<S>>(configs),
      Ticker(machine::fast_period_ns(m.timing), static_cast<std::uint32_t>(machine::slow_ratio(m.timing))));
  const auto ticks = std::llround(seconds / m.timing.fast_period);
  const auto first_second = std::llround(1.0 / m.timing.fast_period);
  for (long long i = 0; i < ticks; ++i) {
    // Callgrind, told to wait, counts from here on: neither the reading of the machine file nor the start from rest.
    if (i == first_second) CALLGRIND_START_INSTRUMENTATION;
    const auto point = path.at(static_cast<double>(loop.now_ns()) * 1e-9);
    const std::array<SetPoint<S>, 1> set{sim::to_set_point<S>(point.axes[0])};
    loop.tick_untraced(set);
  }
  CALLGRIND_STOP_INSTRUMENTATION;
  return backend.plant(0).position();
}

}  // namespace

double run_axis_fixed(double seconds) { return run<FixedSignals>(seconds); }
double run_axis_double(double seconds) { return run<machine::DoubleSignals>(seconds); }

}  // namespace stiction::benchmark
