// The step cam of a studio: what its project saves, what relief is refused, and how motion and project go together.
#include "host/studio/step_studio.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "firmware/machine/file/machine_file.hpp"
#include "host/cam/step/project_text.hpp"
#include "host/studio/studio.hpp"
#include "host/studio/track_edit.hpp"
#include "sim/cam/motion_file.hpp"
#include "tests/host/cam/step/step_case.hpp"

namespace stiction::host {
namespace {

using sim::cam::CamError;

constexpr const char* motion_file = "step.toml";

std::string step_motion_text() { return sim::cam::motion_text({step::step_motion(90, 180)}); }

// A studio with the first of the published cases, and 720 steps so that it is quick.
Studio with_step_cam() {
  Studio studio;
  studio.load_motion(motion_file, step_motion_text());
  studio.new_step();
  studio.set_step_number("steps", 720.0);
  return studio;
}

TEST(StepProjectText, ReadsBackAsTheSameProject) {
  auto project = step::relieved_case();
  project.name = "dial", project.motion_file = motion_file;
  project.load.torque = 0.1 + 0.2;  // no decimal number
  project.load.preload = 1e-5, project.load.stiffness = 1e8, project.load.largest_pressure = 1.2e9;
  project.relief.lead_in = 0.07, project.relief.peak.middle_arc = true;
  project.relief.overrides = {
      {.cam = 1, .angle = 150.5 * step::degree, .depth = 3e-5, .blend = {}, .begin = 2.5, .end = 2.6},
      {.cam = 0, .angle = 1.0 / 3.0, .blend = 0.05}};
  project.electronic = step::ElectronicCam{0.004, 0.0};
  const auto text = project_text(project);
  const auto again = step::parse_step_project("dial.toml", text, step_motion_text());
  EXPECT_EQ(project_text(again), text);
  EXPECT_EQ(again.load.torque, project.load.torque);
  EXPECT_EQ(again.relief.overrides[1].angle, 1.0 / 3.0);
  for (const auto& number : step::project_numbers()) EXPECT_EQ(number.get(again), number.get(project)) << number.name();
  for (const auto& choice : step::project_choices()) EXPECT_EQ(choice.get(again), choice.get(project)) << choice.name();
}

TEST(StepProjectText, HoldsAMeasuredLiftAndASpring) {
  auto project = step::first_case();
  step::MeasuredLift lift;
  for (int k = 0; k <= 720; ++k) {
    const double psi = k == 720 ? step::turn : step::turn * k / 720;
    lift.psi.push_back(psi), lift.way.push_back(0.25 * (psi - std::sin(psi)));
  }
  project.cam.reset();
  project.measured = lift;
  const auto text = project_text(project);
  const auto again = step::parse_step_project("m.toml", text, "");
  ASSERT_TRUE(again.measured);
  EXPECT_EQ(again.measured->way, lift.way);
  EXPECT_EQ(project_text(again), text);

  auto single = step::first_case();
  single.motion_file = motion_file;
  single.mechanism.rollers = 1;
  single.spring = step::ReturnSpring{20.0, 5.0};
  EXPECT_EQ(project_text(step::parse_step_project("s.toml", project_text(single), step_motion_text())),
            project_text(single));
}

TEST(StepStudio, RefusesASingleCamAndKeepsWhatItHas) {
  Studio studio = with_step_cam();
  auto single = step::first_case();
  single.mechanism.rollers = 1, single.motion_file = motion_file;
  single.spring = step::ReturnSpring{20.0, 5.0};
  const auto before = studio.step_text();
  EXPECT_THROW(studio.load_step("single.toml", project_text(single)), CamError);
  EXPECT_EQ(studio.step_text(), before);
  EXPECT_THROW(Studio().step_text(), CamError);
}

TEST(StepStudio, SetsNumbersInTheUnitsOfThePageAndLeavesOutWhatIsNone) {
  Studio studio = with_step_cam();
  studio.set_step_number("mechanism.arm", 51.3);
  EXPECT_EQ(studio.step().project()->mechanism.arm, 51.3e-3);
  studio.set_step_number("load.speed", 217.0);
  EXPECT_NE(studio.step_text().find("speed = \"217 rpm\""), std::string::npos);
  studio.set_step_number("load.largest_pressure", 1000.0);
  EXPECT_NE(studio.step_text().find("largest_pressure = \"1000 MPa\""), std::string::npos);
  studio.set_step_number("load.largest_pressure", std::nullopt);
  EXPECT_EQ(studio.step_text().find("largest_pressure"), std::string::npos);
  const auto before = studio.step_text();
  EXPECT_THROW(studio.set_step_number("mechanism.rollers", 3.5), machine::MachineFileError);
  EXPECT_THROW(studio.set_step_number("mechanism.arm", -1.0), machine::MachineFileError);
  EXPECT_THROW(studio.set_step_number("mechanism.teeth", 3.0), CamError);
  EXPECT_THROW(studio.set_step_choice("mechanism.carousel_turns", "sideways and back"), std::runtime_error);
  EXPECT_EQ(studio.step_text(), before);
}

TEST(StepStudio, LowersAllArcsOfAKindOrOneAlone) {
  Studio studio = with_step_cam();
  const auto arcs = [&] { return studio.step().made()->arcs; };
  ASSERT_EQ(arcs().size(), 4U);
  studio.set_relief({.arc = 0, .depth = 5e-5}, false);
  for (const auto& arc : arcs()) EXPECT_EQ(arc.shape.depth, arc.valley == arcs()[0].valley ? 5e-5 : 0.0);
  studio.set_relief({.arc = 1, .depth = 2e-5, .alone = true}, false);
  studio.set_relief({.arc = 1, .blend = 3.0 * step::degree, .alone = true}, true);
  EXPECT_EQ(studio.step().project()->relief.overrides.size(), 1U);
  EXPECT_EQ(arcs()[1].shape.depth, 2e-5);
  EXPECT_NEAR(arcs()[1].shape.blend, 3.0 * step::degree, 1e-15);
  const auto before = studio.step_text();
  EXPECT_THROW(studio.set_relief({.arc = 0, .depth = 0.05}, false), CamError);  // beyond the hub
  EXPECT_THROW(studio.set_relief({.arc = 9, .depth = 0.0}, false), CamError);
  EXPECT_EQ(studio.step_text(), before);
  studio.undo();
  EXPECT_TRUE(studio.step().project()->relief.overrides.empty());
}

TEST(StepStudio, SaysWhatCannotBeBuiltAndComesBackByUndo) {
  Studio studio = with_step_cam();
  ASSERT_NE(studio.step().made(), nullptr);
  studio.edit({.verb = "level", .at = 1, .y = 80 * step::degree});
  EXPECT_EQ(studio.step().made(), nullptr);
  EXPECT_NE(studio.step().problem().find("whole number"), std::string::npos);
  EXPECT_THROW(studio.step().profiles(), CamError);
  studio.undo();
  EXPECT_NE(studio.step().made(), nullptr);
  EXPECT_EQ(studio.step().turn().values.size(), studio.step().turn().columns * 720);
}

TEST(StepStudio, ReliefThatIsKeptGivesWhatAFreshSynthesisGives) {
  Studio studio = with_step_cam();
  ASSERT_NE(studio.step().made(), nullptr);
  studio.set_relief({.arc = 0, .depth = 5e-5}, false);
  Studio fresh;
  fresh.load_motion(motion_file, studio.motion_text());
  fresh.load_step("step_cam.toml", studio.step_text());
  EXPECT_EQ(studio.step().profiles().values, fresh.step().profiles().values);
  EXPECT_EQ(studio.step().contacts().values, fresh.step().contacts().values);
  EXPECT_EQ(studio.step().figures_json(), fresh.step().figures_json());
}

TEST(StudioCams, EditsTheChosenOneAndKeepsTheOthers) {
  auto first = step::step_motion(90, 180), second = step::step_motion(90, 200);
  first.name = "a", second.name = "b";
  Studio studio;
  studio.load_motion("two.toml", sim::cam::motion_text({first, second}));
  EXPECT_EQ(studio.cam().name, "a");
  studio.choose_cam(1);
  studio.edit({.verb = "law", .at = 1, .key = "sloping_sine"});
  const auto cams = sim::cam::parse_motion_file("two.toml", studio.motion_text());
  EXPECT_EQ(cams[0].segments[1].law, "modified_sine");
  EXPECT_EQ(cams[1].segments[1].law, "sloping_sine");
  EXPECT_THROW(studio.choose_cam(2), CamError);
  studio.new_step();  // it has to name its cam
  EXPECT_NE(studio.step_text().find("cam = \"b\""), std::string::npos);
  while (studio.undo()) {
  }
  EXPECT_EQ(studio.cam().name, "cam");
}

TEST(StudioTracks, AreEditedAsAFileHasThem) {
  auto cam = step::step_motion(90, 180);
  cam = with_track(cam, {.verb = "track", .key = "gripper", .x = 1.0, .y = 2.0});
  cam = with_track(cam, {.verb = "window", .at = 0, .key = "1", .x = 3.0, .y = 4.0});
  cam = with_track(cam, {.verb = "on_compensation", .at = 0, .x = -0.003});
  cam = with_track(cam, {.verb = "hysteresis", .at = 0, .x = 0.01});
  cam = with_track(cam, {.verb = "track-name", .at = 0, .key = "pin"});
  ASSERT_EQ(cam.tracks.size(), 1U);
  EXPECT_EQ(cam.tracks[0].name, "pin");
  ASSERT_EQ(cam.tracks[0].windows.size(), 2U);
  EXPECT_EQ(cam.tracks[0].windows[1].last, 4.0);
  EXPECT_EQ(cam.tracks[0].on_compensation, -0.003);
  EXPECT_THROW(with_track(cam, {.verb = "hysteresis", .at = 0, .x = -1.0}), std::runtime_error);
  EXPECT_THROW(with_track(cam, {.verb = "track-name", .at = 0, .key = "a \"b\""}), CamError);
  EXPECT_THROW(with_track(cam, {.verb = "window", .at = 0, .key = "3", .x = 0.0, .y = 1.0}), CamError);
  EXPECT_THROW(with_track(cam, {.verb = "off_compensation", .at = 1}), CamError);
  cam = with_track(cam, {.verb = "unwindow", .at = 0, .key = "0"});
  EXPECT_EQ(cam.tracks[0].windows[0].first, 3.0);
  EXPECT_THROW(with_track(cam, {.verb = "unwindow", .at = 0, .key = "0"}), CamError);
  EXPECT_TRUE(with_track(cam, {.verb = "untrack", .at = 0}).tracks.empty());
}

TEST(StudioLevel, OfACycleWithoutAdvanceMayAdvanceByTheModulo) {
  Studio studio;
  studio.edit({.verb = "modulo", .x = 90 * step::degree});
  studio.edit({.verb = "law", .at = 0, .key = "modified_sine"});
  EXPECT_THROW(studio.edit({.verb = "level", .at = 0, .y = 50 * step::degree}), CamError);
  studio.edit({.verb = "level", .at = 0, .y = 90 * step::degree});
  EXPECT_NEAR(studio.cam().segments[0].stroke, 90 * step::degree, 1e-12);
  EXPECT_NEAR(*studio.cam().modulo, 90 * step::degree, 1e-12);
}

}  // namespace
}  // namespace stiction::host
