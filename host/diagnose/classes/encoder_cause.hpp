// What the engine knows of an effect that shows in the difference of two encoders, one on either side of an elastic
// shaft: by how much the load is further ahead of its motor, or less, than the file's shaft lets it be.
#pragma once

#include <Eigen/Dense>
#include <string_view>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/diagnose/verdict/verdict.hpp"

namespace stiction::host {

// One record at its full rate.
struct ShaftRun {
  const machine::AxisModel& axis;  // of the file
  std::vector<double> force;       // N, through the shaft: the motor's less what moves the motor itself
  std::vector<double> motor;       // m, where each encoder shows the two to be
  std::vector<double> load;
};

struct EncoderCause {
  // As those of Candidate.
  std::vector<double> (*grid)(const machine::AxisModel&) = nullptr;
  std::vector<std::vector<double>> (*columns)(const ShaftRun&, double shape) = nullptr;  // m per unit of weight
  bool (*possible)(const machine::AxisModel&, double shape, const Eigen::VectorXd& coefficients) = nullptr;
  void (*describe)(const machine::AxisModel&, double shape, const Eigen::VectorXd& coefficients,
                   const Eigen::MatrixXd& covariance, Finding&) = nullptr;
};

namespace effects {
// Adds a key of the finding's effect. `axis`: whose units it has; `finding`: to which it is added; `value` of the `key`
// and its standard `error` in SI of the linear axis.
inline void add_key(const machine::AxisModel& axis, Finding& finding, std::string_view key, double value,
                    double error) {
  finding.values[std::string(key)] = {value};
  finding.parameters.push_back(effect_parameter(axis, finding.effect, key, {value}, {error}));
}
}  // namespace effects

}  // namespace stiction::host
