// Projects of step cams: what is refused, with its place and reason, each next to one that just passes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "host/cam/step/shop_files.hpp"
#include "tests/host/cam/step/step_case.hpp"
#include "tests/support/figure.hpp"

namespace stiction::host::step {
namespace {

constexpr const char* motion = R"(schema = "stiction.cam/1"
[cam.step]
cycle = "360 deg"
modulo = "90 deg"
[[cam.step.segment]]
length = "90 deg"
[[cam.step.segment]]
length = "180 deg"
stroke = "90 deg"
law = "modified sine"
[[cam.step.segment]]
end = "360 deg"
)";

std::string text_with(const std::string& mechanism = "", const std::string& rest = "",
                      const std::string& head = "schema = \"stiction.step-cam/1\"\nmotion = \"step.toml\"\n") {
  std::string text = head +
                     "[mechanism]\naxis_distance = \"105 mm\"\narm = \"52 mm\"\nroller_radius = \"13 mm\"\n"
                     "roller_width = \"12 mm\"\nrollers = 4\n" +
                     mechanism +
                     "[cam_material]\nmodulus = \"210 GPa\"\npoisson = 0.3\n"
                     "[roller_material]\nmodulus = \"210 GPa\"\npoisson = 0.3\n"
                     "[load]\ninertia = \"0.02 kg m^2\"\nspeed = \"300 rpm\"\n";
  return text + rest;
}

// What is said against a project; empty where it is made.
std::string problem(const std::string& text) {
  try {
    synthesize(parse_step_project("p.toml", text, motion));
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}
std::string problem(const StepProject& project) {
  try {
    synthesize(project);
  } catch (const sim::cam::CamError& error) {
    return error.what();
  }
  return "";
}
std::string replaced(std::string text, const std::string& what, const std::string& by) {
  return text.replace(text.find(what), what.size(), by);
}
testing::AssertionResult says(const std::string& said, const std::string& words) {
  if (said.find(words) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "said: " << said;
}

TEST(StepProject, ReadsWhatItIsWritten) {
  const auto project = parse_step_project("dial.toml", text_with("hub_radius = \"25 mm\"\n"), motion);
  EXPECT_EQ(project.name, "dial");
  EXPECT_NEAR(project.mechanism.row_angle, 45.0 * degree, 1e-12);
  EXPECT_NEAR(project.mechanism.dwell_position, 22.5 * degree, 1e-12);
  EXPECT_TRUE(project.mechanism.against);
  EXPECT_NEAR(project.load.cam.modulus, 210e9, 1.0);
  EXPECT_EQ(problem(text_with()), "");
}

TEST(StepProject, RefusesFilesWithTheirPlace) {
  EXPECT_TRUE(says(problem(replaced(text_with(), "step-cam/1", "step-cam/2")), "p.toml:1: schema: found"));
  EXPECT_TRUE(says(problem(replaced(text_with(), "modulus = \"210 GPa\"\n", "")), "cam_material.modulus"));
  EXPECT_TRUE(says(problem(replaced(text_with(), "\"12 mm\"", "\"-12 mm\"")), "roller_width: found"));
  EXPECT_TRUE(says(problem(text_with("teeth = 3\n")), "mechanism.teeth"));
  EXPECT_TRUE(says(problem(replaced(text_with(), "\"105 mm\"", "\"105 kg\"")), "axis_distance"));
  EXPECT_TRUE(says(problem(text_with("", "preload = \"10 um\"\n")), "stiffness"));
  EXPECT_EQ(problem(text_with("", "preload = \"10 um\"\nstiffness = \"100 N/um\"\n")), "");
  EXPECT_TRUE(says(problem(text_with("", "[relief]\ndepth = \"-0.1 mm\"\nblend = \"4 deg\"\n")), "relief.depth"));
  EXPECT_TRUE(
      says(problem(text_with("", "[relief]\ndepth = \"0.1 mm\"\nblend = \"4 deg\"\nlaw = \"no law\"\n")), "blend law"));
}

TEST(StepProject, RefusesWhatCannotBeBuilt) {
  EXPECT_EQ(problem(first_case()), "");
  const auto with = [](auto&& change) {
    StepProject project = first_case();
    change(project);
    return problem(project);
  };
  EXPECT_TRUE(says(with([](auto& p) { p.mechanism.rollers = 6; }), "3/2 pitches"));
  EXPECT_TRUE(says(with([](auto& p) { p.mechanism.against = false; }), "turn against the cam"));
  EXPECT_TRUE(says(with([](auto& p) { p.mechanism.row_angle = 0.0; }), "loose carousel"));
  // Rollers are 73.5 mm apart.
  EXPECT_TRUE(says(with([](auto& p) { p.mechanism.roller_radius = 36.8e-3; }), "hit each other"));
  EXPECT_FALSE(says(with([](auto& p) { p.mechanism.roller_radius = 36.7e-3; }), "hit each other"));
  EXPECT_TRUE(says(with([](auto& p) { p.mechanism.hub_radius = 40.0e-3; }), "the hub has 40 mm"));
  EXPECT_EQ(with([](auto& p) { p.mechanism.hub_radius = 39.9e-3; }), "");
  // The peak speed of 1.76 times stroke over rise against (a - b) / b = 1.02: from 155 degrees on it can be built;
  // below, contact is lost, the profile is undercut, and at last the path turns back.
  const auto of_rise = [&](double rise) { return with([&](auto& p) { p.cam = step_motion(90, rise); }); };
  EXPECT_EQ(of_rise(155), "");
  EXPECT_TRUE(says(of_rise(150), "no contact with cam 1 at 164"));
  EXPECT_TRUE(says(of_rise(140), "undercut"));
  EXPECT_TRUE(says(of_rise(130), "turns back"));
}

TEST(StepProject, RefusesAWheelThatIsNotSmallerThanTheHollows) {
  StepProject project = first_case();
  const StepSynthesis made = synthesize(project);
  const double hollow = least_radii(made.profiles).concave;
  project.wheel_radius = 1.001 * hollow;
  EXPECT_TRUE(says(problem(project), "found a grinding wheel"));
  EXPECT_TRUE(says(problem(project), "°"));
  project.wheel_radius = 0.999 * hollow;
  EXPECT_EQ(problem(project), "");
}

TEST(StepProject, RefusesReliefThatCannotBe) {
  StepProject project = relieved_case();
  EXPECT_EQ(problem(project), "");
  project.relief.overrides = {{.cam = 0, .angle = 90.0 * degree, .depth = 1e-4}};
  EXPECT_TRUE(says(problem(project), "in no arc"));
  project.relief.overrides = {{.cam = 0, .angle = 150.0 * degree, .begin = 120.0 * degree}};
  EXPECT_TRUE(says(problem(project), "needs the contact"));
  EXPECT_TRUE(says(problem(project), "valley of cam 1"));
  project.relief.overrides = {{.cam = 0, .angle = 150.0 * degree, .begin = 134.0 * degree, .end = 160.0 * degree}};
  EXPECT_EQ(problem(project), "");
  project.relief.overrides = {{.cam = 0, .angle = 150.0 * degree, .depth = -1e-5}};
  EXPECT_TRUE(says(problem(project), "expected 0 or more"));
  project = relieved_case();
  project.mechanism.hub_radius = 39.0e-3;
  project.relief.valley.depth = 1.1e-3;
  EXPECT_TRUE(says(problem(project), "above the hub"));
  project.relief.valley.depth = 0.9e-3;
  EXPECT_EQ(problem(project), "");
  project.relief.law = "linear";
  EXPECT_TRUE(says(problem(project), "blend law"));
}

MeasuredLift table(int rows, double unit = degree) {
  const auto lift = lift_of(step_motion(90, 180));
  MeasuredLift table;
  for (int k = 0; k <= rows; ++k) {
    const double psi = k == rows ? turn : k * turn / rows;
    table.psi.push_back(psi / degree * unit);
    table.way.push_back(lift.at(psi).way);
    table.speed.push_back(lift.at(psi).speed);
  }
  return table;
}

TEST(StepProject, ChecksMeasuredTables) {
  StepProject project = first_case();
  project.cam.reset();
  project.measured = table(360);
  EXPECT_EQ(problem(project), "");
  EXPECT_TRUE(synthesize(project).notes.empty());
  project.measured = table(358);
  EXPECT_TRUE(says(problem(project), "expected at least 360"));
  project.measured = table(360, 1.0);
  EXPECT_TRUE(says(problem(project), "look like degrees"));
  project.measured = table(360);
  project.measured->speed[200] *= 1.02;
  ASSERT_EQ(synthesize(project).notes.size(), 1u);
  EXPECT_TRUE(says(synthesize(project).notes[0], "at 200°"));
  project.measured = table(360);
  project.measured->psi[100] = project.measured->psi[99];
  EXPECT_NE(problem(project), "");
}

// A refusal with the place and reason that it says, and what is said of a project that just passes beside it. `later`:
// that one is refused by a check behind this one, because no mechanism passes there: contact is lost long before a
// profile is undercut or a path turns back, and those two say why.
struct Refusal {
  const char* what;
  std::string refused, words, beside;
  bool later = false;
};

std::vector<Refusal> refusals_of_mechanisms() {
  const auto with = [](const StepProject& from, auto&& change) {
    StepProject project = from;
    change(project);
    return problem(project);
  };
  // Each of these is the last one of a search by halves.
  const auto of = [&](double a, double b, double c, int n, double rise) {
    return problem(step_project(a, b, c, n, 360.0 / n, rise));
  };
  const auto first = [&](auto&& change) { return with(first_case(), change); };
  const auto relief = [&](auto&& change) { return with(relieved_case(), change); };
  const double hollow = least_radii(synthesize(first_case()).profiles).concave;
  return {
      {"stroke", first([](auto& p) { p.mechanism.rollers = 6; }), "90° with 6 rollers a row, 3/2 pitches",
       problem(step_project(105, 52, 8, 6, 60, 180))},
      {"stroke that stays", first([](auto& p) { p.cam->segments[1].stroke = 0.0; }), "a step above 0",
       of(105, 52, 13, 4, 180)},
      {"rollers that hit each other", of(64.41, 34.87, 15.14, 7, 146.1), "hit each other",
       of(64.41, 34.87, 15.09, 7, 146.1)},
      {"rollers that hit the hub", first([](auto& p) { p.mechanism.hub_radius = 40.0e-3; }), "the hub has 40 mm",
       first([](auto& p) { p.mechanism.hub_radius = 39.99e-3; })},
      {"sense of rotation", first([](auto& p) { p.mechanism.against = false; }), "has to turn against the cam",
       of(105, 52, 13, 4, 180)},
      {"a cam without contact", of(105, 52, 13, 4, 154.6), "no contact with cam 1 at 169", of(105, 52, 13, 4, 154.7)},
      {"a carousel that is not held", of(70.68, 25.96, 8.84, 8, 53.7), "no contact that pushes the carousel on",
       of(70.68, 25.96, 8.84, 8, 53.8)},
      {"a path that turns back", of(105, 52, 13, 4, 130), "turns back, phi' =", of(105, 52, 13, 4, 140), true},
      {"an undercut", of(105, 52, 13, 4, 140), "undercut", of(105, 52, 13, 4, 150), true},
      {"a wheel", first([&](auto& p) { p.wheel_radius = 1.0001 * hollow; }), "the concave radius of cam",
       first([&](auto& p) { p.wheel_radius = 0.9999 * hollow; })},
      {"relief beyond the hub",
       relief([](auto& p) { p.mechanism.hub_radius = 39e-3, p.relief.valley.depth = 1.01e-3; }), "above the hub",
       relief([](auto& p) { p.mechanism.hub_radius = 39e-3, p.relief.valley.depth = 0.99e-3; })},
      {"relief of needed contacts",
       relief([](auto& p) { p.relief.overrides = {{.cam = 0, .angle = 150 * degree, .begin = 132.9 * degree}}; }),
       "at 132.9° of the valley of cam 1",
       relief([](auto& p) { p.relief.overrides = {{.cam = 0, .angle = 150 * degree, .begin = 133.2 * degree}}; })},
      {"a vertex in no arc", relief([](auto& p) { p.relief.overrides = {{.cam = 0, .angle = 132.9 * degree}}; }),
       "132.9° of cam 1, in no arc",
       relief([](auto& p) { p.relief.overrides = {{.cam = 0, .angle = 133.2 * degree}}; })},
      {"overlapping vertices", relief([](auto& p) {
         p.relief.overrides = {{.cam = 0, .angle = 150 * degree}, {.cam = 0, .angle = 160 * degree}};
       }),
       "vertices at 150° and 160° of cam 1 that overlap", relief([](auto& p) {
         p.relief.overrides = {{.cam = 0, .angle = 150 * degree}, {.cam = 0, .angle = 215 * degree}};
       })},
      {"a blend of less than two steps", relief([](auto& p) { p.relief.peak.blend = 0.19 * degree; }),
       "two steps of the profile", relief([](auto& p) { p.relief.peak.blend = 0.21 * degree; })},
      {"a law that is no rise from rest", relief([](auto& p) { p.relief.law = "linear"; }), "blend law",
       relief([](auto& p) { p.relief.law = "sloping_sine"; })},
  };
}

std::vector<Refusal> refusals_of_tables() {
  const auto with = [](const MeasuredLift& measured) {
    StepProject project = first_case();
    project.cam.reset();
    project.measured = measured;
    return problem(project);
  };
  const auto note = [](double factor) {
    StepProject project = first_case();
    project.cam.reset();
    project.measured = table(360);
    project.measured->speed[200] *= factor;
    const auto notes = synthesize(project).notes;
    return notes.empty() ? std::string() : notes.front();
  };
  MeasuredLift back = table(360), on = table(360);
  back.psi[100] = back.psi[99];
  on.psi[100] = 0.5 * (on.psi[99] + on.psi[101]);
  return {
      {"a short table", with(table(358)), "found a table of 359 rows; expected at least 360", with(table(359))},
      {"degrees for radians", with(table(360, 1.0)), "look like degrees", with(table(360))},
      {"a table that goes back", with(back), "", with(on)},
      // It is said, not refused: the column is not used.
      {"a speed that is none", note(1.002), "at 200°", note(1.0005)},
  };
}

std::vector<Refusal> refusals_of_files() {
  const std::string sound = problem(text_with()), pressed = "preload = \"10 um\"\n";
  const auto line = [](const std::string& what, const std::string& by) {
    return problem(replaced(text_with(), what, by));
  };
  return {
      {"a newer schema", line("step-cam/1", "step-cam/2"), "p.toml:1: schema: found", sound},
      {"a material without modulus", line("modulus = \"210 GPa\"\n", ""), "cam_material.modulus", sound},
      {"Poisson's ratio", line("poisson = 0.3", "poisson = 0.5"), "cam_material.poisson",
       line("poisson = 0.3", "poisson = 0.499")},
      {"a negative width", line("\"12 mm\"", "\"-12 mm\""), "roller_width: found", line("\"12 mm\"", "\"0.1 mm\"")},
      {"an unknown key", problem(text_with("teeth = 3\n")), "mechanism.teeth", sound},
      {"a wrong unit", line("\"105 mm\"", "\"105 kg\""), "axis_distance", line("\"105 mm\"", "\"10.5 cm\"")},
      {"preload of rigid rollers", problem(text_with("", pressed)), "stiffness",
       problem(text_with("", pressed + "stiffness = \"100 N/um\"\n"))},
      {"a negative depth", problem(text_with("", "[relief]\ndepth = \"-1 um\"\nblend = \"4 deg\"\n")), "relief.depth",
       problem(text_with("", "[relief]\ndepth = \"0 mm\"\nblend = \"4 deg\"\n"))},
  };
}

TEST(StepProject, EveryRefusalHasANeighbourThatPasses) {
  std::size_t refused = 0, passed = 0;
  auto all = refusals_of_mechanisms();
  for (const auto& more : {refusals_of_tables(), refusals_of_files()}) all.insert(all.end(), more.begin(), more.end());
  for (const Refusal& each : all) {
    const bool said = !each.refused.empty() && says(each.refused, each.words);
    const bool beside = each.later ? !each.beside.empty() && !says(each.beside, each.words) : each.beside.empty();
    EXPECT_TRUE(said) << each.what << ": " << each.refused;
    EXPECT_TRUE(beside) << each.what << ": " << each.beside;
    refused += said, passed += beside;
  }
  test::figure("step cams: refusals with place and reason, neighbours that pass",
               fmt::format("{} of {}, {} of {}", refused, all.size(), passed, all.size()));
}

TEST(StepProject, FilesHoldTheirOwnChecksum) {
  const StepProject project = relieved_case();
  const StepSynthesis made = synthesize(project);
  const std::string texts[] = {dxf_text(project, made, DxfVersion::r12, {"stiction", "dial"}),
                               dxf_text(project, made, DxfVersion::r2000, {"stiction", "dial"}),
                               coordinates_text(project, made.profiles[0], {}, {"stiction", "dial"}),
                               inspection_text(project, made.profiles[1], 5.0 * degree, {}, {"stiction", "dial"})};
  for (std::string text : texts) {
    const auto written = fmt::format("CRC-32 of the other lines: {:08x}", checksum_of(text));
    EXPECT_NE(text.find(written), std::string::npos);
    text[text.size() / 2] ^= 1;
    EXPECT_EQ(text.find(fmt::format("{:08x}", checksum_of(text))), std::string::npos);
  }
  TableLayout unknown;
  unknown.columns = {"angle", "colour"};
  EXPECT_THROW(coordinates_text(project, made.profiles[0], unknown, {}), sim::cam::CamError);
}

}  // namespace
}  // namespace stiction::host::step
