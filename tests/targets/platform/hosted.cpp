// Under an operating system.
#include <cstdio>

#include "tests/targets/platform/platform.hpp"

namespace stiction::targets {

Input::Input(const char* path) : file_(std::fopen(path, "rb")) {}
bool Input::read(void* to, std::size_t bytes) {
  return file_ != nullptr && std::fread(to, 1, bytes, static_cast<std::FILE*>(file_)) == bytes;
}

void print(const char* text) { std::fputs(text, stdout); }

const bool counts_instructions = false;
std::uint32_t count_instructions(Work work, void* data) {
  work(data);
  return 0;
}

}  // namespace stiction::targets
