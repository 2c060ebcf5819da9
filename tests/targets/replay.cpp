// Runs the firmware's axes over a recording of their inputs and prints a hash of every trace signal. Needs nothing but
// the firmware's headers, so that it runs on every target. Status 1: the trace differs from the recorded one.
// usage: replay RECORDING
#include <array>

#include "stiction/drive/axis.hpp"
#include "stiction/drive/ticker.hpp"
#include "tests/targets/decimal.hpp"
#include "tests/targets/platform/platform.hpp"
#include "tests/targets/recording.hpp"
#include "tests/targets/trace_hash.hpp"

namespace {

using namespace stiction;
using namespace stiction::targets;

Opening opening;
std::array<TraceHash, axis_count> hashes;
std::array<CompensationBeside, axis_count> compensations;

int replay(const char* path) {
  Input input(path);
  if (!read_opening(input, opening)) {
    print("replay: no recording of this version\n");
    return 2;
  }
  std::array<Axis<FixedSignals>, axis_count> axes{Axis<FixedSignals>(opening.configs[0]),
                                                  Axis<FixedSignals>(opening.configs[1])};
  Ticker ticker(opening.header.period_ns, static_cast<std::uint32_t>(opening.header.slow_ratio));
  bool equal = true;
  for (std::int64_t i = 0; i < opening.header.ticks; ++i, ticker.advance())
    for (std::size_t k = 0; k < axis_count; ++k) {
      Sample sample;
      if (!read_record(input, sample)) {
        print("replay: the recording is shorter than it says\n");
        return 2;
      }
      if (i == 0) {
        axes[k].start(sample.feedback);
        compensations[k].start(sample.feedback);
      }
      AxisSignals<FixedSignals> signals;
      axes[k].tick(sample.set, sample.feedback, ticker.now_ns(), ticker.slow(), signals);
      compensations[k].tick(sample.set, signals);
      if (hashes[k].add(signals, axes[k], compensations[k]) == sample.digest || !equal) continue;
      equal = false;
      print("differs first at tick ");
      print_decimal(static_cast<std::uint32_t>(i));
      print(" of axis ");
      print_decimal(static_cast<std::uint32_t>(k));
      print("\n");
    }
  for (std::size_t k = 0; k < axis_count; ++k) hashes[k].report(k, print);
  return equal ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2) return replay(argv[1]);
  print("usage: replay RECORDING\n");
  return 2;
}
