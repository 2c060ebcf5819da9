#include "host/identify/contact.hpp"

#include <algorithm>
#include <cmath>

#include "sim/plant/friction/friction.hpp"
#include "sim/plant/friction/lugre.hpp"

namespace stiction::host {
namespace {

// The contact of the law along the motion, over its level.
std::vector<double> level_of_law(const Motion& motion, const ContactShape& shape) {
  auto friction = *shape.law;
  const auto contact = sim::contact_of(friction);
  sim::stretch_contact(friction, contact->stiffness / (contact->level * shape.inverse_length));
  std::vector<double> displacement(motion.x.size());
  for (std::size_t i = 0; i < displacement.size(); ++i) displacement[i] = motion.x[i] - motion.x.front();
  auto level = sim::contact_force(friction, displacement);
  for (double& s : level) s /= contact->level;
  return level;
}

}  // namespace

Contact contact_of(const Motion& motion, const ContactShape& shape) {
  const std::size_t n = motion.x.size();
  Contact contact{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n)};
  const bool stribeck = shape.static_ratio != 1.0;
  double s = 0.0, memory = 1.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double step = i == 0 ? 0.0 : motion.x[i] - motion.x[i - 1];
    double limit = 1.0;
    if (stribeck) {
      const double ratio = step / (motion.period * shape.stribeck_velocity);
      limit += (shape.static_ratio - 1.0) * sim::LuGre<>::stribeck(ratio);
    }
    const double left = std::exp(-shape.inverse_length * std::abs(step) / limit);
    const double to = std::copysign(limit, step);
    s = to + (s - to) * left;
    memory *= left;
    contact.level[i] = s;
    contact.memory[i] = memory;
  }
  if (shape.law != nullptr) contact.level = level_of_law(motion, shape);
  contact.rate = central_difference(contact.level, motion.period);
  return contact;
}

std::vector<double> stribeck_column(const Motion& motion, const std::vector<double>& level, double stribeck_velocity) {
  std::vector<double> column(level.size());
  for (std::size_t i = 0; i < column.size(); ++i)
    column[i] = level[i] * sim::LuGre<>::stribeck(motion.v[i] / stribeck_velocity);
  return column;
}

std::vector<double> stop_operator(const Motion& motion, double distance) {
  std::vector<double> column(motion.x.size());
  double stretched = 0.0;
  for (std::size_t i = 1; i < column.size(); ++i)
    column[i] = stretched = std::clamp(stretched + motion.x[i] - motion.x[i - 1], -distance, distance);
  return column;
}

}  // namespace stiction::host
