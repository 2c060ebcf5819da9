// Compiled for this instruction set alone (host/CMakeLists.txt).
#include "host/batch/kernel_of.hpp"

namespace stiction::host {

std::unique_ptr<Kernel> make_kernel_sse2(const BatchKind& kind) { return make_kernel<machine::Sse2>(kind); }

}  // namespace stiction::host
