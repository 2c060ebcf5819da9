// Whether there is room for a trace, asked before anything moves: memory while it runs, a file behind it.
#pragma once

#include <cstdint>
#include <filesystem>

namespace stiction::drive {

// Throws StartRefused where `bytes` are more than four fifths of the memory that is free, or than the process may lock.
// `bytes`: of what is kept while the loop runs; `locked`: whether memory is locked.
void check_memory(double bytes, bool locked);

// Creates and empties `file`. Throws StartRefused where it is no ordinary file, cannot be written, or its disk has no
// room for `bytes`.
void check_trace_file(const std::filesystem::path& file, std::uint64_t bytes);

}  // namespace stiction::drive
