// Mass and friction from the rows of logs: force = m a + friction + constant, linear in everything but the contact's
// length and Stribeck's velocity, which are scanned and then refined (variable projection: Golub, Pereyra 1973).
#pragma once

#include <Eigen/Dense>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/identify/contact.hpp"
#include "host/identify/log_rows.hpp"
#include "host/identify/regression.hpp"

namespace stiction::host {

// A parameter with what block bootstrap made of it.
struct FittedParameter {
  std::string name;  // with its unit, as --json shows it: "mass_kg"
  double value = 0.0;
  std::vector<double> replicates;

  Interval interval() const { return interval_95(replicates); }
};

struct FrictionFit {
  std::string model;  // the friction model it belongs to, by its name in a machine file
  std::vector<FittedParameter> parameters;
  ContactShape shape;       // inverse_length 0: a model without contact
  Eigen::MatrixXd columns;  // the regressors; the first three are acceleration, velocity and 1
  Eigen::VectorXd weights;
  Eigen::VectorXd contact;   // level of the contact in each row, from -1 to 1: sgn(v) while it slides
  Eigen::VectorXd residual;  // N, force minus fit
  std::vector<RowBlock> blocks;
  double correlation = 1.0;  // rows
  // Mass, Coulomb and viscous friction come from the rows in steady sliding alone: the contact's model contradicts
  // them.
  bool sliding_only = false;

  const FittedParameter& at(std::string_view name) const;  // throws std::out_of_range
  const FittedParameter* find(std::string_view name) const;
};

struct FitSettings {
  int replicates = 400;
  std::uint64_t seed = 1;
};

// Coulomb and viscous friction with sgn(v) of every sample, as the published recipe has it: parameters mass_kg,
// coulomb_N, viscous_N_s_per_m, constant_force_N.
FrictionFit fit_coulomb_viscous(const LogRows& rows, const FitSettings& settings);

// LuGre's contact beside them: also stiffness_N_per_m, damping_ratio, static_ratio, and stribeck_velocity_m_per_s where
// held-out blocks show that friction falls with speed. Where they do not, static_ratio is what a fall over 1 mm/s would
// be, on either side of 1.
FrictionFit fit_lugre(const LogRows& rows, const FitSettings& settings);

// Whether the law in use has a contact whose shape the file gives and whose length a fit can find: not one of elements
// of their own lengths, and not LuGre's, which fit_lugre() finds with its fall.
bool has_contact_of_one_length(const machine::FrictionParameters& friction);

// The same with the contact of the law in use of `friction`, drawn out or shortened as a whole: what else shapes it
// stays as it is there. Where friction falls with speed it is fit_lugre(). `rows`, `settings`: as above.
FrictionFit fit_law(const LogRows& rows, const machine::FrictionParameters& friction, const FitSettings& settings);

// Viscous friction of each direction, a fit with both beside the other columns of `fit`:
// viscous_positive_N_s_per_m, viscous_negative_N_s_per_m, coulomb_positive_N, coulomb_negative_N. `rows`: of all logs;
// `settings`: of the bootstrap.
std::vector<FittedParameter> fit_directions(const LogRows& rows, const FrictionFit& fit, const FitSettings& settings);

// Spring-slider elements (Maxwell slip): stop operators of fixed slip distances, their weights not negative.
struct SlipElement {
  double stiffness;  // N/m
  double level;      // N
};
struct MaxwellSlipFit {
  std::vector<SlipElement> elements;  // from the shortest slip distance on
  double mass, viscous, constant;     // kg, N s/m, N
  Eigen::VectorXd residual;           // N
};
MaxwellSlipFit fit_maxwell_slip(const LogRows& rows);

}  // namespace stiction::host
