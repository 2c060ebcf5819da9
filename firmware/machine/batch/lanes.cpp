#include "firmware/machine/batch/lanes.hpp"

#include <cmath>

namespace stiction::machine::lanes {

void sines(double* values, std::size_t count) {
  for (std::size_t k = 0; k < count; ++k) values[k] = std::sin(values[k]);
}

void start(const Learning::Config* configs, Learning::State* states, std::size_t count) {
  for (std::size_t k = 0; k < count; ++k) states[k] = Learning::start(configs[k]);
}

void play(const Learning::Config* configs, Learning::State* states, const double* dx, const double* v, const double* a,
          double* current, std::size_t count) {
  SaturationCounter none;
  for (std::size_t k = 0; k < count; ++k)
    current[k] = Learning::play(configs[k], states[k], {dx[k]}, {v[k]}, {a[k]}, none).value;
}

void learn(const Learning::Config* configs, Learning::State* states, const double* e, double* missing, double* dropped,
           std::size_t count) {
  SaturationCounter none;
  for (std::size_t k = 0; k < count; ++k) {
    Learning::learn(configs[k], states[k], {e[k]}, none);
    missing[k] = states[k].missing.value;
    dropped[k] = states[k].dropped ? 1.0 : 0.0;
  }
}

void start(const Pulse::Config* configs, Pulse::State* states, std::size_t count) {
  for (std::size_t k = 0; k < count; ++k) states[k] = Pulse::start(configs[k]);
}

void step(const Pulse::Config* configs, Pulse::State* states, const double* v, const double* a, double* speed,
          std::size_t count) {
  SaturationCounter none;
  for (std::size_t k = 0; k < count; ++k) speed[k] = Pulse::step(configs[k], states[k], {v[k]}, {a[k]}, none).value;
}

}  // namespace stiction::machine::lanes
