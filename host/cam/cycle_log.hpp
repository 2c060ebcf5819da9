// Why the log of a cycle says nothing of a vibration: a machine that was stopped in it, or an encoder that did not
// follow.
#pragma once

#include <optional>
#include <span>
#include <string>

namespace stiction::host {

// One cycle, sample by sample. Angles in rad, ways in m.
struct CycleSamples {
  std::span<const double> time;    // s, rising
  std::span<const double> master;  // as many
  std::span<const double> load;    // of the load's encoder, as many
  std::span<const double> set;     // set-points of the slave, as many or none
};

// Whether the master stopped in a cycle: "found ..; expected ..", without the source; none: it turned on. `samples`: of
// the cycle; `master_speed`: as it should be, in rad/s or m/s; `scale`: of the master's place in the sentence, in
// `unit`.
std::optional<std::string> stop_in_cycle(const CycleSamples& samples, double master_speed, double scale,
                                         const std::string& unit);
// The same of an encoder at its end, whose position stays while the set-points of `samples` go on. `range`: how far the
// slave goes; `scale` and `unit` as above.
std::optional<std::string> encoder_at_its_end(const CycleSamples& samples, double range, double scale,
                                              const std::string& unit);

}  // namespace stiction::host
