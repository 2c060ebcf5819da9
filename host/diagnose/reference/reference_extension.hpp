// The extension of a machine by what its measured rows can tell: the sliding law of its rows of steady friction, the
// contact with the shape of its rows of presliding, one scale of each an axis from one circle. SI units.
#pragma once

#include <vector>

#include "firmware/machine/model/effect.hpp"
#include "firmware/machine/model/machine.hpp"
#include "host/diagnose/reference/reference_circles.hpp"
#include "host/diagnose/reference/sliding_law.hpp"
#include "sim/experiment/circle_result.hpp"

namespace stiction::host {

// What a reading of the rows can be off: Tab 6.4 prints currents to 0.1 A and measured errors to 0.5 um, and the error
// that the position controller sees has steps of 1 um. Standard deviations of even distributions of these widths.
inline constexpr double current_reading = 0.029, error_reading = 0.32e-6;  // A, m

inline constexpr double friction_drift = 0.03;  // of friction from day to day (2 to 4 % measured)

struct AxisExtension {
  std::string axis;
  bool own_rows = false;      // of steady friction; else the law is another axis', scaled
  std::string law_from;       // the axis whose rows the law comes from
  double force = 1.0;         // scale of that law
  double force_error = 0.0;   // standard error
  bool contact = false;       // whether the file's contact cannot give the training row's error
  double displacement = 1.0;  // scale of the presliding rows' displacements
  double displacement_error = 0.0;
  double error_with_file_contact = 0.0;  // m, at the training feed
  double stiffness_per_force = 0.0;      // 1/m, unscaled: initial stiffness over Coulomb friction
  double distance = 0.0;                 // m, unscaled: to 90 % of it
};

struct ReferenceExtension {
  double training_feed = 0.0;  // m/s
  SlidingFit sliding;
  std::vector<AxisExtension> axes;  // in the machine's order
};

// The circle of a measured row, with its lap: `machine`, of two axes; `feed`, m/s.
sim::CircleRun reference_circle(const machine::Machine& machine, double feed);

// The friction law that an axis of the file has, without Stribeck's fall. Throws MissingRows for a model without one.
SlidingLaw file_law(const machine::AxisModel& axis);

// `machine`: with the measured rows; `training_feed`: m/s, of the circle that gives the scales; `circles`: of this
// machine, which keeps those that were driven. Throws MissingRows where rows are missing or no scale gives the training
// row.
ReferenceExtension extend_by_rows(const machine::Machine& machine, double training_feed, ReferenceCircles& circles);

// The effects of an axis of the extension, in the order coulomb, viscous, rise, contact; only those that are named.
// `machine`: of the file.
std::vector<machine::Effect> effects_of(const machine::Machine& machine, const ReferenceExtension& extension,
                                        std::size_t axis);

machine::Machine extended_by(machine::Machine machine, const ReferenceExtension& extension);

// The measured row of an axis at a feed (m/s); nullptr without one. `machine`: of the file.
const machine::CircleReference* measured_row(const machine::Machine& machine, const std::string& axis, double feed);

}  // namespace stiction::host
