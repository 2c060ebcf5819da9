#include "host/cam/limit_share.hpp"

#include <algorithm>
#include <cmath>

namespace stiction::host {

std::function<double(const sim::cam::Motion&, double)> shares_of_limits(const AxisLoad& load, double master_speed) {
  return [load, w = master_speed](const sim::cam::Motion& motion, double coulomb) {
    AxisLoad rough = load;
    rough.coulomb = std::max(load.coulomb, coulomb);
    double largest = 0.0;
    // Ends of the pieces, where accelerations jump, and two places between: a tuner asks for many motions, and
    // `duty_of` has the exact peaks of the one that is used.
    for (const auto& piece : motion.curve.pieces())
      for (int k = 0; k < 4; ++k) {
        const double x = piece.begin + piece.length() * k / 3;
        const double speed = piece.derivative(x, 1) * w, acceleration = piece.derivative(x, 2) * w * w;
        largest =
            std::max({largest, std::fabs(speed) / load.max_speed, std::fabs(acceleration) / load.max_acceleration,
                      std::fabs(rough.effort(piece.derivative(x, 0), speed, acceleration)) / load.largest_effort});
      }
    return largest;
  };
}

}  // namespace stiction::host
