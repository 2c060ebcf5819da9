// What clients ask of an axis in the modes of cam and gear, at the border to the drive's number formats, and what they
// are shown of it.
#pragma once

#include "firmware/stictiond/modbus_registers.hpp"
#include "stiction/drive/remote_axis.hpp"

namespace stiction::drive {

// Takes `write` where it is of a cam; false: it is not. `period`: of the fast tick, s; `axis`: takes it, where it has a
// master.
bool ask_cam(const MotionWrite& write, double period, RemoteAxis& axis);
// The state of `axis`, written to `shown`. `period`: as above.
void show_cam(const RemoteAxis& axis, double period, PublishedCam& shown);

}  // namespace stiction::drive
