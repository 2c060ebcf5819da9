#include "host/simulate/cam_set_points.hpp"

#include <cmath>

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "firmware/machine/configuration/cam_configuration.hpp"
#include "sim/cam/segment_table.hpp"
#include "stiction/motion/cam_words.hpp"

namespace stiction::host {
namespace {

// What a measured master may show beyond the true one: the estimator's noise is in its speed and acceleration.
machine::MotionBounds seen_bounds(double speed, MasterSignal signal) {
  auto bounds = machine::master_bounds(speed);
  if (signal == MasterSignal::ideal) return bounds;
  bounds.velocity *= 1.05;
  bounds.acceleration = 2.0 * bounds.acceleration + 0.5;
  bounds.jerk *= 2.0;
  return bounds;
}

MasterEstimator::Config estimator_of(MasterSignal signal) {
  MasterEstimator::Config config;
  config.jump = std::int64_t{1} << 58;
  if (signal == MasterSignal::steps) config.half_count = std::llround(std::ldexp(0.5 / master_steps, 64));
  return config;
}

[[noreturn]] void refuse(CamRefusal refusal, const CamCurve& curve, const CamMode::Config& config, double period,
                         const machine::AxisModel& axis) {
  if (refusal == CamRefusal::not_continuous)
    throw machine::ConfigurationError(
        "found a motion whose position, speed or acceleration jumps, as the drive refuses it; expected one without "
        "jumps: "
        "`stiction cam check` shows their places, and --model cascade simulates the motion as it is");
  const bool rotary = axis.coordinate.rotary();
  throw machine::ConfigurationError(
      refusal == CamRefusal::beyond_limits
          ? machine::words_of_limits(curve, config.motion, period, rotary ? 1.0 / axis.coordinate.radius : 1.0,
                                     rotary ? "rad" : "m")
          : std::string("found ") + words_of(refusal) + "; expected a cam that the drive can follow");
}

}  // namespace

CamSetPoints::CamSetPoints(const machine::Timing& timing, const machine::AxisModel& axis,
                           const sim::cam::Motion& motion, double master_speed, MasterSignal signal)
    : period_(timing.fast_period),
      signal_(signal),
      bytes_(sim::cam::table_within(motion, sim::cam::table_tolerance(motion)).bytes),
      master_({}),
      estimator_(estimator_of(signal)) {
  if (const auto problem = CamTable::read(bytes_, table_); problem != CamTableProblem::none)
    throw machine::ConfigurationError(std::string("found ") + words_of(problem));
  const double speed = master_speed / motion.cam.cycle();
  const auto limits = machine::motion_limits(machine::master_bounds(speed), period_);
  const auto seen = machine::motion_limits(seen_bounds(speed, signal), period_);
  // A measured master is not where its speed leads by what the estimator corrects.
  const std::int64_t jump = signal == MasterSignal::ideal ? 1024 : std::int64_t{1} << 30;
  config_.motion = CamMotion::Config::of(machine::motion_limits(machine::cam_bounds(timing, axis), period_), seen,
                                         MotionLimits{}, jump);
  config_.rate = FixedSignals::rate(machine::fast_period_ns(timing));
  CamCurve::Config curve;
  curve.table = &table_;
  curve.periodic = true;
  // Of a rotary axis m are rad times its radius.
  if (axis.coordinate.rotary()) curve.slave_scale = std::llround(std::ldexp(axis.coordinate.radius, 32));
  const auto prepared = CamCurve::prepare(curve, curve_);
  if (prepared != CamRefusal::none) refuse(prepared, curve_, config_, period_, axis);
  master_ = VirtualMaster(VirtualMaster::Config::of(limits));
  axis_ = std::make_unique<CamMode>(config_);
  const auto begun = axis_->begin(curve_, master_.point());
  if (begun != CamRefusal::none) refuse(begun, curve_, config_, period_, axis);
  estimator_.start({});
  start_ = position();
  master_.run(machine::master_speed(speed, period_));
}

double CamSetPoints::cycles_per_second() const {
  return machine::motion_bounds({true_master_.velocity, 0, 0}, period_).velocity;
}

double CamSetPoints::position() const {
  return std::ldexp(static_cast<double>(axis_->point().position), -MotionPoint::position_bits);
}

sim::AxisSetPoint CamSetPoints::in_si() const {
  const auto& p = axis_->point();
  const auto si = machine::motion_bounds({p.velocity, p.acceleration, 0}, period_);
  return {.position = position(), .velocity = si.velocity, .acceleration = si.acceleration};
}

MasterReading CamSetPoints::seen() {
  if (signal_ == MasterSignal::ideal) return {true_master_, true};
  MasterPosition measured = true_master_.position;
  if (signal_ == MasterSignal::noisy) {
    measured = measured + MasterPosition::fine(std::llround(std::ldexp(noise_(engine_) * master_noise, 64)));
  } else {
    const auto count = static_cast<double>(measured.phase) * 0x1p-64 * master_steps;
    measured.phase = static_cast<std::uint64_t>(std::ldexp(std::floor(count) / master_steps, 64));
  }
  estimator_.step(measured);
  return {estimator_.point(), true};
}

void CamSetPoints::step() {
  true_master_ = master_.step();
  set_ = axis_->step(seen());
}

}  // namespace stiction::host
