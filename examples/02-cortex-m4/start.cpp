// Start-up of a Cortex-M4: vectors, data from flash to RAM, cleared memory, constructors. An exception that nobody
// expects ends the program with status 125, which the emulator passes on.
#include <cstdint>

#include "board.hpp"

extern "C" {
extern std::uint64_t data[], data_end[], data_in_flash[], zero[], zero_end[], stack_top[];
extern void (*constructors[])();
extern void (*constructors_end[])();
int main();

[[noreturn]] void reset() {
  const auto* from = data_in_flash;
  for (auto* to = data; to != data_end; ++to, ++from) *to = *from;
  for (auto* word = zero; word != zero_end; ++word) *word = 0;
  for (auto* construct = constructors; construct != constructors_end; ++construct) (*construct)();
  board::exit(main());
}

[[noreturn]] void unexpected() { board::exit(125); }
}

namespace {

using Vector = void (*)();
struct Vectors {
  const std::uint64_t* stack;
  Vector exceptions[15];
};
[[gnu::section(".vectors"), gnu::used]] const Vectors vectors{
    stack_top,
    {reset, unexpected, unexpected, unexpected, unexpected, unexpected, nullptr, nullptr, nullptr, nullptr, unexpected,
     unexpected, nullptr, unexpected, unexpected}};

}  // namespace
