#include "sim/cam/shaping/identified_drive.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "sim/cam/shaping/normal_equations.hpp"
#include "sim/cam/shaping/pulses.hpp"

namespace stiction::sim::cam {
namespace {

// A step of the acceleration leaves a tenth of a degree of the drive's lag: e^-6 of it is a fiftieth of the resolution,
// and a hundredth of a vibration that is worth tuning.
constexpr double settling = 6.0;  // time constants

using States = std::vector<LoadState>;

// The load along the last of `cycles` of `motion`.
States response(const ShapingTask& task, const ElasticDrive& drive, double coulomb, const Motion& motion, int cycles) {
  const ResponseSettings settings{.master_speed = task.master_speed, .cycles = cycles};
  States states =
      coulomb > 0.0 ? lagrange_response(drive, motion, settings, coulomb) : transfer_response(drive, motion, settings);
  if (cycles == 1) return states;
  const auto& curve = motion.curve;
  const double before = (cycles - 1) * curve.length();
  const double rise = (cycles - 1) * (curve.derivative(curve.end(), 0, Side::left) - curve(curve.begin()));
  std::erase_if(states, [&](const LoadState& state) { return state.master < before - 1e-9 * curve.length(); });
  for (LoadState& state : states) state.master -= before, state.position -= rise;
  return states;
}

LoadState state_at(const States& states, double master, double master_speed) {
  const auto behind =
      std::partition_point(states.begin(), states.end(), [&](const LoadState& state) { return state.master < master; });
  if (behind == states.begin()) return states.front();
  if (behind == states.end()) return states.back();
  const LoadState &a = *(behind - 1), &b = *behind;
  const double t = (master - a.master) / master_speed,
               jerk = (b.acceleration - a.acceleration) * master_speed / (b.master - a.master);
  return {master, a.position + t * (a.speed + t * (0.5 * a.acceleration + t * jerk / 6.0)),
          a.speed + t * (a.acceleration + 0.5 * t * jerk), a.acceleration + t * jerk};
}

// What the record of a rise is explained by beside the model: delay, Coulomb friction, and what is found for
// their sake alone: acceleration and jerk of the load, damping and inertia of the drive, by all of which a drive
// differs from its model, stiffness and damping of the shaft, which are better known from the dwell.
constexpr std::size_t unknowns = 9;

// The slopes over these of what the encoder shows, at any place of the master.
class Slopes {
 public:
  Slopes(const ShapingTask& task, const IdentifiedDrive& drive, double friction_step)
      : speed_(task.master_speed),
        friction_step_(friction_step),
        now_(response(task, drive.drive, drive.coulomb, task.motion, drive.cycles)),
        rougher_(response(task, drive.drive, drive.coulomb + friction_step, task.motion, drive.cycles)) {
    constexpr std::array<double ElasticDrive::*, 5> varied{&ElasticDrive::drive_damping, &ElasticDrive::rotor_inertia,
                                                           &ElasticDrive::shaft_stiffness, &ElasticDrive::shaft_damping,
                                                           &ElasticDrive::drive_stiffness};
    for (std::size_t k = 0; k < varied.size(); ++k) {
      ElasticDrive other = drive.drive;
      other.*varied[k] *= 1.0 + share;
      varied_[k] = response(task, other, drive.coulomb, task.motion, drive.cycles);
    }
  }

  double position(double master) const { return at(now_, master).position; }
  Vector<unknowns> operator()(double master) const {
    constexpr double apart = 1e-3;  // s
    const LoadState state = at(now_, master);
    const auto change = [&](const States& states) { return at(states, master).position - state.position; };
    const double jerk =
        (at(now_, master + apart * speed_).acceleration - at(now_, master - apart * speed_).acceleration) /
        (2.0 * apart);
    return {-state.speed,
            change(rougher_) / friction_step_,
            state.acceleration,
            jerk,
            change(varied_[0]) / share,
            change(varied_[1]) / share,
            change(varied_[2]) / share,
            change(varied_[3]) / share,
            change(varied_[4]) / share};
  }

 private:
  LoadState at(const States& states, double master) const { return state_at(states, master, speed_); }

  static constexpr double share = 0.02;  // of a parameter, by which it is varied
  double speed_, friction_step_;
  States now_, rougher_;
  std::array<States, 5> varied_;
};

DwellRecord dwell_of(const ShapingTask& task, const States& states) {
  const double begin = settled(task), end = std::min(task.dwell.end(), task.motion.curve.length());
  DwellRecord record;
  for (const LoadState& state : states) {
    if (state.master < begin || state.master > end) continue;
    record.time.push_back((state.master - task.end()) / task.master_speed);
    record.position.push_back(state.position - task.start - task.stroke);
  }
  return record;
}

// After so many cycles a thousandth of the first residual is carried over.
int cycles_to_settle(const ShapingTask& task, const Mode& mode) {
  const double carried = -mode.pole.real() * task.motion.curve.length() / task.master_speed;
  constexpr double thousandth = 6.9;
  constexpr int most = 24;
  return carried * most < thousandth ? most : 1 + static_cast<int>(std::ceil(thousandth / carried));
}

// The drive that rings with `mode` in the dwell of the task's motion, `coulomb` at the motor.
ElasticDrive ringing_drive(const ShapingTask& task, const Mode& mode, double coulomb, int cycles) {
  ElasticDrive drive = drive_with_mode(task.drive, mode);
  if (coulomb == 0.0) return drive;
  // A motor that sticks in the dwell makes the load ring as if it were clamped.
  constexpr int iterations = 4;
  Mode wanted = mode;
  for (int k = 0; k < iterations; ++k) {
    const auto fit = fit_dwell(dwell_of(task, response(task, drive, coulomb, task.motion, cycles)), mode.frequency());
    if (!fit) break;
    wanted.pole += mode.pole - fit->mode.pole;
    drive = drive_with_mode(task.drive, wanted);
  }
  return drive;
}

// Values and standard errors of what explains `deviations` by `rows`, whose deviations belong together over `block`
// rows.
struct Estimate {
  double value = 0.0, error = 0.0;
};
template <std::size_t n>
std::array<Estimate, n> estimated(const std::vector<Vector<n>>& rows, std::vector<double> deviations,
                                  std::size_t block) {
  Normal<n> normal;
  for (std::size_t k = 0; k < rows.size(); ++k) normal.add(rows[k], deviations[k]);
  const auto values = normal.solve();
  for (std::size_t k = 0; k < rows.size(); ++k)
    for (std::size_t i = 0; i < n; ++i) deviations[k] -= rows[k][i] * values[i];
  const auto variance = variances(rows, deviations, block);
  std::array<Estimate, n> found;
  for (std::size_t i = 0; i < n; ++i) found[i] = {values[i], std::sqrt(variance[i])};
  return found;
}

std::vector<Vector<unknowns - 1>> without_last(const std::vector<Vector<unknowns>>& rows) {
  std::vector<Vector<unknowns - 1>> fewer(rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) std::copy(rows[k].begin(), rows[k].end() - 1, fewer[k].begin());
  return fewer;
}

}  // namespace

double settled(const ShapingTask& task) { return task.end() + settling * drive_lag(task); }

IdentifiedDrive identify_drive(const ShapingTask& task, const CycleRecord& record, const DwellFit& fit, bool running) {
  IdentifiedDrive found;
  if (running) found.cycles = cycles_to_settle(task, fit.mode);
  found.ringing = fit.mode;
  found.drive = drive_with_mode(task.drive, fit.mode);
  // The torque that the motion takes: a twentieth of it is a step in which friction shows and changes nothing else.
  const double time = task.rise_time();
  const double torque =
      (task.drive.load_inertia + task.drive.rotor_inertia) * 4.0 * std::fabs(task.stroke) / (time * time);
  // From a tenth of the rise to half a period behind it: there the load moves fast.
  const double begin = task.begin + 0.1 * task.length(), end = task.end() + 0.5 * task.period_length();
  const double quarter = 0.25 * task.mode().period();
  constexpr int iterations = 6;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    const Slopes slopes(task, found, 0.05 * torque);
    std::vector<Vector<unknowns>> rows;
    std::vector<double> deviations;
    for (std::size_t k = 0; k < record.master.size(); ++k) {
      if (record.master[k] < begin || record.master[k] > end) continue;
      const double master = record.master[k] - found.delay * task.master_speed;
      rows.push_back(slopes(master));
      deviations.push_back(record.position[k] - slopes.position(master));
    }
    if (rows.size() < 2 * unknowns) break;
    const double tick = (end - begin) / task.master_speed / static_cast<double>(rows.size());
    const auto block = static_cast<std::size_t>(std::max(1.0, quarter / tick));
    const auto with_any_drive = estimated(rows, deviations, block);
    // Less stiffness of the drive looks like friction, which is looked for with that of the machine file.
    const auto with_this_drive = estimated(without_last(rows), deviations, block);
    const Estimate step = with_any_drive[0], friction = with_this_drive[1];
    found.delay += step.value;
    found.delay_error = step.error;
    const double before = found.coulomb;
    found.coulomb = std::max(0.0, before + friction.value);
    found.coulomb_error = friction.error;
    // Less is none: without friction the model is exact.
    if (found.coulomb < 3.0 * found.coulomb_error) found.coulomb = 0.0;
    found.drive = ringing_drive(task, fit.mode, found.coulomb, found.cycles);
    if (std::fabs(step.value) < 0.1 * found.delay_error &&
        std::fabs(found.coulomb - before) < 0.1 * found.coulomb_error)
      break;
  }
  return found;
}

std::complex<double> modelled_residual(const ShapingTask& task, const IdentifiedDrive& identified, const Motion& motion,
                                       int cycles) {
  return residual_with_mode(dwell_of(task, response(task, identified.drive, identified.coulomb, motion, cycles)),
                            identified.ringing);
}

}  // namespace stiction::sim::cam
