#include "tests/targets/cam_laws.hpp"

#include "tests/targets/cam_table_bytes.hpp"

// Names without decoration, so that a profiler's options can name them.
#define STICTION_LAW(name)                                                                 \
  static void name##_of(stiction::targets::CamContext& c);                                 \
  extern "C" [[gnu::noinline]] void name(void* data);                                      \
  void name(void* data) { name##_of(*static_cast<stiction::targets::CamContext*>(data)); } \
  [[gnu::always_inline]] static inline void name##_of(stiction::targets::CamContext& c)

STICTION_LAW(law_cam_nothing) { static_cast<void>(c); }

STICTION_LAW(law_cam_master) { c.at = c.master.step(); }

STICTION_LAW(law_cam_estimator) {
  // An encoder of 2^16 counts.
  c.estimator.step({c.at.position.cycles, c.at.position.phase >> 48 << 48});
  c.estimated = c.estimator.point();
}

STICTION_LAW(law_cam_evaluate) { c.found = c.table.evaluate(c.at.position.coarse()); }

STICTION_LAW(law_cam_motion) { c.point = c.motion.step(c.at); }

STICTION_LAW(law_cam_switch) { c.outputs = stiction::CamSwitch::step(c.tracks, c.switches, c.at, {}); }

STICTION_LAW(law_cam_tuning) { stiction::CamTuning::step(c.tuning_config, c.tuning, c.tuned); }

namespace stiction::targets {
namespace {

constexpr double rate = 16000.0;
constexpr MotionLimits limits(double v, double a, double j) {
  return {static_cast<std::int64_t>(v / rate * 0x1p52), static_cast<std::int64_t>(a / rate / rate * 0x1p64),
          static_cast<std::int64_t>(j / rate / rate / rate * 0x1p76)};
}
constexpr MotionLimits axis_limits = limits(60.0, 1000.0, 60000.0), shaft_limits = limits(3.0, 20.0, 400.0),
                       phasing_limits = limits(0.5, 5.0, 100.0);

}  // namespace

CamContext::CamContext()
    : config(CamMotion::Config::of(axis_limits, shaft_limits, phasing_limits, 1024)),
      master(VirtualMaster::Config::of(shaft_limits)),
      estimator({.bits = 7, .half_count = std::int64_t{1} << 47, .jump = std::int64_t{1} << 56, .look_ahead = 3 << 15}),
      motion(config) {
  static_cast<void>(CamTable::read(cam_bytes.bytes, table));
  static_cast<void>(CamCurve::prepare({.table = &table}, cam));
  static_cast<void>(CamCurve::prepare(
      {.table = &table, .slave_scale = std::int64_t{3} << 30, .slave_offset = std::int64_t{1} << 37}, scaled));
  static_cast<void>(CamCurve::prepare({.ratio = GearRatio(355, 113), .rise = std::int64_t{1} << 40}, gear));
  for (std::uint32_t k = 0; k < tracks.size(); ++k)
    tracks[k] = {.first = 0x15000000u * k,
                 .last = 0x15000000u * k + 0x30000000u,
                 .duration = 100 << 16,
                 .on_compensation = -static_cast<std::int32_t>(k) * (20 << 16),
                 .off_compensation = static_cast<std::int32_t>(k) * (5 << 16),
                 .hysteresis = 0x10000u,
                 .direction = static_cast<CamSwitch::Direction>(k % 3),
                 .kind = static_cast<CamSwitch::Kind>(k / 6)};
  // A rise over the first half of the cycle, the mode of the load above, and pulses of no particular place.
  tuning_config = {.rise_begin = 0,
                   .rise_length = 0x80000000u,
                   .settling = 0x08000000u,
                   .window_end = 0x7f000000u,
                   .ticks_a_phase = 1049,
                   .turn_re = 1073641064,
                   .turn_im = 6108976,
                   .shift = 16,
                   .every = 4,
                   .least_ticks = 1104,
                   .speed = std::int64_t{281474976710},
                   .speed_tolerance = std::int64_t{1} << 50,
                   .noise = 256,
                   .pulses = {20000000, -3000000, 5000000, 15000000}};
  master.start({});
  estimator.start({});
  motion.start(0);
}

constexpr std::array<CamLaw, 7> all{{{"law_cam_nothing", law_cam_nothing},
                                     {"law_cam_master", law_cam_master},
                                     {"law_cam_estimator", law_cam_estimator},
                                     {"law_cam_evaluate", law_cam_evaluate},
                                     {"law_cam_motion", law_cam_motion},
                                     {"law_cam_switch", law_cam_switch},
                                     {"law_cam_tuning", law_cam_tuning}}};
const std::array<CamLaw, 7> cam_laws = all;

}  // namespace stiction::targets
