// Runs both axes of the shipped machine for one second in closed loop and records what went into the firmware, with a
// digest of its trace a tick; prints the hash of every signal, as `replay` does. The motion visits all that can make a
// tick take another path; what it did not visit is an error.
// usage: record_inputs RECORDING
#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <fstream>

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "hal/control_loop.hpp"
#include "hal/simulated/simulated_backend.hpp"
#include "sim/experiment/circle_path.hpp"
#include "sim/machine_file.hpp"
#include "stiction/number/fixed_signals.hpp"
#include "tests/targets/recording.hpp"
#include "tests/targets/trace_hash.hpp"

namespace {

using namespace stiction;
using S = FixedSignals;

constexpr double duration = 1.0;  // s

machine::Machine machine() {
  std::vector<std::string> set;
  for (const char* axis : {"X", "Y"})
    for (const char* value : {"encoder.velocity=estimated", "encoder.noise=1 nm"})
      set.push_back(fmt::format("axis.{}.{}", axis, value));
  return sim::read_machine(std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/mcfv5050ln.toml",
                           {"circle", std::move(set)});
}

// A circle with its reversals; then, on top of it, what drives the loops into each of their limits.
class Motion {
 public:
  double start(std::size_t axis) const { return path_.at(0.0).axes[axis].position; }

  sim::AxisSetPoint at(double t, std::size_t axis) const {
    sim::AxisSetPoint set = path_.at(t).axes[axis];
    // A test signal in the set current.
    if (within(t, 0.30, 0.32)) set.injection = within(t, 0.31, 0.32) ? -1.5 : 1.5;
    // Wanted speeds of either sign beyond the limit.
    if (within(t, 0.55, 0.562)) set.velocity += within(t, 0.554, 0.558) ? -3.0 : 3.0;
    // A step that asks for more current and voltage than there is.
    if (within(t, 0.65, 0.66)) set.position += 1.2e-3;
    // An acceleration whose feedforward the current's format cannot hold on the heavy axis.
    if (within(t, 0.72, 0.722)) set.acceleration = within(t, 0.721, 0.722) ? -510.0 : 510.0;
    // A jump beyond the following error that the format holds: a fault, which stops both axes.
    if (t > 0.95 && axis == 0) set.position += 0.7;
    return set;
  }

 private:
  static bool within(double t, double begin, double end) { return t >= begin && t < end; }

  sim::CirclePath path_{[] {
    sim::CircleSettings settings;
    settings.feed = 16.0 / 60.0;
    settings.radius = 20e-3;
    settings.acceleration = 5.0;
    settings.jerk = 500.0;
    return settings;
  }()};
};

// The simulated machine with an encoder that now and then gives no position.
class LossyBackend {
 public:
  using Signals = S;

  LossyBackend(const machine::Machine& machine, std::span<const double> positions) : machine_(machine, positions) {}

  std::size_t axis_count() const { return machine_.axis_count(); }
  std::int64_t wait_for_tick() { return machine_.wait_for_tick(); }
  void read(std::span<Feedback<S>> feedback) {
    machine_.read(feedback);
    // One sample is missing, and later two in a row: as many as an axis allows.
    const std::size_t phase = reads_++ % 1600;
    if (phase == 700 || phase == 1500 || phase == 1501)
      for (auto& f : feedback) f.position_valid = false;
    std::copy(feedback.begin(), feedback.end(), latest_.begin());
  }
  void write(std::span<const Command<S>> command) { machine_.write(command); }

  const Feedback<S>& latest(std::size_t axis) const { return latest_[axis]; }

 private:
  hal::SimulatedBackend<S> machine_;
  std::array<Feedback<S>, targets::axis_count> latest_{};
  std::size_t reads_ = 0;
};

// How often the run visited what can change the path through a tick.
struct Visits {
  int velocity_limit = 0, current_limit = 0, voltage_limit = 0, reversals = 0, lost_positions = 0, saturations = 0,
      faults = 0;

  void add(const AxisSignals<S>& s, const Feedback<S>& feedback, bool reversed) {
    velocity_limit += s.limiting.velocity;
    current_limit += s.limiting.current;
    voltage_limit += s.limiting.voltage;
    reversals += reversed;
    lost_positions += !feedback.position_valid;
    faults += s.fault != Fault::none;
  }
  std::string text() const {
    return fmt::format(
        "ticks with velocity limited {}, current limited {}, voltage limited {}, reversal {}, position lost {}, "
        "fault {}; saturations {}",
        velocity_limit, current_limit, voltage_limit, reversals, lost_positions, faults, saturations);
  }
  bool all() const {
    return velocity_limit && current_limit && voltage_limit && reversals && lost_positions && saturations && faults;
  }
};

int record(const char* name) {
  const auto m = machine();
  const Motion motion;
  const std::array<double, 2> start{motion.start(0), motion.start(1)};
  LossyBackend backend(m, start);
  targets::Opening opening;
  for (std::size_t k = 0; k < targets::axis_count; ++k)
    opening.configs[k] = machine::configure_axis<S>(m.timing, m.axes[k]);
  opening.header.period_ns = machine::fast_period_ns(m.timing);
  opening.header.slow_ratio = machine::slow_ratio(m.timing);
  opening.header.ticks = std::llround(duration / m.timing.fast_period);

  std::ofstream file(name, std::ios::binary);
  struct Sink {
    std::ofstream& file;
    void write(const void* data, std::size_t bytes) {
      file.write(static_cast<const char*>(data), static_cast<std::streamsize>(bytes));
    }
  } sink{file};
  targets::write_record(sink, opening.header);
  for (const auto& config : opening.configs) targets::write_record(sink, config);

  hal::ControlLoop loop(backend, std::span<const AxisConfig<S>>(opening.configs),
                        Ticker(opening.header.period_ns, static_cast<std::uint32_t>(opening.header.slow_ratio)));
  std::array<targets::TraceHash, targets::axis_count> hashes;
  std::array<targets::CompensationBeside, targets::axis_count> compensations;
  std::array<targets::Sample, targets::axis_count> samples;
  Visits visits;
  for (std::int64_t i = 0; i < opening.header.ticks; ++i) {
    std::array<SetPoint<S>, targets::axis_count> set;
    std::array<int, targets::axis_count> direction;
    for (std::size_t k = 0; k < targets::axis_count; ++k) {
      set[k] = sim::to_set_point<S>(motion.at(static_cast<double>(loop.now_ns()) * 1e-9, k));
      samples[k] = {set[k], backend.latest(k)};
      if (i == 0) compensations[k].start(backend.latest(k));
      direction[k] = loop.signals()[k].v.raw() < 0;
    }
    loop.tick(set);
    for (std::size_t k = 0; k < targets::axis_count; ++k) {
      const auto& s = loop.signals()[k];
      compensations[k].tick(set[k], s);
      samples[k].digest = hashes[k].add(s, loop.axes()[k], compensations[k]);
      targets::write_record(sink, samples[k]);
      visits.add(s, samples[k].feedback, direction[k] != (s.v.raw() < 0));
    }
  }
  for (const auto& axis : loop.axes()) visits.saturations += static_cast<int>(axis.state().saturations.count);
  for (std::size_t k = 0; k < targets::axis_count; ++k)
    hashes[k].report(k, [](const char* text) { std::fputs(text, stdout); });
  std::fprintf(stderr, "%s\n", visits.text().c_str());
  file.close();
  if (!file) {
    std::fprintf(stderr, "record_inputs: %s could not be written\n", name);
    return 1;
  }
  if (!visits.all()) std::fputs("record_inputs: the motion did not visit all of these\n", stderr);
  return visits.all() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2) return record(argv[1]);
  std::fputs("usage: record_inputs RECORDING\n", stderr);
  return 2;
}
