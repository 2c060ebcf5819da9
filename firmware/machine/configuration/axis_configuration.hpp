// From the machine file's SI values to the drive's configuration: discretisation of the laws and conversion to the
// formats of the signal policy.
#pragma once

#include <stdexcept>
#include <string>

#include "firmware/machine/model/machine.hpp"
#include "stiction/drive/axis.hpp"

namespace stiction::machine {

// A parameter that the signal formats cannot hold. what() names the machine file's key, the value and the range.
class ConfigurationError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// S: FixedSignals or DoubleSignals. Throws ConfigurationError.
template <class S>
AxisConfig<S> configure_axis(const Timing& timing, const AxisModel& axis);

// Whole fast periods in a slow one.
int slow_ratio(const Timing& timing);
// The fast period in whole nanoseconds.
std::int64_t fast_period_ns(const Timing& timing);

}  // namespace stiction::machine
