// A plant of your own under the firmware's cascade: a mass with friction on a guideway, moved by a DC motor, goes back
// and forth for two seconds. Prints one stroke, with the current next to the one that mass and friction need, and
// leaves a log, own_plant.csv, which example 04 and `stiction inspect` read. Replace Plant and the numbers of the
// design by yours.
#include <cmath>
#include <cstdio>
#include <stiction/stiction.hpp>

using S = stiction::FixedSignals;
using stiction::design::to_si, stiction::design::to_signal;

struct Plant {
  double mass = 20.0, coulomb = 25.0, viscous = 60.0;                             // kg, N, N s/m
  double resistance = 2.0, inductance = 10e-3, back_emf = 50.0, constant = 50.0;  // Ohm, H, V s/m, N/A
  double x = 0.0, v = 0.0, i = 0.0;                                               // m, m/s, A

  double friction() const { return coulomb * std::tanh(v / 1e-4) + viscous * v; }
  void advance(double u, double time) {
    for (int k = 0; k < 8; ++k) {
      i += (u - resistance * i - back_emf * v) / inductance * time / 8;
      v += (constant * i - friction()) / mass * time / 8;
      x += v * time / 8;
    }
  }
};

constexpr stiction::AxisDesign design{
    .timing = {.fast_period = 62.5e-6, .slow_period = 1e-3},
    .mass = 20.0,
    .max_velocity = 1.0,
    .motor = {.loop = stiction::CurrentLoop::direct, .force_constant = 50.0},
    .inverter = {.voltage_limit = 300.0, .current_limit = 20.0},
    .position_controller = {.gain = 80.0},
    .velocity_controller = {.gain = 150.0, .integral_time = 8e-3},
    .current_controller = {.gain = 40.0, .integral_time = 2e-3},
    .feedforward = {.velocity = 1.0, .current = 1.0},
};

int main() {
  const auto problems = design.validate();
  for (const auto& problem : problems) std::printf("%s\n", problem.sentence().c_str());
  std::FILE* log = std::fopen("own_plant.csv", "w");
  if (!problems.empty() || log == nullptr) return 1;

  Plant plant;
  stiction::Axis<S> axis(design.configuration());
  stiction::Ticker clock(axis.config().period_ns, design.slow_ticks());
  stiction::AxisSignals<S> signals;
  std::fprintf(log, "t[s],x_set[m],v_set[m/s],a_set[m/s^2],x[m],i[A]\n");
  std::printf("%6s %10s %10s %10s %10s %12s\n", "t/ms", "x/mm", "v/(mm/s)", "error/um", "i/A", "needed/A");
  const double stroke = 0.04, w = 2.0 * 3.141592653589793;  // m, 1/s
  for (int n = 0; n < 32000; ++n, clock.advance()) {
    stiction::Feedback<S> feedback;  // an encoder with increments of 1 nm, sampled with the current
    feedback.position = to_signal<S::Position>(std::round(plant.x * 1e9) * 1e-9);
    feedback.position_time_ns = clock.now_ns();
    feedback.position_valid = true;
    feedback.current[0] = to_signal<S::Current>(plant.i);
    if (n == 0) axis.start(feedback);

    const double t = static_cast<double>(clock.now_ns()) * 1e-9;
    stiction::SetPoint<S> set{to_signal<S::Position>(0.5 * stroke * (1.0 - std::cos(w * t))),
                              to_signal<S::Velocity>(0.5 * stroke * w * std::sin(w * t)),
                              to_signal<S::Acceleration>(0.5 * stroke * w * w * std::cos(w * t))};
    const auto command = axis.tick(set, feedback, clock.now_ns(), clock.slow(), signals);
    if (n % 16 == 0)
      std::fprintf(log, "%.7f,%.10g,%.10g,%.10g,%.10g,%.10g\n", t, to_si(signals.x_set), to_si(signals.v_set),
                   to_si(signals.a_set), to_si(signals.x), to_si(signals.i));
    if (n >= 16000 && n % 1600 == 0)
      std::printf("%6.0f %10.3f %10.2f %10.3f %10.4f %12.4f\n", t * 1e3, to_si(signals.x) * 1e3, to_si(signals.v) * 1e3,
                  to_si(signals.e) * 1e6, to_si(signals.i),
                  (plant.friction() + plant.mass * to_si(signals.a_set)) / plant.constant);
    plant.advance(command.enable ? to_si(command.voltage[0]) : 0.0, design.timing.fast_period);
  }
  std::fclose(log);
  std::printf("fault: %s; log: own_plant.csv\n", stiction::name_of(axis.fault()));
  return axis.fault() == stiction::Fault::none ? 0 : 1;
}
