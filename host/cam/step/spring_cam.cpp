#include "host/cam/step/spring_cam.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/cam/step/feasibility.hpp"

namespace stiction::host::step {
namespace {

using sim::cam::CamError;

// A lift that ends no farther from its start returns, rad.
constexpr double returned = 1e-9;
// Beyond this pressure angle a cam cannot push its arm, rad.
constexpr double steepest_push = 89.0 * degree;

// The torque that the contact has to give, in the way of its push, as rest + w^2 inertial.
struct Wanted {
  double rest = 0.0;      // N m, of spring and load
  double inertial = 0.0;  // kg m^2
  double at(double speed) const { return rest + speed * speed * inertial; }
};

class SpringDrive {
 public:
  SpringDrive(const StepProject& project, const StepLift& lift) : project_(project), lift_(lift) {
    way_ = roller(0.0).push(0.0) > 0.0 ? 1.0 : -1.0;
  }

  RollerPoint roller(double psi) const {
    return roller_at(project_.mechanism, project_.mechanism.base(0), psi, lift_.at(psi));
  }
  // The cosine of the pressure angle; below 0 the cam would have to pull.
  double lever(const RollerPoint& at, double psi) const { return way_ * at.push(psi); }

  Wanted wanted(double psi) const {
    const LiftState state = lift_.at(psi);
    const double raised = way_ * (project_.mechanism.against ? -1.0 : 1.0);  // of the lift, in the way of the push
    const double against = state.speed > 0.0 ? raised : state.speed < 0.0 ? -raised : 0.0;
    return {project_.spring->preload + project_.spring->rate * raised * state.way + project_.load.torque * against,
            project_.load.inertia * raised * state.acceleration};
  }

  SpringContact contact(double psi, double speed) const {
    const RollerPoint at = roller(psi);
    const StepMechanism& m = project_.mechanism;
    SpringContact contact{.psi = psi, .pressure_angle = sim::arc_cosine(std::clamp(lever(at, psi), -1.0, 1.0))};
    contact.curvature = at.curvature / (1.0 - m.roller_radius * at.curvature);
    contact.force = wanted(psi).at(speed) / (m.arm * lever(at, psi));
    contact.pressure = hertz_pressure(contact.force, m.roller_width, m.roller_radius, contact.curvature,
                                      project_.load.cam, project_.load.roller);
    contact.input_torque = contact.force * cross(at.contact(m.roller_radius), at.normal);
    return contact;
  }

 private:
  const StepProject& project_;
  const StepLift& lift_;
  double way_ = 1.0;
};

void require_one_roller(const StepProject& project, const StepLift& lift) {
  if (project.mechanism.rollers != 1)
    throw CamError(fmt::format("found {} rollers on a cam with a spring; expected 1", project.mechanism.rollers));
  if (std::fabs(lift.stroke()) > returned)
    throw CamError(
        fmt::format("found a lift that ends {:.6g}° from its start with a spring; expected one that returns, since a "
                    "spring holds an arm that returns",
                    lift.stroke() / degree));
}

void require_profile(const StepProject& project, const StepProfile& profile) {
  if (!(profile.least_radius > project.mechanism.hub_radius))
    throw CamError(fmt::format("found a profile down to {:.4g} mm, where the hub has {:.4g} mm; expected more",
                               1e3 * profile.least_radius, 1e3 * project.mechanism.hub_radius));
  require_wheel(project.wheel_radius, {&profile, 1});
}

void require_push(const SpringDrive& drive, double psi) {
  const double lever = drive.lever(drive.roller(psi), psi);
  if (lever > sim::sine_cosine(steepest_push).cosine) return;
  throw CamError(fmt::format(
      "found a pressure angle of {:.4g}° at {:.5g}° of the cam; expected less than {:.4g}°: a longer rise, a "
      "smaller stroke or an arm farther from the line between the axes",
      sim::arc_cosine(std::clamp(lever, -1.0, 1.0)) / degree, psi / degree, steepest_push / degree));
}

// The highest speed of a square that the force may have, by the closed form at each angle.
void add_lift_off(SpringCam& made, const SpringDrive& drive, int steps) {
  made.lift_off_speed = infinity;
  for (int k = 0; k < steps; ++k) {
    const double psi = turn * k / steps;
    const Wanted wanted = drive.wanted(psi);
    const double square = wanted.inertial < 0.0 ? std::max(0.0, wanted.rest) / -wanted.inertial : infinity;
    const double speed = wanted.rest < 0.0 ? 0.0 : std::sqrt(square);
    if (speed < made.lift_off_speed) made.lift_off_speed = speed, made.lift_off_psi = psi;
  }
}

// p^2 grows with w^2 along a straight line at each angle.
double speed_within(double largest, const SpringDrive& drive, int steps) {
  double least = infinity;
  for (int k = 0; k < steps; ++k) {
    const double psi = turn * k / steps;
    const double rest = drive.contact(psi, 0.0).force, moving = drive.contact(psi, 1.0).force;
    const double pressure = drive.contact(psi, 0.0).pressure;
    if (pressure > largest) return 0.0;
    if (!(moving > rest) || !(rest > 0.0)) continue;
    const double most = rest * (largest / pressure) * (largest / pressure);
    least = std::min(least, std::sqrt((most - rest) / (moving - rest)));
  }
  return least;
}

}  // namespace

SpringCam synthesize_spring_cam(const StepProject& project) {
  std::vector<std::string> notes;
  SpringCam made{lift_of(project, notes), {}, {}, 0.0, 0.0, infinity, std::move(notes)};
  require_one_roller(project, made.lift);
  const SampledLift samples = sampled(made.lift, project.steps);
  made.profile = cut_profile(project.mechanism, samples, 0, project.steps);
  require_buildable(project.mechanism, samples, {&made.profile, 1});
  require_profile(project, made.profile);
  const SpringDrive drive(project, made.lift);
  for (int k = 0; k < project.steps; ++k) {
    const double psi = turn * k / project.steps;
    require_push(drive, psi);
    made.contacts.push_back(drive.contact(psi, project.load.speed));
  }
  add_lift_off(made, drive, project.steps);
  if (project.load.largest_pressure)
    made.speed_for_pressure = speed_within(*project.load.largest_pressure, drive, project.steps);
  if (made.lift_off_speed < project.load.speed)
    made.notes.push_back(
        fmt::format("The roller lifts off at {:.2f}° of the cam: more preload or a stiffer spring holds it.",
                    made.lift_off_psi / degree));
  return made;
}

}  // namespace stiction::host::step
