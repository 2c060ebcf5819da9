// Sums, differences, products and narrowing of all formats in use against exact 128-bit arithmetic.
#include <gtest/gtest.h>

#include "stiction/number/fixed.hpp"
#include "stiction/number/fixed_signals.hpp"
#include "tests/firmware/number/exact.hpp"

namespace stiction {
namespace {

using test::drawn;
using test::Int128;
using test::rescaled;

template <class... Types>
struct TypeList {};

// Signals, coefficients and accumulators of the firmware, and odd ones: no bits, many bits, a negative count.
using Operands = TypeList<Fixed<0>, Fixed<20>, Fixed<40>, Coefficient<12>, Coefficient<28, 29>, Coefficient<0, 1>,
                          Wide<20, 1000>, Wide<-3, 12>, Wide<33, (std::uint64_t{1} << 32) + 5>>;

template <class Visit, class... Types>
void for_each_type(TypeList<Types...>, Visit&& visit) {
  (visit.template operator()<Types>(), ...);
}

// What compiles: the largest result fits 64 bits. (does_not_compile.cpp holds what does not.)
constexpr Int128 highest_word = INT64_MAX;
template <class A, class B>
constexpr bool product_fits = static_cast<Int128>(A::bound) * static_cast<Int128>(B::bound) <= highest_word;
template <class A, class B>
constexpr bool sum_fits = [] {
  constexpr int more = A::fraction_bits - B::fraction_bits;
  const Int128 a = static_cast<Int128>(A::bound) << (more < 0 ? -more : 0);
  const Int128 b = static_cast<Int128>(B::bound) << (more > 0 ? more : 0);
  return a + b <= highest_word;
}();

RC_GTEST_PROP(FixedArithmetic, ProductsAreExactAndWithinTheirBound, ()) {
  for_each_type(Operands{}, []<class A>() {
    for_each_type(Operands{}, []<class B>() {
      if constexpr (product_fits<A, B>) {
        const A a = drawn<A>();
        const B b = drawn<B>();
        const auto product = a * b;
        using P = decltype(product);
        static_assert(P::fraction_bits == A::fraction_bits + B::fraction_bits);
        const Int128 exact = Int128{a.raw()} * b.raw();
        RC_ASSERT(Int128{product.raw()} == exact);
        RC_ASSERT(exact <= static_cast<Int128>(P::bound) && exact >= -static_cast<Int128>(P::bound));
      }
    });
  });
}

RC_GTEST_PROP(FixedArithmetic, SumsAndDifferencesAlignAndAreExact, ()) {
  for_each_type(Operands{}, []<class A>() {
    for_each_type(Operands{}, []<class B>() {
      if constexpr (sum_fits<A, B>) {
        const A a = drawn<A>();
        const B b = drawn<B>();
        const auto sum = a + b;
        const auto difference = a - b;
        constexpr int bits = decltype(sum)::fraction_bits;
        static_assert(bits == (A::fraction_bits > B::fraction_bits ? A::fraction_bits : B::fraction_bits));
        const Int128 x = rescaled(a.raw(), A::fraction_bits, bits);
        const Int128 y = rescaled(b.raw(), B::fraction_bits, bits);
        RC_ASSERT(Int128{sum.raw()} == x + y);
        RC_ASSERT(Int128{difference.raw()} == x - y);
        RC_ASSERT(x + y <= static_cast<Int128>(decltype(sum)::bound));
        RC_ASSERT(x - y >= -static_cast<Int128>(decltype(difference)::bound));
      }
    });
  });
}

template <class Out, class In>
void check_narrow() {
  const In in = drawn<In>();
  SaturationCounter counter;
  const Out out = narrow<Out>(in, counter);
  RC_ASSERT(std::int64_t{out.raw()} == test::expected_raw<Out>(in.raw(), In::fraction_bits));
  RC_ASSERT(counter.count == (test::leaves_range<Out>(in.raw(), In::fraction_bits) ? 1u : 0u));
}

RC_GTEST_PROP(FixedArithmetic, NarrowIsTheNearestValueOfTheOutput, ()) {
  using S = FixedSignals;
  check_narrow<Fixed<28>, Wide<68, std::uint64_t{1} << 61>>();
  check_narrow<Fixed<20>, Wide<40, 3 * (std::uint64_t{1} << 61)>>();
  check_narrow<Fixed<20>, Wide<48, 5 * (std::uint64_t{1} << 60)>>();
  check_narrow<Fixed<18>, Wide<36, std::uint64_t{1} << 62>>();
  check_narrow<Coefficient<28>, Wide<45, std::uint64_t{1} << 61>>();
  check_narrow<Coefficient<20, 7>, Fixed<22>>();
  check_narrow<S::Position, Wide<68, std::uint64_t{1} << 61>>();
  check_narrow<S::Step, Wide<40, std::uint64_t{1} << 62>>();
  check_narrow<S::VelocityIntegral, Wide<S::VelocityIntegral::fraction_bits, 3 * (std::uint64_t{1} << 61)>>();
  check_narrow<Fixed<12>, Fixed<12>>();
  // Towards more fraction bits, where the word does not hold them all.
  check_narrow<Fixed<30>, Fixed<4>>();
  check_narrow<Fixed<0>, Wide<-10, 1u << 25>>();
  check_narrow<Coefficient<30>, Coefficient<0, 30>>();
}

RC_GTEST_PROP(FixedArithmetic, ExceedsComparesMagnitudes, ()) {
  const auto a = drawn<Fixed<7>>();
  const auto bound = Fixed<7>::from_raw(static_cast<std::int32_t>(test::drawn_between(0, INT32_MAX)));
  const Int128 size = a.raw() < 0 ? -Int128{a.raw()} : Int128{a.raw()};
  RC_ASSERT(exceeds(a, bound) == (size > bound.raw()));
  RC_ASSERT(Int128{opposite(a).raw()} == std::min(-Int128{a.raw()}, Int128{INT32_MAX}));
}

RC_GTEST_PROP(FixedArithmetic, SaturatedSumsAreNarrowedSums, ()) {
  const auto a = drawn<Fixed<7>>();
  const auto b = drawn<Fixed<7>>();
  SaturationCounter short_way, long_way;
  RC_ASSERT(saturated_sum(a, b, short_way) == narrow<Fixed<7>>(a + b, long_way));
  RC_ASSERT(saturated_difference(a, b, short_way) == narrow<Fixed<7>>(a - b, long_way));
  RC_ASSERT(short_way.count == long_way.count);
}

RC_GTEST_PROP(FixedArithmetic, FromRawClampsAndNeverWraps, ()) {
  const auto raw = *rc::gen::arbitrary<std::int64_t>();
  using W = Wide<5, 123456789>;
  RC_ASSERT(W::from_raw(raw).raw() == std::clamp(raw, W::lowest_raw, W::highest_raw));
  const auto word = static_cast<std::int32_t>(raw);
  using C = Coefficient<5, 17>;
  RC_ASSERT(C::from_raw(word).raw() == std::clamp<std::int32_t>(word, -(1 << 17), 1 << 17));
}

}  // namespace
}  // namespace stiction
