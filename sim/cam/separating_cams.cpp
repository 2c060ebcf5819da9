#include "sim/cam/separating_cams.hpp"

#include <array>

namespace stiction::sim::cam {
namespace {

// Three laws without a jump of the acceleration, which a drive refuses. In the order of their harmonics: the
// trapezoid's acceleration is nearly constant and has the most at high orders, the modified sine asks for the least
// torque.
constexpr const char* shows_trapezoid =
    "a nearly constant acceleration one way and the other: inertia, force per ampere, and what a shaft makes of them";
constexpr const char* shows_quintic =
    "an acceleration that is a smooth wave: lags and delays, whose force follows its slope";
constexpr const char* shows_sine =
    "a nearly constant speed over a large part of the rise, at little torque: friction over speed and place";
// Each half of the one before it in acceleration, which tells what goes with the speed from what goes with its square.
constexpr double middle_speed = 0.70710678, low_speed = 0.5;
constexpr double short_rise = 0.4, long_rise = 0.8;

struct SeparatingLaw {
  const char* name;
  const char* words;
};
constexpr std::array laws_taken{SeparatingLaw{"modified_trapezoid", shows_trapezoid},
                                SeparatingLaw{"polynomial_3_4_5", shows_quintic},
                                SeparatingLaw{"modified_sine", shows_sine}};
constexpr std::array rise_shares{short_rise, long_rise};
constexpr std::array speed_shares{1.0, middle_speed, low_speed};

constexpr auto separating_table = [] {
  std::array<SeparatingCam, laws_taken.size() * rise_shares.size() * speed_shares.size()> cams{};
  std::size_t k = 0;
  for (const auto& law : laws_taken)
    for (const double rise : rise_shares)
      for (const double speed : speed_shares) cams[k++] = {law.name, rise, speed, law.words};
  return cams;
}();

Segment rest_of(double length) {
  Segment segment;
  segment.length = length;
  return segment;
}
Segment move_of(double length, double stroke, const char* law) {
  auto segment = rest_of(length);
  segment.stroke = stroke;
  segment.law = law;
  return segment;
}

}  // namespace

std::span<const SeparatingCam> separating_cams() { return separating_table; }

double rise_of(const SeparatingCam& each, const CamRange& range) {
  return each.rise_share * (range.returns ? 0.5 * range.cycle : range.cycle);
}

Cam separating_cam(const SeparatingCam& each, const CamRange& range) {
  const double rise = rise_of(each, range), room = range.returns ? 0.5 * range.cycle : range.cycle;
  const double between = room - rise;
  Cam cam;
  cam.name = "next";
  cam.slave = range.slave;
  cam.start = range.start;
  cam.modulo = range.modulo;
  cam.segments = {rest_of(0.5 * between), move_of(rise, range.stroke, each.law)};
  if (range.returns) {
    cam.segments.push_back(rest_of(between));
    cam.segments.push_back(move_of(rise, -range.stroke, each.law));
  }
  cam.segments.push_back(rest_of(0.5 * between));
  return cam;
}

}  // namespace stiction::sim::cam
