// What a client of Modbus or of a node's objects asks of an axis, at the border to the drive's number formats, and what
// it is shown of it.
#pragma once

#include "firmware/stictiond/modbus_registers.hpp"
#include "stiction/drive/remote_axis.hpp"

namespace stiction::drive {

// `period`: of the fast tick, s. The registers have kept values to what the axis can. `write`: the commands of one
// request; `axis`: takes them; `source`: the bus that they came over.
void ask(const MotionWrite& write, double period, RemoteAxis& axis, CommandSource source = CommandSource::modbus);
// The state of `axis` as clients read it, written to `shown`. `period`: as above.
void show_asked(const RemoteAxis& axis, double period, PublishedAxis& shown);

}  // namespace stiction::drive
