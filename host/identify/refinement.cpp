#include "host/identify/refinement.hpp"

#include <ceres/ceres.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "firmware/machine/configuration/double_signals.hpp"
#include "firmware/machine/model/motor_force.hpp"
#include "host/identify/fit_support.hpp"
#include "host/identify/regression.hpp"
#include "host/log/set_points.hpp"
#include "host/simulate/control_run.hpp"
#include "sim/effects/constant_force/constant_force.hpp"
#include "sim/effects/effects.hpp"
#include "sim/plant/friction/classical.hpp"
#include "sim/plant/friction/friction.hpp"
#include "sim/plant/friction/lugre.hpp"
#include "sim/plant/friction/parameters.hpp"

namespace stiction::host {
namespace {

// The step of the numeric derivatives, relative. The quantizer of a position controller makes what the loop does jump
// by a newton for a moment; a hundredth of the Coulomb friction stands out from that.
constexpr double step = 1e-2;
constexpr double ignored = 0.25;  // s at a log's start: contact and loop come from a state that is not known

struct Simulated {
  std::vector<double> force, position;  // N, m; at the log's samples
};

// The axis alone, with the friction model that is refined.
machine::Machine machine_of(const machine::Machine& machine, const machine::AxisModel& axis,
                            const Identification& result) {
  auto one = machine;
  one.axes = {axis};
  auto& friction = one.axes.front().friction;
  const auto value = [&](const char* name, double otherwise) {
    const auto* found = result.find(name);
    return found == nullptr ? otherwise : found->value;
  };
  if (result.find("stiffness_N_per_m") != nullptr) {
    if (result.friction != sim::LuGre<>::name) return one;  // the law in use was fitted
    const bool falls = result.find("stribeck_velocity_m_per_s") != nullptr;
    friction.use = std::string(sim::LuGre<>::name);
    friction.models[friction.use] = sim::values_of<sim::LuGre<>>({0.0, falls ? value("static_ratio", 1.0) : 1.0, 0.0,
                                                                  value("stribeck_velocity_m_per_s", 1e-3), 0.0,
                                                                  std::max(value("damping_ratio", 0.1), 0.0)});
  } else {
    friction.use = std::string(sim::Classical<>::name);
    friction.models[friction.use] = sim::values_of<sim::Classical<>>({0.0, 1.0, 0.0});
  }
  return one;
}

void set_parameters(machine::AxisModel& axis, const std::vector<double>& values) {
  axis.mass = values[0];
  sim::set_coulomb(axis.friction, values[1]);
  sim::set_viscous(axis.friction, values[2]);
  if (values.size() > 3) axis.friction.models.at(axis.friction.use)["stiffness"] = {values[3]};
}

class ClosedLoop {
 public:
  ClosedLoop(const std::vector<Log>& logs, const machine::Machine& machine, const machine::AxisModel& axis,
             const Identification& result, Amperes amperes)
      : machine_(machine_of(machine, axis, result)) {
    SignalSettings settings;
    settings.skip_start = ignored;
    for (const auto& log : logs) {
      const auto& channels = channels_of(log, axis);
      if (!channels.external_force.empty())
        throw LogError(fmt::format(
            "{}: found F_ext; expected none with --refine, whose simulation has no external force", log.source));
      set_points_.emplace_back(log, channels);
      forces_are_logged_.push_back(!channels.force.empty());
      measured_.push_back(channels.x);
      motions_.push_back(motion_of(log, channels, axis, amperes, settings));
      filters_.emplace_back(motions_.back(), settings);
      first_row_.push_back(rows_);
      rows_ += filters_.back().rows();
    }
    if (const auto* weight = result.find("gravity_moment_N"); weight != nullptr && machine_.axes.front().gravity) {
      auto& gravity = *machine_.axes.front().gravity;
      gravity.force = weight->value + gravity.counterweight.value_or(0.0);
    }
    if (const auto* constant = result.find("constant_force_N")) {
      constant_ = constant->value;  // takes the place of the file's
      std::erase_if(machine_.axes.front().effects,
                    [](const machine::Effect& each) { return sim::is_a<sim::ConstantForce>(each); });
    }
  }

  std::size_t rows() const { return rows_; }
  const std::vector<std::size_t>& logs() const { return first_row_; }
  int simulations() const { return simulations_; }

  // Simulated minus logged force in the rows of all logs; false when a run ended in a fault.
  bool residual(const std::vector<double>& values, double* out) {
    set_parameters(machine_.axes.front(), values);
    ++simulations_;
    try {
      for (std::size_t k = 0; k < motions_.size(); ++k) {
        auto simulated = run(k);
        for (std::size_t i = 0; i < simulated.force.size(); ++i) simulated.force[i] -= motions_[k].force[i];
        const auto rows = filters_[k](simulated.force);
        out = std::copy(rows.begin(), rows.end(), out);
      }
      return true;
    } catch (const FaultTripped&) {
      return false;
    }
  }
  double position_rms(const std::vector<double>& values) {
    set_parameters(machine_.axes.front(), values);
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t k = 0; k < motions_.size(); ++k) {
      const auto simulated = run(k);
      const auto first = static_cast<std::size_t>(ignored / motions_[k].period);
      for (std::size_t i = first; i < simulated.position.size(); ++i, ++count)
        sum += std::pow(simulated.position[i] - measured_[k][i], 2);
    }
    return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(count, 1)));
  }
  Eigen::VectorXd velocity() const {
    Eigen::VectorXd all(static_cast<Eigen::Index>(rows_));
    for (std::size_t k = 0; k < motions_.size(); ++k) {
      const auto rows = filters_[k](motions_[k].v);
      std::copy(rows.begin(), rows.end(), all.begin() + static_cast<Eigen::Index>(first_row_[k]));
    }
    return all;
  }

 private:
  Simulated run(std::size_t log) {
    const auto& motion = motions_[log];
    const std::array<double, 1> start{measured_[log].front()};
    ControlRun<machine::DoubleSignals> control(machine_, start);
    control.plant(0).set_external_force(-constant_);
    const double per_ampere = machine::acting_force_constant(machine_.axes.front().motor);
    Simulated result;
    const double half_tick = 0.5 * machine_.timing.fast_period;
    while (result.force.size() < motion.t.size()) {
      const double t = motion.t.front() + control.time();
      const double force = control.plant(0).motor_force(), position = control.plant(0).encoder_position();
      control.tick(std::array{set_points_[log].at(t)});
      if (t + half_tick < motion.t[result.force.size()]) continue;
      const bool logged = forces_are_logged_[log];
      result.force.push_back(logged ? force : per_ampere * machine::to_si(control.signals(0).i));
      result.position.push_back(position);
    }
    return result;
  }

  machine::Machine machine_;
  std::vector<SetPoints> set_points_;
  std::vector<bool> forces_are_logged_;
  std::vector<std::vector<double>> measured_;
  std::vector<Motion> motions_;
  std::vector<RowFilter> filters_;
  std::vector<std::size_t> first_row_;
  std::size_t rows_ = 0;
  double constant_ = 0.0;
  int simulations_ = 0;
};

// The solver's parameters are factors of the values at the start.
std::vector<double> scaled(const std::vector<double>& start, const double* factors) {
  std::vector<double> values(start);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] *= std::max(factors[i], 0.01);
  return values;
}

struct OutputError {
  ClosedLoop& loop;
  const std::vector<double>& start;
  bool operator()(double const* const* factors, double* residual) const {
    return loop.residual(scaled(start, factors[0]), residual);
  }
};

}  // namespace

Refinement refine_in_closed_loop(const std::vector<Log>& logs, const machine::Machine& machine,
                                 const machine::AxisModel& axis, const Identification& result,
                                 const IdentifyOptions& options) {
  std::vector<const IdentifiedParameter*> moved;
  for (const char* name : {"mass_kg", "coulomb_N", "viscous_N_s_per_m"}) {
    moved.push_back(result.find(name));
    if (moved.back() == nullptr)
      throw LogError(fmt::format(
          "--refine: found no initial value of {}; expected logs that determine mass, Coulomb and viscous friction",
          name));
  }
  if (const auto* stiffness = result.find("stiffness_N_per_m")) moved.push_back(stiffness);
  std::vector<double> start, factors(moved.size(), 1.0);
  for (const auto* parameter : moved) start.push_back(parameter->value);

  ClosedLoop loop(logs, machine, axis, result, options.amperes);
  const auto rows = static_cast<Eigen::Index>(loop.rows());
  Eigen::VectorXd before(rows), after(rows);
  if (!loop.residual(start, before.data()))
    throw LogError(
        "--refine: found a fault in the simulated closed loop; expected set-points that the machine file's "
        "controller can follow");
  using Cost = ceres::DynamicNumericDiffCostFunction<OutputError, ceres::CENTRAL>;
  ceres::NumericDiffOptions steps;
  steps.relative_step_size = step;
  auto* cost = new Cost(new OutputError{loop, start}, ceres::TAKE_OWNERSHIP, steps);
  cost->AddParameterBlock(static_cast<int>(factors.size()));
  cost->SetNumResiduals(static_cast<int>(rows));
  ceres::Problem problem;
  problem.AddResidualBlock(cost, nullptr, factors.data());
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.max_num_iterations = 6;
  solver.function_tolerance = 1e-4;
  solver.parameter_tolerance = 1e-4;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);

  // Intervals: the linear problem at the solution, its blocks resampled.
  std::vector<double> jacobian_values(static_cast<std::size_t>(rows) * factors.size());
  double* jacobian_block = jacobian_values.data();
  const double* at = factors.data();
  cost->Evaluate(&at, after.data(), &jacobian_block);
  const Eigen::MatrixXd jacobian = Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
      jacobian_values.data(), rows, static_cast<Eigen::Index>(factors.size()));
  const auto shortest = static_cast<std::size_t>(std::ceil(3.0 * correlation_length(after, loop.logs())));
  const BlockRegression linear(jacobian, -after,
                               blocks_of(loop.velocity(), loop.logs(), std::max<std::size_t>(shortest, 10)));
  const auto replicates = linear.bootstrap(options.fit.replicates, options.fit.seed);
  Refinement refinement;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    const double middle = linear.solve()[column];
    auto interval = interval_95(
        fitting::replicate(replicates, [&](const auto& w) { return start[i] * (factors[i] + w[column] - middle); }));
    refinement.parameters.push_back({moved[i]->name, start[i] * factors[i], interval, "output error in closed loop"});
  }
  refinement.force_before = rms(before);
  refinement.force_after = rms(after);
  refinement.position_before = loop.position_rms(start);
  refinement.position_after = loop.position_rms(scaled(start, factors.data()));
  refinement.simulations = loop.simulations();
  return refinement;
}

}  // namespace stiction::host
