// Which of the processor's vectors a batch uses.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace stiction::host {

enum class InstructionSet { sse2, neon, avx2, avx512 };

const char* name_of(InstructionSet set);

// Axes in a batch of that `set`.
std::size_t lanes_of(InstructionSet set);

// Those that this program and this processor have, the narrowest first; at least one.
std::span<const InstructionSet> instruction_sets();

// The widest of them.
InstructionSet widest_instruction_set();

}  // namespace stiction::host
