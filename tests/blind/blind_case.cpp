#include "tests/blind/blind_case.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <utility>

#include "sim/plant/friction/maxwell_slip.hpp"
#include "sim/plant/friction/parameters.hpp"
#include "tests/blind/truth/command.hpp"

namespace stiction::blind {
namespace {

using Signal = std::vector<double>;

double mean_square(const std::vector<Signal>& signals) {
  double sum = 0.0, count = 0.0;
  for (const auto& signal : signals) {
    for (const double value : signal) sum += value * value;
    count += static_cast<double>(signal.size());
  }
  return sum / count;
}

std::vector<Signal> difference(std::vector<Signal> a, const std::vector<Signal>& b) {
  for (std::size_t k = 0; k < a.size(); ++k)
    for (std::size_t n = 0; n < a[k].size(); ++n) a[k][n] -= b[k][n];
  return a;
}

Eigen::VectorXd stacked(const std::vector<Signal>& signals) {
  Eigen::Index size = 0;
  for (const auto& signal : signals) size += static_cast<Eigen::Index>(signal.size());
  Eigen::VectorXd all(size);
  Eigen::Index at = 0;
  for (const auto& signal : signals) {
    all.segment(at, static_cast<Eigen::Index>(signal.size())) =
        Eigen::Map<const Eigen::VectorXd>(signal.data(), static_cast<Eigen::Index>(signal.size()));
    at += static_cast<Eigen::Index>(signal.size());
  }
  return all;
}

// X of the cross table with a friction that the file can express to the end and a motor constant that is that of its
// windings: the inverse dynamics of the machine file is exact.
machine::Machine draw_machine(machine::Machine machine, Random& random) {
  machine.axes.resize(1);
  auto& axis = machine.axes.front();
  axis.mass = uniform(random, 190.0, 250.0);
  axis.motor.force_constant = 1.5 * axis.motor.phase_force_constant;
  axis.encoder.velocity = machine::VelocitySource::estimated;
  sim::MaxwellSlipParameters friction;
  friction.viscous = uniform(random, 300.0, 600.0);
  for (const auto& e : exponential_contact(uniform(random, 70.0, 130.0), uniform(random, 2e-6, 6e-6))) {
    friction.stiffness.push_back(e.stiffness);
    friction.level.push_back(e.level);
  }
  sim::set_parameters<sim::MaxwellSlip<>>(axis.friction, friction);
  axis.friction.use = "maxwell_slip";
  return machine;
}

Mechanics mechanics_of(const machine::AxisModel& axis) {
  const auto friction = sim::parameters_of<sim::MaxwellSlip<>>(axis.friction);
  Mechanics m;
  m.mass = axis.mass;
  m.viscous = friction.viscous;
  m.force_constant = axis.motor.force_constant;
  m.file_position_gain = axis.position_controller.gain;
  m.file_velocity_gain = axis.velocity_controller.gain;
  m.file_velocity_integral_time = axis.velocity_controller.integral_time.value_or(1.0);
  for (std::size_t k = 0; k < friction.level.size(); ++k)
    m.contact.push_back({friction.stiffness[k], friction.level[k]});
  return m;
}

NoiseLevels draw_noise(Random& random) {
  return {.slow_force = uniform(random, 1.5, 3.0),
          .slow_force_corner = uniform(random, 1.0, 5.0),
          .fast_force = uniform(random, 2.0, 4.0),
          .fast_force_corner = uniform(random, 15.0, 60.0),
          .encoder = uniform(random, 0.5e-9, 2e-9),
          .phase_current = uniform(random, 0.02, 0.05)};
}

// The runs of one case: the same trajectories with other mechanics.
class Runs {
 public:
  Runs(const machine::Machine& machine, const std::vector<Trajectory>& trajectories, double period, std::uint64_t seed)
      : machine_(machine),
        file_(mechanics_of(machine.axes.front())),
        trajectories_(trajectories),
        period_(period),
        seed_(seed) {}

  std::vector<host::Log> logs(const Mechanics& mechanics, const NoiseLevels& noise) const {
    std::vector<host::Log> all;
    for (std::size_t k = 0; k < trajectories_.size(); ++k)
      all.push_back(record(machine_, mechanics, trajectories_[k], trajectories_[(k + 1) % trajectories_.size()], noise,
                           period_, seed_ + k));
    return all;
  }
  std::vector<Signal> residuals(const std::vector<host::Log>& logs) const {
    std::vector<Signal> all;
    for (const auto& log : logs) all.push_back(residual_force(log, file_, machine_.axes.front().motor.force_constant));
    return all;
  }
  // Residual force that `mechanics` alone makes, without noise; or what it leaves in the command residual.
  std::vector<Signal> effect(const Mechanics& mechanics, bool in_command) {
    if (plain_.empty()) plain_ = logs(file_, {});
    if (!in_command) return difference(residuals(logs(mechanics, {})), residuals(plain_));
    std::vector<Signal> all;
    for (const auto& log : plain_) all.push_back(command_effect(log, machine_.axes.front(), mechanics));
    return all;
  }
  const Mechanics& file() const { return file_; }

 private:
  const machine::Machine& machine_;
  Mechanics file_;
  const std::vector<Trajectory>& trajectories_;
  double period_;
  std::uint64_t seed_;
  std::vector<host::Log> plain_;
};

// A^2 below 100 Hz in the recorded current's amplitude: the sensors' noise, white at the record's rate. The rest of a
// command residual is what a replay between samples cannot know, and as small as that replay is good.
double sensor_noise(const NoiseLevels& noise, double period) {
  return 2.0 / 3.0 * noise.phase_current * noise.phase_current * std::min(1.0, 200.0 * period);
}

// The strength with the wanted mean square; most residual forces grow like it or like its root.
machine::Effect scaled(const Hideable& row, const AtStrength& at, double wanted, Runs& runs) {
  double strength = 1.0;
  for (int round = 0; round < 8; ++round) {
    Mechanics m = runs.file();
    row.apply(at(strength), m);
    const double ratio = wanted / mean_square(runs.effect(m, row.in_command));
    if (std::abs(ratio - 1.0) < 0.05) break;
    strength *= std::sqrt(ratio);
  }
  return at(strength);
}

double oracle(const std::vector<Signal>& signals, const Eigen::MatrixXd& held_regressors,
              const std::vector<Signal>& held, const Eigen::MatrixXd& regressors) {
  const Eigen::VectorXd coefficients = regressors.colPivHouseholderQr().solve(stacked(signals));
  const Eigen::VectorXd before = stacked(held);
  return (before.squaredNorm() - (before - held_regressors * coefficients).squaredNorm()) /
         static_cast<double>(before.size());
}

}  // namespace

namespace {

BlindCase make_case_of(const machine::Machine& shipped, const CaseOrder& order, std::uint64_t attempt) {
  Random random(order.seed * 0x9E3779B97F4A7C15ULL + 1 + attempt);
  BlindCase blind{order, draw_machine(shipped, random), {}, {}, {}, 0.0, 0.0};
  const auto noise = draw_noise(random);
  const double period = random() & 1U ? 1e-3 : 0.5e-3;
  const auto training = training_trajectories(random), held = holdout_trajectories(random);
  Runs runs(blind.machine, training, period, order.seed * 100),
      held_runs(blind.machine, held, period, order.seed * 100 + 50);
  const double noise_power = mean_square(runs.residuals(runs.logs(runs.file(), noise)));
  blind.noise_rms = std::sqrt(noise_power);

  Mechanics truth = runs.file();
  std::vector<std::vector<Signal>> regressors, held_regressors;
  for (const auto& name : order.hidden) {
    const auto& row = hideable(name);
    const double power = row.in_command ? sensor_noise(noise, period) : noise_power;
    blind.truth.push_back(scaled(row, row.draw(random, runs.file()), power * order.share / (1.0 - order.share), runs));
    Mechanics alone = runs.file();
    row.apply(blind.truth.back(), alone);
    if (!row.in_command) {
      regressors.push_back(runs.effect(alone, false));
      held_regressors.push_back(held_runs.effect(alone, false));
    }
    row.apply(blind.truth.back(), truth);
  }
  if (order.slightly_off) {
    truth.mass *= uniform(random, 0.97, 1.03);
    truth.viscous *= uniform(random, 0.92, 1.08);
    const double level = uniform(random, 0.95, 1.05);
    for (auto& e : truth.contact) e.stiffness *= level, e.level *= level;
  }
  blind.training = runs.logs(truth, noise);
  blind.holdout = held_runs.logs(truth, noise);
  if (!regressors.empty()) {
    const auto columns = static_cast<Eigen::Index>(regressors.size());
    const auto before = runs.residuals(blind.training), held_before = held_runs.residuals(blind.holdout);
    Eigen::MatrixXd a(stacked(before).size(), columns), b(stacked(held_before).size(), columns);
    for (Eigen::Index k = 0; k < columns; ++k) {
      a.col(k) = stacked(regressors[static_cast<std::size_t>(k)]);
      b.col(k) = stacked(held_regressors[static_cast<std::size_t>(k)]);
    }
    blind.oracle_cut = oracle(before, b, held_before, a);
  }
  return blind;
}

}  // namespace

// A machine whose drive trips on the way leaves no log: another one is drawn for the same order.
BlindCase make_case(const machine::Machine& shipped, const CaseOrder& order) {
  constexpr std::uint64_t attempts = 8;
  for (std::uint64_t attempt = 0;; ++attempt) try {
      return make_case_of(shipped, order, attempt);
    } catch (const Tripped&) {
      if (attempt + 1 == attempts) throw;
    }
}

}  // namespace stiction::blind
