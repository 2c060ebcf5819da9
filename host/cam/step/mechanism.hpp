// A radial step cam: two cams on one shaft turn a carousel with two rows of rollers (Dostrasil 2014, KINy2KV). The
// carousel's arm angle v of a roller is counted from the line between both axes; the rows are half a pitch apart. SI.
//
// The source's figure with the sense of rotation is lost, and so is how it counts rollers; docs/step_cams.md says what
// was chosen and why.
#pragma once

#include "host/cam/step/angle.hpp"

namespace stiction::host::step {

struct StepMechanism {
  double axis_distance = 0.0;   // m, between cam shaft and carousel
  double arm = 0.0;             // m, from the carousel's axis to the roller's
  double roller_radius = 0.0;   // m
  double roller_width = 0.0;    // m
  int rollers = 0;              // a row
  double row_angle = 0.0;       // rad, from the second row to the first one
  double dwell_position = 0.0;  // rad, of a roller of the first row while the carousel rests
  bool against = true;          // the carousel turns against the cam
  double hub_radius = 0.0;      // m, of the cam shaft's hub; 0: none

  // Between rollers of a row, rad.
  double pitch() const { return turn / rollers; }
  // The arm angle of the row's first roller at rest, rad. `row`: 0 or 1.
  double base(int row) const { return row == 0 ? dwell_position : dwell_position - row_angle; }
};

}  // namespace stiction::host::step
