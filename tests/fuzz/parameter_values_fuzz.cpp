// Values of any size for any keys of valid machines: finds allowed ranges that are too wide for the simulation or for
// the conversion to the drive's formats. The bytes choose a machine, then key after key with its value.
#include <fmt/format.h>
#include <fuzzer/FuzzedDataProvider.h>

#include <array>

#include "sim/machine_file.hpp"
#include "tests/fuzz/fuzzed_number.hpp"
#include "tests/fuzz/machine_bytes.hpp"

namespace stiction::fuzz {
namespace {

struct Key {
  std::string name;  // with `axis.*`
  std::string unit;  // empty: a text or a name, which are left to the other fuzzers
  bool list;
};

std::vector<Key> keys_of(bool force_motor) {
  std::vector<Key> keys;
  for (const auto& table : sim::machine_file_description()) {
    if (table.name.starts_with("[")) continue;  // rows of references do not reach the plant
    std::string prefix = table.name;
    if (const auto at = prefix.find("NAME"); at != std::string::npos) prefix.replace(at, 4, "*");
    for (const auto& key : table.keys)
      if (!key.unit.empty())
        keys.push_back({fmt::format("{}.{}", prefix, key.key),
                        force_motor && !key.unit_of_force_motor.empty() ? key.unit_of_force_motor : key.unit,
                        key.list});
  }
  return keys;
}

struct Base {
  std::filesystem::path file;
  std::vector<Key> keys;
};

std::string value_of(FuzzedDataProvider& bytes, const Key& key) {
  const std::string number = fuzzed_number(bytes);
  const std::string quantity = key.unit == "1" ? number : fmt::format("\"{} {}\"", number, key.unit);
  return key.list ? fmt::format("[{0}, {0}, {0}]", quantity) : quantity;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::array<Base, 3> bases{Base{valid_machine("synchronous"), keys_of(false)},
                                         Base{valid_machine("dc"), keys_of(false)},
                                         Base{valid_machine("force"), keys_of(true)}};
  FuzzedDataProvider bytes(data, size);
  const Base& base = bases[bytes.ConsumeIntegralInRange<std::size_t>(0, bases.size() - 1)];
  machine::ReadOptions options;
  while (bytes.remaining_bytes() > 0 && options.set.size() < 20) {
    const Key& key = base.keys[bytes.ConsumeIntegralInRange<std::size_t>(0, base.keys.size() - 1)];
    options.set.push_back(fmt::format("{}={}", key.name, value_of(bytes, key)));
  }
  read_and_run(base.file, options);
  return 0;
}

}  // namespace stiction::fuzz
