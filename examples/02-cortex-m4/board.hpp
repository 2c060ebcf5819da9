// The board around the drive. On hardware these are registers: encoder counter, current converter, PWM, a serial line.
// Here, under the emulator, a motor and a mass with friction in whole numbers take their place (those of example 01),
// and the text goes to the debugger (semihosting: Arm IHI 0100).
#pragma once

#include <cstdint>

namespace board {

class Motor {
 public:
  std::int32_t encoder_nm() const { return static_cast<std::int32_t>(x_ / 16000); }
  std::int32_t current_uA() const { return static_cast<std::int32_t>(i_); }
  // One tick of 62.5 us under a voltage: 2 Ohm, 10 mH, 50 V s/m, 50 N/A, 20 kg, 25 N and 60 N s/m.
  void pwm_uV(std::int64_t u) {
    i_ += (u - 2 * i_ - v_ / 20) / 160;
    const std::int64_t contact = v_ * 250 > 25000000 ? 25000000 : v_ * 250 < -25000000 ? -25000000 : v_ * 250;
    v_ += (50 * i_ - contact - v_ * 60 / 1000) / 320;
    x_ += v_;
  }

 private:
  std::int64_t x_ = 0, v_ = 0, i_ = 0;  // nm / 16000, nm/s, uA
};

inline std::intptr_t debugger(std::uint32_t operation, const void* parameters) {
  register std::uint32_t r0 asm("r0") = operation;
  register const void* r1 asm("r1") = parameters;
  asm volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
  return static_cast<std::intptr_t>(r0);
}

inline void print(const char* text) { debugger(0x04, text); }

inline void print(std::int32_t number) {
  char text[12];
  char* place = text + sizeof text;
  *--place = '\0';
  std::uint32_t rest = number < 0 ? 0u - static_cast<std::uint32_t>(number) : static_cast<std::uint32_t>(number);
  do *--place = static_cast<char>('0' + rest % 10);
  while (rest /= 10);
  if (number < 0) *--place = '-';
  print(place);
}

[[noreturn]] inline void exit(int status) {
  const std::uintptr_t block[2] = {0x20026, static_cast<std::uintptr_t>(status)};
  debugger(0x20, block);
  for (;;) {
  }
}

}  // namespace board
