// Any bytes as frames of a motion controller and of the network's master, cycle by cycle, before an axis that follows
// or stands: what is asked for never leaves the travel in a profile move, nothing is taken where motion is not allowed,
// and no number overflows.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "firmware/machine/configuration/conversion.hpp"
#include "firmware/stictiond/can_server.hpp"

namespace stiction::fuzz {
namespace {

using S = FixedSignals;

[[noreturn]] void finding(const char* what) {
  std::fprintf(stderr, "finding: %s\n", what);
  std::abort();
}

// As much of a drive as the axis asks for; its carriage is its set-point.
struct Drive {
  S::Position at{};
  S::Velocity v{};
  bool following = false;
  bool stepped = false;  // it has followed in the tick before too
  Fault seen = Fault::none;
  S::Position set_position() const { return at; }
  bool stops_along() const { return false; }
  bool stops_fast() const { return false; }
  S::Position position() const { return at; }
  S::Velocity set_velocity() const { return v; }
  S::Velocity velocity() const { return v; }
  S::Current set_current() const { return {}; }
  bool referenced() const { return true; }
  bool powered() const { return following; }
  bool standing() const { return v == S::Velocity{}; }
  bool follows() const { return following; }
  Fault fault() const { return seen; }
};

template <class T>
T signal(double value) {
  return *machine::to_signal<T>(value);
}

constexpr double travel = 0.3;         // m, to both sides
constexpr double most_current = 70.0;  // A

RemoteAxisConfig axis_config(int smoothing_bits) {
  RemoteAxisConfig config;
  config.interpolation = SetPointInterpolator::configure(62500, 16, signal<SetPointInterpolator::Way>(1.35e-3));
  config.streamed = true;
  config.low = signal<S::Position>(-travel);
  config.high = signal<S::Position>(travel);
  config.profile = {S::seconds(62500), S::rate(62500), smoothing_bits};
  config.fastest = {
      {}, signal<S::Velocity>(1.33), signal<S::Velocity>(20.0 * 62.5e-6), signal<S::Velocity>(20.0 * 62.5e-6)};
  config.target_window = signal<S::Position>(10e-6);
  config.step_limit = {config.fastest.acceleration, S::seconds(31'250), S::rate(62'500), signal<S::Position>(2e-3)};
  config.torque.most = signal<S::Current>(most_current);
  config.torque.slope = signal<S::Current>(0.5);
  config.torque.speed = config.fastest.velocity;
  config.torque.deceleration = signal<S::Velocity>(10.0 * 62.5e-6);
  config.torque.speed_of_current = signal<TorqueMode::SpeedOfCurrent>(0.4 * 62.5e-6);
  config.torque.gain = signal<S::VelocityGain>(600.0);
  config.torque.low = config.low;
  config.torque.high = config.high;
  config.torque.rate = S::rate(62'500);
  return config;
}

void run_cycle(RemoteAxis& axis, Drive& drive) {
  axis.begin_cycle();
  for (int i = 0; i < 16; ++i) {
    const auto set = axis.tick(drive);
    const auto word = axis.statusword(0);
    if (axis.mode() == OperationMode::cyclic_position && word != 0) finding("bits of pp in csp");
    drive.seen = axis.fault();
    if (drive.seen != Fault::none || !set.valid) drive.following = false;
    if (!drive.following) drive.v = {};
    const bool stepped = drive.stepped && drive.following;
    drive.stepped = drive.following;
    if (!drive.following) continue;
    if (set.by_current) {
      // The carriage follows its current, so that what holds it within speed and travel is seen.
      if (std::abs(machine::to_si(set.injection)) > most_current) finding("a current beyond the limit");
      const double v = machine::to_si(drive.v) + 0.4 * 62.5e-6 * machine::to_si(set.injection);
      if (std::abs(v) > 1.5) finding("a speed that no current is to make");
      drive.v = signal<S::Velocity>(v);
      drive.at = S::Position::from_raw(drive.at.raw() + std::llround(v * 62.5e-6 * 0x1p40));
      if (std::abs(machine::to_si(drive.at)) > travel + 6e-3) finding("a current that drives beyond the travel");
      continue;
    }
    const auto change = set.velocity.raw() - drive.v.raw();
    if (stepped && std::abs(change) > 20.0 * 62.5e-6 * 0x1p28 + 2.0) finding("a step of the set speed");
    drive.at = set.position;
    drive.v = set.velocity;
    const double x = machine::to_si(set.position);
    const bool profile = axis.mode() == OperationMode::profile_position;
    // Between targets of csp the polynomial may swing beyond the last one.
    if (std::abs(x) > travel + (profile ? 1e-9 : 5e-3)) finding("a set-point beyond the travel");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  const std::uint8_t how = data[0];
  drive::CanServerConfig config;
  config.nodes = {5};
  config.current_limit = {70.0};
  config.motion_allowed = (how & 1) != 0;
  static const auto log = std::make_unique<drive::LogRing>();
  drive::LogRecord record;
  while (log->pop(record)) {
  }
  drive::ControllerFrames frames(config, *log);
  std::array<RemoteAxis, 1> axes{RemoteAxis(axis_config((how >> 1) % 9))};
  axes[0].ask(controlword::shutdown);  // an axis takes targets from its owner
  Drive drive;
  std::int64_t now_ns = 0;
  // Each frame: which PDO, or any identifier; what the drive does; size and data. A cycle behind it.
  for (std::size_t at = 1; at + 2 <= size;) {
    hal::can::Frame frame;
    const std::uint8_t what = data[at], length = data[at + 1];
    at += 2;
    frame.id = hal::can::pdo_table[what % hal::can::pdo_table.size()].id() + ((what & 8) != 0 ? 5u : what);
    for (std::size_t i = 0; i < 8 && at < size; ++i) frame.data[i] = data[at++];
    const auto address = hal::can::pdo_address_of(frame);
    frame.size = (length & 0x80) != 0 ? static_cast<std::uint8_t>(length % 9) : description_of(address.pdo).size;
    // A controller near the axis: a fuzzer does not find it by trying.
    if ((what & 16) != 0 && address.pdo == hal::can::Pdo::target) {
      const auto near = static_cast<std::int32_t>(machine::to_si(drive.at) * 1e9) +
                        static_cast<std::int16_t>(frame.data[2] | frame.data[3] << 8) * 40;
      for (std::size_t i = 0; i < 4; ++i)
        frame.data[2 + i] = static_cast<std::uint8_t>(static_cast<std::uint32_t>(near) >> (8 * i));
    }
    // An order of the network's master, or a heartbeat, in the place of it.
    if (config.motion_allowed && (length & 0x60) == 0x60) {
      constexpr std::uint8_t orders[]{1, 2, 128, 129, 130};
      frame.id = (what & 1) != 0 ? 0x000 : 0x77f;
      frame.size = (what & 1) != 0 ? 2 : 1;
      if ((what & 2) != 0) frame.data[0] = orders[frame.data[0] % 5];
      if ((what & 4) != 0) frame.data[1] = 5;
      frames.links()->at(0).watched = 0x007f0000u | length;
    }
    drive.following = (what & 32) != 0 || drive.following;
    if ((what & 64) != 0) drive.following = false;
    frames.take(now_ns, frame, axes);
    frames.begin_cycle(now_ns, axes);
    frames.node(0).step(now_ns, drive.seen, [](const hal::can::Frame& sent) {
      if (sent.id != 0x705 && sent.id != 0x085) finding("a frame that no node sends by itself");
    });
    const int cycles = 1 + (length & 7) * ((what & 128) != 0 ? 20 : 1);
    for (int i = 0; i < cycles; ++i) run_cycle(axes[0], drive);
    now_ns += 1'000'000;
    if (!config.motion_allowed && (axes[0].controlword() != controlword::shutdown || frames.counts().taken != 0))
      finding("taken without permission");
  }
  return 0;
}

}  // namespace stiction::fuzz
