// Kernels for instruction sets that this processor family does not have.
#include "host/batch/kernel.hpp"

namespace stiction::host {

#if defined(__x86_64__)
std::unique_ptr<Kernel> make_kernel_neon(const BatchKind&) { return nullptr; }
#else
std::unique_ptr<Kernel> make_kernel_sse2(const BatchKind&) { return nullptr; }
std::unique_ptr<Kernel> make_kernel_avx2(const BatchKind&) { return nullptr; }
std::unique_ptr<Kernel> make_kernel_avx512(const BatchKind&) { return nullptr; }
#endif

}  // namespace stiction::host
