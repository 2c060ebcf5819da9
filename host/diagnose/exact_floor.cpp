#include "host/diagnose/exact_floor.hpp"

#include <array>
#include <cstddef>
#include <utility>

#include "host/diagnose/exact_records.hpp"
#include "host/diagnose/statistics/noise_model.hpp"

namespace stiction::host {
namespace {

// Their mean adds a twelfth of the residual's variance to it. None of them is drawn again as one that prices a name.
constexpr std::size_t first_draw = 1000, draws = 12;

// N, of the rows; empty where no exact machine can go the way of the record.
Eigen::VectorXd exact_floor(const Prepared& prepared, const DiagnoseInput& input, const Record& record) {
  const auto drawn = exact_records(prepared, input, record, {record.target})(first_draw, first_draw + draws);
  if (drawn.empty()) return {};
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(record.target.size());
  for (const auto& each : drawn) sum += each.target;
  return (sum / static_cast<double>(drawn.size())).cwiseProduct(record.regressors.counts());
}

}  // namespace

void take_exact_floor_off(Prepared& prepared, const DiagnoseInput& input) {
  if (!prepared.context.exact_records) return;
  auto &training = prepared.training, &held_out = prepared.held_out;
  Eigen::VectorXd of_training = exact_floor(prepared, input, training);
  if (of_training.size() == 0 || noise_log_likelihood(training.target - of_training, training.regressors) <=
                                     noise_log_likelihood(training.target, training.regressors))
    return;
  Eigen::VectorXd of_held_out = exact_floor(prepared, input, held_out);
  if (of_held_out.size() == 0) return;
  training.of_exact_records = std::move(of_training);
  held_out.of_exact_records = std::move(of_held_out);
  for (auto* record : {&training, &held_out}) record->target -= record->of_exact_records;
}

}  // namespace stiction::host
