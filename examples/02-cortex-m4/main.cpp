// The firmware on a Cortex-M4 without an operating system or a floating-point unit: a drive goes back and forth and
// stops. The design is checked and converted while compiling, so that a wrong one does not build and no double reaches
// the target. Runs on QEMU's board MPS2 AN386 (see README.md); board.hpp is what a port replaces.
#include <stiction/stiction.hpp>

#include "board.hpp"

using S = stiction::FixedSignals;
using stiction::Coefficient, stiction::Fixed, stiction::narrow, stiction::design::to_signal;

constexpr stiction::AxisDesign design{
    .timing = {.fast_period = 62.5e-6, .slow_period = 1e-3},
    .mass = 20.0,
    .max_velocity = 1.0,
    .motor = {.loop = stiction::CurrentLoop::direct, .force_constant = 50.0},
    .inverter = {.voltage_limit = 300.0, .current_limit = 20.0},
    .position_controller = {.gain = 80.0},
    .velocity_controller = {.gain = 150.0, .integral_time = 8e-3},
    .notch = {.frequency = 900.0, .numerator_damping = 0.1, .denominator_damping = 0.7},
    .current_controller = {.gain = 40.0, .integral_time = 2e-3},
    .feedforward = {.velocity = 1.0, .current = 1.0},
};
static_assert(design.validate().empty(), "the design does not validate; run it at the desk to read why");

// Counts of the board to the firmware's formats: an encoder of 1 nm, a converter of 1 uA.
constexpr auto nanometre = to_signal<Coefficient<59>>(1e-9);
constexpr auto microampere = to_signal<Coefficient<49>>(1e-6);

using Ramp = stiction::VelocityRamp<S>;
constexpr Ramp::Config ramp{to_signal<S::Velocity>(2.0 * design.timing.fast_period), S::seconds(31250),
                            S::rate(62500)};  // 2 m/s^2
constexpr auto feed = to_signal<S::Velocity>(0.1), rest = S::Velocity{};

constinit stiction::Axis<S> axis(design.configuration());
stiction::Ticker clock(62500, design.slow_ticks());
stiction::AxisSignals<S> signals;
stiction::SaturationCounter saturations;
Ramp::State set_point;
board::Motor motor;

stiction::Feedback<S> read_feedback() {
  stiction::Feedback<S> feedback;
  feedback.position = narrow<S::Position>(Fixed<0>::from_raw(motor.encoder_nm()) * nanometre, saturations);
  feedback.position_time_ns = clock.now_ns();
  feedback.position_valid = true;
  feedback.current[0] = narrow<S::Current>(Fixed<0>::from_raw(motor.current_uA()) * microampere, saturations);
  return feedback;
}

// On hardware: the interrupt of the PWM's timer, each 62.5 us.
void tick(S::Velocity target) {
  const auto acceleration = Ramp::step(ramp, set_point, target, saturations);
  const auto feedback = read_feedback();
  const auto command = axis.tick({set_point.position, set_point.velocity, acceleration}, feedback, clock.now_ns(),
                                 clock.slow(), signals);
  motor.pwm_uV(command.enable ? std::int64_t{command.voltage[0].raw()} * 1000000 >> S::Voltage::fraction_bits : 0);
  clock.advance();
}

extern "C" const char flash_used[], ram_used[];  // of the linker script; their addresses are the numbers

int main() {
  axis.start(read_feedback());
  std::int32_t worst = 0;  // nm
  for (int n = 0; n < 16000; ++n) {
    tick(n < 5000 ? feed : n < 10000 ? stiction::opposite(feed) : rest);
    const auto error = static_cast<std::int32_t>((std::int64_t{signals.e.raw()} * 1000000000) >> 32);
    worst = error > worst ? error : -error > worst ? -error : worst;
  }
  const auto print = [](const char* before, std::int32_t number, const char* after) {
    board::print(before), board::print(number), board::print(after);
  };
  print("largest following error: ", worst, " nm\n");
  print("position at the end: ", motor.encoder_nm(), " nm");
  print(", set ", static_cast<std::int32_t>((set_point.position.raw() * 1000) / 1099511628), " um\n");
  print("flash: ", static_cast<std::int32_t>(reinterpret_cast<std::intptr_t>(flash_used)), " bytes\n");
  print("RAM: ", static_cast<std::int32_t>(reinterpret_cast<std::intptr_t>(ram_used)), " bytes, without the stack\n");
  board::print("fault: "), board::print(stiction::name_of(axis.fault())), board::print("\n");
  return axis.fault() == stiction::Fault::none ? 0 : 1;
}
