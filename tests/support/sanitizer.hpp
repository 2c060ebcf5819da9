// Whether this program runs under the address sanitizer, which has an allocator of its own and locks no memory.
#pragma once

namespace stiction::test {

#if defined(__SANITIZE_ADDRESS__)
#define STICTION_ADDRESS_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define STICTION_ADDRESS_SANITIZER 1
#endif
#endif
#if !defined(STICTION_ADDRESS_SANITIZER)
#define STICTION_ADDRESS_SANITIZER 0
#endif

inline constexpr bool address_sanitizer = STICTION_ADDRESS_SANITIZER == 1;

}  // namespace stiction::test
