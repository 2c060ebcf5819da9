#include "host/diagnose/next_measurement/separation.hpp"

#include <algorithm>
#include <cmath>

#include "host/algebra/least_squares.hpp"
#include "host/diagnose/classes/candidate_columns.hpp"
#include "host/diagnose/record/inverse_dynamics.hpp"
#include "host/diagnose/search/context_lines.hpp"

namespace stiction::host {
namespace {

// Of the expected force: what inverse dynamics from samples and filtered derivatives may be off by, whatever the cause.
// Rows of high acceleration count for less than their noise alone would have it.
constexpr double model_error = 2e-3;

// Columns side by side, each of unit length where it has one.
class Basis {
 public:
  explicit Basis(const std::vector<Eigen::VectorXd>& columns) {
    if (columns.empty()) return;
    matrix_.resize(columns.front().size(), static_cast<Eigen::Index>(columns.size()));
    for (std::size_t k = 0; k < columns.size(); ++k) matrix_.col(static_cast<Eigen::Index>(k)) = columns[k];
    scale_ = matrix_.colwise().norm().unaryExpr([](double l) { return l > 0.0 ? 1.0 / l : 0.0; }).transpose();
    solver_ = LeastSquares(matrix_ * scale_.asDiagonal(), 1e-9);
  }
  Eigen::VectorXd coefficients(const Eigen::VectorXd& force) const { return scale_.cwiseProduct(solver_.solve(force)); }
  Eigen::VectorXd without(const Eigen::VectorXd& force) const {
    return matrix_.cols() == 0 ? force : Eigen::VectorXd(force - matrix_ * coefficients(force));
  }

 private:
  Eigen::MatrixXd matrix_;
  Eigen::VectorXd scale_;
  LeastSquares solver_;
};

void append(std::vector<Eigen::VectorXd>& all, const std::vector<Eigen::VectorXd>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

}  // namespace

Eigen::VectorXd force_of(const Records& records, const Explanation& cause) {
  const auto& candidate = candidates()[cause.candidate];
  const auto columns = shared_columns(records.rows, records.context, candidate, cause.shape);
  Eigen::VectorXd coefficients = cause.coefficients;
  if (candidate.per_record)
    coefficients = Eigen::Map<const Eigen::Vector2d>(effects::first_wave(cause.coefficients).data());
  Eigen::VectorXd force = Eigen::VectorXd::Zero(records.rows.rows());
  for (std::size_t c = 0; c < columns.size(); ++c) force += coefficients[static_cast<Eigen::Index>(c)] * columns[c];
  return force;
}

Separation::Separation(const LogRows& rows, const Eigen::VectorXd& residual) : whitening_(residual, rows.logs()) {
  const Eigen::VectorXd white = whitening_(residual);
  noise_ = std::sqrt(residual.squaredNorm() / static_cast<double>(residual.size()));
  deviation_ =
      std::sqrt(white.squaredNorm() / static_cast<double>(white.size()) * correlation_length(white, rows.logs()));
}

Eigen::VectorXd Separation::white(const LogRows& rows, const Eigen::VectorXd& column) const {
  return whitening_.over(rows.logs())(column);
}

// Of each row: its noise over that and the model's error together.
const Eigen::VectorXd& Separation::trust(const Records& records) const {
  if (records.trust.size() > 0) return records.trust;
  const auto force = records.rows.stacked([&](const Motion& m) { return force_along(records.context.axis, m); });
  records.trust = force.unaryExpr([this](double f) { return noise_ / std::hypot(noise_, model_error * f); });
  return records.trust;
}

const std::vector<Eigen::VectorXd>& Separation::white_columns(const Records& records, std::size_t candidate,
                                                              double shape) const {
  const auto [place, unknown] = records.columns.try_emplace({candidate, shape});
  if (unknown)
    for (const auto& column : group_columns(records.rows, records.context, candidates()[candidate], shape))
      place->second.push_back(white(records.rows, column));
  return place->second;
}

// The lines that a periodic candidate would be looked for at, were `force` what these records leave.
SearchContext Separation::scanned(const Records& records, const Eigen::VectorXd& force) const {
  auto context = records.context;
  find_lines(records.rows, force, whitening_.over(records.rows.logs()), context);
  return context;
}

std::vector<double> Separation::values_of(const Records& records, std::size_t candidate,
                                          const Eigen::VectorXd& force) const {
  const auto& c = candidates()[candidate];
  return c.grid(c.periodic ? scanned(records, force) : records.context);
}

std::optional<Explanation> Separation::best_fit(const Records& records, const Eigen::VectorXd& target,
                                                std::size_t candidate, std::span<const Explanation> others) const {
  std::vector<Eigen::VectorXd> beside;
  for (const auto& other : others) append(beside, white_columns(records, other.candidate, other.shape));
  const Basis rest(beside);
  const Eigen::VectorXd force = rest.without(white(records.rows, target));
  std::optional<Explanation> best;
  double least = force.squaredNorm();
  for (const double value : values_of(records, candidate, target)) {
    auto own = white_columns(records, candidate, value);
    for (auto& column : own) column = rest.without(column);
    const Basis basis(own);
    const auto coefficients = basis.coefficients(force);
    const double left = basis.without(force).squaredNorm();
    if (left >= least || !candidates()[candidate].possible(records.context, value, coefficients)) continue;
    least = left;
    best = Explanation{candidate, value, coefficients};
  }
  return best;
}

double Separation::explained(const Records& records, const Eigen::VectorXd& target,
                             std::span<const Explanation> causes) const {
  std::vector<Eigen::VectorXd> columns;
  for (const auto& cause : causes) append(columns, white_columns(records, cause.candidate, cause.shape));
  const auto force = white(records.rows, target);
  return 1.0 - Basis(columns).without(force).squaredNorm() / force.squaredNorm();
}

double Separation::expected(const Records& records, std::span<const Explanation> truth,
                            std::span<const Explanation> rival, std::span<const Explanation> others) const {
  return unimitated(records, truth, rival, others).norm() / deviation_;
}

Eigen::VectorXd Separation::separating_part(const Records& records, std::span<const Explanation> truth,
                                            std::span<const Explanation> rival,
                                            std::span<const Explanation> others) const {
  return unimitated(records, truth, rival, others) / deviation_;
}

Eigen::VectorXd Separation::unimitated(const Records& records, std::span<const Explanation> truth,
                                       std::span<const Explanation> rival, std::span<const Explanation> others) const {
  const auto& rows = records.rows;
  const auto& context = records.context;
  const auto& trusted = trust(records);
  const auto columns_of = [&](const Explanation& cause, double value) {
    auto columns = white_columns(records, cause.candidate, value);
    for (auto& column : columns) column = column.cwiseProduct(trusted);
    return columns;
  };
  std::vector<Eigen::VectorXd> beside;
  bool constant = true, coulomb = true;
  for (const auto causes : {truth, rival, others})
    for (const auto& cause : causes) {
      constant = constant && !candidates()[cause.candidate].names_constant;
      coulomb = coulomb && !candidates()[cause.candidate].names_coulomb;
    }
  for (std::size_t k = 0; k < rows.motions().size(); ++k) {
    const auto& motion = rows.motions()[k];
    if (constant)
      beside.emplace_back(white(rows, rows.of_log(k, std::vector<double>(motion.t.size(), 1.0))).cwiseProduct(trusted));
    if (coulomb)
      beside.emplace_back(white(rows, rows.of_log(k, contact_level(context.axis, motion))).cwiseProduct(trusted));
  }
  for (const auto& other : others) append(beside, columns_of(other, other.shape));
  if (rival.size() > 1)
    for (const auto& each : rival) append(beside, columns_of(each, each.shape));
  Eigen::VectorXd acting = Eigen::VectorXd::Zero(rows.rows());
  for (const auto& cause : truth) acting += force_of(records, cause);
  const Basis rest(beside);
  const Eigen::VectorXd force = rest.without(white(rows, acting).cwiseProduct(trusted));
  if (rival.size() != 1) return force;
  Eigen::VectorXd least = force;
  auto values = std::vector{rival.front().shape};
  if (!candidates()[rival.front().candidate].replays) {
    const auto more = values_of(records, rival.front().candidate, acting);
    values.insert(values.end(), more.begin(), more.end());
  }
  for (const double value : values) {
    auto own = columns_of(rival.front(), value);
    for (auto& column : own) column = rest.without(column);
    const Basis basis(own);
    if (!candidates()[rival.front().candidate].possible(context, value, basis.coefficients(force))) continue;
    if (Eigen::VectorXd left = basis.without(force); left.norm() < least.norm()) least = std::move(left);
  }
  return least;
}

}  // namespace stiction::host
