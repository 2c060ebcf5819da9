#include "host/batch/batch_recording.hpp"

#include <array>

namespace stiction::host {
namespace {

constexpr std::array kept_signals{BatchSignal{"x", "m", Row::x},           BatchSignal{"v", "m/s", Row::v},
                                  BatchSignal{"i", "A", Row::i},           BatchSignal{"i_set", "A", Row::i_set},
                                  BatchSignal{"e", "m", Row::e},           BatchSignal{"e_held", "m", Row::e_held},
                                  BatchSignal{"F", "N", Row::motor_force}, BatchSignal{"position", "m", Row::position}};
constexpr std::size_t ticks_between_reports = 4096;

}  // namespace

std::span<const BatchSignal> batch_signals() { return kept_signals; }

std::size_t kept_ticks(std::size_t ticks, std::size_t every) { return (ticks + every - 1) / every; }

void record_batch(BatchRun& run, const BatchSetPoints& set, std::size_t every, std::span<const BatchColumn> columns,
                  const std::function<void(std::size_t)>& progress) {
  const std::size_t members = run.size(), wide = set.shared ? 1 : members;
  const std::size_t ticks = set.position.size() / wide;
  std::vector<sim::AxisSetPoint> points(wide);
  std::size_t until_kept = 1, kept = 0;
  for (std::size_t k = 0; k < ticks; ++k) {
    for (std::size_t m = 0; m < wide; ++m) {
      const std::size_t at = k * wide + m;
      points[m] = {set.position[at], set.velocity[at], set.acceleration[at], 0.0};
    }
    run.tick(points);
    if (--until_kept == 0) {
      for (const auto& column : columns) run.values(column.row, {column.values + kept * members, members});
      ++kept;
      until_kept = every;
    }
    if (progress && (k + 1) % ticks_between_reports == 0) progress(k + 1);
  }
}

}  // namespace stiction::host
