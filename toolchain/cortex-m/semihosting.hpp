// The part of Arm's semihosting that the programs here use (Arm IHI 0100, "Semihosting for AArch32 and AArch64"):
// files of the machine that runs the emulator, its console, the exit status.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace semihosting {

enum class Operation : std::uint32_t {
  open = 0x01,
  close = 0x02,
  write_text = 0x04,
  read = 0x06,
  command_line = 0x15,
  exit = 0x20
};

inline std::intptr_t call(Operation operation, const void* parameters) {
  register std::uint32_t r0 asm("r0") = static_cast<std::uint32_t>(operation);
  register const void* r1 asm("r1") = parameters;
  asm volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
  return static_cast<std::intptr_t>(r0);
}

// A handle, or -1.
inline std::intptr_t open_to_read(const char* path, std::size_t length) {
  constexpr std::uintptr_t binary_read = 1;
  const std::array<std::uintptr_t, 3> block{reinterpret_cast<std::uintptr_t>(path), binary_read, length};
  return call(Operation::open, block.data());
}

// How many bytes were read. `handle`: from open_to_read(); `to`: at least `bytes` of space.
inline std::size_t read(std::intptr_t handle, void* to, std::size_t bytes) {
  const std::array<std::uintptr_t, 3> block{static_cast<std::uintptr_t>(handle), reinterpret_cast<std::uintptr_t>(to),
                                            bytes};
  return bytes - static_cast<std::size_t>(call(Operation::read, block.data()));
}

inline void write(const char* text) { call(Operation::write_text, text); }

// Fills `text` with the command line, closed by a zero.
inline bool command_line(char* text, std::size_t size) {
  const std::array<std::uintptr_t, 2> block{reinterpret_cast<std::uintptr_t>(text), size};
  return call(Operation::command_line, block.data()) == 0;
}

[[noreturn]] inline void exit(int status) {
  constexpr std::uintptr_t application_exit = 0x20026;
  const std::array<std::uintptr_t, 2> block{application_exit, static_cast<std::uintptr_t>(status)};
  call(Operation::exit, block.data());
  for (;;) {
  }
}

}  // namespace semihosting
