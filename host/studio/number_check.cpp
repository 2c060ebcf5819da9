#include "host/studio/number_check.hpp"

#include <bit>
#include <cstdint>

#include "sim/number/arc.hpp"
#include "sim/number/arithmetic.hpp"
#include "sim/number/sine_cosine.hpp"

namespace stiction::host {
namespace {

class SplitMix {
 public:
  std::uint64_t next() {
    state_ += 0x9e3779b97f4a7c15U;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31);
  }
  // From 0 to below 1.
  double share() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  // Above 0, of every magnitude that is a normal number.
  double magnitude() {
    const std::uint64_t exponent = 1 + next() % 2046;
    return std::bit_cast<double>(exponent << 52 | next() >> 12);
  }

 private:
  std::uint64_t state_ = 31;
};

}  // namespace

std::vector<double> number_values(NumberFunction function, std::size_t count) {
  SplitMix random;
  std::vector<double> values;
  values.reserve(count);
  for (std::size_t k = 0; k < count; ++k) switch (function) {
      case NumberFunction::sine:
        values.push_back(sim::sine_cosine(2e6 * (random.share() - 0.5)).sine);
        break;
      case NumberFunction::cosine:
        values.push_back(sim::sine_cosine(2e6 * (random.share() - 0.5)).cosine);
        break;
      case NumberFunction::exponential:
        values.push_back(sim::exponential(-708.0 + 1417.0 * random.share()));
        break;
      case NumberFunction::logarithm:
        values.push_back(sim::logarithm(random.magnitude()));
        break;
      case NumberFunction::square_root:
        values.push_back(sim::square_root(random.magnitude()));
        break;
      case NumberFunction::arc_tangent: {
        const double y = 2.0 * random.share() - 1.0;
        values.push_back(sim::arc_tangent(y, 2.0 * random.share() - 1.0));
        break;
      }
      case NumberFunction::arc_cosine:
        values.push_back(sim::arc_cosine(2.0 * random.share() - 1.0));
        break;
    }
  return values;
}

}  // namespace stiction::host
