// Start-up of a bare-metal Cortex-M4F program: vectors, cleared memory, constructors, arguments from the debugger's
// command line, exit status to the debugger. No heap, no C library beyond memcpy and its like.
#include <array>
#include <cstddef>
#include <cstdint>

#include "semihosting.hpp"

extern "C" {
extern std::uint64_t zero_begin[], zero_end[];
extern void (*constructors_begin[])();
extern void (*constructors_end[])();
extern std::uint64_t stack_top[];
int main(int argc, char** argv);
[[noreturn]] void reset();
[[noreturn]] void stopped();
}

namespace {

// Words of the command line, parted by blanks.
int split(char* text, std::array<char*, 8>& words) {
  int count = 0;
  for (; *text != '\0' && count < 7; ++count) {
    words[static_cast<std::size_t>(count)] = text;
    while (*text != '\0' && *text != ' ') ++text;
    while (*text == ' ') *text++ = '\0';
  }
  return count;
}

using Vector = void (*)();
struct Vectors {
  const std::uint64_t* stack;
  std::array<Vector, 15> exceptions;
};
[[gnu::section(".vectors"), gnu::used]] const Vectors vectors{
    stack_top,
    {reset, stopped, stopped, stopped, stopped, stopped, nullptr, nullptr, nullptr, nullptr, stopped, stopped, nullptr,
     stopped, stopped}};

}  // namespace

void reset() {
  // Nothing here needs the floating-point unit; it stays off, so that its use would be a fault.
  for (auto* word = zero_begin; word != zero_end; ++word) *word = 0;
  for (auto* construct = constructors_begin; construct != constructors_end; ++construct) (*construct)();

  static std::array<char, 1024> line;
  std::array<char*, 8> words{};
  const int count = semihosting::command_line(line.data(), line.size()) ? split(line.data(), words) : 0;
  semihosting::exit(main(count, words.data()));
}

// Any exception: the program ends with a status that no program gives itself.
void stopped() {
  semihosting::write("stopped by an exception\n");
  semihosting::exit(125);
}
