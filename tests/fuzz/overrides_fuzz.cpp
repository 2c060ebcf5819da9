// Any lines as values of `--set` over a valid machine; the first line names the experiment.
#include <cstddef>
#include <cstdint>

#include "tests/fuzz/machine_bytes.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto file = stiction::fuzz::valid_machine("synchronous");
  stiction::machine::ReadOptions options;
  std::string_view rest(reinterpret_cast<const char*>(data), size);
  bool first = true;
  while (!rest.empty()) {
    const std::size_t end = rest.find('\n');
    const std::string line(rest.substr(0, end));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (first)
      options.experiment = line;
    else
      options.set.push_back(line);
    first = false;
  }
  stiction::fuzz::read_and_run(file, options);
  return 0;
}
