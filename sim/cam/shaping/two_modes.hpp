// Two vibrations in the record of one dwell: where a damped sine leaves more than the encoder does, a second one is
// looked for in what is left, and both are fitted together. Of two that are nearer than the reciprocal of the record no
// fit tells which is which.
#pragma once

#include <array>
#include <complex>
#include <optional>
#include <vector>

#include "sim/cam/shaping/dwell_fit.hpp"
#include "sim/cam/shaping/pulses.hpp"

namespace stiction::sim::cam {

struct TwoModeFit {
  std::array<DwellFit, 2> modes;  // with the offset and the scatter of both together
};

// Of a `record` that vibrates with a mode like `first`, and with one of a higher frequency by at least `least` from
// peak to peak at its beginning. `hold`: the first mode is known, and not fitted. None where there is no second one.
// Throws CamError for two that are too near to be told apart.
std::optional<TwoModeFit> fit_two_modes(const DwellRecord& record, const Mode& first, double least, bool hold);

struct TwoResiduals {
  std::array<std::complex<double>, 2> of{};  // as DwellFit::residual
  double offset = 0.0;
};
// Of a `record` that vibrates with both `modes`, which are known.
TwoResiduals residuals_with_modes(const DwellRecord& record, const std::array<Mode, 2>& modes);

// What a `lift` makes of a `mode` at the end of the rise of `task`, but for a factor that every lift has: the integral
// of the lift's speed times e^(-pole t). So the ratio of the residuals of two lifts is known of any linear machine,
// whatever its drive and its encoder's delay.
std::complex<double> lift_transform(const ShapingTask& task, const Curve& lift, const Mode& mode);

// Where four pulses are: two in periods of either mode.
using FourPlaces = std::array<PulsePlaces, 2>;
using FourPulses = std::array<PulsePair, 2>;
// All places for the rise of `task` that it has room for, such that those come first whose pulses make the least
// acceleration of what cancels `residuals`, in units of lift_transform(), of both `modes`.
std::vector<FourPlaces> four_places(const ShapingTask& task, const std::array<Mode, 2>& modes,
                                    const std::array<std::complex<double>, 2>& residuals);
// The four pulses at `places` of `task` that cancel `residuals` of both `modes`, as above: one linear equation.
FourPulses four_pulses(const ShapingTask& task, const std::array<Mode, 2>& modes,
                       const std::array<std::complex<double>, 2>& residuals, const FourPlaces& places);
// The same of pulses where `pulses` are, for `residuals` of both `modes` of a `task`.
FourPulses four_pulses_at(const ShapingTask& task, const std::array<Mode, 2>& modes,
                          const std::array<std::complex<double>, 2>& residuals, FourPulses pulses);

}  // namespace stiction::sim::cam
