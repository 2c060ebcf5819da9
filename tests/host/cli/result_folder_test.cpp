// --out on a folder that is there: what the command made is replaced, everything else stays.
#include "tests/host/cli/program.hpp"

namespace stiction::test {
namespace {

const std::string circle = "simulate circle --machine emps --out ";

TEST_F(Cli, AResultIsReplacedAndForeignFilesStay) {
  ASSERT_EQ(stiction(circle + "r").code, 0);
  std::ofstream(work() / "r/notes.txt") << "precious";
  fs::create_directories(work() / "r/pictures");
  std::ofstream(work() / "r/pictures/one.png") << "picture";
  fs::create_symlink("notes.txt", work() / "r/link");
  std::ofstream(work() / "r/report.html") << "outdated";
  const auto result = stiction(circle + "r");
  ASSERT_EQ(result.code, 0) << result.error;
  EXPECT_GT(content(work() / "r/report.html").size(), 10000u);
  EXPECT_EQ(content(work() / "r/notes.txt"), "precious");
  EXPECT_EQ(content(work() / "r/pictures/one.png"), "picture");
  EXPECT_EQ(fs::read_symlink(work() / "r/link"), "notes.txt");
  EXPECT_EQ(std::distance(fs::directory_iterator(work()), {}), 1) << "something is left beside the result";
  EXPECT_EQ(std::distance(fs::directory_iterator(work() / "r"), {}), 6) << "two results, a record, three foreign ones";
}

TEST_F(Cli, WhatTheSameCommandMadeBeforeAndNoLongerMakesGoes) {
  const std::string unstable = " --set axis.Y.position_controller.gain='700 1/s'";
  ASSERT_EQ(stiction("simulate circle --machine mcfv5050ln --out r" + unstable).code, 1);
  ASSERT_TRUE(fs::exists(work() / "r/trace.csv"));
  ASSERT_EQ(stiction("simulate circle --machine mcfv5050ln --out r").code, 0);
  EXPECT_FALSE(fs::exists(work() / "r/trace.csv")) << "a trace beside a result that it does not belong to";
  EXPECT_TRUE(fs::exists(work() / "r/report.html"));
}

TEST_F(Cli, WhatADifferentCommandMadeStaysUnlessItHasTheSameName) {
  ASSERT_EQ(stiction("simulate commissioning --machine emps --out r").code, 0);
  ASSERT_EQ(stiction(circle + "r").code, 0);
  EXPECT_TRUE(fs::exists(work() / "r/machine.toml"));
  EXPECT_TRUE(fs::exists(work() / "r/report.html"));
}

TEST_F(Cli, AForeignFileOfAResultsNameIsNotReplaced) {
  ASSERT_EQ(stiction("simulate commissioning --machine emps --out r").code, 0);
  std::ofstream(work() / "r/report.html") << "thesis";
  const auto result = stiction(circle + "r");
  EXPECT_EQ(result.code, 2);
  EXPECT_NE(result.error.find("r/report.html: found a file that no command of stiction made"), std::string::npos)
      << result.error;
  EXPECT_EQ(content(work() / "r/report.html"), "thesis");
}

TEST_F(Cli, AResultOfAVersionWithoutRecordsIsKnownByItsNames) {
  fs::create_directories(work() / "r");
  for (const char* name : {"result.json", "report.html", "identified.toml"})
    std::ofstream(work() / "r" / name) << "old";
  std::ofstream(work() / "r/notes.txt") << "precious";
  ASSERT_EQ(stiction(circle + "r").code, 0);
  EXPECT_FALSE(fs::exists(work() / "r/identified.toml"));
  EXPECT_EQ(content(work() / "r/notes.txt"), "precious");
}

TEST_F(Cli, AnInterruptedCommandLeavesNothing) {
  // A tuning takes its 1000 simulated laps on any machine; it is ended as Ctrl-C ends it.
  const auto result = run_shell("timeout -s INT -k 20 1 '{}' tune-friction --machine mcfv5050ln --out deep/r");
  ASSERT_EQ(result.code, 124) << "it was over before it was interrupted: " << result.error;
  std::size_t files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(work())) files += !entry.is_directory();
  EXPECT_EQ(files, 0u);
  EXPECT_FALSE(fs::exists(work() / "deep/r"));
}

}  // namespace
}  // namespace stiction::test
