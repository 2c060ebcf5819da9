#include "firmware/stictiond/modbus_cam.hpp"

#include <algorithm>
#include <cmath>

namespace stiction::drive {
namespace {

using What = MotionWrite::What;

constexpr int fine_bits = 64, way_bits = MotionPoint::position_bits, scale_bits = 32;

std::int64_t raw(double value, int bits) {
  constexpr double most = 0x1p60;
  return std::llround(std::clamp(std::ldexp(value, bits), -most, most));
}
double value(std::int64_t raw, int bits) { return std::ldexp(static_cast<double>(raw), -bits); }

MasterPosition place(double cycles) { return MasterPosition::way(raw(cycles, way_bits)); }
double cycles_of(const MasterPosition& place) { return value(place.raw(), way_bits); }

bool bit(double word, unsigned k) { return ((static_cast<unsigned>(word) >> k) & 1u) != 0; }

void take(const MotionWrite& write, double period, CamMode::Asked& asked) {
  switch (write.what) {
    case What::cam_table:
      asked.table = static_cast<std::uint16_t>(write.value);
      break;
    case What::cam_trigger:
      asked.trigger = static_cast<CamTrigger>(static_cast<std::uint8_t>(write.value));
      break;
    case What::cam_approach:
      asked.approach = static_cast<CamApproach>(static_cast<std::uint8_t>(write.value));
      break;
    case What::cam_options:
      asked.master_relative = bit(write.value, 0);
      asked.slave_relative = bit(write.value, 1);
      asked.backward = bit(write.value, 2);
      break;
    case What::cam_time:
      asked.ticks = std::max<std::int64_t>(1, std::llround(write.value / period));
      break;
    case What::cam_distance:
      asked.distance = std::max<std::int64_t>(1, raw(write.value, way_bits));
      break;
    case What::cam_at:
      asked.at = place(write.value);
      break;
    case What::cam_master_offset:
      asked.master_offset = place(write.value);
      break;
    case What::cam_slave_offset:
      asked.slave_offset = raw(write.value, way_bits);
      break;
    case What::cam_slave_scale:
      asked.slave_scale = raw(write.value, scale_bits);
      break;
    case What::gear_numerator:
      asked.numerator = static_cast<std::int32_t>(write.value);
      break;
    case What::gear_denominator:
      asked.denominator = static_cast<std::uint16_t>(write.value);
      break;
    case What::gear_way:
      asked.gear_way = raw(write.value, way_bits);
      break;
    case What::cam_tolerance:
      asked.tolerance.position = raw(write.value, way_bits);
      break;
    case What::cam_tolerance_speed:
      asked.tolerance.velocity = raw(write.value * period, MotionPoint::velocity_bits);
      break;
    case What::cam_tolerance_acceleration:
      asked.tolerance.acceleration = raw(write.value * period * period, MotionPoint::acceleration_bits);
      break;
    case What::cam_leave_speed:
      asked.leave_speed = raw(write.value * period, MotionPoint::velocity_bits);
      break;
    case What::cam_superposed:
      asked.superposed = raw(write.value, way_bits);
      break;
    case What::cam_leave_position:
      asked.leave_position = raw(write.value, way_bits);
      break;
    case What::cam_phase:
      asked.phase = raw(write.value, way_bits);
      break;
    default:
      break;
  }
}

}  // namespace

bool ask_cam(const MotionWrite& write, double period, RemoteAxis& axis) {
  if (write.what < What::cam_table) return false;
  RemoteCam& cam = axis.cam();
  if (!cam.attached()) return true;
  if (write.what == What::cam_tuning_command)
    cam.ask_tuning(static_cast<std::uint8_t>(write.value));
  else if (write.what == What::cam_command)
    axis.ask(static_cast<CamCommand>(static_cast<std::uint8_t>(write.value)));
  else if (write.what == What::master_speed)
    cam.master().run(raw(write.value * period, fine_bits - 8) * (1 << 8));
  else
    take(write, period, cam.mode().asked());
  return true;
}

void show_cam(const RemoteAxis& axis, double period, PublishedCam& shown) {
  const RemoteCam& cam = axis.cam();
  shown = {};
  if (!cam.attached()) return;
  const CamStatus& status = cam.mode().status();
  const CamStatus& second = cam.mode().second_status();
  const bool flags[]{status.busy,    status.active,          status.in_sync,
                     status.waiting, status.command_aborted, cam.master().reading().valid,
                     second.busy,    second.in_sync};
  for (unsigned k = 0; k < std::size(flags); ++k)
    shown.state = static_cast<std::uint16_t>(shown.state | (flags[k] ? 1u << k : 0u));
  shown.refusal = cam.mode().refusal();
  shown.followed = cam.mode().table();
  shown.second = cam.mode().second_table();
  shown.ends = cam.ends();
  const MasterPoint& master = cam.master().reading().point;
  shown.master_phase = std::ldexp(static_cast<double>(master.position.phase >> 11), -53);
  shown.master_cycles =
      static_cast<std::int32_t>(std::clamp<std::int64_t>(master.position.cycles, INT32_MIN, INT32_MAX));
  shown.master_speed = value(master.velocity, MotionPoint::velocity_bits) / period;
  const CamMode::Asked& asked = cam.mode().asked();
  shown.table = asked.table;
  shown.trigger = static_cast<std::uint16_t>(asked.trigger);
  shown.approach = static_cast<std::uint16_t>(asked.approach);
  shown.options = static_cast<std::uint16_t>((asked.master_relative ? 1 : 0) | (asked.slave_relative ? 2 : 0) |
                                             (asked.backward ? 4 : 0));
  shown.time = static_cast<double>(asked.ticks) * period;
  shown.distance = value(asked.distance, way_bits);
  shown.at = cycles_of(asked.at);
  shown.master_offset = cycles_of(asked.master_offset);
  shown.slave_offset = value(asked.slave_offset, way_bits);
  shown.slave_scale = value(asked.slave_scale, scale_bits);
  shown.numerator = asked.numerator;
  shown.denominator = asked.denominator;
  shown.gear_way = value(asked.gear_way, way_bits);
  shown.phase = value(asked.phase, way_bits);
  shown.tolerance = value(asked.tolerance.position, way_bits);
  shown.tolerance_speed = value(asked.tolerance.velocity, MotionPoint::velocity_bits) / period;
  shown.tolerance_acceleration = value(asked.tolerance.acceleration, MotionPoint::acceleration_bits) / period / period;
  shown.leave_speed = value(asked.leave_speed, MotionPoint::velocity_bits) / period;
  shown.superposed = value(asked.superposed, way_bits);
  shown.leave_position = value(asked.leave_position, way_bits);
}

}  // namespace stiction::drive
