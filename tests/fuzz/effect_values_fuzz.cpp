// Values of any size for any effects of valid machines: finds allowed ranges that are too wide for the simulation. The
// bytes choose a machine, then effect after effect with the values of its keys.
#include <fmt/format.h>
#include <fuzzer/FuzzedDataProvider.h>

#include <array>
#include <fstream>
#include <iterator>

#include "sim/effects/effects.hpp"
#include "tests/fuzz/fuzzed_number.hpp"
#include "tests/fuzz/machine_bytes.hpp"

namespace stiction::fuzz {
namespace {

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

std::string value_of(FuzzedDataProvider& bytes, const machine::ValueKey& key) {
  const auto quantity = [&] {
    const auto number = fuzzed_number(bytes);
    return key.unit == "1" ? number : fmt::format("\"{} {}\"", number, key.unit);
  };
  if (!key.list) return quantity();
  std::string list;
  for (int count = bytes.ConsumeIntegralInRange<int>(0, 3); count > 0; --count) list += quantity() + ", ";
  return "[" + list + "]";
}

std::string effect_of(FuzzedDataProvider& bytes) {
  const auto kinds = sim::all_effects();
  const auto kind = kinds[bytes.ConsumeIntegralInRange<std::size_t>(0, kinds.size() - 1)];
  std::string text = fmt::format("[[axis.X.effect]]\nname = \"{}\"\n", kind.name());
  for (const auto& key : kind->keys)
    if ((!key.fallback && !key.optional) || bytes.ConsumeBool())
      text += fmt::format("{} = {}\n", key.key, value_of(bytes, key));
  return text;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::array bases{text_of(valid_machine("synchronous")), text_of(valid_machine("dc")),
                                text_of(valid_machine("force")), text_of(valid_machine("elastic"))};
  static FileInMemory file;
  FuzzedDataProvider bytes(data, size);
  const auto& base = bases[bytes.ConsumeIntegralInRange<std::size_t>(0, bases.size() - 1)];
  std::string effects;
  for (int count = 0; bytes.remaining_bytes() > 0 && count < 6; ++count) effects += effect_of(bytes);
  file.replace_by(base + effects);
  read_and_run(file.path(), {}, effects);
  return 0;
}

}  // namespace stiction::fuzz
