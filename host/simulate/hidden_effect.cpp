#include "host/simulate/hidden_effect.hpp"

#include <array>
#include <random>

#include "sim/plant/friction/friction.hpp"

namespace stiction::host {
namespace {

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed) {}

  double between(double low, double high) {
    // Not a distribution of the library: its draws differ from one to another.
    return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1p-53;
  }
  double sign() { return (random_() >> 63) != 0 ? 1.0 : -1.0; }
  std::size_t index(std::size_t count) { return static_cast<std::size_t>(random_() % count); }

 private:
  std::mt19937_64 random_;
};

using Values = machine::KeyedValues;

struct Hideable {
  const char* name;
  Values (*draw)(const machine::AxisModel&, Draw&);
};

constexpr std::array hideables{
    Hideable{"mass_mismatch",
             [](const machine::AxisModel& axis, Draw& draw) {
               return Values{{"mass", {axis.mass * (1.0 + draw.sign() * draw.between(0.02, 0.06))}}};
             }},
    Hideable{
        "coulomb_mismatch",
        [](const machine::AxisModel& axis, Draw& draw) {
          return Values{{"coulomb", {sim::coulomb_of(axis.friction) * (1.0 + draw.sign() * draw.between(0.08, 0.2))}}};
        }},
    Hideable{
        "viscous_mismatch",
        [](const machine::AxisModel& axis, Draw& draw) {
          return Values{{"viscous", {sim::viscous_of(axis.friction) * (1.0 + draw.sign() * draw.between(0.1, 0.3))}}};
        }},
    Hideable{"viscous_nonlinear",
             [](const machine::AxisModel&, Draw& draw) {
               return Values{{"force", {draw.between(15.0, 30.0)}}, {"velocity", {draw.between(0.02, 0.08)}}};
             }},
    Hideable{"stribeck",
             [](const machine::AxisModel&, Draw& draw) {
               return Values{{"break_away", {draw.between(20.0, 40.0)}}, {"velocity", {draw.between(4e-3, 12e-3)}}};
             }},
    Hideable{"presliding_hysteresis",
             [](const machine::AxisModel& axis, Draw& draw) {
               const double distance = draw.between(150e-6, 500e-6);
               const double sharpness = draw.between(3.0, 8.0);
               return Values{{"stiffness", {sharpness * sim::coulomb_of(axis.friction) / distance}},
                             {"distance", {distance}}};
             }},
    Hideable{"position_spring",
             [](const machine::AxisModel&, Draw& draw) {
               return Values{{"stiffness", {draw.between(80.0, 250.0)}}, {"neutral", {draw.between(-0.05, 0.05)}}};
             }},
    Hideable{"force_ripple",
             [](const machine::AxisModel&, Draw& draw) {
               constexpr std::array pitches{0.072, 0.036, 0.024, 0.0205};
               return Values{{"pitch", {pitches[draw.index(pitches.size())]}},
                             {"cosine", {draw.sign() * draw.between(4.0, 10.0)}},
                             {"sine", {draw.sign() * draw.between(2.0, 8.0)}}};
             }},
    Hideable{"constant_force",
             [](const machine::AxisModel&, Draw& draw) {
               return Values{{"force", {draw.sign() * draw.between(6.0, 15.0)}}};
             }},
    Hideable{"friction_asymmetry",
             [](const machine::AxisModel&, Draw& draw) {
               return Values{{"coulomb", {0.0}}, {"viscous", {draw.sign() * draw.between(40.0, 100.0)}}};
             }},
};

}  // namespace

machine::Effect draw_hidden_effect(const machine::AxisModel& axis, std::uint64_t seed) {
  Draw draw(seed);
  const auto& chosen = hideables[draw.index(hideables.size())];
  return {chosen.name, chosen.draw(axis, draw)};
}

}  // namespace stiction::host
