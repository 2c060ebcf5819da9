// Motion files drawn at random, as text with the units that users write: for what must hold of any file.
#pragma once

#include <fmt/format.h>

#include <string>

#include "tests/sim/cam/random_motion.hpp"

namespace stiction::sim::cam {

// A file with one cam from rest to rest: laws by their names, some with the modifications of VDI 2143, Hermite laws
// through forced values, a table of points and a switch track. `seed` draws it, the same on every host.
class RandomMotionFile {
 public:
  explicit RandomMotionFile(std::uint64_t seed) : random_(seed), linear_(random_.whole(3) == 0) {}

  std::string text() {
    std::string file = "schema = \"stiction.cam/1\"\n[cam.drawn]\n";
    file += fmt::format("cycle = \"{} deg\"\n", cycle);
    if (linear_) file += "slave = \"linear\"\n";
    const std::size_t segments = 3 + random_.whole(5);
    for (std::size_t k = 0; k < segments; ++k) {
      const bool last = k + 1 == segments;
      const double length = random_.between(0.6, 1.2) * cycle / static_cast<double>(segments + 1);
      file += "[[cam.drawn.segment]]\n";
      if (!last && random_.whole(5) == 0) {
        file += points(length);
        continue;
      }
      file += last ? fmt::format("end = \"{} deg\"\nto = \"{}\"\n", cycle, place(0.0))
                   : fmt::format("length = \"{:.3f} deg\"\nto = \"{}\"\n", length, place(random_.between(1.0, 80.0)));
      file += law();
    }
    const double on = random_.between(0.0, 180.0);
    const double off = on + random_.between(1.0, 170.0);
    file += fmt::format("[[cam.drawn.track]]\nname = \"valve\"\non = \"{:.2f} deg\"\noff = \"{:.2f} deg\"\n", on, off);
    return file + fmt::format("on_compensation = \"{:.3f} ms\"\n", random_.between(-20.0, 20.0));
  }

 private:
  static constexpr double cycle = 360.0;

  std::string place(double value) const { return fmt::format("{:.4f} {}", value, linear_ ? "mm" : "deg"); }

  // Measured points over `length` degrees, at rest at both ends.
  std::string points(double length) {
    std::string rows;
    double slave = 0.0;
    for (int k = 0; k <= 6; ++k) {
      rows += fmt::format("{}[{:.3f}, {:.4f}]", k == 0 ? "" : ", ", k == 6 ? length : length * k / 6, slave);
      slave += random_.between(0.5, 4.0);
    }
    return fmt::format(
        "length = \"{:.3f} deg\"\npoints = {{ master_unit = \"deg\", slave_unit = \"{}\", spline = "
        "\"quintic_clamped\", rows = [{}] }}\n",
        length, linear_ ? "mm" : "deg", rows);
  }

  std::string law() {
    switch (random_.whole(5)) {
      case 0:
        return fmt::format("law = \"{}\"\n", "modifizierte Sinuslinie");
      case 1: {
        // One draw a statement: the order in which arguments are evaluated differs between compilers.
        const double c = random_.between(0.4, 1.0);
        const double lambda = random_.between(0.25, 0.75);
        return fmt::format("law = \"3-4-5\"\nparameters = {{ c = {:.3f}, lambda = {:.3f} }}\n", c, lambda);
      }
      case 2:
        return fmt::format("law = \"scca\"\nparameters = {{ sine = {:.3f} }}\n", random_.between(0.1, 0.6));
      case 3:
        return "law = \"exponential_1\"\n";
      default:
        return fmt::format("law = \"{}\"\n", random_.smooth_law());
    }
  }

  RandomMotion random_;
  bool linear_;
};

}  // namespace stiction::sim::cam
