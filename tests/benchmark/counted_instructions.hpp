// Instructions that a function takes, counted by stepping through it: whatever instructions the processor has, and
// without counters of hardware. A million take some seconds.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

namespace stiction::benchmark {

// Of `work` in a process of its own; none where processes may not be traced.
std::optional<std::uint64_t> counted_instructions(const std::function<void()>& work);

}  // namespace stiction::benchmark
