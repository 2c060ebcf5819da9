// Numbers and texts of matio's variables. Only the .cpp files of this folder may include it.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>

#include "host/log/mat_handles.hpp"

namespace stiction::host {

// Calls visit(values) with the array as a span of its own number type; false for a class that is no number.
template <class Visit>
bool with_numbers(const matvar_t& v, Visit&& visit) {
  const auto as = [&]<class T>(T) {
    visit(std::span<const T>(static_cast<const T*>(v.data), v.nbytes / sizeof(T)));
    return true;
  };
  switch (v.class_type) {
    case MAT_C_DOUBLE:
      return as(double{});
    case MAT_C_SINGLE:
      return as(float{});
    case MAT_C_INT8:
      return as(std::int8_t{});
    case MAT_C_UINT8:
      return as(std::uint8_t{});
    case MAT_C_INT16:
      return as(std::int16_t{});
    case MAT_C_UINT16:
      return as(std::uint16_t{});
    case MAT_C_INT32:
      return as(std::int32_t{});
    case MAT_C_UINT32:
      return as(std::uint32_t{});
    case MAT_C_INT64:
      return as(std::int64_t{});
    case MAT_C_UINT64:
      return as(std::uint64_t{});
    default:
      return false;
  }
}

inline std::string shape_of(const matvar_t& v) {
  std::string shape;
  for (int d = 0; d < v.rank; ++d) shape += fmt::format("{}{}", d > 0 ? "x" : "", v.dims[d]);
  return shape;
}

inline std::string text_of(const matvar_t* v) {
  if (v == nullptr || v->class_type != MAT_C_CHAR || v->data == nullptr) return {};
  // Both levels may keep characters as 8 or 16 bits; units and comments are ASCII or UTF-8.
  std::string text;
  const auto size = static_cast<std::size_t>(std::max(1, v->data_size));
  const auto* bytes = static_cast<const char*>(v->data);
  for (std::size_t k = 0; k < v->nbytes; k += size) text += bytes[k];
  return text;
}

// Whether it is a two-dimensional array of real numbers.
inline bool is_real_matrix(const matvar_t& v) {
  return v.isComplex == 0 && v.rank == 2 && v.data != nullptr && with_numbers(v, [](const auto&) {});
}

}  // namespace stiction::host
