// The friction compensation from SI units alone, against the machine file with the same values.
#include "stiction/design/compensation_design.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "firmware/machine/configuration/compensation_configuration.hpp"
#include "tests/firmware/design/configuration_words.hpp"
#include "tests/support/shipped_machine.hpp"

namespace stiction::test {
namespace {

// As in mcfv5050ln.toml, X.
constexpr double distance[] = {31.62e-6, 74.99e-6, 133.4e-6, 177.8e-6, 237.1e-6, 316.2e-6, 562.3e-6, 1778e-6};
constexpr double level[] = {0.0694, 0.148, 0.173, 0.142, 0.149, 0.168, 0.104, 0.00566};

CompensationDesign design_of(const machine::Machine& machine, CompensationKind kind) {
  const auto& file = *machine.axes.at(0).friction_compensation;
  CompensationDesign design;
  design.kind = kind;
  design.set_point_delay = machine.timing.set_point_delay;
  design.pulse = {.amplitude = 0.6019e-3,
                  .final_amplitude = 0.6019e-3,
                  .rise_until = 0.001,
                  .flat_until = 20.0,
                  .fall_until = 40.0,
                  .delay = 3.923e-3,
                  .duration = 25.23e-3};
  design.friction = {.look_ahead = 279e-6,
                     .distance = distance,
                     .level = level,
                     .contact_damping = 3.25e-3,
                     .speed = file.friction->speed,
                     .forward = file.friction->forward,
                     .backward = file.friction->backward};
  design.learning = {
      .gain = 0.6, .forgetting = 0.02, .smoothing = 0.2, .limit = 0.48, .dead_zone = 0.1e-6, .filter = 1e-3};
  return design;
}

TEST(CompensationDesign, GivesTheConfigurationOfTheSameMachineFileToTheBit) {
  auto machine = cross_table();
  const auto axis = machine::design_of(machine.timing, machine.axes.at(0));
  for (const auto kind : {CompensationKind::pulse, CompensationKind::friction, CompensationKind::learning}) {
    machine.axes[0].friction_compensation->use = kind;
    const auto design = design_of(machine, kind);
    ASSERT_TRUE(design.validate(axis).empty()) << design.validate(axis)[0].sentence().c_str();
    EXPECT_EQ(words(design.configuration(axis)),
              words(machine::configure_compensation<FixedSignals>(machine, machine.axes[0])));
  }
}

struct WrongCompensation {
  const char* sentence;
  std::function<void(CompensationDesign&)> change;
};

constexpr double two[] = {2e-6, 1e-6}, long_ones[] = {1e-3, 2e-3};
const std::vector<WrongCompensation> wrong_compensations{
    {"timing.set_point_delay: found 0.002 s; expected 0 s to 0.0009375 s, 15 fast periods",
     [](CompensationDesign& d) { d.set_point_delay = 2e-3; }},
    {"friction_compensation.friction.look_ahead: found 0.01 s; expected 0 s to 0.000625 s, the set_point_delay",
     [](CompensationDesign& d) { d.friction.look_ahead = 0.01; }},
    {"friction_compensation.friction.level: found number of values = 8; expected as many as there are distances, 2",
     [](CompensationDesign& d) { d.friction.distance = two; }},
    {"friction_compensation.friction.distance: found 1e-06 m; expected increasing values, more than 2e-06 m",
     [](CompensationDesign& d) { d.friction.distance = d.friction.level = two; }},
    {"friction_compensation.friction.distance: found 0.002 m; expected at most 0.0019 m",
     [](CompensationDesign& d) { d.friction.distance = d.friction.level = long_ones; }},
    {"friction_compensation.pulse.duration: found 1e+30 s; expected more than 0 s and at most 10 s",
     [](CompensationDesign& d) { d.pulse.duration = 1e30; }},
    {"friction_compensation.learning.filter: found 0 s; expected 0.0001 s to 0.01 s",
     [](CompensationDesign& d) { d.learning.filter = 0.0; }},
};

TEST(CompensationDesign, SaysInASentenceWhatIsWrong) {
  const auto machine = cross_table();
  const auto axis = machine::design_of(machine.timing, machine.axes.at(0));
  for (const auto& row : wrong_compensations) {
    auto design = design_of(machine, CompensationKind::learning);
    row.change(design);
    std::string found;
    for (const auto& problem : design.validate(axis)) found += std::string(problem.sentence().c_str()) + "\n";
    EXPECT_NE(found.find(row.sentence), std::string::npos) << row.sentence << "; said:\n" << found;
    EXPECT_EQ(design.configuration(axis).kind, CompensationKind::off) << "a stage that does nothing";
  }
}

}  // namespace
}  // namespace stiction::test
