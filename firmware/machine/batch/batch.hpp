// Many doubles as one number, for the control law and the plant of many axes at once: as many lanes as two of the
// processor's vectors have, so that one waits for no result of the other. Each lane's result is that of the same
// operation on doubles, to the bit: nothing is fused, and no function of a library is called.
//
// An instruction set is a part of the type, so that what is compiled for one of them is never linked into what runs on
// another: every function here is inline by order or has the set in its name.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace stiction::machine {

// Instruction sets. `bytes`: of a vector.
struct Sse2 {
  static constexpr const char* name = "SSE2";
  static constexpr std::size_t bytes = 16;
};
struct Neon {
  static constexpr const char* name = "NEON";
  static constexpr std::size_t bytes = 16;
};
struct Avx2 {
  static constexpr const char* name = "AVX2";
  static constexpr std::size_t bytes = 32;
};
struct Avx512 {
  static constexpr const char* name = "AVX-512";
  static constexpr std::size_t bytes = 64;
};

#define STICTION_INLINE [[gnu::always_inline]] inline

namespace detail {

// The compiler's own vectors.
template <std::size_t bytes>
struct Vectors;
template <>
struct Vectors<16> {
  typedef double V __attribute__((vector_size(16)));
  typedef long long M __attribute__((vector_size(16)));
  typedef unsigned long long Bits __attribute__((vector_size(16)));
};
template <>
struct Vectors<32> {
  typedef double V __attribute__((vector_size(32)));
  typedef long long M __attribute__((vector_size(32)));
  typedef unsigned long long Bits __attribute__((vector_size(32)));
};

// One vector and what is done with it. `M` is all ones in the lanes where it holds.
template <class Isa>
struct Part {
  using V = typename Vectors<Isa::bytes>::V;
  using M = typename Vectors<Isa::bytes>::M;
  using Bits = typename Vectors<Isa::bytes>::Bits;

  STICTION_INLINE static V all_of(double x) { return V{} + x; }
  STICTION_INLINE static M mask(bool x) { return M{} - static_cast<long long>(x); }
  STICTION_INLINE static M less(V a, V b) { return a < b; }
  STICTION_INLINE static M less_equal(V a, V b) { return a <= b; }
  STICTION_INLINE static M equal(V a, V b) { return a == b; }
  STICTION_INLINE static M not_equal(V a, V b) { return a != b; }
  STICTION_INLINE static M conjunction(M a, M b) { return a & b; }
  STICTION_INLINE static M disjunction(M a, M b) { return a | b; }
  STICTION_INLINE static M negation(M a) { return ~a; }
  STICTION_INLINE static V select(M m, V yes, V no) {
#if defined(__AVX__)
    // The compiler's own choice compares the mask with zero before.
    if constexpr (Isa::bytes == 32)
      return reinterpret_cast<V>(_mm256_blendv_pd(reinterpret_cast<__m256d>(no), reinterpret_cast<__m256d>(yes),
                                                  reinterpret_cast<__m256d>(m)));
#endif
    return m ? yes : no;
  }
  // A bit a lane.
  STICTION_INLINE static unsigned bits(M m) {
#if defined(__AVX__)
    if constexpr (Isa::bytes == 32) return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<__m256d>(m)));
#endif
#if defined(__x86_64__)
    if constexpr (Isa::bytes == 16) return static_cast<unsigned>(_mm_movemask_pd(reinterpret_cast<__m128d>(m)));
#endif
    unsigned sum = 0;
    for (std::size_t k = 0; k < Isa::bytes / 8; ++k) sum |= (m[k] != 0 ? 1U : 0U) << k;
    return sum;
  }
};

#if defined(__AVX512F__)
// The same with registers for masks.
typedef unsigned long long Vectors64Bits __attribute__((vector_size(64)));
template <>
struct Part<Avx512> {
  using V = __m512d;
  using M = __mmask8;
  using Bits = Vectors64Bits;

  STICTION_INLINE static V all_of(double x) { return _mm512_set1_pd(x); }
  STICTION_INLINE static M mask(bool x) { return static_cast<M>(x ? 0xff : 0); }
  STICTION_INLINE static M less(V a, V b) { return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ); }
  STICTION_INLINE static M less_equal(V a, V b) { return _mm512_cmp_pd_mask(a, b, _CMP_LE_OQ); }
  STICTION_INLINE static M equal(V a, V b) { return _mm512_cmp_pd_mask(a, b, _CMP_EQ_OQ); }
  STICTION_INLINE static M not_equal(V a, V b) { return _mm512_cmp_pd_mask(a, b, _CMP_NEQ_UQ); }
  STICTION_INLINE static M conjunction(M a, M b) { return static_cast<M>(a & b); }
  STICTION_INLINE static M disjunction(M a, M b) { return static_cast<M>(a | b); }
  STICTION_INLINE static M negation(M a) { return static_cast<M>(~a); }
  STICTION_INLINE static V select(M m, V yes, V no) { return _mm512_mask_blend_pd(m, no, yes); }
  STICTION_INLINE static unsigned bits(M m) { return m; }
};
#endif

}  // namespace detail

// What holds in some lanes.
template <class Isa>
struct BatchMask {
  using P = detail::Part<Isa>;
  typename P::M low, high;

  STICTION_INLINE BatchMask() : BatchMask(false) {}
  STICTION_INLINE explicit BatchMask(bool all) : low(P::mask(all)), high(low) {}
  STICTION_INLINE BatchMask(typename P::M a, typename P::M b) : low(a), high(b) {}

  STICTION_INLINE bool any() const { return P::bits(P::disjunction(low, high)) != 0; }
  STICTION_INLINE bool all() const { return P::bits(P::conjunction(low, high)) == (1U << (Isa::bytes / 8)) - 1; }
  // A bit a lane, the first one lowest.
  STICTION_INLINE unsigned bits() const { return P::bits(low) | P::bits(high) << (Isa::bytes / 8); }

  STICTION_INLINE friend BatchMask operator&&(BatchMask a, BatchMask b) {
    return {P::conjunction(a.low, b.low), P::conjunction(a.high, b.high)};
  }
  STICTION_INLINE friend BatchMask operator||(BatchMask a, BatchMask b) {
    return {P::disjunction(a.low, b.low), P::disjunction(a.high, b.high)};
  }
  STICTION_INLINE friend BatchMask operator!(BatchMask a) { return {P::negation(a.low), P::negation(a.high)}; }
  STICTION_INLINE BatchMask& operator|=(BatchMask b) { return *this = *this || b; }
};

template <class Isa>
struct Batch {
  using P = detail::Part<Isa>;
  using V = typename P::V;
  using Mask = BatchMask<Isa>;
  static constexpr std::size_t lanes = 2 * Isa::bytes / sizeof(double);

  V low{}, high{};

  STICTION_INLINE Batch() {}
  template <class Number>
  requires std::is_arithmetic_v<Number> STICTION_INLINE Batch(Number x)
      : low(P::all_of(static_cast<double>(x))), high(low) {}
  STICTION_INLINE Batch(V a, V b) : low(a), high(b) {}

  // `lanes` doubles.
  STICTION_INLINE static Batch load(const double* from) {
    Batch x;
    std::memcpy(&x.low, from, Isa::bytes);
    std::memcpy(&x.high, from + lanes / 2, Isa::bytes);
    return x;
  }
  STICTION_INLINE void store(double* to) const {
    std::memcpy(to, &low, Isa::bytes);
    std::memcpy(to + lanes / 2, &high, Isa::bytes);
  }

  STICTION_INLINE double lane(std::size_t k) const {
    double x = 0.0;
    std::memcpy(&x, reinterpret_cast<const char*>(this) + k * sizeof(double), sizeof(double));
    return x;
  }
  STICTION_INLINE void set_lane(std::size_t k, double x) {
    std::memcpy(reinterpret_cast<char*>(this) + k * sizeof(double), &x, sizeof(double));
  }

  STICTION_INLINE friend Batch operator+(Batch a, Batch b) { return {a.low + b.low, a.high + b.high}; }
  STICTION_INLINE friend Batch operator-(Batch a, Batch b) { return {a.low - b.low, a.high - b.high}; }
  STICTION_INLINE friend Batch operator*(Batch a, Batch b) { return {a.low * b.low, a.high * b.high}; }
  STICTION_INLINE friend Batch operator/(Batch a, Batch b) { return {a.low / b.low, a.high / b.high}; }
  STICTION_INLINE friend Batch operator-(Batch a) { return {-a.low, -a.high}; }
  STICTION_INLINE Batch& operator+=(Batch b) { return *this = *this + b; }
  STICTION_INLINE Batch& operator-=(Batch b) { return *this = *this - b; }
  STICTION_INLINE Batch& operator*=(Batch b) { return *this = *this * b; }
  // One more where it holds.
  STICTION_INLINE Batch& operator+=(Mask m) { return *this += select(m, Batch(1.0), Batch()); }

  STICTION_INLINE friend Mask operator<(Batch a, Batch b) { return {P::less(a.low, b.low), P::less(a.high, b.high)}; }
  STICTION_INLINE friend Mask operator<=(Batch a, Batch b) {
    return {P::less_equal(a.low, b.low), P::less_equal(a.high, b.high)};
  }
  STICTION_INLINE friend Mask operator>(Batch a, Batch b) { return b < a; }
  STICTION_INLINE friend Mask operator>=(Batch a, Batch b) { return b <= a; }
  STICTION_INLINE friend Mask operator==(Batch a, Batch b) {
    return {P::equal(a.low, b.low), P::equal(a.high, b.high)};
  }
  STICTION_INLINE friend Mask operator!=(Batch a, Batch b) {
    return {P::not_equal(a.low, b.low), P::not_equal(a.high, b.high)};
  }

  // `m`: the lanes; `yes`: their values; `no`: those of the others.
  STICTION_INLINE friend Batch select(Mask m, Batch yes, Batch no) {
    return {P::select(m.low, yes.low, no.low), P::select(m.high, yes.high, no.high)};
  }
  // In the lanes of `m` the variable `to` becomes `value`.
  STICTION_INLINE friend void assign(Mask m, Batch& to, Batch value) { to = select(m, value, to); }

  // The integers that the bits of the lanes are, and back.
  struct Bits {
    typename P::Bits low, high;
  };
  STICTION_INLINE Bits bits() const {
    return {reinterpret_cast<typename P::Bits>(low), reinterpret_cast<typename P::Bits>(high)};
  }
  STICTION_INLINE static Batch from_bits(Bits b) { return {reinterpret_cast<V>(b.low), reinterpret_cast<V>(b.high)}; }
};

// |x|, and `magnitude` with the sign of `sign`.
template <class Isa>
STICTION_INLINE Batch<Isa> absolute(Batch<Isa> x) {
  const auto b = x.bits();
  return Batch<Isa>::from_bits({b.low & 0x7fffffffffffffffULL, b.high & 0x7fffffffffffffffULL});
}
template <class Isa>
STICTION_INLINE Batch<Isa> copy_sign(Batch<Isa> magnitude, Batch<Isa> sign) {
  constexpr unsigned long long bit = 0x8000000000000000ULL;
  const auto m = magnitude.bits(), s = sign.bits();
  return Batch<Isa>::from_bits({(m.low & ~bit) | (s.low & bit), (m.high & ~bit) | (s.high & bit)});
}
// The whole number towards zero, of magnitudes below 2^51.
template <class Isa>
STICTION_INLINE Batch<Isa> truncated(Batch<Isa> x) {
  const auto magnitude = absolute(x), near = (magnitude + 0x1p52) - 0x1p52;
  return copy_sign(select(near > magnitude, near - 1.0, near), x);
}
// The same towards minus infinity.
template <class Isa>
STICTION_INLINE Batch<Isa> floored(Batch<Isa> x) {
  const auto whole = truncated(x);
  return select(whole > x, whole - 1.0, whole);
}
// As std::round(): ties away from zero.
template <class Isa>
STICTION_INLINE Batch<Isa> rounded(Batch<Isa> x) {
  const auto magnitude = absolute(x), near = (magnitude + 0x1p52) - 0x1p52;
  const auto whole = select(magnitude - near >= 0.5, near + 1.0, near);
  return select(magnitude < 0x1p52, copy_sign(whole, x), x);
}
// 2^(the exponent of x) lies in this field; x positive and normal.
template <class Isa>
STICTION_INLINE Batch<Isa> exponent_of(Batch<Isa> x) {
  constexpr unsigned long long magic = 0x4330000000000000ULL;  // 2^52
  const auto b = x.bits();
  return Batch<Isa>::from_bits({b.low >> 52 | magic, b.high >> 52 | magic}) - (0x1p52 + 1023.0);
}
// x of 1 to 2 with the digits of a positive normal number.
template <class Isa>
STICTION_INLINE Batch<Isa> mantissa_of(Batch<Isa> x) {
  constexpr unsigned long long digits = 0xfffffffffffffULL, one = 0x3ff0000000000000ULL;
  const auto b = x.bits();
  return Batch<Isa>::from_bits({(b.low & digits) | one, (b.high & digits) | one});
}
// 2^k of whole numbers from -1022 to 1023.
template <class Isa>
STICTION_INLINE Batch<Isa> power_of_two(Batch<Isa> k) {
  const auto b = (k + (0x1p52 + 1023.0)).bits();
  return Batch<Isa>::from_bits({b.low << 52, b.high << 52});
}
template <class Isa>
STICTION_INLINE BatchMask<Isa> is_finite(Batch<Isa> x) {
  return absolute(x) < __builtin_inf();
}

template <class Isa>
STICTION_INLINE bool any(BatchMask<Isa> m) {
  return m.any();
}
template <class Isa>
STICTION_INLINE bool all(BatchMask<Isa> m) {
  return m.all();
}
// `m`: the lanes; `yes`: their values; `no`: those of the others.
template <class Isa>
STICTION_INLINE BatchMask<Isa> select(BatchMask<Isa> m, BatchMask<Isa> yes, BatchMask<Isa> no) {
  return (m && yes) || (!m && no);
}
// In the lanes of `m` the variable `to` becomes `value`.
template <class Isa>
STICTION_INLINE void assign(BatchMask<Isa> m, BatchMask<Isa>& to, BatchMask<Isa> value) {
  to = select(m, value, to);
}

}  // namespace stiction::machine
