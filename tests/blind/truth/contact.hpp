// The truth's friction contact: springs with sliders in parallel (Iwan 1966), driven by displacement. Rate-independent,
// so it acts on a simulated carriage and on a recorded position alike.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace stiction::blind {

struct ContactElement {
  double stiffness = 0.0;  // N/m
  double level = 0.0;      // N
};

class Contact {
 public:
  Contact() = default;
  explicit Contact(std::vector<ContactElement> elements)
      : elements_(std::move(elements)), force_(elements_.size(), 0.0) {
    for (const auto& e : elements_) sum_ += e.level;
  }

  // Moves on by dx (m); returns the force (N) that opposes the motion.
  double move(double dx) {
    double total = 0.0;
    for (std::size_t k = 0; k < elements_.size(); ++k) {
      force_[k] = std::clamp(force_[k] + elements_[k].stiffness * dx, -elements_[k].level, elements_[k].level);
      total += force_[k];
    }
    return total;
  }
  double coulomb() const { return sum_; }

 private:
  std::vector<ContactElement> elements_;
  std::vector<double> force_;
  double sum_ = 0.0;
};

// Elements whose curve of first loading is F = coulomb (1 - e^(-x / length)), straight between `corners`: from rest to
// these fractions of the level, the last of which reaches it.
inline std::vector<ContactElement> exponential_contact(double coulomb, double length) {
  constexpr double fractions[] = {0.15, 0.35, 0.55, 0.75, 0.90, 0.97};
  std::vector<double> x{0.0}, f{0.0};
  for (const double fraction : fractions) {
    x.push_back(-length * std::log(1.0 - fraction));
    f.push_back(coulomb * fraction);
  }
  x.push_back(6.0 * length);
  f.push_back(coulomb);
  std::vector<ContactElement> elements;
  for (std::size_t k = 1; k < x.size(); ++k) {
    const double before = (f[k] - f[k - 1]) / (x[k] - x[k - 1]);
    const double after = k + 1 < x.size() ? (f[k + 1] - f[k]) / (x[k + 1] - x[k]) : 0.0;
    elements.push_back({before - after, (before - after) * x[k]});
  }
  return elements;
}

}  // namespace stiction::blind
