// An axis that a bus asks for modes, targets and a homing.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>

#include "tests/firmware/drive/served_axis.hpp"

namespace stiction::test {

inline constexpr std::uint16_t on_word = controlword::enable_operation,
                               offer_word = on_word | controlword::new_set_point_bit;
inline constexpr double end = ServedAxis::end;

inline ServedAxis enabled_in(OperationMode mode, double at = 0.0, HomingMethod method = HomingMethod::none) {
  ServedAxis a({}, method, at);
  EXPECT_TRUE(a.enable());
  a.remote.ask(mode);
  a.remote.ask(on_word);
  a.stream(64, 0.0);
  EXPECT_EQ(a.remote.mode(), mode);
  return a;
}

inline void offer(ServedAxis& a, double target, std::uint16_t bits = 0) {
  a.remote.ask(on_word);
  a.step();
  a.remote.ask_target(si<FixedSignals::Position>(target));
  a.remote.ask(static_cast<std::uint16_t>(offer_word | bits));
  a.step();
}

inline void home(ServedAxis& a) {
  a.remote.ask(OperationMode::homing);
  a.remote.ask(on_word | controlword::homing_start_bit);
  a.stream(200, 0.0);
  ASSERT_TRUE(a.drive.referenced());
}

}  // namespace stiction::test
