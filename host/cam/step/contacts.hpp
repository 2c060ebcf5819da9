// Which rollers touch which cam at each angle, and which of them the carousel does not need: one that pushes each way
// holds it; a third one makes the drive fight itself, and is what relief takes away.
#pragma once

#include <array>
#include <vector>

#include "host/cam/step/profile.hpp"

namespace stiction::host::step {

// A contact is a gap of at most this, m: what grinding to a micron leaves of one.
inline constexpr double contact_gap = 1.5e-6;

struct Contact {
  int cam = 0;             // 0 or 1, as its row
  int roller = 0;          // of the row
  double gap = 0.0;        // m, between roller and profile
  double push = 0.0;       // signed cosine of the pressure angle (RollerPoint::push)
  double arm_angle = 0.0;  // rad, within half a turn of the line between the axes
  Point place{};           // of the cam's frame, m
  Point normal{};          // into the cam
  double curvature = 0.0;  // of the profile before relief, 1/m
  bool needed = false;

  double pressure_angle() const;  // rad
};

struct ContactSet {
  double psi = 0.0;
  std::vector<Contact> contacts;

  // The needed contact that pushes the carousel up (`way` 1) or down (-1) in v; null where none does.
  const Contact* pushing(int way) const;
};

// Searches contacts on both profiles; knows nothing of relief but by the profiles' radii.
class ContactSearch {
 public:
  // Of `mechanism` with that `lift`. `profiles`: of rows 0 and 1, which must stay as long as this does. `lead_in`: the
  // angle, rad, on both sides of a corner where a contact is needed only if no other one pushes the same way.
  ContactSearch(const StepMechanism& mechanism, const StepLift& lift, const std::array<StepProfile, 2>& profiles,
                double lead_in = 0.0);

  // All contacts with a gap of at most `largest_gap`, m, at the cam's angle `psi`, rad; the needed ones are marked: of
  // those that push one way the one with the smallest pressure angle, before those that are led in.
  ContactSet at(double psi, double largest_gap = contact_gap) const;
  // The gap of one roller of the cam `cam`, m; `at`: where it is. Infinite where it is far from the cam; exact up to
  // `largest_gap`, m.
  double gap_of(int cam, const RollerPoint& at, double largest_gap) const;

 private:
  const StepMechanism& mechanism_;
  const StepLift& lift_;
  const std::array<StepProfile, 2>& profiles_;
  double lead_in_;
  std::array<std::vector<Point>, 2> places_;
};

// An arc of a profile, from `begin` to `end`, rad; the end may lie beyond a turn.
struct ProfileArc {
  double begin = 0.0, end = 0.0;
  double length() const { return end - begin; }
};

// For each point of a profile whether the carousel needs the contact that it has there, and the arcs where it does not.
struct Coupling {
  std::vector<bool> needed;                  // a point of the profile each
  std::vector<std::vector<Contact>> others;  // the other contacts at that cam angle, 1 to 3
  std::vector<ProfileArc> redundant;         // in the order of the angle
};
// Of `profile`, by `search` over the profiles before relief.
Coupling couple(const StepProfile& profile, const ContactSearch& search);

}  // namespace stiction::host::step
