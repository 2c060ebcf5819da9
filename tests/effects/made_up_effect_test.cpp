// An effect that the product does not have, from the folder of a recipe (docs/extending.md) alone: this programme links
// it into the vocabulary, and file, plant, diagnosis, report and documentation have it.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "firmware/machine/file/extended_machine.hpp"
#include "firmware/machine/file/machine_file.hpp"
#include "firmware/machine/file/reference_page.hpp"
#include "host/diagnose/diagnose.hpp"
#include "host/diagnose/verdict/verdict_json.hpp"
#include "host/log/inspection.hpp"
#include "host/report/diagnosis_report.hpp"
#include "host/simulate/commissioning.hpp"
#include "sim/effects/effects_markdown.hpp"
#include "sim/effects/end_cushion/end_cushion.hpp"
#include "sim/machine_file.hpp"
#include "sim/plant/axis_plant.hpp"
#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

constexpr double begin = 0.03, stiffness = 4000.0;  // m, N/m^2

std::string shipped_text() {
  std::ifstream stream(std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/mcfv5050ln.toml");
  return {std::istreambuf_iterator<char>(stream), {}};
}
std::string with_cushion(const std::string& keys) {
  return shipped_text() + "\n[[axis.X.effect]]\nname = \"end_cushion\"\n" + keys;
}
std::string refusal_of(const std::string& keys) {
  try {
    sim::parse_machine("FILE", with_cushion(keys));
  } catch (const machine::MachineFileError& error) {
    return error.what();
  }
  return "nothing";
}

TEST(MadeUpEffect, IsReadFromAMachineFileThatRefusesTypos) {
  const auto machine = sim::parse_machine("FILE", with_cushion("begin = \"30 mm\"\nstiffness = \"4000 N/m^2\"\n"));
  const auto parameters = sim::effects_of<sim::EndCushion>(machine.axes.front());
  ASSERT_EQ(parameters.size(), 1U);
  EXPECT_EQ(parameters.front().begin, begin);
  EXPECT_EQ(parameters.front().stiffness, stiffness);
  EXPECT_NE(refusal_of("beginn = \"30 mm\"\nstiffness = \"4000 N/m^2\"\n").find("did you mean \"begin\"?"),
            std::string::npos);
  EXPECT_NE(refusal_of("begin = \"30 N\"\nstiffness = \"4000 N/m^2\"\n").find("dimension"), std::string::npos);
  EXPECT_NE(refusal_of("begin = \"30 mm\"\nstiffness = \"-1 N/m^2\"\n").find("greater than 0 N/m^2"),
            std::string::npos);
}

TEST(MadeUpEffect, IsOnTheReferencePageAndInTheTablesOfTheDocumentation) {
  EXPECT_NE(sim::reference_page().find("effect end_cushion: a cushion before the end of the travel"),
            std::string::npos);
  const auto tables = sim::effects_markdown();
  EXPECT_NE(tables.find("| [end_cushion](../" STICTION_MADE_UP_FOLDER "/page.md) | a cushion before the end of the "
                        "travel | `begin` (m), `stiffness` (N/m^2) |\n"),
            std::string::npos);
  EXPECT_NE(tables.find("| position_spring | end_cushion | the same segment with and without"), std::string::npos);
}

// Held at a place within it, a plant without current is pushed out; before it, it stays.
TEST(MadeUpEffect, ActsInThePlant) {
  auto machine = sim::parse_machine("FILE", shipped_text());
  auto axis = machine.axes.front();
  axis.effects = {sim::effect_of<sim::EndCushion>({begin, 1e6})};
  sim::AxisPlant inside(machine.timing, axis, begin + 0.05, 1), before(machine.timing, axis, begin - 0.05, 1);
  for (auto* plant : {&inside, &before}) {
    plant->command({}, false);
    for (int tick = 0; tick < 1000; ++tick) plant->advance_tick();
  }
  EXPECT_LT(inside.position(), begin + 0.049);
  EXPECT_EQ(before.position(), begin - 0.05);
}

// As the demonstration has it.
host::DiagnoseInput commissioned() {
  host::DiagnoseInput input;
  input.machine = sim::parse_machine(
      "mcfv5050ln.toml", shipped_text(),
      {{}, {"axis.X.encoder.velocity=estimated", "axis.X.encoder.noise=2 nm", "axis.X.motor.force_constant=94.2 N/A"}});
  input.closed_loop = input.next_measurement = false;
  auto machine = input.machine;
  machine.axes.front().effects = {sim::effect_of<sim::EndCushion>({begin, stiffness})};
  for (auto& record : host::record_commissioning(machine, 0, 1))
    (record.held_out ? input.held_out : input.logs).push_back(std::move(record.log));
  return input;
}

TEST(MadeUpEffect, IsFoundInRecordsAndShownOnAReport) {
  const auto input = commissioned();
  const auto inspected = host::inspect(input.logs.front()).axes.front().determinable;
  EXPECT_TRUE(std::any_of(inspected.begin(), inspected.end(), [](const auto& each) {
    return each.what == "Cushion at the end of the travel" && each.possible;
  }));

  const auto verdict = host::diagnose(input);
  ASSERT_FALSE(verdict.findings.empty());
  const auto& found = verdict.findings.front();
  ASSERT_TRUE(sim::is_a<sim::EndCushion>(found.effect)) << found.effect.name();
  const auto parameters = sim::parameters_of<sim::EndCushion>(found.values);
  figure("made-up effect: where the cushion begins", fmt::format("{:.1f} mm (30 mm)", 1e3 * parameters.begin));
  EXPECT_NEAR(parameters.begin, begin, 0.01);
  EXPECT_NEAR(parameters.stiffness, stiffness, 0.3 * stiffness);

  const auto json = host::verdict_json(verdict)["findings"][0];
  EXPECT_EQ(json["effect"], "end_cushion");
  EXPECT_TRUE(json["parameters"].contains("begin_m")) << json.dump();
  EXPECT_TRUE(json["parameters"].contains("stiffness_N_per_m2")) << json.dump();

  const auto extended = sim::effect_table("X", found.row(), false);
  EXPECT_NE(extended.find("name = \"end_cushion\""), std::string::npos) << extended;

  ASSERT_FALSE(found.charts.empty());
  EXPECT_EQ(found.charts.front().title, "Along the stroke");
  const auto page = host::diagnosis_report_html({"stiction diagnose", "0", input.machine, verdict});
  for (const char* text : {"Cushion at the end of the travel", "the axis meets an elastic cushion",
                           "the buffer of the end stop", STICTION_MADE_UP_FOLDER "/page.md"})
    EXPECT_NE(page.find(text), std::string::npos) << text;
}

}  // namespace
}  // namespace stiction::test
