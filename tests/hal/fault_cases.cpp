#include "tests/hal/fault_cases.hpp"

#include <fmt/format.h>

#include <cmath>

namespace stiction::test {
namespace {

using hal::FrameFault;
using hal::SwitchFault;

// Limits of the cross table's two axes by the machine file.
constexpr std::array<double, 2> current_limit{70.0, 140.0};  // A

// A jammed carriage: 100 kN s/m against its motion.
void jam(Bench& b, std::size_t axis, int) {
  auto& plant = b.simulated.plant(axis);
  plant.set_external_force(-1e5 * plant.velocity());
}

// An amplitude of the sensors' currents beyond the limit, whose sum is zero.
void false_current(Bench& b, std::size_t axis, int) {
  const double i = 2.0 * current_limit[axis];
  b.backend.faults(axis).current_offset = {i, -0.5 * i, -0.5 * i};
}

template <class Value>
auto set_fault(Value hal::AxisFaults::*member, Value value) {
  return [=](Bench& b, std::size_t axis, int) { b.backend.faults(axis).*member = value; };
}

FaultCase shifted_encoder(double shift) {
  return {.fault = Fault::encoder_jump,
          .name = fmt::format("jumps by {:g} mm", shift * 1e3),
          .inject = set_fault(&hal::AxisFaults::encoder_shift, shift)};
}

FaultCase flipped_bit(int bit) {
  return {.fault = Fault::encoder_jump,
          .name = fmt::format("bit {} of 1 nm flips", bit),
          .inject = set_fault(&hal::AxisFaults::flipped_bit, std::optional<int>(bit))};
}

FaultCase offset_of_phase(std::size_t phase, double share) {
  return {.fault = Fault::current_offset,
          .name = fmt::format("phase {} by {:g} % of the limit", "ABC"[phase], share * 100.0),
          .inject = [=](Bench& b, std::size_t axis,
                        int) { b.backend.faults(axis).current_offset[phase] = share * current_limit[axis]; },
          .shows_at_rest = true};
}

FaultCase disturbed_frames(FrameFault kind, const char* name) {
  return {.fault = Fault::frames_disturbed,
          .name = fmt::format("each fifth frame {}", name),
          .inject =
              [kind](Bench& b, std::size_t axis, int) {
                b.backend.faults(axis).frame = kind;
                b.backend.faults(axis).frame_period = 5;
              },
          .violated = [](Bench& b, std::size_t axis, const Shown&) { return b.backend.disturbed(axis) > 10; },
          .shows_at_rest = true};
}

// An end of the travel that the circle crosses, of X at -50 mm and of Y at 50 mm, and a switch 1 mm behind it.
void short_travel(machine::DriveAxisSetup& setup, std::size_t axis) {
  (axis == 0 ? setup.negative_end : setup.positive_end) = axis == 0 ? -0.05 : 0.05;
  (axis == 0 ? setup.line.limit_negative : setup.line.limit_positive) = 0;  // wired
}
constexpr double end_of_travel = 0.05, switch_at = 0.051;  // m
void place_switch(Bench& b, std::size_t axis, int) {
  auto& marks = b.backend.marks(axis);
  if (axis == 0) marks.limit_negative = -switch_at;
  if (axis == 1) marks.limit_positive = switch_at;
}
double outward(std::size_t axis, const Shown& shown) { return axis == 0 ? -shown.x : shown.x; }

FaultCase programme(Fault fault, const char* name) {
  return {.fault = fault,
          .name = name,
          .inject = [fault](Bench& b, std::size_t axis, int) { b.loop.trip(axis, fault); },
          .shows_after = 0,
          .shows_at_rest = true};
}

void home_without_mark(Bench& b, std::size_t, int) {
  b.mode = OperationMode::homing;
  b.extra_bits = controlword::homing_start_bit;
}

std::vector<FaultCase> cases_of_the_axis() {
  return {
      {.fault = Fault::following_error,
       .name = "jammed carriage",
       .inject = jam,
       .violated = [](Bench&, std::size_t, const Shown& s) { return std::abs(s.set - s.x) > 2e-3; },
       .recurs = true,
       .least_feed = 10.0 / 60.0},  // all of Y's force moves it by 7.9 m/min
      {.fault = Fault::over_current, .name = "sensors show it", .inject = false_current, .shows_at_rest = true},
      {.fault = Fault::over_speed,
       .name = "set-points beyond the limit",
       .inject = [](Bench&, std::size_t, int) {},
       .violated = [](Bench&, std::size_t, const Shown& s) { return std::abs(s.v) > 0.35; },
       .recurs = true,
       .at_one_place = true,
       .machine = "axis.{}.supervision.over_speed=0.35 m/s"},
      {.fault = Fault::position_lost,
       .name = "open encoder",
       .inject = set_fault(&hal::AxisFaults::encoder_open, true),
       .shows_at_rest = true},
      {.fault = Fault::drive_input,
       .name = "power stage's fault",
       .inject = set_fault(&hal::AxisFaults::power_stage, true),
       .shows_at_rest = true},
      {.fault = Fault::set_point,
       .name = "not a number",
       .inject = [](Bench& b, std::size_t axis, int) { b.invalid_set_point = axis; },
       .shows_after = 0,
       .shows_at_rest = true},
      {.fault = Fault::limit_cycle,
       .name = "power stage 0.75 ms late",
       .inject = set_fault(&hal::AxisFaults::late_commands, std::uint64_t{12}),
       .within = 4000,  // two windows of 125 ms
       .recurs = true},
  };
}

std::vector<FaultCase> cases_of_the_supervision() {
  std::vector<FaultCase> cases{
      {.fault = Fault::encoder_frozen,
       .name = "frozen encoder",
       .inject = set_fault(&hal::AxisFaults::encoder_frozen, true),
       .violated = [](Bench&, std::size_t, const Shown& s) { return std::abs(s.set_before - s.set_at_begin) > 100e-6; },
       .within = 1,
       .recurs = true},
      shifted_encoder(6e-6),
      shifted_encoder(-6e-6),
      shifted_encoder(1e-3),
      shifted_encoder(-0.1),
  };
  for (const int bit : {13, 20, 28}) cases.push_back(flipped_bit(bit));
  for (std::size_t phase = 0; phase < 3; ++phase) cases.push_back(offset_of_phase(phase, phase == 1 ? -0.06 : 0.06));
  cases.push_back({.fault = Fault::runaway,
                   .name = "motor turned by half a period",
                   .inject = set_fault(&hal::AxisFaults::motor_reversed, true),
                   .violated =
                       [](Bench&, std::size_t axis, const Shown& s) {
                         return std::abs(s.i) > current_limit[axis] / 5.0 && s.i * s.v < 0 && s.faster;
                       },
                   .recurs = true,
                   .holding = true});
  cases.push_back({.fault = Fault::limit_switch,
                   .name = "reached in motion",
                   .inject = place_switch,
                   .violated = [](Bench&, std::size_t axis, const Shown& s) { return outward(axis, s) >= switch_at; },
                   .at_one_place = true,
                   .back = sim::Direction::clockwise,
                   .setup = short_travel});
  cases.push_back({.fault = Fault::limit_switch_stuck,
                   .name = "both reached",
                   .inject =
                       [](Bench& b, std::size_t axis, int) {
                         b.backend.faults(axis).negative_switch = SwitchFault::stuck_closed;
                         b.backend.faults(axis).positive_switch = SwitchFault::stuck_closed;
                       },
                   .shows_at_rest = true});
  cases.push_back({.fault = Fault::limit_switch_stuck,
                   .name = "negative one, mid travel",
                   .inject = set_fault(&hal::AxisFaults::negative_switch, SwitchFault::stuck_closed),
                   .shows_at_rest = true});
  cases.push_back({.fault = Fault::limit_switch_stuck,
                   .name = "positive one, mid travel",
                   .inject = set_fault(&hal::AxisFaults::positive_switch, SwitchFault::stuck_closed),
                   .shows_at_rest = true});
  // A hundredth of the travel behind its end: 0.3 m of X, 0.25 m of Y.
  cases.push_back(
      {.fault = Fault::limit_switch_stuck,
       .name = "open behind the end",
       .inject =
           [](Bench& b, std::size_t axis, int since) {
             place_switch(b, axis, since);
             auto& faults = b.backend.faults(axis);
             (axis == 0 ? faults.negative_switch : faults.positive_switch) = SwitchFault::stuck_open;
           },
       .violated = [](Bench&, std::size_t axis,
                      const Shown& s) { return outward(axis, s) > end_of_travel + (axis == 0 ? 3e-3 : 2.5e-3); },
       .shows_at_rest = true,
       .at_one_place = true,
       .back = sim::Direction::clockwise,
       .setup = short_travel});
  cases.push_back({.fault = Fault::homing,
                   .name = "no index mark",
                   .inject = home_without_mark,
                   .violated = [](Bench&, std::size_t, const Shown& s) { return std::abs(s.x - s.x_at_begin) > 0.022; },
                   .within = 3,  // it begins a tick after it is asked for; what it found is seen in the next tick
                   .at_one_place = true,
                   .setup =
                       [](machine::DriveAxisSetup& setup, std::size_t) {
                         setup.homing.method = machine::HomingMethod::index_positive;
                         setup.homing.creep_speed = 0.05;
                         setup.negative_end = -0.01;  // 1.1 times the travel are 22 mm
                         setup.positive_end = 0.01;
                       }});
  return cases;
}

std::vector<FaultCase> cases_of_backend_and_programme() {
  const auto late_tick = [](Bench&, std::size_t, const Shown& s) { return s.gap_ns >= 125000; };
  const auto jump = [](std::int64_t ns) {
    return [ns](Bench& b, std::size_t, int since) {
      if (since == 0) b.backend.jump_clock(ns);
    };
  };
  const auto jumped = [](Bench&, std::size_t, const Shown& s) { return s.gap_ns <= 0 || s.gap_ns > 100'000'000; };
  return {
      {.fault = Fault::frames_lost,
       .name = "none comes",
       .inject = set_fault(&hal::AxisFaults::frame, FrameFault::lost),
       .shows_at_rest = true},
      disturbed_frames(FrameFault::late, "late"),
      disturbed_frames(FrameFault::out_of_order, "out of order"),
      disturbed_frames(FrameFault::twice, "twice"),
      disturbed_frames(FrameFault::stale, "stale"),
      disturbed_frames(FrameFault::damaged, "damaged"),
      {.fault = Fault::bus_off,
       .name = "controller off",
       .inject = set_fault(&hal::AxisFaults::bus_off, true),
       .shows_at_rest = true},
      {.fault = Fault::bus_overload,
       .name = "babbling node, 2 frames a tick",
       .inject = set_fault(&hal::AxisFaults::foreign_frames, std::uint32_t{2}),
       .shows_at_rest = true},
      {.fault = Fault::encoder_signal,
       .name = "told by the backend",
       .inject = set_fault(&hal::AxisFaults::encoder_signal, true),
       .shows_at_rest = true},
      {.fault = Fault::missed_deadline,
       .name = "each tick a period late",
       .inject = [](Bench& b, std::size_t, int since) { b.backend.miss_ticks(since < 4 ? 1 : 0); },
       .violated = late_tick},
      {.fault = Fault::clock_jump, .name = "on by 1 s", .inject = jump(1'000'000'000), .violated = jumped},
      {.fault = Fault::clock_jump, .name = "back by 1 s", .inject = jump(-1'000'000'000), .violated = jumped},
      {.fault = Fault::clock_jump, .name = "back by 1 ms", .inject = jump(-1'000'000), .violated = jumped},
      programme(Fault::parameters_damaged, "told by the programme"),
      programme(Fault::watchdog_starved, "told by the programme"),
      programme(Fault::set_points_lost, "told by the programme"),
      programme(Fault::commander_lost, "told by the programme"),
      programme(Fault::master_lost, "told by the programme"),
      programme(Fault::master_too_fast, "told by the programme"),
      programme(Fault::synchronisation_lost, "told by the programme"),
      programme(Fault::cam_table, "told by the programme"),
  };
}

}  // namespace

std::vector<FaultCase> fault_cases() {
  auto cases = cases_of_the_axis();
  for (auto& c : cases_of_the_supervision()) cases.push_back(std::move(c));
  for (auto& c : cases_of_backend_and_programme()) cases.push_back(std::move(c));
  return cases;
}

void repair(Bench& bench, std::size_t axis) {
  bench.backend.faults(axis) = {};
  bench.simulated.plant(axis).set_external_force(0.0);
  bench.invalid_set_point.reset();
  bench.mode = OperationMode::cyclic_position;
  bench.extra_bits = 0;
}

}  // namespace stiction::test
