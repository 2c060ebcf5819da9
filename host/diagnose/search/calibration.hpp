// What the analysis itself makes of records in which nothing is hidden: the machine exactly as its file says, over the
// same set-points, under forces with the spectrum of what was left of the record. A candidate that stands out there,
// through the control loop, the encoder's steps or a slow clock, has to be worth as much more before it is a cause.
#pragma once

#include <Eigen/Dense>
#include <functional>
#include <optional>
#include <vector>

#include "host/diagnose/classes/candidate.hpp"

namespace stiction::host {

class Calibration {
 public:
  // `context`: with exact_records(); `noise`: N, of the rows, what no cause explains of the record.
  Calibration(const SearchContext& context, const Eigen::VectorXd& noise);

  std::size_t records() const { return records_; }  // that were looked at at most; 0: none can be simulated
  // Nats, 0 and more, of one name: what records of the exact machine say for it in the median, and what one in a
  // hundred exceeds with any name.
  struct Price {
    double typical = 0.0, limit = 0.0;
  };
  // Of each name of which `odds_in` tells the log odds in a record; `own`: in the record itself, of those whose side of
  // their limit has to be known: more records are drawn until it is.
  std::vector<Price> prices(const std::function<std::vector<double>(const ExactRecord&)>& odds_in,
                            const std::vector<std::optional<double>>& own);

 private:
  ExactRecords drawn_;
  std::vector<ExactRecord> kept_;  // the first ones
  std::size_t records_ = 0;
};

}  // namespace stiction::host
