// C++ exceptions in WebAssembly, of which Debian's libc++abi for wasm32 has none: throw, catch and rethrow over the
// engine's own exceptions. The tables are those of the Itanium C++ ABI as clang writes them for wasm32: an entry for
// each landing pad, whose chain of actions names the types that are caught. Types match by single inheritance, which
// all exceptions here have.
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <typeinfo>

extern "C" {
// Between compiled code and personality, by the names that clang calls.
struct LandingPadContext {
  std::uintptr_t pad;         // number of the landing pad
  const std::uint8_t* table;  // of the function
  std::uintptr_t selector;    // 1, 2, ..: the type that matches; 0: none
};
LandingPadContext __wasm_lpad_context = {};

extern char _ZTVN10__cxxabiv120__si_class_type_infoE[];  // virtual table of std::type_info of classes with one base
}

namespace {

using Destructor = void* (*)(void*);  // on wasm32 destructors return their object

struct alignas(16) Header {
  const std::type_info* type;
  Destructor destroy;
  Header* below;  // in the stack of caught exceptions
  int handlers;
  bool rethrown;
};

Header* caught = nullptr;

Header* header_of(void* thrown) { return static_cast<Header*>(thrown) - 1; }

// LEB128, which the tables are written in.
std::uintptr_t unsigned_number(const std::uint8_t*& at) {
  std::uintptr_t value = 0;
  unsigned shift = 0;
  std::uint8_t byte = 0;
  do {
    byte = *at++;
    value |= static_cast<std::uintptr_t>(byte & 0x7f) << shift;
    shift += 7;
  } while ((byte & 0x80) != 0);
  return value;
}

std::intptr_t signed_number(const std::uint8_t*& at) {
  std::uintptr_t value = 0;
  unsigned shift = 0;
  std::uint8_t byte = 0;
  do {
    byte = *at++;
    value |= static_cast<std::uintptr_t>(byte & 0x7f) << shift;
    shift += 7;
  } while ((byte & 0x80) != 0);
  if ((byte & 0x40) != 0 && shift < 32) value |= ~std::uintptr_t{0} << shift;
  return static_cast<std::intptr_t>(value);
}

// As the Itanium C++ ABI (2.9.5) lays it out.
struct SingleBase {
  const void* virtual_table;
  const char* name;
  const std::type_info* base;
};

bool derives(const std::type_info* thrown, const std::type_info& wanted) {
  while (*thrown != wanted) {
    const auto* type = reinterpret_cast<const SingleBase*>(thrown);
    if (type->virtual_table != _ZTVN10__cxxabiv120__si_class_type_infoE + 2 * sizeof(void*)) return false;
    thrown = type->base;
  }
  return true;
}

// The first type of the chain of `action` that `thrown` is; 0: none.
std::uintptr_t selector_of(const std::uint8_t* action, const std::uint8_t* types, const std::type_info* thrown) {
  while (true) {
    const std::intptr_t index = signed_number(action);
    const std::uint8_t* const link = action;
    const std::intptr_t next = signed_number(action);
    if (index > 0) {
      const std::type_info* wanted = nullptr;
      constexpr std::intptr_t size = sizeof(wanted);
      std::memcpy(&wanted, types - index * size, size);
      if (wanted == nullptr || derives(thrown, *wanted)) return static_cast<std::uintptr_t>(index);
    }
    if (next == 0) return 0;
    action = link + next;
  }
}

}  // namespace

extern "C" {

void* __cxa_allocate_exception(std::size_t size) {
  auto* header = static_cast<Header*>(std::calloc(1, sizeof(Header) + size));
  if (header == nullptr) __builtin_trap();
  return header + 1;
}

void __cxa_free_exception(void* thrown) { std::free(header_of(thrown)); }

[[noreturn]] void __cxa_throw(void* thrown, std::type_info* type, Destructor destroy) {
  header_of(thrown)->type = type;
  header_of(thrown)->destroy = destroy;
  __builtin_wasm_throw(0, thrown);
}

void* __cxa_begin_catch(void* thrown) {
  Header* header = header_of(thrown);
  header->rethrown = false;
  if (header->handlers++ == 0) {
    header->below = caught;
    caught = header;
  }
  return thrown;
}

void __cxa_end_catch() {
  Header* header = caught;
  if (header == nullptr || --header->handlers > 0) return;
  caught = header->below;
  if (header->rethrown) return;
  if (header->destroy != nullptr) header->destroy(header + 1);
  std::free(header);
}

[[noreturn]] void __cxa_rethrow() {
  if (caught == nullptr) __builtin_trap();
  caught->rethrown = true;
  __builtin_wasm_throw(0, caught + 1);
}

// Called by each landing pad that catches by type.
int _Unwind_CallPersonality(void* thrown) {
  auto& context = __wasm_lpad_context;
  context.selector = 0;
  constexpr std::uint8_t omitted = 0xff;
  const std::uint8_t* at = context.table;
  if (*at++ != omitted) __builtin_trap();
  const std::uint8_t* types = nullptr;
  if (*at++ != omitted) {
    const std::uintptr_t distance = unsigned_number(at);
    types = at + distance;
  }
  ++at;  // the encoding of the table of landing pads
  const std::uintptr_t length = unsigned_number(at);
  const std::uint8_t* const actions = at + length;
  std::uintptr_t action = 0;
  for (std::uintptr_t pad = 0; pad <= context.pad; ++pad) {
    unsigned_number(at);
    action = unsigned_number(at);
  }
  if (action != 0) context.selector = selector_of(actions + action - 1, types, header_of(thrown)->type);
  return 0;
}

}  // extern "C"
