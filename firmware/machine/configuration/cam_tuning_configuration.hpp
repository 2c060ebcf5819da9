// From the frequency and the damping of a load, which the desk has identified, to the configuration of the drive's
// tuner (cam_tuning.hpp): which rise of a table it records behind, where its two pulses are, and which amplitudes
// cancel a vibration.
//
// A set-point u(t) leaves behind itself, where it has come to rest at t = 0, a vibration Re(r e^(p t)) of the load with
//   r = 2 K * integral of u'(t) e^(-p t) dt,
// K the residue of the drive's transfer function at the load's pole p, over p. The integral depends on the pole alone;
// everything else of drive and encoder is the one number K. Both pulses are rises of half a period, a quarter of a
// period apart, the second one up to the end of the rise, as those of the desk (docs/residual_vibration.md).
#pragma once

#include <complex>
#include <cstdint>
#include <optional>
#include <stdexcept>

#include "firmware/machine/model/machine.hpp"
#include "stiction/motion/cam_table.hpp"
#include "stiction/motion/cam_tuning.hpp"

namespace stiction::machine {

// What a table or an axis lacks to be tuned: what was found, and what was expected.
class CamTuningError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The motion of a table from the rest before to the longest rest that it has.
struct TunedRise {
  std::uint32_t begin = 0, length = 0;  // 2^-32 cycles
  std::uint32_t rest = 0;               // behind it, up to the next motion
  double start = 0.0, stroke = 0.0;     // in the unit of the table

  std::uint32_t end() const { return begin + length; }
};
// None where `table` never rests, or where it moves over its seam.
std::optional<TunedRise> tuned_rise(const CamTable& table);

// A position of a table and its first two derivatives over cycles.
struct TablePoint {
  double position = 0.0, slope = 0.0, bend = 0.0;
};
// Of `table` at `phase`, in 2^-32 cycles: of the segment that holds it, or with `before` of the one that ends there.
TablePoint table_point(const CamTable& table, std::uint64_t phase, bool before = false);

// The load's mode as the desk has identified it.
struct LoadMode {
  double frequency = 0.0;  // Hz, of the undamped vibration
  double damping = 0.0;    // ratio
  double delay = 0.0;      // s, of the encoder at the load, and of the drive beyond its model

  std::complex<double> pole() const;  // rad/s
  double period() const;              // s
};

struct PulsePlaces {
  std::uint32_t first = 0, second = 0, length = 0;  // 2^-32 cycles
};

class CamTuningDesign {
 public:
  struct Given {
    const CamTable* table = nullptr;  // must stay as long as this is made
    const AxisModel* axis = nullptr;  // the same; null: a drive that follows its set-points
    LoadMode mode{};
    double speed = 0.0;      // of the master, cycles/s
    double period = 0.0;     // of the tick, s
    double increment = 0.0;  // of the load's encoder, in the unit of the table
    // Of the pulses; none: half a period long, where they cancel with the least amplitudes.
    std::optional<PulsePlaces> places{};
  };

  // Throws CamTuningError where the table has no rest, the rise has no room for two pulses, or the rest is shorter than
  // a period behind the drive's lag.
  explicit CamTuningDesign(const Given& given);

  // Of the tuner, with the map of a vibration to the change of both pulses for a drive whose K is that of the model
  // over `factor`.
  CamTuning::Config config(std::complex<double> factor = 1.0) const;
  // The vibration, as the encoder shows it, that pulses of those amplitudes add behind the rise.
  std::complex<double> vibration(double first, double second) const { return first * unit_[0] + second * unit_[1]; }
  // That of the rise by itself.
  std::complex<double> own() const { return own_; }

  const TunedRise& rise() const { return rise_; }
  const PulsePlaces& places() const { return places_; }
  const LoadMode& mode() const { return mode_; }

 private:
  TunedRise rise_{};
  PulsePlaces places_{};
  LoadMode mode_{};
  std::complex<double> own_, unit_[2];
  double speed_, tick_, increment_, lag_ = 0.0;
};

// K: what a base that moves by u(t) leaves at the pole of `mode`, and where `axis` is an elastic one with the
// firmware's cascade, with that drive before it. `lag`: the longest time constant of that drive, s.
std::complex<double> drive_residue(const AxisModel* axis, const LoadMode& mode, double& lag);

}  // namespace stiction::machine
