// A sentence in a buffer of fixed size, for messages about a design: no heap, no locale, usable while compiling.
// Numbers look as printf's %g writes them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace stiction::design {

// What does not fit is cut off; the text always ends with a zero.
template <std::size_t Size>
class Text {
 public:
  constexpr const char* c_str() const { return characters_.data(); }
  constexpr std::size_t size() const { return size_; }

  constexpr Text& operator<<(const char* text) {
    for (; *text != '\0'; ++text) put(*text);
    return *this;
  }
  // Six significant digits, without zeros at the end.
  constexpr Text& operator<<(double value) {
    if (value != value) return *this << "nan";
    if (value < 0.0) put('-');
    const double magnitude = value < 0.0 ? -value : value;
    if (magnitude > 1.7976931348623157e308) return *this << "inf";
    if (!(magnitude > 0.0)) return *this << "0";
    write(magnitude);
    return *this;
  }

 private:
  static constexpr int digits = 6;

  static constexpr double scaled(double value, int tens) {
    double power = 1.0;
    for (int k = tens < 0 ? -tens : tens; k > 0; --k) {
      if (power > 1e299) {  // the rest in a second step
        value = tens < 0 ? value / power : value * power;
        power = 1.0;
      }
      power *= 10.0;
    }
    return tens < 0 ? value / power : value * power;
  }

  constexpr void write(double magnitude) {
    int exponent = 0;
    for (double x = magnitude; x >= 10.0; x /= 10.0) ++exponent;
    for (double x = magnitude; x < 1.0; x *= 10.0) --exponent;
    auto whole = static_cast<std::int64_t>(scaled(magnitude, digits - 1 - exponent) + 0.5);
    if (whole >= 1000000) {
      whole /= 10;
      ++exponent;
    }
    std::array<char, digits> decimal{};
    for (std::size_t k = digits; k-- > 0; whole /= 10) decimal[k] = static_cast<char>('0' + whole % 10);
    int used = digits;
    while (used > 1 && decimal[static_cast<std::size_t>(used - 1)] == '0') --used;
    const bool plain = exponent >= -4 && exponent < digits;
    if (plain && exponent < 0) {
      *this << "0.";
      for (int k = -1; k > exponent; --k) put('0');
    }
    const int before_point = plain ? exponent + 1 : 1;
    for (int k = 0; k < used || k < before_point; ++k) {
      if (k == before_point && k > 0) put('.');
      put(decimal[static_cast<std::size_t>(k)]);
    }
    if (!plain) write_exponent(exponent);
  }
  constexpr void write_exponent(int exponent) {
    put('e');
    put(exponent < 0 ? '-' : '+');
    const int magnitude = exponent < 0 ? -exponent : exponent;
    if (magnitude >= 100) put(static_cast<char>('0' + magnitude / 100));
    put(static_cast<char>('0' + magnitude / 10 % 10));
    put(static_cast<char>('0' + magnitude % 10));
  }
  constexpr void put(char c) {
    if (size_ + 1 < Size) characters_[size_++] = c;
  }

  std::array<char, Size> characters_{};
  std::size_t size_ = 0;
};

}  // namespace stiction::design
