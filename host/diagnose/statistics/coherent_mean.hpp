// What several runs of one record have in common, where each has a part of its own that is left to chance: their mean,
// each band of frequencies times the share of its square that is common (Wiener 1949). A weight on it is then not too
// small for what the runs do not agree on, however the frequencies are weighed: regression calibration (Carroll,
// Ruppert, Stefanski, Crainiceanu 2006, ch. 4).
#pragma once

#include <Eigen/Dense>
#include <span>
#include <vector>

namespace stiction::host {

class CoherentMean {
 public:
  // Equally long runs, in any unit.
  void add(std::span<const double> run);

  // Of a single run, of which nothing is known, that itself.
  std::vector<double> estimate() const;
  // Mean square of what chance has left in the mean of the runs; of a single one not known: 0.
  double chance() const;

 private:
  struct Band {
    Eigen::Index begin, length;
    double mean = 0.0, own = 0.0;  // squares: of the mean, and what of it is the runs' own
    double share() const;
  };
  std::vector<Band> bands() const;

  void transform(std::span<const double> run);

  std::size_t runs_ = 0, samples_ = 0;
  std::vector<double> first_;
  Eigen::VectorXcd sum_;
  Eigen::VectorXd squares_;
};

}  // namespace stiction::host
