// Expressions that may overflow die at compile time with a sentence. Compile with -DSTICTION_CASE=n: 0 compiles,
// every other case must not, and the compiler's output must contain the sentence beside it.
#include "stiction/control/pi.hpp"
#include "stiction/number/fixed.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace {

using namespace stiction;
using S = FixedSignals;

[[maybe_unused]] constexpr SaturationCounter counter;
[[maybe_unused]] constexpr auto signal = Fixed<20>::from_raw(1);
[[maybe_unused]] constexpr auto gain = Coefficient<12>::from_raw(1);

#if STICTION_CASE == 0
// What the firmware does: four products of 2^60 in one accumulator.
constexpr auto sum = S::FilterCoefficient{} * signal + S::FilterCoefficient{} * signal +
                     S::FilterCoefficient{} * signal + S::FilterCoefficient{} * signal;
static_assert(sum.raw() == 0);
#elif STICTION_CASE == 1
// "Wide: this sum, product or alignment may overflow 64 bits": a product of a product.
constexpr auto too_large = gain * signal * gain;
#elif STICTION_CASE == 2
// "Wide: this sum, product or alignment may overflow 64 bits": four products of 2^61 make 2^63.
constexpr auto too_large = gain * signal + gain * signal + gain * signal + gain * signal;
#elif STICTION_CASE == 3
// "Wide: this sum, product or alignment may overflow 64 bits": the signal, aligned to 60 fraction bits.
constexpr auto too_large = Fixed<60>{} + signal;
#elif STICTION_CASE == 4
// "Wide: this sum, product or alignment may overflow 64 bits": the same in a difference.
constexpr auto too_large = signal - Fixed<60>{};
#elif STICTION_CASE == 5
// "narrow: rounding this value may overflow 64 bits": no room for the half that rounding adds.
constexpr auto too_large = [] {
  SaturationCounter c;
  return narrow<Fixed<0> >(Wide<1, static_cast<std::uint64_t>(INT64_MAX)>{}, c);
}();
#elif STICTION_CASE == 6
// "narrow: this alignment may overflow 64 bits": 32 bits moved up by 40.
constexpr auto too_large = [] {
  SaturationCounter c;
  return narrow<Wide<60, 1000> >(signal, c);
}();
#elif STICTION_CASE == 7
// "Coefficient: 1 to 30 bits of magnitude"
constexpr auto too_large = Coefficient<20, 31>{};
#elif STICTION_CASE == 8
// "Wide: this sum, product or alignment may overflow 64 bits": a bound of 2^63 itself.
constexpr auto too_large = Wide<0, std::uint64_t{1} << 63>{};
#elif STICTION_CASE == 9
// "narrow: rounding this value may overflow 64 bits": a shift of 63 and more would leave nothing.
constexpr auto too_large = [] {
  SaturationCounter c;
  return narrow<Wide<0, 8> >(Wide<63, 8>{}, c);
}();
#elif STICTION_CASE == 10
// "conversion from": a plain number is no signal; raw access is explicit.
constexpr Fixed<20> implicit = 5;
#elif STICTION_CASE == 11
// "no match": signals of different formats do not compare.
constexpr bool mixed = Fixed<20>{} < Fixed<18>{};
#else
#error "STICTION_CASE: 0 to 11"
#endif

}  // namespace

int main() {}
