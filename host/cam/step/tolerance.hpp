// What the tolerances of the parts do to the carousel's play and to the Hertz pressure, as intervals, and which of them
// matters.
//
// A deviation moves a roller by d against its cam: the gap changes by -d n, and by at most d_t^2 kappa / 2 besides, d_t
// along the profile and kappa the curvature of the pitch path. Both are enclosed, so the interval of the play holds
// every combination; that of the pressure is taken at the lowest and the highest of all 32 corners of the box of
// tolerances, between which the forces of springs in contact are monotonous, with the same enclosure of the gaps.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "host/cam/step/forces.hpp"
#include "host/cam/step/project.hpp"

namespace stiction::host::step {

struct Deviation {
  double axis_distance = 0.0, roller = 0.0, arm = 0.0, profile = 0.0, preload = 0.0;  // m
};

struct Range {
  double low = 0.0, high = 0.0;
  double width() const { return high - low; }
};

inline constexpr std::array<std::string_view, 5> tolerance_names{"axis distance", "roller radius", "arm", "profile",
                                                                 "preload"};

// By how much the gap of `contact` at the cam's angle `psi`, rad, changes with the deviation `by`, to the first order,
// m.
double gap_change(const Contact& contact, double psi, const Deviation& by);

// The play of the carousel between its two needed contacts of `set` along the rollers' circle within the `tolerances`,
// m; below 0: they are pressed. `nearer`: the preload, m; `roller_radius` in m. Not a number where one of them is
// missing.
Range play_at(const ContactSet& set, const StepTolerances& tolerances, double nearer, double roller_radius);

struct ToleranceResult {
  Range play;                              // m, over the turn: the least and the largest possible
  Range play_width;                        // m, of the intervals over the turn
  double widest_psi = 0.0;                 // rad, where the play's interval is the widest
  std::array<double, 5> play_share{};      // m, half width there by tolerance_names
  Range pressure;                          // Pa, of the peak over the turn
  std::array<double, 5> pressure_share{};  // Pa, half of what each tolerance alone changes the peak by
};

// Of the drive of `mechanism`, `lift` and `load` with the contacts `sets` over a turn, within the `tolerances`.
ToleranceResult tolerance_of(const StepMechanism& mechanism, const StepLift& lift, const StepLoad& load,
                             const std::vector<ContactSet>& sets, const StepTolerances& tolerances);

// The peak of the Hertz pressure of that drive over the turn with the deviations `by`, Pa. `mechanism`, `lift`, `load`
// and `sets` as above; `more`: m, added to the gap of each contact in their order, or empty.
double peak_pressure(const StepMechanism& mechanism, const StepLift& lift, const StepLoad& load,
                     const std::vector<ContactSet>& sets, const Deviation& by, const std::vector<double>& more = {});

}  // namespace stiction::host::step
