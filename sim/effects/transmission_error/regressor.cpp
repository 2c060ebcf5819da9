// Waves over the turns of the wheels that the file knows: the motor, the one inside the gear, and the output. Of two
// that make the same waves (an order of the output is the motor's first where their ratio says so) the slower turning
// wheel's higher order is left away.
#include <algorithm>
#include <cmath>

#include "host/diagnose/classes/effect_regressor.hpp"
#include "sim/plant/transmission_error.hpp"

namespace stiction::host::effects::transmission_error {
namespace {

constexpr int orders = 12;  // of each wheel: eccentricity, coupling, poles and steps of a few teeth

struct Wave {
  double per, order;
};

// From the fastest wheel on.
std::vector<Wave> waves_of(const machine::AxisModel& axis) {
  std::vector<Wave> waves;
  const auto& transmission = *axis.transmission;
  for (const double per : {transmission.ratio, transmission.gear_ratio.value_or(1.0), 1.0})
    for (int order = 1; order <= orders; ++order) {
      const auto same = [&](const Wave& wave) { return std::abs(wave.per * wave.order - per * order) < 1e-6 * per; };
      if (std::none_of(waves.begin(), waves.end(), same)) waves.push_back({per, static_cast<double>(order)});
    }
  return waves;
}

std::vector<double> grid(const machine::AxisModel& axis) {
  std::vector<double> places(waves_of(axis).size());
  for (std::size_t k = 0; k < places.size(); ++k) places[k] = static_cast<double>(k);
  return places;
}
Wave wave_at(const machine::AxisModel& axis, double shape) { return waves_of(axis)[static_cast<std::size_t>(shape)]; }

std::vector<std::vector<double>> columns(const ShaftRun& run, double shape) {
  const auto wave = wave_at(run.axis, shape);
  const auto& transmission = *run.axis.transmission;
  const double angle =
      wave.order * wave.per / (transmission.ratio * run.axis.motor_coordinate.radius);  // rad in a metre
  const auto& places = sim::TransmissionError::of_motor(transmission, wave.per) ? run.motor : run.load;
  std::vector<double> cosine(places.size()), sine(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    cosine[i] = std::cos(angle * places[i]);
    sine[i] = std::sin(angle * places[i]);
  }
  return {cosine, sine};
}
bool possible(const machine::AxisModel&, double, const Eigen::VectorXd&) { return true; }
void describe(const machine::AxisModel& axis, double shape, const Eigen::VectorXd& w, const Eigen::MatrixXd& c,
              Finding& finding) {
  const auto wave = wave_at(axis, shape);
  add_key(axis, finding, "per", wave.per, 0.0);
  add_key(axis, finding, "order", wave.order, 0.0);
  add_key(axis, finding, "cosine", w[0], std::sqrt(c(0, 0)));
  add_key(axis, finding, "sine", w[1], std::sqrt(c(1, 1)));
}

}  // namespace

extern const EffectRegressor regressor{
    .encoders = {.grid = grid, .columns = columns, .possible = possible, .describe = describe}};

}  // namespace stiction::host::effects::transmission_error
