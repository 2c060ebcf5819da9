// Why the log of a cycle says nothing of a vibration: a machine that was stopped in it or turned at a speed that is not
// the one given, an encoder that did not follow, an axis that still moved in the dwell.
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
// The same of a master that turned on at a speed more than 2 % off `master_speed`, the mean over the
// cycle in `samples`. `scale` and `unit` as above, of a speed: the sentence says them per second.
std::optional<std::string> other_speed(const CycleSamples& samples, double master_speed, double scale,
                                       const std::string& unit);
// The same of an encoder at its end, whose position stays while the set-points of `samples` go on. `range`: how far the
// slave goes; `scale` and `unit` as above.
std::optional<std::string> encoder_at_its_end(const CycleSamples& samples, double range, double scale,
                                              const std::string& unit);

// What a dwell is judged by.
struct DwellJudge {
  double frequency;   // of the load in rad/s, a guess within 35 %
  double resolution;  // of the load's encoder, in rad or m
  double range;       // how far the slave goes, in rad or m
  double scale;       // of the slave's place in the sentence,
  std::string unit;   // in this unit
};

// The same of a load's encoder that cuts off the vibration in `dwell`, the samples of the dwell alone: it stays at its
// largest or least place for more than a third of a period, while the load goes far to the other side. By `judge`.
std::optional<std::string> cut_off_in_dwell(const CycleSamples& dwell, const DwellJudge& judge);
// The same of an axis that still moves in `dwell`: what is no vibration goes on by more than 2 % of the slave's way. By
// `judge`.
std::optional<std::string> motion_in_dwell(const CycleSamples& dwell, const DwellJudge& judge);

}  // namespace stiction::host
