// What the benchmarks run: one axis in closed loop, LuGre friction, DC motor, a plant step of 15.6 us, the X axis of a
// circle at 16 m/min.
#pragma once

namespace stiction::benchmark {

// Runs `seconds` of logical time; returns the last position (m), so that nothing can be left out.
double run_axis_fixed(double seconds);
double run_axis_double(double seconds);

}  // namespace stiction::benchmark
