#include "tests/fuzz/machine_bytes.hpp"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <vector>

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "firmware/machine/configuration/double_signals.hpp"
#include "hal/control_loop.hpp"
#include "hal/simulated/simulated_backend.hpp"
#include "sim/experiment/set_point.hpp"
#include "sim/machine_file.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::fuzz {
namespace {

constexpr int ticks = 10;

// Of the input that runs, for the message of a finding.
const std::vector<std::string>* current_overrides = nullptr;
const std::string* current_text = nullptr;

bool is_finite(const sim::AxisPlant& plant) {
  return std::isfinite(plant.encoder_position()) && std::isfinite(plant.encoder_velocity()) &&
         std::isfinite(plant.current()[0]) && std::isfinite(plant.current()[1]) && std::isfinite(plant.current()[2]);
}

void rest(const machine::Machine& machine) {
  for (const auto& axis : machine.axes) {
    // An effect may be a force that no step can follow, like a spring of 1e13 N/m; the drive must notice, below.
    if (!axis.effects.empty()) continue;
    sim::AxisPlant plant(machine.timing, axis, 0.0, 1);
    for (int i = 0; i < ticks; ++i) plant.advance_tick();
    if (!is_finite(plant) || !std::isfinite(plant.read_encoder()))
      finding(fmt::format("axis {}: at rest and without command the plant became infinite or NaN", axis.name));
  }
}

// The set-point stands beside the axes, so that every controller has an error to act on.
template <class S>
void control(const machine::Machine& machine) {
  if (machine.axes.empty()) return;
  std::vector<AxisConfig<S>> configs;
  try {
    for (const auto& axis : machine.axes) configs.push_back(machine::configure_axis<S>(machine.timing, axis));
  } catch (const machine::ConfigurationError&) {
    return;
  }
  const std::vector<double> positions(machine.axes.size(), 0.0);
  hal::SimulatedBackend<S> backend(machine, positions);
  const Ticker ticker(machine::fast_period_ns(machine.timing),
                      static_cast<std::uint32_t>(machine::slow_ratio(machine.timing)));
  hal::ControlLoop loop(backend, std::span<const AxisConfig<S>>(configs), ticker);
  const std::vector<SetPoint<S>> set(machine.axes.size(), sim::to_set_point<S>({1e-5, 0.0, 0.0}));
  for (int i = 0; i < ticks && !loop.faulted(); ++i) loop.tick(set);
  bool finite = true;
  for (std::size_t i = 0; i < machine.axes.size(); ++i) finite = finite && is_finite(backend.plant(i));
  if (finite) return;
  for (int i = 0; i <= Axis<S>::missed_positions_allowed; ++i) loop.tick(set);
  if (!loop.faulted()) finding("the drive goes on controlling a plant that is infinite or NaN");
}

}  // namespace

FileInMemory::FileInMemory()
    : descriptor_(memfd_create("machine", MFD_CLOEXEC)), path_(fmt::format("/proc/self/fd/{}", descriptor_)) {
  if (descriptor_ < 0) finding("memfd_create failed");
}
FileInMemory::~FileInMemory() { close(descriptor_); }

void FileInMemory::replace_by(std::string_view text) {
  const auto size = static_cast<ssize_t>(text.size());
  if (ftruncate(descriptor_, 0) != 0 || pwrite(descriptor_, text.data(), text.size(), 0) != size)
    finding("the file in memory cannot be written");
}

std::filesystem::path valid_machine(const std::string& name) {
  return std::filesystem::path(STICTION_SOURCE_DIR) / "tests" / "fuzz" / "seeds" / "machine_file" / (name + ".toml");
}

void run_briefly(const machine::Machine& machine) {
  rest(machine);
  control<FixedSignals>(machine);
  control<machine::DoubleSignals>(machine);
}

void read_and_run(const std::filesystem::path& file, const machine::ReadOptions& options, const std::string& made) {
  current_overrides = &options.set;
  current_text = &made;
  machine::Machine machine;
  try {
    machine = sim::read_machine(file, options);
  } catch (const machine::MachineFileError&) {
    return;
  }
  run_briefly(machine);
}

void finding(const std::string& what) {
  fmt::print(stderr, "finding: {}\n", what);
  if (current_text != nullptr) fmt::print(stderr, "{}", *current_text);
  if (current_overrides != nullptr)
    for (const auto& assignment : *current_overrides) fmt::print(stderr, "  --set '{}'\n", assignment);
  std::abort();
}

}  // namespace stiction::fuzz
