// The cross table served by the drive's programme in logical time, and a motion controller before it whose frames come
// without a bus.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "firmware/stictiond/can_server.hpp"
#include "firmware/stictiond/programme.hpp"
#include "firmware/stictiond/remote_setup.hpp"
#include "hal/simulated/simulated_backend.hpp"

namespace stiction::test {

// Of --cam, --master and --speed; no master: none.
struct CamArguments {
  std::vector<std::string> tables;
  std::string master, speed;
  std::string machine{};  // file; none: the cross table
};

class ServedTable {
 public:
  using Cam = CamArguments;
  // With outputs, which the simulated machine has not.
  struct Simulated : hal::SimulatedBackend<FixedSignals> {
    using hal::SimulatedBackend<FixedSignals>::SimulatedBackend;
    void set_output(std::size_t output, bool active) { outputs.at(output) = active; }
    std::array<bool, 8> outputs{};
  };

  // `settings`: over the machine file, beside nodes 1 and 2 on an interface that nobody opens.
  // `cam_options`: for a cam.
  explicit ServedTable(const std::vector<std::string>& settings = {}, bool allowed = true, const Cam& cam_options = {})
      : configuration(read(settings, allowed, cam_options.machine)),
        cam(make(cam_options, configuration)),
        remote_(drive::remote_axes(configuration)),
        simulated(configuration.machine, std::vector<double>{0.09, 0.0}),
        loop(simulated, configuration.axes, configuration.drives, configuration.ticker, configuration.compensations),
        programme(loop, task_, remote_, *log, nullptr),
        frames(drive::can_server_config(configuration), *log) {}

  // Ticks of one cycle with what the controller sends for it; begins with a slow tick.
  void cycle(const std::function<void()>& sends = {}) {
    if (sends) sends();
    frames.begin_cycle(loop.now_ns(), programme.remote());
    for (auto& axis : programme.remote()) axis.begin_cycle();
    for (int i = 0; i < ticks_of_cycle; ++i) tick();
  }
  void tick() {
    if (before_tick) before_tick();
    programme.tick(false);
    ++ticks;
  }

  // Frames to an axis.
  void send(hal::can::Pdo pdo, std::size_t axis, const hal::can::ControllerData& data) {
    frames.take(loop.now_ns(), encode_pdo(pdo, static_cast<int>(axis) + 1, data), programme.remote());
  }
  void target(std::size_t axis, double x, std::uint16_t word = controlword::enable_operation) {
    send(hal::can::Pdo::target, axis, {.controlword = word, .target = units(x)});
  }
  // A controller that enables an axis with the target where it stands; false when it does not get there.
  bool enable(std::size_t axis) {
    for (int i = 0; i < 100; ++i) {
      if (loop.state(axis) == DriveState::operation_enabled) return true;
      cycle([&] { target(axis, position(axis), controlword_to_enable(loop.state(axis))); });
    }
    return false;
  }
  // The same with a mode, held by whoever asked last.
  void mode(std::size_t axis, OperationMode mode, std::uint16_t word) {
    send(hal::can::Pdo::mode, axis, {.controlword = word, .mode = static_cast<std::int8_t>(mode)});
  }

  double position(std::size_t axis) const { return machine::to_si(loop.drive(axis).position()); }          // m
  double set_position(std::size_t axis) const { return machine::to_si(loop.drive(axis).set_position()); }  // m
  double set_velocity(std::size_t axis) const { return machine::to_si(loop.loop().signals()[axis].v_set); }
  bool powered(std::size_t axis) const { return loop.drive(axis).powered(); }
  std::uint16_t statusword(std::size_t axis) const { return programme.statusword(axis); }
  std::vector<std::string> said() {
    std::vector<std::string> lines;
    drive::LogReader reader(*log, [&](drive::LogLevel, std::string_view text) { lines.emplace_back(text); });
    reader.drain();
    return lines;
  }

  static constexpr double increment = 1e-9;  // m
  static std::int32_t units(double x) { return static_cast<std::int32_t>(std::lround(x / increment)); }

  drive::DriveConfiguration configuration;
  int ticks_of_cycle = 16;
  std::uint64_t ticks = 0;
  std::function<void()> before_tick;
  std::unique_ptr<drive::LogRing> log = std::make_unique<drive::LogRing>();
  std::unique_ptr<drive::CamDrive> cam;

 private:
  static std::unique_ptr<drive::CamDrive> make(const Cam& cam, const drive::DriveConfiguration& configuration) {
    if (cam.master.empty()) return {};
    drive::DriveOptions options;
    options.cam = cam.tables;
    options.master = cam.master;
    options.speed = cam.speed;
    return std::make_unique<drive::CamDrive>(options, configuration);
  }

  static drive::DriveConfiguration read(const std::vector<std::string>& settings, bool allowed,
                                        const std::string& machine) {
    drive::DriveOptions options;
    options.machine = machine;
    if (machine.empty())
      options.machine = std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/mcfv5050ln.toml";
    // Silence is what many of these cases are about; those of the watch set a time of their own.
    options.set = {"drive.can_server.commander_timeout=0 s"};
    options.set.insert(options.set.end(), settings.begin(), settings.end());
    for (const char* setting : {"drive.can_server.interface=vcan1", "drive.axis.X.server_node=1",
                                "drive.axis.Y.server_node=2", "axis.*.encoder.velocity=estimated"})
      options.set.emplace_back(setting);
    if (allowed) options.set.emplace_back("drive.can_server.motion=allowed");
    return drive::read_configuration(options);
  }

  drive::Task task_{
      .approach = drive::Motion(2), .motion = drive::Motion(2), .idle_ticks = 0, .cam = cam.get(), .serve = true};
  std::vector<RemoteAxisConfig> remote_;

 public:
  Simulated simulated;
  hal::DriveLoop<Simulated> loop;
  drive::Programme<Simulated> programme;
  drive::ControllerFrames frames;
};

// A smooth move from 0 to `way` in a time of 1.
inline double smooth(double way, double share) {
  share = std::clamp(share, 0.0, 1.0);
  constexpr double turn = 6.283185307179586;
  return way * (share - std::sin(turn * share) / turn);
}

}  // namespace stiction::test
