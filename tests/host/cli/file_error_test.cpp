// What the file system refuses is told in words before anything runs, and nothing is half written.
#include "tests/host/cli/program.hpp"

namespace stiction::test {
namespace {

const std::string sine = "simulate circle --machine emps ";

TEST_F(Cli, AFolderIsNoFile) {
  fs::create_directories(work() / "../folder");
  expect_refused("inspect ../folder", "../folder: found a folder; expected a log");
  expect_refused("simulate circle --machine ../folder", "../folder: found a folder; expected a machine file");
  expect_refused(sine + "--log ../folder", "../folder: found a folder; expected the name of a file");
  expect_refused("convert a.csv b.csv --map ../folder", "../folder: found a folder; expected a mapping file");
}

TEST_F(Cli, AFileIsNoFolder) {
  std::ofstream(work() / "../file") << "precious";
  expect_refused(sine + "--out ../file", "../file: found a file; expected a folder for the results");
  expect_refused(sine + "--out ../file/r", "../file/r: found that ../file is a file; expected a folder");
  expect_refused(sine + "--log ../file/run.csv", "found that ../file is a file; expected a folder");
  expect_refused("inspect ../file/run.csv", "a part of the path is a file, not a folder");
  EXPECT_EQ(content(work() / "../file"), "precious");
}

TEST_F(Cli, WhatIsNotThereIsNamedWithTheNearestThatIs) {
  std::ofstream(work() / "../march.csv") << "";
  expect_refused("inspect ../marhc.csv",
                 "../marhc.csv: found no such file; expected a log; did you mean \"march.csv\"?");
  expect_refused("inspect nowhere/run.csv", "nowhere/run.csv: found no folder nowhere; expected a log in it");
  expect_refused(sine + "--log nowhere/run.csv", "found no folder nowhere; expected a folder that exists");
  expect_refused(sine + "--out ''", "--out: found an empty name; expected that of a folder");
}

TEST_F(Cli, WithoutPermissionNothingIsReadOrWritten) {
  fs::create_directories(work() / "../closed");
  std::ofstream(work() / "../closed/run.csv") << "t[s],x[m],i[A]\n";
  fs::permissions(work() / "../closed/run.csv", fs::perms::none);
  fs::permissions(work() / "../closed", fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_exec);
  const auto nobody = [&](const std::string& arguments, const std::string& message) {
    const auto result = run_shell(as_nobody() + "'{}' " + arguments);
    EXPECT_EQ(result.code, 2) << arguments;
    EXPECT_NE(result.error.find(message), std::string::npos) << arguments << "\n" << result.error;
  };
  nobody("inspect ../closed/run.csv", "../closed/run.csv: found no permission to read it; expected a log");
  nobody(sine + "--out ../closed/r", "found no permission to write into ../closed");
  nobody(sine + "--log ../closed/r.csv", "../closed/r.csv: found no permission to write it");
  fs::permissions(work() / "../closed", fs::perms::owner_all);
  EXPECT_EQ(std::distance(fs::directory_iterator(work() / "../closed"), {}), 1);
}

TEST_F(Cli, AFullDiskIsToldAndNothingIsLeft) {
  // The limit of a file's size fails a write halfway, as a full disk does.
  for (const char* output : {"--out r", "--log run.csv"}) {
    const auto result = run_shell("ulimit -f 8; '{}' " + sine + output);
    EXPECT_EQ(result.code, 1) << output;
    EXPECT_NE(result.error.find("be written: the file becomes larger than the system allows"), std::string::npos)
        << result.error;
    EXPECT_EQ(result.error.find("partial"), std::string::npos)
        << "the message names a temporary file: " << result.error;
    EXPECT_TRUE(nothing_written()) << output;
  }
  const auto device = stiction(sine + "--log /dev/full");
  EXPECT_EQ(device.code, 1);
  EXPECT_NE(device.error.find("/dev/full: cannot be written: the disk is full"), std::string::npos) << device.error;
  EXPECT_TRUE(fs::is_character_file("/dev/full")) << "a device was replaced by a file";
  const auto output = run_shell("'{}' machine list >/dev/full");
  EXPECT_EQ(output.code, 1);
  EXPECT_NE(output.error.find("standard output: cannot be written: the disk is full"), std::string::npos)
      << output.error;
}

TEST_F(Cli, ALogGoesThroughAPipe) {
  const auto result = run_shell("'{}' " + sine + "--log /dev/stderr");
  EXPECT_EQ(result.code, 0);
  EXPECT_NE(result.error.find("X.x[m]"), std::string::npos);
}

}  // namespace
}  // namespace stiction::test
