// The transfer function of an elastic drive, from the set-point to the load (Dostrasil 2014, 5.2), with its poles and
// zeros. The denominator that the source prints is the one of Lagrange's equations; its numerator lacks the factor p of
// the gear, so that it holds for set-points at the output alone.
#pragma once

#include <array>
#include <complex>
#include <vector>

#include "sim/cam/stand/elastic_drive.hpp"
#include "sim/number/complex.hpp"

namespace stiction::sim::cam {

// Coefficients of s^0, s^1, ...
struct TransferFunction {
  std::array<double, 3> numerator{};
  std::array<double, 5> denominator{};

  std::complex<double> at(std::complex<double> s) const;  // `s` in rad/s
  std::vector<std::complex<double>> poles() const;        // rad/s, in falling order of their real parts
  std::vector<std::complex<double>> zeros() const;        // the same
};

// Of a set-point and a load at the output: G(0) = 1.
TransferFunction transfer_function(const ElasticDrive& drive);

// As the source prints it (5.2), with its own parameters at the motor's shaft: I_RP = I_R + I_P1 + p^2 I_P2 and p the
// turns of the output in a turn of the motor.
struct StudyParameters {
  double rotor_inertia = 0.0;                         // I_RP, kg m^2
  double load_inertia = 0.0;                          // I_Z
  double drive_stiffness = 0.0, drive_damping = 0.0;  // k_M, b_M
  double shaft_stiffness = 0.0, shaft_damping = 0.0;  // k_H, b_H
  double ratio = 1.0;                                 // p
};
TransferFunction printed_transfer_function(const StudyParameters& study);

// The parameters of a `drive` behind a gear of that `ratio` p.
StudyParameters study_parameters(const ElasticDrive& drive, double ratio);

// A pole pair of little damping: what rings after a motion.
struct Mode {
  std::complex<double> pole{};  // of the pair the one above the real axis

  double frequency() const { return magnitude(pole); }  // rad/s
  double damping_ratio() const { return -pole.real() / magnitude(pole); }
  double period() const;  // s, of its damped vibration
};

// The load's mode of a `drive`: the pole pair of the least damping ratio. Throws StandError where no pole vibrates.
Mode load_mode(const ElasticDrive& drive);

}  // namespace stiction::sim::cam
