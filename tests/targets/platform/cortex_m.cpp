// Bare metal under QEMU: files and text by semihosting, instructions by SysTick.
#include <array>
#include <cstring>

#include "semihosting.hpp"
#include "tests/targets/platform/platform.hpp"

namespace stiction::targets {
namespace {

std::array<unsigned char, 65536> buffer;
std::size_t taken = 0;
std::size_t filled = 0;

// SysTick counts down at the 25 MHz of the board; QEMU takes 256 ns, 6.4 counts, for every instruction
// (toolchain/cortex-m/run).
struct SysTick {
  std::uint32_t control;
  std::uint32_t reload;
  std::uint32_t current;
};
volatile SysTick& systick() { return *reinterpret_cast<volatile SysTick*>(0xE000E010); }
constexpr std::uint32_t counter_mask = 0x00FFFFFF;

}  // namespace

Input::Input(const char* path) : file_(reinterpret_cast<void*>(semihosting::open_to_read(path, std::strlen(path)))) {}

bool Input::read(void* to, std::size_t bytes) {
  const auto handle = reinterpret_cast<std::intptr_t>(file_);
  if (handle == -1) return false;
  auto* out = static_cast<unsigned char*>(to);
  while (bytes > 0) {
    if (taken == filled) {
      taken = 0;
      filled = semihosting::read(handle, buffer.data(), buffer.size());
      if (filled == 0) return false;
    }
    const std::size_t part = bytes < filled - taken ? bytes : filled - taken;
    std::memcpy(out, buffer.data() + taken, part);
    taken += part;
    out += part;
    bytes -= part;
  }
  return true;
}

void print(const char* text) { semihosting::write(text); }

const bool counts_instructions = true;
[[gnu::noinline]] std::uint32_t count_instructions(Work work, void* data) {
  auto& timer = systick();
  timer.reload = counter_mask;
  timer.control = 5;  // the processor's clock, no interrupt
  const std::uint32_t before = timer.current;
  work(data);
  const std::uint32_t after = timer.current;
  // Whole counts of 6.4 an instruction: the nearest number of instructions is exact.
  return (((before - after) & counter_mask) * 5 + 16) / 32;
}

}  // namespace stiction::targets
