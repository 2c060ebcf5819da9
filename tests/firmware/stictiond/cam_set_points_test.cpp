// `stictiond --cam` against `stiction simulate cam`: the same set-points to the last digit, over the simulated machine
// itself and over the frames of CAN FD.
#include "host/simulate/cam_set_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "firmware/stictiond/programme.hpp"
#include "firmware/stictiond/remote_setup.hpp"
#include "firmware/stictiond/run.hpp"
#include "hal/can/frames.hpp"
#include "hal/simulated/simulated_backend.hpp"
#include "tests/firmware/stictiond/cam_files.hpp"
#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

using S = FixedSignals;
using Simulated = hal::SimulatedBackend<S>;

// The simulated machine behind the frames of a bus: what the drive gets and gives has been coded and decoded.
class FramedBackend {
 public:
  using Signals = S;
  static constexpr auto format = hal::can::Format::fd;

  explicit FramedBackend(Simulated& machine) : machine_(machine), states_(machine.axis_count()) {}

  std::size_t axis_count() const { return machine_.axis_count(); }
  std::int64_t wait_for_tick() {
    ++tick_;
    return now_ns_ = machine_.wait_for_tick();
  }
  void read(std::span<Feedback<S>> feedback) {
    machine_.read(feedback);
    for (std::size_t i = 0; i < feedback.size(); ++i) {
      auto& state = states_[i];
      state.feedback = feedback[i];
      state.feedback.position_time_ns -= now_ns_;
      std::array<hal::can::Frame, 2> frames;
      const int node = static_cast<int>(i) + 1;
      hal::can::encode_feedback(format, node, tick_, state, frames);
      hal::can::NodeFeedback got;
      std::uint32_t counter = 0;
      good_ &= hal::can::decode_feedback(format, hal::can::Kind::position, frames[0], counter, got);
      feedback[i] = got.feedback;
      feedback[i].position_time_ns += now_ns_;
    }
  }
  void write(std::span<const Command<S>> command) {
    std::vector<Command<S>> got(command.size());
    for (std::size_t i = 0; i < command.size(); ++i) {
      std::uint32_t counter = 0;
      const auto frame = hal::can::encode_command(format, static_cast<int>(i) + 1, tick_, command[i]);
      good_ &= hal::can::decode_command(format, frame, counter, got[i]);
    }
    machine_.write(got);
  }
  bool good() const { return good_; }

 private:
  Simulated& machine_;
  std::vector<hal::can::NodeFeedback> states_;
  std::uint32_t tick_ = 0;
  std::int64_t now_ns_ = 0;
  bool good_ = true;
};

constexpr double speed = 130.0 / 60.0;  // turns a second
constexpr double seconds = 10.0;

struct Compared {
  std::uint64_t ticks = 0, different = 0;
  bool faulted = false;
  double end = 0.0;  // m/s, the largest speed in the last tick before the power went
};

// The drive's own run over `backend`, each of its set-points beside one of the simulation.
template <class B>
Compared compare(B& backend, const drive::DriveOptions& options, const drive::DriveConfiguration& configuration,
                 host::CamSetPoints& simulated) {
  hal::DriveLoop<B> loop(backend, configuration.axes, configuration.drives, configuration.ticker,
                         configuration.compensations);
  const auto cam = drive::cam_of(options, configuration);
  const std::vector<double> positions(configuration.names.size());
  const drive::Task task = drive::task_of(options, configuration, positions, cam.get());
  const auto remote = drive::remote_axes(configuration);
  const auto log = std::make_unique<drive::LogRing>();
  drive::Programme programme(loop, task, remote, *log, nullptr);
  Compared run;
  for (std::uint64_t tick = 0; tick < 400'000 && !programme.over(); ++tick) {
    const bool follows = programme.phase() == drive::Phase::motion;
    programme.tick(false);
    if (loop.drive(0).powered()) run.end = machine::to_si(loop.drive(0).set_velocity());
    if (!follows || run.ticks == task.cam_ticks) continue;
    simulated.step();
    const auto& wanted = simulated.set_point();
    ++run.ticks;
    const bool same = loop.drive(0).set_position().raw() == wanted.position.raw() &&
                      loop.drive(0).set_velocity().raw() == wanted.velocity.raw() &&
                      loop.loop().signals()[0].a_set.raw() == wanted.acceleration.raw();
    run.different += same ? 0 : 1;
  }
  run.faulted = programme.faulted();
  return run;
}

class CamSetPoints : public ::testing::Test {
 protected:
  CamSetPoints() {
    options.machine = std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/screw-linear-scale.toml";
    options.cam = {files.add(linear_cam(15e-3))};
    options.master = "virtual";
    options.speed = "130 rpm";
    options.hold = seconds;
    configuration.emplace(drive::read_configuration(options));
    const auto& machine = configuration->machine;
    simulated = std::make_unique<host::CamSetPoints>(machine.timing, machine.axes[0], files.motions[0],
                                                     speed * 2.0 * std::numbers::pi);
  }
  void expect_same(const Compared& run, const char* over) const {
    EXPECT_FALSE(run.faulted);
    EXPECT_EQ(run.ticks, 160'000u);
    EXPECT_EQ(run.different, 0u);
    EXPECT_EQ(run.end, 0.0) << "the master brakes it to rest along the cam";
    figure(fmt::format("cam, 10 s at 130/min: drive against simulate cam, {}", over),
           fmt::format("{} of {} set-points differ (bound 0)", run.different, run.ticks));
  }

  CamFiles files;
  drive::DriveOptions options;
  std::optional<drive::DriveConfiguration> configuration;
  std::unique_ptr<host::CamSetPoints> simulated;
};

TEST_F(CamSetPoints, OfTheDriveAreThoseOfTheSimulationToTheLastDigit) {
  Simulated machine(configuration->machine, std::vector<double>{0.0});
  expect_same(compare(machine, options, *configuration, *simulated), "simulated");
}

TEST_F(CamSetPoints, OverTheFramesOfCanFdAreTheSame) {
  Simulated machine(configuration->machine, std::vector<double>{0.0});
  FramedBackend framed(machine);
  expect_same(compare(framed, options, *configuration, *simulated), "CAN FD");
  EXPECT_TRUE(framed.good());
}

}  // namespace
}  // namespace stiction::test
