#include "host/cam/step/relief.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/cam/laws.hpp"

namespace stiction::host::step {
namespace {

using sim::cam::CamError;

bool holds(const ProfileArc& arc, double angle) { return wrapped(angle - arc.begin) <= arc.length(); }
std::size_t index_at(const StepProfile& profile, double angle) {
  return static_cast<std::size_t>(std::lround(wrapped(angle) / profile.step())) % profile.points.size();
}

// The least radius of an arc is inside of it in a valley, at one of its ends in a peak.
bool is_valley(const StepProfile& profile, const ProfileArc& arc) {
  const double ends =
      std::min(profile.points[index_at(profile, arc.begin)].radius, profile.points[index_at(profile, arc.end)].radius);
  for (double angle = arc.begin; angle <= arc.end; angle += profile.step())
    if (profile.points[index_at(profile, angle)].radius < ends - 1e-6) return true;
  return false;
}

std::string name_of(const ReliefArc& arc) {
  return fmt::format("the {} of cam {} from {:.4g}° to {:.4g}°", arc.valley ? "valley" : "peak", arc.cam + 1,
                     wrapped(arc.arc.begin) / degree, wrapped(arc.arc.end) / degree);
}

void apply(const ReliefOverride& change, const StepProfile& profile, const Coupling& coupling,
           std::vector<ReliefArc>& arcs) {
  const auto is_it = [&](const ReliefArc& arc) { return arc.cam == change.cam && holds(arc.arc, change.angle); };
  const auto found = std::find_if(arcs.begin(), arcs.end(), is_it);
  if (found == arcs.end())
    throw CamError(
        fmt::format("found a relief vertex at {:.4g}° of cam {}, in no arc without needed contacts; expected "
                    "an angle in one",
                    change.angle / degree, change.cam + 1));
  if (found->changed_at)
    throw CamError(
        fmt::format("found relief vertices at {:.4g}° and {:.4g}° of cam {} that overlap, both in {}; expected one for "
                    "an arc",
                    *found->changed_at / degree, change.angle / degree, change.cam + 1, name_of(*found)));
  found->changed_at = change.angle;
  if (change.depth) found->shape.depth = *change.depth;
  if (change.blend) found->shape.blend = *change.blend;
  if (change.begin) found->arc.begin = *change.begin;
  if (change.end) found->arc.end = *change.end;
  if (found->arc.end < found->arc.begin) found->arc.end += turn;
  for (double angle = found->arc.begin; angle <= found->arc.end; angle += profile.step()) {
    const auto j = index_at(profile, angle);
    if (coupling.needed[j])
      throw CamError(
          fmt::format("found a relief at {:.4g}° of {}, where the carousel needs the contact of roller {}; "
                      "expected an arc without needed contacts",
                      wrapped(angle) / degree, name_of(*found), profile.points[j].roller + 1));
  }
}

void require_sound(const ReliefArc& arc, const StepProfile& profile, double hub) {
  if (!(arc.shape.depth >= 0.0) || !(arc.shape.blend >= 0.0))
    throw CamError(fmt::format("found a depth of {:.4g} mm and a blend of {:.4g}° of {}; expected 0 or more",
                               1e3 * arc.shape.depth, arc.shape.blend / degree, name_of(arc)));
  if (arc.shape.depth > 0.0 && !(arc.shape.blend >= 2.0 * profile.step()))
    throw CamError(fmt::format("found a blend of {:.4g}° of {}; expected at least {:.4g}°, two steps of the profile",
                               arc.shape.blend / degree, name_of(arc), 2.0 * profile.step() / degree));
  double least = infinity;
  for (double angle = arc.arc.begin; angle <= arc.arc.end; angle += profile.step())
    least = std::min(least, profile.points[index_at(profile, angle)].radius);
  if (least - arc.shape.depth <= hub)
    throw CamError(
        fmt::format("found a relief of {:.4g} mm in {}, where the profile is {:.4g} mm above {}; expected less",
                    1e3 * arc.shape.depth, name_of(arc), 1e3 * (least - hub), hub > 0.0 ? "the hub" : "the axis"));
}

sim::cam::Curve blend_law(const std::string& name) {
  const sim::cam::Law* law = sim::cam::find_law(name);
  if (law == nullptr || law->kind != sim::cam::LawKind::rise || task_of(*law) != "R-R")
    throw CamError(fmt::format("found the blend law \"{}\"; expected one of `stiction cam laws --task R-R`", name));
  return unit_curve(*law);
}

class Lowering {
 public:
  Lowering(const StepProfile& profile, const std::vector<ReliefArc>& arcs, const std::string& law)
      : profile_(profile), law_(blend_law(law)) {
    for (const ReliefArc& arc : arcs)
      if (arc.cam == profile.row && arc.shape.depth > 0.0) arcs_.push_back({arc, middle_radius(arc)});
  }

  bool lowers(double angle) const {
    return std::any_of(arcs_.begin(), arcs_.end(), [&](const auto& each) { return holds(each.arc.arc, angle); });
  }

  double radius(double angle, double original) const {
    for (const auto& [arc, middle] : arcs_) {
      if (!holds(arc.arc, angle)) continue;
      const double in = wrapped(angle - arc.arc.begin), out = arc.arc.length() - in;
      const double share = (arc.begins_at_corner ? 1.0 : blended(in / arc.shape.blend)) *
                           (arc.ends_at_corner ? 1.0 : blended(out / arc.shape.blend));
      return original - share * (original - std::min(original - arc.shape.depth, middle));
    }
    return original;
  }

 private:
  struct Lowered {
    ReliefArc arc;
    double middle;  // radius of the circle between the blends; infinite: none
  };

  double blended(double x) const { return x >= 1.0 ? 1.0 : x <= 0.0 ? 0.0 : law_(x); }

  double middle_radius(const ReliefArc& arc) const {
    double least = infinity;
    if (!arc.shape.middle_arc) return least;
    for (double angle = arc.arc.begin; angle <= arc.arc.end; angle += profile_.step()) {
      const double in = angle - arc.arc.begin, out = arc.arc.end - angle;
      if (in >= arc.shape.blend && out >= arc.shape.blend)
        least = std::min(least, profile_.points[index_at(profile_, angle)].radius - arc.shape.depth);
    }
    return least;
  }

  const StepProfile& profile_;
  sim::cam::Curve law_;
  std::vector<Lowered> arcs_;
};

// Normal and curvature of a lowered point, from its neighbours; beside a corner as before, which a parallel line has.
void measure(StepProfile& profile, std::size_t j) {
  if (profile.has_corner(profile.points[j].angle, 1.5 * profile.step())) return;
  const auto count = profile.points.size();
  ProfilePoint& p = profile.points[j];
  const double before = profile.points[(j + count - 1) % count].radius, behind = profile.points[(j + 1) % count].radius;
  const double r = p.radius, slope = (behind - before) / (2.0 * profile.step());
  const double bend = (before - 2.0 * r + behind) / (profile.step() * profile.step());
  const double size = r * r + slope * slope;
  p.curvature = (size + slope * slope - r * bend) / (size * std::sqrt(size));
  p.normal = Point(0.0, 1.0) * Point(slope, r) / std::sqrt(size) * sim::in_direction(1.0, p.angle);
}

}  // namespace

std::vector<ReliefArc> relief_arcs(const std::array<StepProfile, 2>& profiles, const std::array<Coupling, 2>& couplings,
                                   const ReliefSettings& settings, double hub) {
  blend_law(settings.law);
  std::vector<ReliefArc> arcs;
  for (int cam = 0; cam < 2; ++cam)
    for (const ProfileArc& arc : couplings[static_cast<std::size_t>(cam)].redundant) {
      const bool valley = is_valley(profiles[static_cast<std::size_t>(cam)], arc);
      arcs.push_back({cam, arc, valley, false, false, valley ? settings.valley : settings.peak, std::nullopt});
    }
  for (const ReliefOverride& change : settings.overrides)
    apply(change, profiles[static_cast<std::size_t>(change.cam)], couplings[static_cast<std::size_t>(change.cam)],
          arcs);
  for (ReliefArc& arc : arcs) {
    const auto& profile = profiles[static_cast<std::size_t>(arc.cam)];
    arc.begins_at_corner = profile.has_corner(arc.arc.begin, 1.01 * profile.step());
    arc.ends_at_corner = profile.has_corner(arc.arc.end, 1.01 * profile.step());
    if (arc.shape.depth != 0.0) require_sound(arc, profile, hub);
  }
  return arcs;
}

StepProfile relieved(const StepProfile& profile, const std::vector<ReliefArc>& arcs, const std::string& law) {
  const Lowering lowering(profile, arcs, law);
  StepProfile lowered = profile;
  std::vector<std::size_t> changed;
  for (std::size_t j = 0; j < lowered.points.size(); ++j) {
    ProfilePoint& point = lowered.points[j];
    if (!lowering.lowers(point.angle)) continue;
    point.radius = lowering.radius(point.angle, point.radius);
    changed.push_back(j);
  }
  for (ProfileVertex& vertex : lowered.vertices) vertex.radius = lowering.radius(vertex.angle, vertex.radius);
  for (const std::size_t j : changed) measure(lowered, j);
  lowered.least_radius = infinity, lowered.largest_radius = 0.0;
  const auto include = [&](double radius) {
    lowered.least_radius = std::min(lowered.least_radius, radius);
    lowered.largest_radius = std::max(lowered.largest_radius, radius);
  };
  for (const ProfilePoint& point : lowered.points) include(point.radius);
  for (const ProfileVertex& vertex : lowered.vertices) include(vertex.radius);
  return lowered;
}

}  // namespace stiction::host::step
