#include "tests/cam_tuning/truth.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "firmware/machine/configuration/double_signals.hpp"
#include "firmware/machine/file/machine_file.hpp"
#include "host/cam/limit_share.hpp"
#include "host/simulate/stand_run.hpp"
#include "sim/machine_file.hpp"
#include "stiction/number/fixed_signals.hpp"
#include "tests/sim/cam/stand/study.hpp"

namespace stiction::cam_tuning {

Truth drawn(std::mt19937_64& random) {
  std::uniform_real_distribution<double> share(0.0, 1.0);
  Truth truth;
  truth.factor = 0.8 + 0.4 * share(random);
  truth.rise = share(random) < 0.5 ? 120.0 : 180.0;
  truth.delay = 6.0 * share(random);
  truth.seed = random();
  return truth;
}

namespace {

// A flywheel in two parts on a motor that is held: shaft - m1 - spring - m2, with the squares of both frequencies and
// with the residuals of both modes at m1 in a ratio. With v = k2/m2, m1's share of a mode is
// (k1/m1) (v - w_i^2)/((w_j^2 - w_i^2) w_i^2), and what a jump of the acceleration leaves of it goes with 1/w_i^2.
struct TwoParts {
  double shaft, spring;  // over m1, 1/s^2
  double ratio;          // m2/m1
};
TwoParts two_parts(double first, double second, double residuals) {
  const double a = first * first, b = second * second, q = residuals * (b / a) * (b / a);
  const double v = (b + q * a) / (1.0 + q), shaft = a * b / v, spring = a + b - v - shaft;
  return {shaft, spring, spring / v};
}

}  // namespace

machine::Machine machine_of(const Truth& truth) {
  constexpr double inertia = 0.1035711, stiffness = 859.67506, damping = 0.2353522;
  double shaft = stiffness * truth.factor * truth.factor;
  std::optional<machine::Effect> part;
  if (truth.second > 0.0) {
    const double second = 2.0 * std::numbers::pi * truth.second_frequency;
    const auto two = two_parts(truth.factor * std::sqrt(stiffness / inertia), second, truth.second);
    const double near = inertia / (1.0 + two.ratio);
    shaft = two.shaft * near;
    // That of the effect is of both parts free.
    const double free = std::sqrt(two.spring * (1.0 + 1.0 / two.ratio));
    part = machine::Effect{"structural_resonance",
                           {{"frequency", {free / (2.0 * std::numbers::pi)}},
                            {"damping_ratio", {0.01}},
                            {"mass_ratio", {near / inertia}},
                            {"motor_measured", {1.0}}}};
  }
  std::vector<std::string> set{
      fmt::format("axis.L.transmission.stiffness={:.9g} N m/rad", shaft),
      // The first mode keeps its damping where the shaft is stiffer.
      fmt::format("axis.L.transmission.damping={:.9g} N m s/rad",
                  truth.second > 0.0 ? damping * shaft / (stiffness * truth.factor * truth.factor) : damping),
      fmt::format("axis.L.second_encoder.delay={:.9g} ms", truth.delay)};
  if (truth.backlash > 0.0) set.push_back(fmt::format("axis.L.transmission.backlash={:.9g} deg", truth.backlash));
  auto machine = sim::read_machine(machine::find_machine("cam-stand"), {.experiment = "", .set = set});
  if (part) machine.axes.front().effects.push_back(*part);
  if (truth.coulomb > 0.0) {
    // At the shaft of the motor, whose way is 33 times the load's.
    auto& axis = machine.axes.front();
    axis.motor_friction.emplace();
    axis.motor_friction->use = "coulomb_viscous";
    const double force = truth.coulomb * 33.0 / axis.coordinate.radius;
    axis.motor_friction->models["coulomb_viscous"] = {{"coulomb", {force}}, {"viscous", {0.0}}};
  }
  return machine;
}

sim::cam::Motion motion_of(const Truth& truth) { return sim::cam::indexing("parabola", 30.0, truth.rise); }

sim::cam::ShapingTask task_of(const Truth& truth) {
  return shaping_task(motion_of(truth), sim::cam::study_drive(), stand_speed, 0.2, {});
}

sim::cam::TunerSettings settings_of(const Truth& truth) {
  const auto load = host::load_of(machine_of(truth).axes.front());
  return {.resolution = resolution,
          .share_of_limits = host::shares_of_limits(load, stand_speed),
          .largest_force = load.effort_left()};
}

Cycle run(const Truth& truth, const sim::cam::Motion& motion, std::uint64_t number, int cycles) {
  const auto found = host::run_stand<FixedSignals>(
      machine_of(truth), motion, {.master_speed = stand_speed, .cycles = cycles, .seed = truth.seed + number});
  const auto dwell = sim::cam::longest_dwell(motion_of(truth));
  Cycle cycle;
  cycle.load = found.load;
  for (const double current : found.log.axes.front().i) cycle.current = std::max(cycle.current, std::fabs(current));
  auto figures = dwell_figures(cycle.load, motion, *dwell);
  if (truth.coulomb > 0.0) {
    // Friction leaves the load off, which no pulse can change.
    auto centred = cycle.load;
    for (auto& state : centred) state.position -= figures.mean;
    figures = dwell_figures(centred, motion, *dwell);
  }
  cycle.quality = figures.quality / (degree * degree);
  const double length = motion.curve.length(), begin = (cycles - 1) * length;
  const double start = motion.curve.derivative(motion.curve.end(), 0, sim::cam::Side::left) * (cycles - 1);
  for (const auto& state : found.measured) {
    if (state.master < begin) continue;
    cycle.record.master.push_back(state.master - begin);
    cycle.record.position.push_back(state.position - start);
  }
  return cycle;
}

Running run_on(const Truth& truth, const std::vector<sim::cam::Cam>& cams) {
  sim::cam::Cam all{.name = "cycles"};
  all.periodic = false;
  for (const auto& cam : cams) all.segments.insert(all.segments.end(), cam.segments.begin(), cam.segments.end());
  const auto found = host::run_stand<FixedSignals>(machine_of(truth), sim::cam::compose(all),
                                                   {.master_speed = stand_speed, .seed = truth.seed});
  Running running;
  const double turn = 2.0 * std::numbers::pi, rise = truth.rise * degree;
  for (std::size_t c = 0; c < cams.size(); ++c) {
    const double begin = static_cast<double>(c) * turn, rest = static_cast<double>(c + 1) * 30.0 * degree;
    // Of the drive's lag of 7.7 ms at 130/min: behind three time constants no more than a hundredth of a degree is
    // left.
    constexpr double settling = 20.0 * degree;
    double area = 0.0, settled = 0.0;
    for (std::size_t k = 1; k < found.load.size(); ++k) {
      const auto& state = found.load[k];
      if (state.master < begin + rise || state.master > begin + turn) continue;
      const double part = std::fabs(state.position - rest) * (state.master - found.load[k - 1].master);
      area += part;
      if (state.master > begin + rise + settling) settled += part;
    }
    running.qualities.push_back(area / (degree * degree));
    running.settled.push_back(settled / (degree * degree));
  }
  const double begin = static_cast<double>(cams.size() - 1) * turn;
  const double start = static_cast<double>(cams.size() - 1) * 30.0 * degree;
  for (const auto& state : found.measured) {
    if (state.master < begin || state.master > begin + turn) continue;
    running.last.master.push_back(state.master - begin);
    running.last.position.push_back(state.position - start);
  }
  return running;
}

Ringing ringing_of(const Truth& truth) {
  const double turn = 2.0 * std::numbers::pi, rise = truth.rise * degree, seconds = 4.0;
  sim::cam::Cam cam{.name = "long"};
  cam.modulo = 30.0 * degree;
  cam.segments = {{.length = rise, .stroke = 30.0 * degree, .law = "parabola"}, {.length = seconds * stand_speed}};
  // Doubles: what a single encoder increment of the drive moves is less than the turning points' own rounding.
  const auto found = host::run_stand<machine::DoubleSignals>(machine_of(truth), sim::cam::compose(cam),
                                                             {.master_speed = stand_speed, .seed = 1});
  // Where the speed changes its sign, behind what the drive's own mode leaves.
  std::vector<double> times, heights;
  for (std::size_t k = 1; k < found.load.size(); ++k) {
    const auto& a = found.load[k - 1];
    const auto& b = found.load[k];
    if (a.master < rise + 0.2 * stand_speed || (a.speed > 0.0) == (b.speed > 0.0)) continue;
    const double share = a.speed / (a.speed - b.speed);
    times.push_back((a.master + share * (b.master - a.master)) / stand_speed);
    heights.push_back(a.position + share * (b.position - a.position));
  }
  const std::size_t n = times.size() - 1;
  const double damped = 0.5 * turn * static_cast<double>(n) / (times[n] - times[0]);
  // From one turning point to the next, so that where the load comes to rest need not be known.
  const double first = std::fabs(heights[1] - heights[0]), last = std::fabs(heights[n] - heights[n - 1]);
  const double decay = std::log(first / last) / (times[n - 1] - times[0]);
  const double frequency = std::hypot(damped, decay);
  return {frequency, decay / frequency};
}

}  // namespace stiction::cam_tuning
