// Motions drawn at random, the same from a seed on every host: for what must hold of any motion.
#pragma once

#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "sim/cam/laws.hpp"
#include "sim/cam/motion.hpp"

namespace stiction::sim::cam {

class RandomMotion {
 public:
  explicit RandomMotion(std::uint64_t seed) : engine_(seed) {}

  std::size_t whole(std::size_t count) { return static_cast<std::size_t>(engine_() % count); }
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }

  // Segments from rest to rest, dwells among them, continuous to the acceleration; the cam closes.
  Cam rests(std::size_t segments) {
    Cam cam = empty();
    for (std::size_t k = 0; k < segments; ++k) {
      Segment segment{.length = between(0.2, 1.5), .stroke = between(-2.0, 2.0), .law = smooth_law()};
      if (whole(4) == 0) segment = {.length = segment.length};
      cam.segments.push_back(segment);
    }
    return closed(cam);
  }

  // Polynomials of 7th degree through any state where they meet: continuous to the jerk, also over the seam.
  Cam septics(std::size_t segments) {
    Cam cam = empty();
    for (std::size_t k = 0; k < segments; ++k) {
      Segment segment{.length = between(0.4, 1.2), .stroke = between(-2.0, 2.0), .law = "hermite_septic"};
      segment.end = {between(-1.0, 1.0), between(-4.0, 4.0), between(-10.0, 10.0)};
      cam.segments.push_back(segment);
    }
    return closed(cam);
  }

  // The name of a law from rest to rest without a jump of the acceleration.
  std::string smooth_law() {
    static const std::vector<std::string> names = [] {
      std::vector<std::string> found;
      for (const Law& law : laws())
        if (law.kind == LawKind::rise && law.start == End::rest && law.end == End::rest && law.number != 2 &&
            law.number != 3 && law.number != 5)
          found.emplace_back(law.name);
      return found;
    }();
    return names[whole(names.size())];
  }

 private:
  Cam empty() {
    Cam cam;
    cam.name = "random";
    cam.start = between(-1.0, 1.0);
    return cam;
  }

  // The last segment returns to the start.
  static Cam closed(Cam cam) {
    Segment& last = cam.segments.back();
    if (last.law == "linear") last.law = "modified_sine";
    last.stroke = 0.0;
    last.stroke = cam.start - cam.position_of(cam.segments.size());
    return cam;
  }

  std::mt19937_64 engine_;
};

}  // namespace stiction::sim::cam
