#include "host/requests/cam_run_request.hpp"

#include <fmt/format.h>

#include <cmath>

#include "firmware/machine/configuration/double_signals.hpp"
#include "host/cam/duty.hpp"
#include "host/requests/cam_choice.hpp"
#include "host/requests/names.hpp"
#include "host/requests/run_options.hpp"
#include "host/requests/usage_error.hpp"
#include "host/simulate/cam_run_result.hpp"
#include "host/simulate/control_run.hpp"
#include "host/simulate/stand_result.hpp"
#include "host/simulate/stand_run.hpp"
#include "sim/cam/check.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {
namespace {

// Refuses a speed at which the axis cannot follow, with the place and the highest speed that works.
void require_limits(const sim::cam::Motion& motion, const AxisLoad& load, double speed, int cycles) {
  const Duty duty = duty_of(motion, load, speed);
  const bool rotary = motion.cam.master == sim::cam::Coordinate::rotary;
  for (const Limit& limit : duty.limits)
    if (limit.broken())
      throw UsageError(fmt::format(
          "--speed: found a {} of {:.5g} {} at {:.5g} {} of the master; expected at most {:.5g} {}, which a speed of "
          "up "
          "to {:.5g} {} keeps",
          limit.name, limit.found, limit.unit, rotary ? limit.place * 57.295779513082321 : limit.place * 1e3,
          rotary ? "°" : "mm", limit.allowed, limit.unit,
          rotary ? duty.highest_speed() * 9.5492965855137201 : duty.highest_speed(), rotary ? "rpm" : "m/s"));
  const double rise = std::fabs(motion.cam.position_of(motion.cam.segments.size()) - motion.cam.start);
  if (rise * (cycles + 1) > load.travel)
    throw UsageError(
        fmt::format("--cycles: found {} and one to start, each further on by {:.5g} {}; expected them within "
                    "the travel of {:.5g} {}",
                    cycles, rise, load.unit(), load.travel, load.unit()));
  for (const auto& found : jumps_of(motion))
    if (found.jump.order < 2)
      throw UsageError(fmt::format("--cam: found a jump of the {}; expected a motion that an axis can follow",
                                   sim::cam::derivative_name(found.jump.order)));
}

template <class S>
std::vector<CamRunCase> cam_run_cases(const machine::Machine& machine, const sim::cam::Motion& motion,
                                      CamRunSettings settings, const CamRunHooks& hooks) {
  std::vector<CamRunCase> cases;
  const auto& axis = machine.axes.front();
  const bool compensates = axis.friction_compensation && axis.friction_compensation->use != CompensationKind::off;
  if (hooks.begin) hooks.begin(compensates ? 3 : 2);
  const auto add = [&](const char* name, const char* label) {
    cases.push_back({name, label, {}, {}});
    // A run with less than the machine file has may stop; its own must not.
    try {
      cases.back().run = run_cam<S>(machine, motion, settings);
    } catch (const FaultTripped& tripped) {
      if (cases.size() == 1) throw;
      cases.back().stopped = tripped.what();
    }
    if (hooks.done) hooks.done(label);
  };
  if (compensates) add("compensated", "with feedforward and friction compensation");
  settings.compensation = false;
  add("feedforward", "with feedforward");
  settings.feedforward = false;
  add("plain", "without feedforward");
  return cases;
}

// The machine with the axis alone that follows `cam`.
machine::Machine following(const CamRunHooks& hooks, const AxisLoad& load) {
  auto machine =
      hooks.load({.command = "cam", .rotary = true, .controllers = Controllers::known, .formats = Formats::or_doubles});
  std::erase_if(machine.axes, [&](const auto& axis) { return axis.name != load.axis; });
  return machine;
}

CamRunFound drive_cam(const CamRunRequest& request, const CamRunHooks& hooks) {
  const auto cam = one_cam(request.motion, request.name, "--cam");
  const auto motion = sim::cam::compose(cam);
  const AxisLoad load = axis_of_cam(hooks.load(cam_needs()), request.axis, &cam);
  CamRunFound found{following(hooks, load), cam.name, {}};
  CamRunSettings settings;
  settings.master_speed = master_speed("--speed", request.speed, cam.master);
  settings.cycles = request.cycles;
  settings.master = request.master == "noisy"   ? MasterSignal::noisy
                    : request.master == "steps" ? MasterSignal::steps
                                                : MasterSignal::ideal;
  require_limits(motion, load, settings.master_speed, settings.cycles);
  const auto& axis = found.machine.axes.front();
  const bool fixed = axis.cascaded() && found.machine.fits_formats();
  auto cases = fixed ? cam_run_cases<FixedSignals>(found.machine, motion, settings, hooks)
                     : cam_run_cases<machine::DoubleSignals>(found.machine, motion, settings, hooks);
  found.result = cam_run_result(motion, axis, fixed ? FixedSignals::name : machine::DoubleSignals::name, cases);
  for (auto& each : cases)
    if (each.stopped.empty()) found.logs.push_back({each.name, std::move(each.run.log)});
  return found;
}

struct StandSimulation {
  const machine::Machine& machine;
  const sim::cam::Motion& motion;
  double speed;
  int cycles;
  Log log{};
  std::string signals{};
};

StandCase stand_case(const std::string& model, StandSimulation& s) {
  const auto drive = sim::cam::elastic_drive_of(s.machine.axes.front());
  const sim::cam::ResponseSettings settings{.master_speed = s.speed, .cycles = s.cycles, .step = 0.1e-3};
  if (model == "transfer-function")
    return {model, "by the transfer function", transfer_response(drive, s.motion, settings)};
  if (model == "lagrange") return {model, "by Lagrange's equations", lagrange_response(drive, s.motion, settings)};
  const StandSettings run{.master_speed = s.speed, .cycles = s.cycles};
  const bool fixed = s.machine.fits_formats();
  auto done = fixed ? run_stand<FixedSignals>(s.machine, s.motion, run)
                    : run_stand<machine::DoubleSignals>(s.machine, s.motion, run);
  s.log = std::move(done.log);
  s.signals = fixed ? FixedSignals::name : machine::DoubleSignals::name;
  return {model, "by the firmware's cascade", std::move(done.load)};
}

CamRunFound cam_on_stand(const CamRunRequest& request, const CamRunHooks& hooks) {
  const auto models = split_list(request.model.empty() ? "transfer-function, lagrange" : request.model);
  for (const auto& model : models) require_known("--model", model, "a model", stand_models());
  if (request.verification && (!request.motion.empty() || !request.speed.empty()))
    throw UsageError("--verification: found it with --cam or --speed; expected one of them, since it has its own");
  const auto cam = request.verification ? verification_cam() : one_cam(request.motion, request.name, "--cam");
  const double speed = request.verification ? verification_speed : master_speed("--speed", request.speed, cam.master);
  const auto motion = sim::cam::compose(cam);
  CamRunFound found{following(hooks, axis_of_cam(hooks.load(cam_needs()), request.axis, &cam)), cam.name, {}};
  StandSimulation simulation{found.machine, motion, speed, request.verification ? 1 : request.cycles};
  std::vector<StandCase> cases;
  try {
    for (const auto& model : models) cases.push_back(stand_case(model, simulation));
  } catch (const sim::cam::StandError& error) {
    throw UsageError(fmt::format("--model: {}", error.what()));
  }
  found.result = stand_result(motion, speed, cases, simulation.signals);
  if (request.verification)
    found.result.findings.emplace_back(
        "The transfer function that Dostrasil 2014 prints has the denominator of Lagrange's equations; its numerator "
        "lacks "
        "the gear's 1/33, so that it holds for set-points at the output alone. The corrected one is used here.");
  if (!simulation.log.t.empty()) found.logs.push_back({"cascade", std::move(simulation.log)});
  return found;
}

}  // namespace

CamRunFound cam_run_request(const CamRunRequest& request, const CamRunHooks& hooks) {
  require_known("--master", request.master, "one of", {"ideal", "noisy", "steps"});
  return request.verification || !request.model.empty() ? cam_on_stand(request, hooks) : drive_cam(request, hooks);
}

}  // namespace stiction::host
