// The registers of the modes of cam and gear, in a range of their own of each axis: 40 to 67.
#pragma once

#include "firmware/stictiond/modbus_rows.hpp"

namespace stiction::drive::cam_registers {

using hal::Register;
using enum hal::RegisterType;
using Axis = PublishedAxis;
using What = MotionWrite::What;

inline void above_zero(const machine::AxisModel&, Register& r) { up_to(1e3, r); }
inline void to_hour(const machine::AxisModel&, Register& r) { up_to(3600.0, r); }
inline void to_options(const machine::AxisModel&, Register& r) {
  r.low = 0.0;
  r.high = 7.0;
}
inline void from_one(const machine::AxisModel&, Register& r) {
  r.low = 1.0;
  r.high = 65535.0;
}

inline constexpr std::array<StateRow<Axis>, 7> state_rows{{
    {40, uint16, 1, "cam_state", "1",
     "modes cam and gear; bit 0: busy, 1: active, 2: in sync, 3: a request waits, 4: the last command was aborted, 5: "
     "the master is known",
     [](const Axis& a) -> double { return a.cam.state; }},
    {41, uint16, 1, "cam_refusal", "1",
     "why the last cam command was refused; 0: it was not, 1: numbers beyond the formats, 2: a table that jumps, 3: "
     "more "
     "than the axis' limits, 4: no way to the curve within them, 5: a start by distance from an axis that moves, 6: a "
     "master outside of the profile, 7: a speed, 8: no such table, 9: the axis is not enabled in this mode, 10: beyond "
     "the travel",
     [](const Axis& a) { return static_cast<double>(a.cam.refusal); }},
    {42, uint16, 1, "cam_followed", "1", "table that is followed; 0: none, or a gear",
     [](const Axis& a) -> double { return a.cam.followed; }},
    {44, uint32, 1, "cam_ends", "1", "ends of the profile that were passed",
     [](const Axis& a) -> double { return a.cam.ends; }},
    {46, uint32, 1e-6, "master_phase", "1", "place of the master in its cycle, 0 to 1",
     [](const Axis& a) { return a.cam.master_phase; }},
    {48, int32, 1, "master_cycles", "1", "whole cycles of the master",
     [](const Axis& a) -> double { return a.cam.master_cycles; }},
    {50, int32, 1e-6, "master_velocity", "1/s", "speed of the master in cycles",
     [](const Axis& a) { return a.cam.master_speed; }},
}};

// In the order of MotionWrite::What.
inline constexpr std::array<MotionRow, 16> motion_rows{{
    {41,
     uint16,
     1,
     "cam_table",
     "1",
     "table of the next engage, by its number in the order of --cam, from 1",
     What::cam_table,
     [](const Axis& a) -> double { return a.cam.table; },
     {}},
    {42,
     uint16,
     1,
     "cam_trigger",
     "1",
     "when an engage acts; 0: at once, 1: where the master passes cam_at, 2: where it does in its cycle, 3: where the "
     "cycle begins",
     What::cam_trigger,
     [](const Axis& a) -> double { return a.cam.trigger; },
     {0, 1, 2, 3}},
    {43,
     uint16,
     1,
     "cam_approach",
     "1",
     "how the axis comes to the curve; 0: in the shortest time that its limits allow, 1: in cam_time, 2: in "
     "cam_distance of the master, from standstill",
     What::cam_approach,
     [](const Axis& a) -> double { return a.cam.approach; },
     {0, 1, 2}},
    {44,
     uint16,
     1,
     "cam_options",
     "1",
     "bit 0: the cycle begins where the master is; bit 1: the curve begins where the axis is; bit 2: the distance is "
     "covered backward",
     What::cam_options,
     [](const Axis& a) -> double { return a.cam.options; },
     {},
     to_options},
    {46,
     uint32,
     1e-6,
     "cam_time",
     "s",
     "of approach 1",
     What::cam_time,
     [](const Axis& a) { return a.cam.time; },
     {},
     to_hour},
    {48,
     uint32,
     1e-6,
     "cam_distance",
     "1",
     "of approach 2, cycles",
     What::cam_distance,
     [](const Axis& a) { return a.cam.distance; },
     {},
     above_zero},
    {50,
     int32,
     1e-6,
     "cam_at",
     "1",
     "place of trigger 1 and 2, cycles",
     What::cam_at,
     [](const Axis& a) { return a.cam.at; },
     {}},
    {52,
     int32,
     1e-6,
     "cam_master_offset",
     "1",
     "added to the master behind the ratio, cycles",
     What::cam_master_offset,
     [](const Axis& a) { return a.cam.master_offset; },
     {}},
    {54,
     int32,
     position_scale,
     "cam_slave_offset",
     "m",
     "added to the position",
     What::cam_slave_offset,
     [](const Axis& a) { return a.cam.slave_offset; },
     {}},
    {56,
     int32,
     1e-6,
     "cam_slave_scale",
     "1",
     "factor of the positions of a table; initial value: 1",
     What::cam_slave_scale,
     [](const Axis& a) { return a.cam.slave_scale; },
     {}},
    {58,
     int32,
     1,
     "gear_numerator",
     "1",
     "of the ratio, of a cam as well; initial value: 1",
     What::gear_numerator,
     [](const Axis& a) -> double { return a.cam.numerator; },
     {}},
    {60,
     uint16,
     1,
     "gear_denominator",
     "1",
     "of the ratio; initial value: 1",
     What::gear_denominator,
     [](const Axis& a) -> double { return a.cam.denominator; },
     {},
     from_one},
    {62,
     int32,
     position_scale,
     "gear_way",
     "m",
     "mode gear: displacement of the axis in a cycle behind the ratio",
     What::gear_way,
     [](const Axis& a) { return a.cam.gear_way; },
     {}},
    {64,
     int32,
     1e-6,
     "cam_phase",
     "1",
     "phase of the master as the axis sees it, cycles; acts with command 4",
     What::cam_phase,
     [](const Axis& a) { return a.cam.phase; },
     {}},
    {66,
     int32,
     1e-6,
     "master_speed",
     "1/s",
     "cycles a second to which a virtual master goes, of all axes; held to --speed",
     What::master_speed,
     [](const Axis& a) { return a.cam.master_speed; },
     {}},
    {40,
     uint16,
     1,
     "cam_command",
     "1",
     "1: engage, 2: leave to standstill, 3: delete what waits, 4: phase; each write acts once, the newest of a "
     "millisecond counts",
     What::cam_command,
     [](const Axis&) { return 0.0; },
     {0, 1, 2, 3, 4}},
}};

}  // namespace stiction::drive::cam_registers
