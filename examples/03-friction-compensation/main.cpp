// The friction compensation alone, with a controller of your own: it looks at the set-points and says how much
// current to add. A mass with presliding friction goes back and forth under a P-PI controller in doubles; the table
// shows the largest following error after a reversal, without and with the compensation.
#include <cmath>
#include <cstdio>
#include <stiction/stiction.hpp>

using S = stiction::FixedSignals;
using stiction::design::to_si, stiction::design::to_signal;

// A slide on a guideway, 20 kg and 50 N/A: a contact that yields by 10 um before it slips (Dahl's law), and viscosity.
struct Plant {
  double x = 0.0, v = 0.0, contact = 0.0;  // m, m/s, N
  void advance(double i, double time) {
    constexpr double mass = 20.0, constant = 50.0, coulomb = 25.0, viscous = 60.0, stiffness = 5e6;
    for (int k = 0; k < 8; ++k) {
      contact += stiffness * (v - std::abs(v) * contact / coulomb) * time / 8;
      v += (constant * i - contact - viscous * v) / mass * time / 8;
      x += v * time / 8;
    }
  }
};

// Your controller; here 80 1/s over 150 A s/m with 8 ms, and a feedforward of the mass.
struct Controller {
  double integral = 0.0;  // A
  double step(double x_set, double v_set, double a_set, const Plant& plant, double time) {
    const double error = v_set + 80.0 * (x_set - plant.x) - plant.v;
    integral += 150.0 * error * time / 8e-3;
    return 150.0 * error + integral + a_set * 20.0 / 50.0;
  }
};

// What identification found (`stiction identify`): the curve of the contact after a reversal, 1 - 2 exp(-s / 5 um), as
// a polygon with corners at 4, 12 and 30 um, and the viscosity.
constexpr double distance[] = {4e-6, 12e-6, 30e-6}, level[] = {0.19, 0.24, 0.07};  // m, A: 0.5 A in all
constexpr double speed[] = {1.0}, sliding[] = {1.2};                               // m/s, A beyond the contact
constexpr stiction::AxisDesign axis{.mass = 20.0,
                                    .max_velocity = 1.0,
                                    .motor = {.loop = stiction::CurrentLoop::direct, .force_constant = 50.0},
                                    .inverter = {.voltage_limit = 300.0, .current_limit = 20.0},
                                    .position_controller = {.gain = 80.0},
                                    .velocity_controller = {.gain = 150.0, .integral_time = 8e-3},
                                    .current_controller = {.gain = 40.0, .integral_time = 2e-3}};

// Largest error (m) within 20 ms after a reversal, once the first second is over.
double largest_error(stiction::CompensationKind kind) {
  const stiction::CompensationDesign design{
      .kind = kind,
      .friction = {.distance = distance, .level = level, .speed = speed, .forward = sliding, .backward = sliding}};
  for (const auto& problem : design.validate(axis)) std::printf("%s\n", problem.sentence().c_str());
  stiction::FrictionCompensation<S> compensation(design.configuration(axis));
  stiction::FrictionCompensationSignals<S> signals;
  Plant plant;
  Controller controller;
  compensation.start(to_signal<S::Position>(plant.x));
  const double period = axis.timing.fast_period, w = 2.0 * 3.141592653589793, amplitude = 0.02;  // s, 1/s, m
  double worst = 0.0;
  for (int n = 0; n < 48000; ++n) {
    const double t = n * period, x = amplitude * (1.0 - std::cos(w * t)), v = amplitude * w * std::sin(w * t),
                 a = amplitude * w * w * std::cos(w * t);
    stiction::SetPoint<S> set{to_signal<S::Position>(x), to_signal<S::Velocity>(v), to_signal<S::Acceleration>(a)};
    compensation.step(set, signals);
    plant.advance(controller.step(x, v, a, plant, period) + to_si(set.injection), period);
    if (t > 1.0 && std::fmod(t, 0.5) < 0.02) worst = std::fmax(worst, std::abs(x - plant.x));
  }
  return worst;
}

int main() {
  const double without = largest_error(stiction::CompensationKind::off);
  const double with = largest_error(stiction::CompensationKind::friction);
  std::printf("largest error after a reversal\n  without compensation: %.2f um\n  with compensation: %.2f um\n",
              without * 1e6, with * 1e6);
  return with < without ? 0 : 1;
}
