// A machine from scratch, twice: machine.toml for the stiction program, and the design below for a drive of your own.
// Do both give the same drive? The program simulates the file and logs every signal of every tick; here the drive gets
// the same set-points, positions and currents, and must answer with the same voltages:
//   stiction simulate circle --machine machine.toml --log run.csv && ./machine_from_scratch run.csv
// A port of the firmware to a new target is tested in the same way. usage: machine_from_scratch LOG
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <stiction/stiction.hpp>
#include <string>
#include <vector>

using S = stiction::FixedSignals;
using stiction::design::to_si, stiction::design::to_signal;

// The keys are those of machine.toml, the values in SI units.
const stiction::AxisDesign design{
    .timing = {.fast_period = 62.5e-6, .slow_period = 1e-3},
    .mass = 20.0,
    .max_velocity = 1.0,
    .motor = {.loop = stiction::CurrentLoop::direct, .force_constant = 50.0},
    .inverter = {.voltage_limit = 300.0, .current_limit = 20.0},
    .position_controller = {.gain = 80.0, .increment = 1e-6},
    .velocity_controller = {.gain = 150.0, .integral_time = 8e-3},
    .notch = {.frequency = 900.0, .numerator_damping = 0.1, .denominator_damping = 0.7},
    .current_controller = {.gain = 40.0, .integral_time = 2e-3},
    .feedforward = {.velocity = 1.0, .current = 1.0},
};

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: machine_from_scratch LOG\n"), 2;
  const auto problems = design.validate();
  for (const auto& problem : problems) std::printf("%s\n", problem.sentence().c_str());

  std::ifstream log(argv[1]);
  std::string line, cell;
  while (std::getline(log, line) && line[0] == '#') continue;
  std::map<std::string, std::size_t> column;
  std::istringstream header(line);
  for (std::size_t k = 0; std::getline(header, cell, ','); ++k) column[cell] = k;
  if (!problems.empty() || column.count("X.u_A[V]") == 0)
    return std::printf("%s: found no log of every signal of axis X\n", argv[1]), 1;

  stiction::Axis<S> axis(design.configuration());
  stiction::Ticker clock(axis.config().period_ns, design.slow_ticks());
  stiction::AxisSignals<S> signals;
  double largest = 0.0, difference = 0.0;  // V
  long ticks = 0, equal = 0;
  for (std::vector<double> row; std::getline(log, line); clock.advance(), ++ticks) {
    row.clear();
    std::istringstream cells(line);
    while (std::getline(cells, cell, ',')) row.push_back(std::strtod(cell.c_str(), nullptr));
    if (row.size() != column.size()) break;
    const auto value = [&](const char* name) { return row[column.at(name)]; };
    stiction::Feedback<S> feedback;
    feedback.position = to_signal<S::Position>(std::round(value("X.x[m]") * 1e9) * 1e-9);  // increments of 1 nm
    feedback.position_time_ns = clock.now_ns();
    feedback.position_valid = true;
    feedback.current[0] = to_signal<S::Current>(value("X.i_A[A]"));
    if (ticks == 0) axis.start(feedback);
    const auto command =
        axis.tick({to_signal<S::Position>(value("X.x_set[m]")), to_signal<S::Velocity>(value("X.v_set[m/s]")),
                   to_signal<S::Acceleration>(value("X.a_set[m/s^2]"))},
                  feedback, clock.now_ns(), clock.slow(), signals);
    const double mine = to_si(command.voltage[0]), logged = value("X.u_A[V]");
    largest = std::fmax(largest, std::abs(logged));
    difference = std::fmax(difference, std::abs(mine - logged));
    equal += command.voltage[0] == to_signal<S::Voltage>(logged);
  }
  std::printf("%ld ticks, voltages up to %.1f V\n", ticks, largest);
  std::printf("to the bit the same in %ld of them; largest difference: %.3g V\n", equal, difference);
  // The log has ten digits of each signal: a unit of the set position may be lost.
  return ticks > 0 && difference < 1e-3 * largest ? 0 : 1;
}
