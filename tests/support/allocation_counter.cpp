// In a file of its own, so that no compiler sees a new and a free in one place.
#include "tests/support/allocation_counter.hpp"

#include <atomic>
#include <cstdlib>
#include <new>

#include "tests/support/sanitizer.hpp"

namespace {
std::atomic<std::size_t> count{0};
}

namespace stiction::test {
std::size_t allocations() { return count; }
bool allocations_are_counted() { return !address_sanitizer; }
}  // namespace stiction::test

#if !STICTION_ADDRESS_SANITIZER
// NOLINTBEGIN(cppcoreguidelines-no-malloc): these stand below what else would be used
void* operator new(std::size_t size) {
  ++count;
  if (void* const memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
// NOLINTEND(cppcoreguidelines-no-malloc)
#endif
