// All of the firmware: include this one, or the headers of the parts that a drive uses. What they need of the world is
// a C++20 compiler: no library, no heap, no exceptions, no operating system, and no floating point outside of design/.
#pragma once

#include "stiction/design/axis_design.hpp"             // a drive's configuration from SI units
#include "stiction/design/compensation_design.hpp"     // that of its friction compensation
#include "stiction/drive/axis.hpp"                     // the cascade: Axis<FixedSignals>
#include "stiction/drive/faults.hpp"                   // its faults, one table
#include "stiction/drive/friction_compensation.hpp"    // between set-points and axis
#include "stiction/drive/master_encoder.hpp"           // a master that is an encoder on a bus
#include "stiction/drive/remote_axis.hpp"              // set-points from a bus: csp and pp of CiA 402
#include "stiction/drive/servo_drive.hpp"              // states, supervision, homing, stops around the cascade
#include "stiction/drive/ticker.hpp"                   // fast and slow ticks
#include "stiction/motion/cam_motion.hpp"              // an axis that follows a master along cams and gears
#include "stiction/motion/cam_switch.hpp"              // outputs that switch at angles of a master
#include "stiction/motion/cam_table.hpp"               // an electronic cam as polynomials
#include "stiction/motion/cam_tuning.hpp"              // residual vibration in a dwell, and pulses against it
#include "stiction/motion/cam_words.hpp"               // why a table or a request was refused
#include "stiction/motion/endless_phase.hpp"           // whole turns and the exact rest of an endless axis
#include "stiction/motion/master.hpp"                  // a virtual master
#include "stiction/motion/master_estimator.hpp"        // speed and acceleration of a measured one
#include "stiction/motion/position_profile.hpp"        // moves with limited jerk
#include "stiction/motion/set_point_interpolator.hpp"  // from targets each cycle to a set-point each tick
#include "stiction/number/crc.hpp"                     // checksums of parameter blocks
#include "stiction/number/fixed_signals.hpp"           // the formats
