#include "host/simulate/stand_run.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "firmware/machine/configuration/double_signals.hpp"
#include "host/simulate/control_run.hpp"
#include "host/simulate/log_recorder.hpp"
#include "sim/cam/characteristics.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {
namespace {

// The set-point of the slave at the master's `place` over all cycles, in m of the axis' numbers.
class SteadySlave {
 public:
  SteadySlave(const sim::cam::Motion& motion, double master_speed, double radius)
      : motion_(motion), speed_(master_speed), radius_(radius), cycle_(motion.curve.length()) {
    const auto& curve = motion.curve;
    rise_ = curve.derivative(curve.end(), 0, sim::cam::Side::left) - curve(curve.begin());
  }

  double place(double master) const { return master - cycle_ * std::floor(master / cycle_); }
  sim::AxisSetPoint at(double master) const {
    const double x = place(master);
    const auto& piece = motion_.curve.pieces()[motion_.curve.piece_at(x)];
    return {.position = (piece.derivative(x, 0) + rise_ * std::floor(master / cycle_)) * radius_,
            .velocity = piece.derivative(x, 1) * speed_ * radius_,
            .acceleration = piece.derivative(x, 2) * speed_ * speed_ * radius_};
  }

 private:
  const sim::cam::Motion& motion_;
  double speed_, radius_, cycle_, rise_ = 0.0;
};

void require_rest_at_start(const sim::cam::Motion& motion) {
  const auto& curve = motion.curve;
  const double speed = curve.derivative(curve.begin(), 1);
  if (std::fabs(speed) > 1e-9 * extremes(curve, 1).magnitude())
    throw sim::cam::StandError(
        fmt::format("cam {}: found a speed of {:.4g} at the master's 0; expected a motion that rests there, since its "
                    "master turns from the beginning",
                    motion.cam.name, speed));
}

}  // namespace

template <class S>
StandRun run_stand(const machine::Machine& machine, const sim::cam::Motion& motion, const StandSettings& settings) {
  require_rest_at_start(motion);
  const auto& axis = machine.axes.front();
  const double radius = axis.coordinate.rotary() ? axis.coordinate.radius : 1.0;
  const SteadySlave slave(motion, settings.master_speed, radius);
  ControlRun<S> run(machine, std::array<double, 1>{slave.at(0.0).position});
  LogRecorder recorder(machine);
  const auto record = recorder.template sink<S>();
  StandRun result;
  std::vector<double> places;
  const double end = settings.cycles * motion.curve.length() / settings.master_speed;
  while (run.time() <= end) {
    const double master = settings.master_speed * run.time();
    const auto wanted = slave.at(master);
    auto& plant = run.plant(0);
    const double velocity = plant.velocity() / radius;
    const double change = result.load.empty() ? 0.0 : velocity - result.load.back().speed;
    result.load.push_back({master, plant.position() / radius, velocity, change / machine.timing.fast_period});
    if (const auto seen = plant.read_second_encoder()) result.measured.push_back({master, *seen / radius, 0.0, 0.0});
    result.motor_error = std::max(result.motor_error, std::fabs(wanted.position - plant.motor_position()) / radius);
    places.push_back(slave.place(master));
    run.tick(std::array{wanted}, record);
  }
  result.log = recorder.take();
  places.resize(result.log.t.size(), 0.0);
  result.log.axes.front().master = std::move(places);
  auto& x_load = result.log.axes.front().x_load;
  for (const auto& state : result.measured) x_load.push_back(state.position);
  if (!x_load.empty()) x_load.resize(result.log.t.size(), x_load.back());
  result.log.axes.front().table.assign(result.log.t.size(), 1.0);
  return result;
}

template StandRun run_stand<FixedSignals>(const machine::Machine&, const sim::cam::Motion&, const StandSettings&);
template StandRun run_stand<machine::DoubleSignals>(const machine::Machine&, const sim::cam::Motion&,
                                                    const StandSettings&);

}  // namespace stiction::host
