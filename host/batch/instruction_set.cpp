#include "host/batch/instruction_set.hpp"

#include <vector>

namespace stiction::host {
namespace {

std::vector<InstructionSet> found_sets() {
#if defined(__x86_64__)
  std::vector<InstructionSet> sets{InstructionSet::sse2};
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2")) sets.push_back(InstructionSet::avx2);
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512bw"))
    sets.push_back(InstructionSet::avx512);
  return sets;
#else
  return {InstructionSet::neon};
#endif
}

}  // namespace

const char* name_of(InstructionSet set) {
  switch (set) {
    case InstructionSet::sse2:
      return "SSE2";
    case InstructionSet::neon:
      return "NEON";
    case InstructionSet::avx2:
      return "AVX2";
    case InstructionSet::avx512:
      return "AVX-512";
  }
  return "";
}

std::size_t lanes_of(InstructionSet set) {
  switch (set) {
    case InstructionSet::sse2:
    case InstructionSet::neon:
      return 4;
    case InstructionSet::avx2:
      return 8;
    case InstructionSet::avx512:
      return 16;
  }
  return 1;
}

std::span<const InstructionSet> instruction_sets() {
  static const std::vector<InstructionSet> sets = found_sets();
  return sets;
}

InstructionSet widest_instruction_set() { return instruction_sets().back(); }

}  // namespace stiction::host
