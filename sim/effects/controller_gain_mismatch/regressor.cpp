// Gains and integral times of the drive, which the command residual is searched for.
#include <array>

#include "host/diagnose/classes/effect_regressor.hpp"

namespace stiction::host::effects::controller_gain_mismatch {
namespace {

constexpr double relative_step = 0.01;

using A = machine::AxisModel;
using Value = std::optional<double>;

template <Value (*value)(const A&)>
double part(const A& axis, const machine::Timing&) {
  return relative_step * *value(axis);
}

Value position_gain(const A& a) { return a.position_controller.gain; }
Value velocity_gain(const A& a) { return a.velocity_controller.gain; }
Value velocity_time(const A& a) { return a.velocity_controller.integral_time; }
Value current_gain(const A& a) { return a.current_controller ? Value(a.current_controller->gain) : Value(); }
Value current_time(const A& a) { return a.current_controller ? a.current_controller->integral_time : Value(); }

constexpr std::array gains{
    CommandParameter{"position_gain", position_gain, [](A& a, double v) { a.position_controller.gain = v; },
                     part<position_gain>},
    CommandParameter{"velocity_gain", velocity_gain, [](A& a, double v) { a.velocity_controller.gain = v; },
                     part<velocity_gain>},
    CommandParameter{"velocity_integral_time", velocity_time,
                     [](A& a, double v) { a.velocity_controller.integral_time = v; }, part<velocity_time>},
    CommandParameter{"current_gain", current_gain, [](A& a, double v) { a.current_controller->gain = v; },
                     part<current_gain>},
    CommandParameter{"current_integral_time", current_time,
                     [](A& a, double v) { a.current_controller->integral_time = v; }, part<current_time>},
};

}  // namespace

// They leave nothing in the residual force.
extern const EffectRegressor regressor{.command = gains};

}  // namespace stiction::host::effects::controller_gain_mismatch
