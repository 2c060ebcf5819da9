// What the fits share: the order of their columns, weights, blocks, replicates. Internal to this room.
#pragma once

#include <functional>

#include "host/identify/friction_fit.hpp"

namespace stiction::host::fitting {

// Columns of every fit; the last two of those with a contact (level of the contact, its rate), or of a level that rises
// with a weight.
inline constexpr Eigen::Index acceleration = 0, velocity = 1, one = 2, level = 3, rate = 4, risen_level = 4;

// Least squares over all rows.
Eigen::VectorXd weights_of(const Eigen::MatrixXd& columns, const Eigen::VectorXd& force);

using OfWeights = std::function<double(const Eigen::RowVectorXd&)>;

// `of` each replicate (row).
std::vector<double> replicate(const Eigen::MatrixXd& replicates, const OfWeights& of);

// A parameter that is `of` the weights, with its replicates. `fit`: to which it is added; `name`: its key, with unit;
// `centre`: weights of all rows; `replicates`: weights of each bootstrap replicate, one per row.
void add(FrictionFit& fit, const char* name, const Eigen::RowVectorXd& centre, const Eigen::MatrixXd& replicates,
         const OfWeights& of);

// Mass, Coulomb and viscous friction and the constant force, of fits with a level column. `fit`: to which they are
// added; `centre`: weights of all rows; `replicates`: one per row.
void add_sliding_parameters(FrictionFit& fit, const Eigen::RowVectorXd& centre, const Eigen::MatrixXd& replicates);

// 1 for rows in steady sliding: faster than a twentieth of the logs' highest speed throughout 30 ms before and after,
// which is what the anti-aliasing filter reaches; 0 for the others.
Eigen::VectorXd steady_sliding(const LogRows& rows);

// Hausman's test (1978) of the contact's model: mass, Coulomb and viscous friction from the rows in steady sliding must
// agree with those from all rows. Where one differs by more than three standard deviations of the difference and one
// percent, the contact's model is wrong enough to bend them, and they are replaced by those of steady sliding. `fit`:
// changed where they disagree; `rows`: of all logs; `settings`: of the bootstrap.
void check_against_sliding(FrictionFit& fit, const LogRows& rows, const FitSettings& settings);

// From the correlation of the fit's residual.
void choose_blocks(FrictionFit& fit, const LogRows& rows);

}  // namespace stiction::host::fitting
