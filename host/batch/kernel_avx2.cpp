// Compiled for this instruction set alone (host/CMakeLists.txt).
#include "host/batch/kernel_of.hpp"

namespace stiction::host {

std::unique_ptr<Kernel> make_kernel_avx2(const BatchKind& kind) { return make_kernel<machine::Avx2>(kind); }

}  // namespace stiction::host
