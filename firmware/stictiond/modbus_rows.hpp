// One row of a table a register of an axis: what the drive shows, and what clients may ask for (modbus_registers.cpp).
#pragma once

#include <array>
#include <cstdint>

#include "firmware/machine/model/machine.hpp"
#include "firmware/stictiond/modbus_registers.hpp"
#include "hal/modbus/register_map.hpp"

namespace stiction::drive {

inline constexpr double position_scale = 1e-8;  // m: 32 bits reach 21 m, in steps finer than any panel shows

template <class Owner>
struct StateRow {
  std::uint16_t offset;
  hal::RegisterType type;
  double scale;
  const char* name;
  const char* unit;
  const char* text;
  double (*value)(const Owner&);
};

struct MotionRow {
  std::uint16_t offset;
  hal::RegisterType type;
  double scale;
  const char* name;
  const char* unit;
  const char* text;
  MotionWrite::What what;
  double (*value)(const PublishedAxis&);
  std::array<double, 9> choices{};  // all 0: every number
  // Limits what may be written to what the axis can; null: every number.
  void (*limit)(const machine::AxisModel&, hal::Register&) = nullptr;
};

inline void up_to(double high, hal::Register& r) {
  r.low = 0.0;
  r.low_open = true;
  r.high = high;
}

// All rows of two tables.
template <class Row, std::size_t A, std::size_t B>
constexpr std::array<Row, A + B> joined(const std::array<Row, A>& first, const std::array<Row, B>& second) {
  std::array<Row, A + B> all{};
  for (std::size_t k = 0; k < A; ++k) all[k] = first[k];
  for (std::size_t k = 0; k < B; ++k) all[A + k] = second[k];
  return all;
}

}  // namespace stiction::drive
