// Whether the data bear a term beside others: blocks of rows must agree on it (F test with covariance by clusters of
// rows), it must take something off the cross-validated residual, not owed to a single event, and in both halves of the
// records it must have one sign.
#pragma once

#include <optional>
#include <string>

#include "host/diagnose/statistics/evidence.hpp"

namespace stiction::host {

struct Judgement {
  double p_value = 1.0;  // that its weights are zero, times what was tried for its nonlinear parameter
  double gain = 0.0;     // share of the cross-validated residual that it takes away
  double first_half = 0.0, second_half = 0.0;   // its size found in each half of the rows, over that in all
  bool nearly = false;                          // not quite significant: better data may name it
  std::optional<std::string> rejection_reason;  // why it does not stay
};

// Of the columns `own` beside the columns `others`. `evidence`: as it is looked at, `plain`: the same columns, not
// whitened; `trials`: independent values of its nonlinear parameter that were tried.
Judgement judge_columns(const Evidence& evidence, const Evidence& plain, const ColumnIndices& others,
                        const ColumnIndices& own, double trials);

}  // namespace stiction::host
