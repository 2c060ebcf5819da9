// What the programs here need of the machine they run on, with or without an operating system.
#pragma once

#include <cstddef>
#include <cstdint>

namespace stiction::targets {

// A file, read from its beginning.
class Input {
 public:
  explicit Input(const char* path);
  bool read(void* to, std::size_t bytes);  // false: the file is missing or shorter

 private:
  void* file_;
};

void print(const char* text);

// Whether count_instructions() counts. Where not, a tool from outside does.
extern const bool counts_instructions;

// Runs `work(data)` and returns how many instructions it took, with a constant excess that an empty `work` shows.
using Work = void (*)(void* data);
std::uint32_t count_instructions(Work work, void* data);

}  // namespace stiction::targets
