// The open and closed loops of an axis and its plant alone, from the answers of its signals to one test signal that is
// added to the output of the velocity controller (i_inject in docs/formats.md). No loop is opened, and one
// experiment gives all of them: with O, I, V, X the answers of controller output, current, speed and position, and S =
// 1 + O that of the set current,
//
//   current loop    open  I/(S - I)                       closed  I/S
//   velocity loop   open  L_v = C V/S, C = -O/(K_v Z X + V)   closed  L_v/(1 + L_v)
//   position loop   open  L_p = K_v Z (X/V) L_v/(1 + L_v)     closed  L_p/(1 + L_p)
//   plant alone     V/I
//
// C is the velocity controller with its notch, as it answers to the speed error -(K_v Z X + V). The position controller
// has another rate: it samples every n-th tick and holds, Z = (1 + z^-1 + .. + z^-(n-1))/n. What its sampling folds to
// other frequencies is left out: of a line at 60 Hz it returns at 940 Hz, weakened by 1e-4. Its quantizer adds noise to
// O, which averages out over passes with other phases and lowers the coherence until then; an increment of zero turns
// it off.
//
// Loops are those of one controller with the inner ones closed and the outer ones open, as they are designed. But a
// controller's gain scales what the outer loops feed back through it as well: `broken` is the return ratio of the whole
// axis, cut behind that controller, and its gain margin is the factor of that gain at which the axis goes unstable:
//
//   current   (I - O)/(S - I)        velocity   -O/S        position   the same as open
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/response/margins.hpp"
#include "host/response/spectra.hpp"

namespace stiction::host {

struct LoopResponse {
  Curve open, closed, broken;
  std::vector<double> coherence;  // of the loop's own signal with the test signal, point by point

  std::optional<PhaseMargin> phase;
  std::optional<GainMargin> gain;    // of `open`
  std::optional<GainMargin> limit;   // of `broken`: the axis on the limit of stability
  std::optional<GainMargin> decays;  // of `broken`: a swing of the axis takes a third of a second for a factor of ten
  std::optional<double> bandwidth;   // Hz, of `closed`
};

struct AxisResponse {
  std::string axis;
  std::optional<LoopResponse> current;  // none of a force motor, or of a log without current
  LoopResponse velocity, position;
  Curve plant;  // m/s per A of the current, per V of a force motor; per A of the set current where there is no current
  std::vector<double> plant_coherence;
  bool set_current_computed = false;  // by the machine's controllers, as the log has none
  std::size_t samples_at_limit = 0;   // in which the limit of current (voltage of a force motor) holds back
  Spectra spectra;
};

// Points with less coherence than this take no part in margins.
inline constexpr double least_coherence = 0.9;

// `axis` gives K_v, the rates, and the controllers where the log has no set current. Throws ResponseError when the log
// lacks what is needed. `log`: with the test signal; `measured`: its channels of the axis; `timing`: periods of the
// loops.
AxisResponse axis_response(const Log& log, const AxisLog& measured, const machine::Timing& timing,
                           const machine::AxisModel& axis);

}  // namespace stiction::host
