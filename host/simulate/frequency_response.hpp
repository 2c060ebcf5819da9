// The experiment of a frequency response: axes shuttle at a constant speed that never comes near zero, so that friction
// acts nearly linearly, and a test signal is added to their set currents meanwhile. It leaves a log as a drive would
// record it (docs/formats.md), which host/response works on as on any other.
#pragma once

#include <cstdint>
#include <optional>

#include "firmware/machine/model/machine.hpp"
#include "host/log/log.hpp"

namespace stiction::host {

enum class TestSignal {
  multisine,     // all frequencies at once; a pass of the axis a realisation
  stepped_sine,  // one after the other
};

struct FrequencyResponsePlan {
  machine::Machine machine;  // its axes are excited, all at the same time: linear ones, or one rotary one alone
  TestSignal signal = TestSignal::multisine;
  std::optional<double> speed;      // m/s; none: usual_speed()
  std::optional<double> amplitude;  // A (V of a force motor), largest magnitude; none: 10 % of the axis' limit
  double lowest = 2.0;              // Hz, lowest frequency and distance of the lines of a multisine
  int periods = 2;                  // measured, after one to settle; of a sine: blocks of whole periods
  int passes = 8;                   // of a multisine, each with other phases
  std::uint64_t seed = 1;           // of the phases
};

// 2 m/min of linear axes; of a rotary one a third of its highest speed, or what its travel allows.
double usual_speed(const FrequencyResponsePlan& plan);

// The log in the units of its axes. Fixed-point signals: the firmware. Throws InfeasibleMotion when the motion does not
// fit the machine, when an axis comes too near to standstill or is held back at a limit while the test signal acts;
// FaultTripped.
Log run_frequency_response(const FrequencyResponsePlan& plan);

}  // namespace stiction::host
