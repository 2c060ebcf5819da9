// Any bytes as a cam in each format of other makers: refused with a message, or a cam that composes.
#include <cstdint>
#include <string>

#include "host/cam/exchange.hpp"

namespace stiction::fuzz {

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  const auto& formats = host::exchange_formats();
  const auto& format = formats[data[0] % formats.size()];
  host::ExchangeSettings settings;
  if ((data[0] & 0x80) != 0) settings.csv = {"xyv", ';', ',', false};
  if ((data[0] & 0x40) != 0) settings.dialect = host::Dialect::twincat, settings.scaling = 0.5;
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  host::looks_like(text);
  try {
    sim::cam::compose(host::imported(text, format, settings, {.name = "a"}));
  } catch (const sim::cam::CamError&) {
  }
  return 0;
}

}  // namespace stiction::fuzz
