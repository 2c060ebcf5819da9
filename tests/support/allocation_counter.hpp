// How often this program asked for memory by operator new. Link allocation_counter.cpp.
#pragma once

#include <cstddef>

namespace stiction::test {

std::size_t allocations();

}  // namespace stiction::test
