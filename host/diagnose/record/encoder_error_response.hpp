// What a small error of the measured position makes of the force that a log shows. The drive closes its loop on what it
// reads. Below half the log's rate the carriage follows the current, and the residual force is that of the acceleration
// that was not there. Above it the drive answers with currents that the log's samples fold down.
#pragma once

#include <Eigen/Dense>
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/identify/motion.hpp"

namespace stiction::host {

// By frequency.
class EncoderErrorResponse {
 public:
  // `axis` and `timing`: of the machine file.
  EncoderErrorResponse(const machine::AxisModel& axis, const machine::Timing& timing);

  // The drive's answer to an error's speed, N per m/s at `frequency` (Hz, not negative): PI, notch and current loop in
  // the steps of the fast tick (discretised as the firmware's), with the carriage's own motion. The position loop, weak
  // there, is left out. 0 for an axis without a velocity controller.
  std::complex<double> of_speed(double frequency) const;
  // The speed (1/s) that the drive makes of a position at `frequency`.
  std::complex<double> speed(double frequency) const;

 private:
  std::complex<double> current_loop(std::complex<double> back) const;

  machine::AxisModel axis_;
  double tick_;
};

// The same along a record, tick by tick: between two samples of a log an axis passes many signal periods, and which of
// them the drive answers to is seen by where it was at each tick.
class SeenEncoderError {
 public:
  // `motion`: of the record, with the position that it reads, which has to live as long; `axis` and `timing`: of the
  // machine file; `difference_points`: by which the motion was derived; `cutoff`: Hz, of its position's filter.
  SeenEncoderError(const Motion& motion, const machine::AxisModel& axis, const machine::Timing& timing,
                   int difference_points, double cutoff);

  // Columns of the residual force (N per m, at the motion's rate) for the errors cos(2 pi x / period) and
  // sin(2 pi x / period); `period`: m.
  std::vector<std::vector<double>> columns(double period) const;

  // By frequency (Hz), at a steady speed: the column (N per m) of a wave, and the frequency at which the log shows it.
  std::complex<double> response(double frequency) const;
  double shown_at(double frequency) const;

  // The transpose of columns(), and where the axis was: the sum over samples of `weight` (one a sample) times the
  // column of an error e(x) is the sum over ticks of `position` times e plus `slope` times de/dx at `place` (m).
  struct Weights {
    Eigen::VectorXd place, position, slope;
  };
  Weights transposed(const std::vector<double>& weight) const;

 private:
  std::size_t ticks() const;
  // Place (m) and speed (m/s) at a stretch of ticks.
  struct Way {
    Eigen::VectorXd place, speed;
  };
  Way way(std::size_t first, std::size_t count) const;
  // What the drive answers in the samples from `first` to before `last`.
  void add_answer(std::size_t first, std::size_t last, double period, std::vector<double>& to_cosine,
                  std::vector<double>& to_sine) const;
  // Whether all ticks are there that a sample's answer needs.
  bool answered(std::size_t sample) const;
  std::vector<double> inverse_dynamics(const std::vector<double>& error) const;
  // Of the difference that a speed is made of.
  std::size_t ticks_back() const { return velocity_ == machine::VelocitySource::mean_difference ? 2 : 1; }

  EncoderErrorResponse drive_;
  std::span<const double> read_;  // m, of each sample
  std::size_t ticks_in_sample_;
  double period_, tick_;  // s, of samples and ticks
  bool answers_;          // ticks are finer than samples
  machine::VelocitySource velocity_;
  double mass_, viscous_;  // kg, N s/m
  int difference_points_;
  double cutoff_;
  Eigen::VectorXd answer_;  // N per m/s of the error's speed, from `reach_` ticks earlier to as many later
  std::size_t reach_ = 0;
};

}  // namespace stiction::host
