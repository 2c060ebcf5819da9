// Stability margins and bandwidth read off a measured frequency response.
#pragma once

#include <complex>
#include <optional>
#include <span>
#include <vector>

namespace stiction::host {

// A complex function of frequency, point by point; the frequencies (Hz) rise. Between points more than an octave apart
// nothing is read off.
struct Curve {
  std::vector<double> frequency;
  std::vector<std::complex<double>> value;

  void add(double f, std::complex<double> z) {
    frequency.push_back(f);
    value.push_back(z);
  }
};

struct GainMargin {
  double frequency = 0.0;  // Hz, where the phase is -180 deg
  double factor = 0.0;     // of the gain, at which the loop is on the limit of stability
};

struct PhaseMargin {
  double frequency = 0.0;  // Hz, where the magnitude is 1
  double degrees = 0.0;
};

// Of an open loop whose closed one is stable: the smallest factor above 1 of the gain with which the curve meets -1;
// none where the phase never crosses -180 deg with a magnitude below 1.
std::optional<GainMargin> gain_margin(const Curve& open);

// Of such a loop: at the crossing of magnitude 1 that is nearest to -180 deg, on either side of it; none where there is
// no crossing. An elastic shaft makes several.
std::optional<PhaseMargin> phase_margin(const Curve& open);

// Where the magnitude of a closed loop first falls below -3 dB.
std::optional<double> bandwidth(const Curve& closed);

// The open loop along s = -decay + j w instead of s = j w (decay in 1/s), so that its gain margin is the gain at which
// a swing of the closed loop decays with e^(-decay t) only: on the limit "does not decay" of a test of finite length.
// From the slopes of the measured curve: ln L(w + j decay) = ln L(w) + j decay d(ln L)/dw, to first order in decay.
Curve with_decay(const Curve& open, double decay);

}  // namespace stiction::host
