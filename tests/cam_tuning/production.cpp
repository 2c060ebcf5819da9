#include "tests/cam_tuning/production.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "host/simulate/control_run.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::cam_tuning {
namespace {

machine::Machine warming_machine(const Truth& truth, double stiffness_loss, double warming_time) {
  auto machine = machine_of(truth);
  auto& transmission = *machine.axes.front().transmission;
  transmission.stiffness_loss = stiffness_loss;
  transmission.warming_time = warming_time;
  return machine;
}

}  // namespace

struct Production::Running {
  Running(const Truth& given, double stiffness_loss, double warming_time)
      : truth(given),
        machine(warming_machine(given, stiffness_loss, warming_time)),
        radius(machine.axes.front().coordinate.radius),
        run(machine, std::array{0.0}) {}

  Truth truth;
  machine::Machine machine;
  double radius;
  host::ControlRun<FixedSignals> run;
  int cycles = 0;
};

Production::Production(const Truth& truth, double stiffness_loss, double warming_time)
    : running_(std::make_unique<Running>(truth, stiffness_loss, warming_time)) {}
Production::~Production() = default;

Cycle Production::run(const sim::cam::Cam& cam) {
  auto& r = *running_;
  const auto motion = sim::cam::compose(cam);
  const auto& curve = motion.curve;
  const double length = curve.length(), stroke = 30.0 * degree, begin = r.cycles * length, start = r.cycles * stroke;
  const auto dwell = *sim::cam::longest_dwell(motion_of(r.truth));
  Cycle cycle;
  double area = 0.0, sum = 0.0;
  std::vector<double> off;
  for (;;) {
    const double master = stand_speed * r.run.time() - begin;
    if (master >= length) break;
    const auto& piece = curve.pieces()[curve.piece_at(master)];
    const std::array wanted{
        sim::AxisSetPoint{.position = (piece.derivative(master, 0) + start) * r.radius,
                          .velocity = piece.derivative(master, 1) * stand_speed * r.radius,
                          .acceleration = piece.derivative(master, 2) * stand_speed * stand_speed * r.radius}};
    auto& plant = r.run.plant(0);
    cycle.record.master.push_back(master);
    cycle.record.position.push_back(*plant.read_second_encoder() / r.radius - start);
    if (master >= dwell.begin) off.push_back(plant.position() / r.radius - start - stroke), sum += off.back();
    r.run.tick(wanted);
  }
  // About its mean where friction leaves it off, which no pulse can change.
  const double mean = r.truth.coulomb > 0.0 ? sum / static_cast<double>(off.size()) : 0.0;
  for (const double each : off) area += std::fabs(each - mean);
  cycle.quality = area * stand_speed * r.machine.timing.fast_period / (degree * degree);
  ++r.cycles;
  return cycle;
}

Followed followed(const Truth& truth, double stiffness_loss, int cycles, bool follow) {
  const double turn_time = 360.0 * degree / stand_speed;
  constexpr double time_constants = 3.0;  // within the cycles: 95 %
  Production machine(truth, stiffness_loss, cycles * turn_time / time_constants);
  auto settings = settings_of(truth);
  settings.running = true;
  sim::cam::RecordTuner tuner(task_of(truth), settings);
  Followed found;
  constexpr int steady = 12, most_to_tune = 5;
  for (int k = 0; k < steady; ++k) {
    const auto now = machine.run(motion_of(truth).cam);
    found.first = now.quality;
    if (k + 1 == steady) tuner.learn(now.record);
  }
  for (int k = 1; k < cycles; ++k) {
    const auto now = machine.run(tuner.cam());
    if (k == 1) found.tuned = now.quality;
    if (k >= most_to_tune) found.worst = std::max(found.worst, now.quality);
    if (k >= cycles - std::max(1, cycles / 100)) found.last = std::max(found.last, now.quality);
    if (!tuner.done() && k < most_to_tune)
      tuner.learn(now.record);
    else if (follow)
      found.corrections += !tuner.follow(now.record, true).note.empty();
  }
  return found;
}

}  // namespace stiction::cam_tuning
