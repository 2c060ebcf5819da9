#include "tests/blind/truth/hidden.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace stiction::blind {
namespace {

double either_sign(Random& random) { return random() & 1U ? 1.0 : -1.0; }
double coulomb_of(const Mechanics& m) { return Contact(m.contact).coulomb(); }
// 90 % of the level is reached 2.303 lengths from rest (exponential_contact); the first element's end gives the length.
double contact_length(const Mechanics& m) {
  return -m.contact.front().level / m.contact.front().stiffness / std::log(1.0 - 0.15);
}
double value(const machine::Effect& e, const char* key) { return e.values.at(key).front(); }

AtStrength draw_mass(Random& random, const Mechanics& file) {
  return [s = either_sign(random), m = file.mass](double x) {
    return machine::Effect{"mass_mismatch", {{"mass", {m * (1.0 + 0.005 * s * x)}}}};
  };
}
AtStrength draw_coulomb(Random& random, const Mechanics& file) {
  return [s = either_sign(random), c = coulomb_of(file)](double x) {
    return machine::Effect{"coulomb_mismatch", {{"coulomb", {c * (1.0 + 0.02 * s * x)}}}};
  };
}
AtStrength draw_viscous(Random& random, const Mechanics& file) {
  return [s = either_sign(random), mu = file.viscous](double x) {
    return machine::Effect{"viscous_mismatch", {{"viscous", {mu * (1.0 + 0.03 * s * x)}}}};
  };
}
AtStrength draw_viscous_nonlinear(Random& random, const Mechanics&) {
  return [s = either_sign(random), v = log_uniform(random, 0.02, 0.1)](double x) {
    return machine::Effect{"viscous_nonlinear", {{"force", {3.0 * s * x}}, {"velocity", {v}}}};
  };
}
AtStrength draw_stribeck(Random& random, const Mechanics&) {
  return [v = log_uniform(random, 0.002, 0.01)](double x) {
    return machine::Effect{"stribeck", {{"break_away", {5.0 * x}}, {"velocity", {v}}}};
  };
}
AtStrength draw_asymmetry(Random& random, const Mechanics&) {
  return [s = either_sign(random), both = uniform(random, 0.0, 20.0)](double x) {
    return machine::Effect{"friction_asymmetry", {{"coulomb", {2.0 * s * x}}, {"viscous", {both * s * x}}}};
  };
}
AtStrength draw_presliding(Random&, const Mechanics& file) {
  return [length = contact_length(file), c = coulomb_of(file)](double x) {
    // The stiffness is that of the first chord, the distance a corner of the elements' curve.
    const double longer = length * (1.0 + x);
    return machine::Effect{
        "presliding_hysteresis",
        {{"stiffness", {0.15 * c / (-std::log(0.85) * longer)}}, {"distance", {std::log(10.0) * longer}}}};
  };
}
AtStrength draw_constant(Random& random, const Mechanics&) {
  return [s = either_sign(random)](double x) { return machine::Effect{"constant_force", {{"force", {2.0 * s * x}}}}; };
}
AtStrength draw_spring(Random& random, const Mechanics&) {
  return [neutral = uniform(random, -0.1, 0.1)](double x) {
    return machine::Effect{"position_spring", {{"stiffness", {20.0 * x}}, {"neutral", {neutral}}}};
  };
}
AtStrength draw_ripple(Random& random, const Mechanics&) {
  constexpr std::array pitches{0.072, 0.036, 0.024};
  const double pitch = random() % 2 == 0 ? pitches[random() % 3] : log_uniform(random, 0.008, 0.06);
  return [pitch, phase = uniform(random, 0.0, 2.0 * std::numbers::pi)](double x) {
    return machine::Effect{
        "force_ripple",
        {{"pitch", {pitch}}, {"cosine", {3.0 * x * std::cos(phase)}}, {"sine", {3.0 * x * std::sin(phase)}}}};
  };
}
AtStrength draw_backlash(Random&, const Mechanics&) {
  return [](double x) { return machine::Effect{"backlash", {{"width", {2e-6 * x}}}}; };
}
AtStrength draw_skew(Random&, const Mechanics&) {
  return [](double x) { return machine::Effect{"time_skew", {{"delay", {1e-4 * x}}}}; };
}

AtStrength draw_force_constant(Random& random, const Mechanics& file) {
  return [s = either_sign(random), k = file.force_constant](double x) {
    return machine::Effect{"force_constant_mismatch", {{"force_constant", {k * (1.0 + 0.005 * s * x)}}}};
  };
}
AtStrength draw_saturation(Random&, const Mechanics&) {
  return [](double x) { return machine::Effect{"force_saturation", {{"current", {100.0 / std::sqrt(x)}}}}; };
}
AtStrength draw_mode(Random& random, const Mechanics&) {
  // Well enough damped that the velocity loop of this axis does not swing it up.
  return [d = uniform(random, 0.1, 0.3), r = uniform(random, 0.3, 0.8)](double x) {
    return machine::Effect{"structural_resonance",
                           {{"frequency", {400.0 / std::sqrt(x)}}, {"damping_ratio", {d}}, {"mass_ratio", {r}}}};
  };
}
AtStrength draw_coupling(Random& random, const Mechanics&) {
  return [s = either_sign(random)](double x) {
    return machine::Effect{"cross_axis_coupling", {{"mass", {3.0 * s * x}}}};
  };
}
AtStrength draw_gain(Random& random, const Mechanics& file) {
  const std::array<std::pair<const char*, double>, 3> gains{
      {{"position_gain", file.file_position_gain},
       {"velocity_gain", file.file_velocity_gain},
       {"velocity_integral_time", file.file_velocity_integral_time}}};
  return [s = either_sign(random), gain = gains[random() % 3]](double x) {
    return machine::Effect{"controller_gain_mismatch", {{gain.first, {gain.second * (1.0 + 0.01 * s * x)}}}};
  };
}
void change_gains(const machine::Effect& e, Mechanics& m) {
  for (const auto& [key, values] : e.values) {
    if (key == "position_gain") m.position_gain = values.front() / m.file_position_gain;
    if (key == "velocity_gain") m.velocity_gain = values.front() / m.file_velocity_gain;
    if (key == "velocity_integral_time") m.velocity_integral_time = values.front() / m.file_velocity_integral_time;
  }
}

AtStrength draw_lag(Random&, const Mechanics&) {
  return [](double x) { return machine::Effect{"friction_lag", {{"time", {4e-3 * x}}}}; };
}
AtStrength draw_profile(Random& random, const Mechanics&) {
  std::vector<double> position, force;
  const auto knots = 3 + random() % 3;
  for (std::size_t k = 0; k < knots; ++k) {
    const double place = -0.15 + 0.33 * static_cast<double>(k) / static_cast<double>(knots - 1);
    position.push_back(place + (k % 2 == 1 ? uniform(random, -0.02, 0.02) : 0.0));
    force.push_back(uniform(random, -6.0, 6.0));
  }
  return [position, force](double x) {
    auto scaled = force;
    for (double& f : scaled) f *= x;
    return machine::Effect{"position_dependent_friction", {{"position", position}, {"force", scaled}}};
  };
}
AtStrength draw_constant_ripple(Random& random, const Mechanics&) {
  constexpr std::array pitches{0.072, 0.036, 0.024, 0.012};
  const double pitch = random() % 2 == 0 ? pitches[random() % 4] : log_uniform(random, 0.008, 0.06);
  return [pitch, phase = uniform(random, 0.0, 2.0 * std::numbers::pi)](double x) {
    return machine::Effect{
        "force_constant_ripple",
        {{"pitch", {pitch}}, {"cosine", {0.02 * x * std::cos(phase)}}, {"sine", {0.02 * x * std::sin(phase)}}}};
  };
}
AtStrength draw_subdivision(Random& random, const Mechanics&) {
  constexpr std::array periods{20e-6, 40e-6, 100e-6, 200e-6, 500e-6};
  const double drawn = random() % 2 == 0 ? periods[random() % 5] : log_uniform(random, 20e-6, 500e-6);
  return [period = drawn, phase = uniform(random, 0.0, 2.0 * std::numbers::pi)](double x) {
    return machine::Effect{"encoder_subdivision_error",
                           {{"period", {period}},
                            {"cosine", {0.003 * period * x * std::cos(phase)}},
                            {"sine", {0.003 * period * x * std::sin(phase)}}}};
  };
}
AtStrength draw_tone(Random& random, const Mechanics&) {
  return [f = log_uniform(random, 6.0, 45.0), phase = uniform(random, 0.0, 2.0 * std::numbers::pi)](double x) {
    return machine::Effect{
        "periodic_disturbance",
        {{"frequency", {f}}, {"cosine", {4.0 * x * std::cos(phase)}}, {"sine", {4.0 * x * std::sin(phase)}}}};
  };
}
AtStrength draw_drift(Random& random, const Mechanics&) {
  return [s = either_sign(random), time = uniform(random, 4.0, 15.0)](double x) {
    return machine::Effect{"thermal_drift", {{"change", {5.0 * s * x}}, {"time_constant", {time}}}};
  };
}

AtStrength draw_bump(Random& random, const Mechanics&) {
  return [s = either_sign(random), x0 = uniform(random, -0.05, 0.08), w = uniform(random, 0.003, 0.008)](double x) {
    return machine::Effect{"push_at_one_place", {{"force", {8.0 * s * x}}, {"position", {x0}}, {"width", {w}}}};
  };
}
AtStrength draw_speed_ripple(Random& random, const Mechanics&) {
  return [p = log_uniform(random, 0.015, 0.05)](double x) {
    return machine::Effect{"ripple_that_grows_with_speed", {{"per_speed", {30.0 * x}}, {"pitch", {p}}}};
  };
}
AtStrength draw_kick(Random& random, const Mechanics&) {
  return [time = uniform(random, 0.03, 0.08)](double x) {
    return machine::Effect{"kick_after_reversals", {{"force", {8.0 * x}}, {"time", {time}}}};
  };
}

void scale_contact(Mechanics& m, double ratio) {
  for (auto& element : m.contact) {
    element.stiffness *= ratio;
    element.level *= ratio;
  }
}

using E = const machine::Effect&;
using M = Mechanics&;

constexpr std::array<Hideable, 26> table{{
    {"mass_mismatch", true, "", draw_mass, [](E e, M m) { m.mass = value(e, "mass"); }},
    {"coulomb_mismatch", true, "", draw_coulomb,
     [](E e, M m) { scale_contact(m, value(e, "coulomb") / coulomb_of(m)); }},
    {"viscous_mismatch", true, "", draw_viscous, [](E e, M m) { m.viscous = value(e, "viscous"); }},
    {"viscous_nonlinear", true, "", draw_viscous_nonlinear,
     [](E e, M m) { m.rise = value(e, "force"), m.rise_velocity = value(e, "velocity"); }},
    {"stribeck", true, "", draw_stribeck,
     [](E e, M m) { m.break_away = value(e, "break_away"), m.stribeck_velocity = value(e, "velocity"); }},
    {"friction_asymmetry", true, "", draw_asymmetry,
     [](E e, M m) { m.more_in_plus = value(e, "coulomb"), m.more_viscous_in_plus = value(e, "viscous"); }},
    {"presliding_hysteresis", true, "", draw_presliding,
     [](E e, M m) { m.contact = exponential_contact(coulomb_of(m), value(e, "distance") / std::log(10.0)); }},
    {"constant_force", true, "", draw_constant, [](E e, M m) { m.constant_force = value(e, "force"); }},
    {"position_spring", true, "", draw_spring,
     [](E e, M m) { m.spring = value(e, "stiffness"), m.spring_neutral = value(e, "neutral"); }},
    {"force_ripple", true, "", draw_ripple,
     [](E e, M m) {
       m.ripple_pitch = value(e, "pitch");
       m.ripple_cosine = e.values.at("cosine"), m.ripple_sine = e.values.at("sine");
     }},
    {"backlash", true, "", draw_backlash, [](E e, M m) { m.backlash = value(e, "width"); }},
    {"time_skew", true, "", draw_skew, [](E e, M m) { m.current_delay = value(e, "delay"); }},
    {"force_constant_mismatch", true, "", draw_force_constant,
     [](E e, M m) { m.force_ratio = value(e, "force_constant") / m.force_constant; }},
    {"force_saturation", true, "", draw_saturation, [](E e, M m) { m.saturation_current = value(e, "current"); }},
    {"structural_resonance", true, "", draw_mode,
     [](E e, M m) {
       m.mode_frequency = value(e, "frequency");
       m.mode_damping = value(e, "damping_ratio"), m.mode_load = value(e, "mass_ratio");
     }},
    {"cross_axis_coupling", true, "", draw_coupling, [](E e, M m) { m.other_mass = value(e, "mass"); }},
    {"controller_gain_mismatch", true, "", draw_gain, change_gains, true},
    {"friction_lag", true, "", draw_lag, [](E e, M m) { m.friction_lag = value(e, "time"); }},
    {"position_dependent_friction", true, "", draw_profile,
     [](E e, M m) { m.profile_position = e.values.at("position"), m.profile_force = e.values.at("force"); }},
    {"thermal_drift", true, "", draw_drift,
     [](E e, M m) { m.drift = value(e, "change"), m.drift_time = value(e, "time_constant"); }},
    {"force_constant_ripple", true, "", draw_constant_ripple,
     [](E e, M m) {
       m.constant_ripple_pitch = value(e, "pitch");
       m.constant_cosine = value(e, "cosine"), m.constant_sine = value(e, "sine");
     }},
    {"encoder_subdivision_error", true, "", draw_subdivision,
     [](E e, M m) {
       m.reading_period = value(e, "period");
       m.reading_cosine = value(e, "cosine"), m.reading_sine = value(e, "sine");
     }},
    {"periodic_disturbance", true, "", draw_tone,
     [](E e, M m) {
       m.tone_frequency = value(e, "frequency");
       m.tone_cosine = value(e, "cosine"), m.tone_sine = value(e, "sine");
     }},
    {"push_at_one_place", false, "", draw_bump,
     [](E e, M m) {
       m.bump = value(e, "force"), m.bump_position = value(e, "position"), m.bump_width = value(e, "width");
     }},
    {"ripple_that_grows_with_speed", false, "", draw_speed_ripple,
     [](E e, M m) { m.speed_ripple = value(e, "per_speed"), m.speed_ripple_pitch = value(e, "pitch"); }},
    {"kick_after_reversals", false, "", draw_kick,
     [](E e, M m) { m.kick = value(e, "force"), m.kick_time = value(e, "time"); }},
}};

}  // namespace

std::span<const Hideable> hideables() { return table; }

const Hideable& hideable(const std::string& name) {
  for (const auto& row : table)
    if (name == row.name) return row;
  throw std::out_of_range("blind: no effect '" + name + "'");
}

}  // namespace stiction::blind
