// One axis of a shipped machine as a drive over the simulated backend: its motor with a true commutation offset that
// the drive does not know, its brake, its protections.
#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "firmware/machine/configuration/drive_configuration.hpp"
#include "firmware/machine/file/drive_file.hpp"
#include "firmware/machine/model/shipped_vocabulary.hpp"
#include "hal/drive_loop.hpp"
#include "hal/simulated/motor_inputs_backend.hpp"
#include "hal/simulated/simulated_backend.hpp"
#include "sim/machine_file.hpp"
#include "stiction/number/fixed_signals.hpp"
#include "tests/support/closed_loop.hpp"

namespace stiction::test {

class MotorBench {
 public:
  using S = FixedSignals;
  using Backend = hal::MotorInputsBackend<hal::SimulatedBackend<S>>;

  // `machine`: shipped, by name; `settings`: of its keys, for plant and drive; `positions`: where the axes stand, m.
  MotorBench(const std::string& machine, const std::vector<std::string>& settings, std::vector<double> positions = {})
      : file_(std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/" + machine + ".toml"),
        machine(sim::read_machine(file_, {"", settings})),
        positions_(positions.empty() ? std::vector<double>(this->machine.axes.size()) : std::move(positions)),
        simulated(this->machine, positions_),
        backend(simulated, this->machine),
        loop(backend, configurations<S>(this->machine), drives(settings), ticker_of(this->machine)),
        set_(this->machine.axes.size()) {}

  std::vector<ServoDriveConfig<S>> drives(const std::vector<std::string>& settings) const {
    return machine::configure_drives<S>(machine, machine::read_drive_setup(file_, machine, {"", settings}));
  }

  void tick() {
    for (std::size_t i = 0; i < set_.size(); ++i)
      loop.set_controlword(i, want_on ? controlword_to_enable(loop.state(i), resets) : 0);
    if (before_tick) before_tick();
    loop.tick(set_);
    ++ticks;
  }
  void run(int count) {
    for (int i = 0; i < count; ++i) tick();
  }
  void hold_here() {
    for (std::size_t i = 0; i < set_.size(); ++i) {
      set_[i] = {};
      set_[i].position = loop.drive(i).position();
    }
  }
  // Until every axis follows its set-points, or one has a fault, for at most `most` ticks; whether they follow.
  bool enable(int most = 96000) {
    want_on = true;
    for (int i = 0; i < most; ++i) {
      hold_here();
      tick();
      if (loop.faulted()) return false;
      bool follow = true;
      for (std::size_t k = 0; k < set_.size(); ++k) follow &= loop.drive(k).follows();
      if (follow) return true;
    }
    return false;
  }
  // A reset with the power off.
  bool reset() {
    want_on = false;
    run(2);
    for (std::size_t i = 0; i < set_.size(); ++i) loop.set_controlword(i, controlword::fault_reset);
    loop.tick(set_);
    run(2);
    return !loop.faulted();
  }
  SetPoint<S>& set(std::size_t axis) { return set_[axis]; }
  double x(std::size_t axis) const { return simulated.plant(axis).position(); }
  double period() const { return machine.timing.fast_period; }
  // Degrees by which the drive's offset is off the plant's, -180 to 180.
  double offset_error(std::size_t axis) const {
    const double drive = 360.0 * 0x1p-32 * loop.drive(axis).commutation().offset().raw;
    const double truth = machine.axes[axis].encoder.commutation_offset * 180.0 / std::numbers::pi;
    return std::remainder(drive - truth, 360.0);
  }

 private:
  std::string file_;

 public:
  machine::Machine machine;

 private:
  std::vector<double> positions_;

 public:
  hal::SimulatedBackend<S> simulated;
  Backend backend;
  hal::DriveLoop<Backend> loop;
  bool want_on = false, resets = false;
  std::function<void()> before_tick;
  std::uint64_t ticks = 0;

 private:
  std::vector<SetPoint<S>> set_;
};

}  // namespace stiction::test
