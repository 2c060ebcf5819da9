// How often this program asked for memory by operator new. Link allocation_counter.cpp.
#pragma once

#include <cstddef>

namespace stiction::test {

std::size_t allocations();

// False under a sanitizer, which has an allocator of its own: nothing is counted then.
bool allocations_are_counted();

}  // namespace stiction::test
