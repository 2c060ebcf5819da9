// Sums that find a lasting change among standard normal deviations (Page 1954), with the threshold that belongs to a
// rate of false alarms (Brook, Evans 1972).
#pragma once

#include <cstddef>

namespace stiction::host {

// One side: grows by what a deviation exceeds `reference`, and never falls below 0.
class Cusum {
 public:
  explicit Cusum(double reference) : reference_(reference) {}
  // Takes the next `deviation`, in standard deviations; the sum. `index`: of its record.
  double add(double deviation, std::size_t index);
  double sum() const { return sum_; }
  std::size_t since() const { return since_; }  // index of the first record of the present excursion

 private:
  double reference_, sum_ = 0.0;
  std::size_t since_ = 0;
};

// Probability for each further record that the sum of independent standard normal deviations with this `reference`
// first exceeds `threshold`, long after its start; nearer to the start it is less. By a Markov chain of 200 states:
// within 1 % of the integral equation.
double cusum_false_alarms(double reference, double threshold);

// The threshold at which that probability is `probability` (between 0 and 0.1), within 1e-4.
double cusum_threshold(double reference, double probability);

}  // namespace stiction::host
