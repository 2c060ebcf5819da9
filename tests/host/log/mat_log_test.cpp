#include "host/log/mat_log.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "host/log/mapping.hpp"
#include "host/log/read_log.hpp"
#include "host/log/text_file.hpp"
#include "tests/host/log/synthetic_log.hpp"
#include "tests/host/log/temporary_file.hpp"

namespace stiction::host {
namespace {

using test::TemporaryFile;

std::string refusal(const std::filesystem::path& file) {
  try {
    read_log(file);
  } catch (const LogError& error) {
    return error.what();
  }
  return "";
}

// A file as another program writes it; false where Python with scipy is not there. `body` fills the dict d.
bool saved_by_scipy(const std::filesystem::path& file, const std::string& body) {
  const auto script =
      fmt::format("import numpy as np, scipy.io\nd = {{}}\nt = np.arange(100) * 1e-3\n{}\nscipy.io.savemat('{}', d)\n",
                  body, file.string());
  const TemporaryFile source(".py");
  write_text_file(source.path(), script);
  return std::system(fmt::format("{} {} 2>/dev/null", STICTION_PYTHON, source.path().string()).c_str()) == 0;
}

class MatLevels : public ::testing::TestWithParam<MatLevel> {};

TEST_P(MatLevels, KeepTwoAxesToTheBit) {
  const TemporaryFile file(".mat");
  const auto log = test::synthetic_log(500);
  write_mat_log(file.path(), log, GetParam());
  const auto again = read_log(file.path());
  expect_same_log(again, log);
  EXPECT_TRUE(again.ignored.empty());
}

TEST_P(MatLevels, KeepAnAxisWithoutPrefix) {
  const TemporaryFile file(".mat");
  auto log = test::synthetic_log(10);
  log.axes.resize(1);
  log.axes[0].axis.clear();
  log.comments.clear();
  write_mat_log(file.path(), log, GetParam());
  expect_same_log(read_log(file.path()), log);
}

TEST_P(MatLevels, CutShortAreRefused) {
  const TemporaryFile file(".mat");
  write_mat_log(file.path(), test::synthetic_log(500), GetParam());
  for (const auto size : {64u, 200u, 1000u}) {
    std::filesystem::resize_file(file.path(), size);
    EXPECT_TRUE(refusal(file.path()).starts_with(file.path().string() + ": ")) << size;
    write_mat_log(file.path(), test::synthetic_log(500), GetParam());
  }
}

INSTANTIATE_TEST_SUITE_P(MatLog, MatLevels, ::testing::Values(MatLevel::level_5, MatLevel::level_7_3),
                         [](const auto& level) { return level.param == MatLevel::level_5 ? "Level5" : "Level73"; });

TEST(MatLog, ReadsPlainVariablesInSiUnits) {
  const TemporaryFile file(".mat");
  if (!saved_by_scipy(file.path(),
                      "d['t'] = t\nd['x'] = np.sin(t)\nd['i'] = np.int16(np.round(3*np.cos(t)))\n"
                      "d['x_set'] = np.float32(t)\nd['note'] = 'hello'\nd['gain'] = 3.0"))
    GTEST_SKIP() << "needs " << STICTION_PYTHON << " with scipy";
  const auto log = read_log(file.path());
  ASSERT_EQ(log.t.size(), 100u);
  EXPECT_DOUBLE_EQ(log.period, 1e-3);
  EXPECT_DOUBLE_EQ(log.axes[0].x[50], std::sin(0.05));
  EXPECT_EQ(log.axes[0].i[0], 3.0);
  EXPECT_EQ(log.ignored, (std::vector<std::string>{"gain", "note"}));
}

TEST(MatLog, ReadsStructsOfAxesAndUnits) {
  const TemporaryFile file(".mat");
  if (!saved_by_scipy(file.path(),
                      "d['t'] = t*1e3\nd['X'] = {'x': t*1e3, 'i': t, 'e': t}\nd['Y'] = {'x': t, 'F': t}\n"
                      "d['units'] = {'t': 'ms', 'F': 'kN', 'i': 'A'}\nd['comments'] = 'machine: table\\nalone\\n'"))
    GTEST_SKIP() << "needs " << STICTION_PYTHON << " with scipy";
  const auto log = read_log(file.path());
  EXPECT_DOUBLE_EQ(log.period, 1e-3);
  ASSERT_EQ(log.axes.size(), 2u);
  EXPECT_EQ(log.axes[1].axis, "Y");
  EXPECT_DOUBLE_EQ(log.axes[1].force[3], 3.0);
  EXPECT_EQ(log.ignored, (std::vector<std::string>{"X.e"}));
  ASSERT_EQ(log.comments.size(), 2u);
  EXPECT_EQ(log.comments[0], (std::pair<std::string, std::string>{"machine", "table"}));
}

TEST(MatLog, RefusesWithTheVariableAndSample) {
  struct Case {
    const char *body, *found;
  };
  for (const auto& c : {
           Case{"d['t'] = t\nd['x'] = t.copy(); d['x'][6] = np.nan\nd['i'] = t", ": x(7): found nan"},
           Case{"d['t'] = t\nd['x'] = t[:-1]\nd['i'] = t", ": x: found 99 values; expected 100"},
           Case{"d['t'] = t\nd['x'] = np.outer(t, t)\nd['i'] = t", ": x: found 100x100 values"},
           Case{"d['t'] = t\nd['x'] = t*1j\nd['i'] = t", ": x: found complex numbers"},
           Case{"d['t'] = t\nd['x'] = 'abc'\nd['i'] = t", ": x: found no numbers"},
           Case{"d['t'] = t\nd['x'] = t\nd['i'] = t\nd['units'] = {'x': 'N'}", ": x: found the unit 'N'"},
           Case{"d['t'] = t[::-1]\nd['x'] = t\nd['i'] = t", ": t(2): found 0.098 s"},
           Case{"d['x'] = t\nd['i'] = t", ": found no variable t;"},
           Case{"d['log'] = {'t': t, 'x': t, 'i': t}", "save(file, '-struct', 'log')"},
           Case{"d['t'] = t\nd['pos'] = t", "columns with unknown names: pos"},
           Case{"d['t'] = t\nd['x'] = t", "neither i[A] nor F[N] nor u[V]"},
       }) {
    const TemporaryFile file(".mat");
    if (!saved_by_scipy(file.path(), c.body)) GTEST_SKIP() << "needs " << STICTION_PYTHON << " with scipy";
    const auto message = refusal(file.path());
    EXPECT_TRUE(message.starts_with(file.path().string())) << message;
    EXPECT_NE(message.find(c.found), std::string::npos) << message;
    EXPECT_NE(message.find("; expected "), std::string::npos) << message;
  }
}

TEST(MatLog, RefusesAFileThatOnlyHasTheName) {
  const TemporaryFile file(".mat");
  write_text_file(file.path(), "t[s],x[m],i[A]\n0,0,0\n1,0,0\n");
  EXPECT_NE(refusal(file.path()).find("expected a MAT-file of level 5 or 7.3"), std::string::npos);
}

TEST(MatLog, IsToldByItsContent) {
  const TemporaryFile file(".log");
  write_mat_log(file.path(), test::synthetic_log(10));
  EXPECT_EQ(read_log(file.path()).t.size(), 10u);
}

TEST(MatLog, IsReadableForScipy) {
  const TemporaryFile file(".mat"), source(".py");
  write_mat_log(file.path(), test::synthetic_log(10));
  write_text_file(source.path(), fmt::format("import scipy.io\nd = scipy.io.loadmat('{}', simplify_cells=True)\n"
                                             "assert d['t'].shape == (10,), d['t'].shape\n"
                                             "assert d['X']['x'][0] == 1e-6\nassert d['units']['x'] == 'm'\n"
                                             "assert d['comments'] == 'machine: none\\nmade by: a test\\n'\n",
                                             file.path().string()));
  if (std::system(fmt::format("{} -c 'import scipy.io' 2>/dev/null", STICTION_PYTHON).c_str()) != 0)
    GTEST_SKIP() << "needs " << STICTION_PYTHON << " with scipy";
  EXPECT_EQ(std::system(fmt::format("{} {}", STICTION_PYTHON, source.path().string()).c_str()), 0);
}

TEST(MatLog, RefusesAnAxisThatNoVariableCanBeNamedAfter) {
  const TemporaryFile file(".mat");
  auto log = test::synthetic_log(10);
  log.axes[1].axis = "2";
  EXPECT_THROW(write_mat_log(file.path(), log), LogError);
  EXPECT_FALSE(std::filesystem::exists(file.path()));
}

TEST(ReadLog, NamesWhatItCannotRead) {
  const TemporaryFile zip(".zip");
  write_text_file(zip.path(), std::string("PK\x03\x04") + "rest");
  EXPECT_NE(refusal(zip.path()).find("found a zip archive"), std::string::npos);
  EXPECT_NE(refusal("/nowhere/run.mat").find("/nowhere/run.mat: found no folder /nowhere; expected a log in it"),
            std::string::npos);
}

TEST(MatLog, ReadsOneMatrixByTheColumnsStatedAndVectorsByAMapping) {
  const TemporaryFile tall(".mat"), wide(".mat"), vectors(".mat"), map(".toml");
  const std::string m = "m = np.c_[1e3 * t, 2.5 + t, 7 * t]\n";
  if (!saved_by_scipy(tall.path(), m + "d['m'] = m; d['gain'] = 3.0") ||
      !saved_by_scipy(wide.path(), m + "d['m'] = m.T"))
    GTEST_SKIP() << "needs " << STICTION_PYTHON << " with scipy";
  for (const auto* file : {&tall, &wide}) {
    const auto log = read_log(file->path(), {"t[ms],x[mm],u[V]", {}});
    ASSERT_EQ(log.t.size(), 100u);
    EXPECT_DOUBLE_EQ(log.t[99], 0.099);
    EXPECT_DOUBLE_EQ(log.axes.at(0).x[99], 2.599e-3);
    EXPECT_DOUBLE_EQ(log.axes.at(0).u[99], 0.693);
  }
  try {
    read_log(tall.path(), {"t[ms],x[mm]", {}});
    ADD_FAILURE() << "three columns were read as two";
  } catch (const LogError& error) {
    EXPECT_NE(std::string(error.what()).find("found m (100x3); expected one matrix with 2 columns"), std::string::npos)
        << error.what();
  }
  ASSERT_TRUE(saved_by_scipy(vectors.path(), m + "d['time'] = t; d['pos'] = m[:, 1]; d['rest'] = m[:, 1:]"));
  write_text_file(
      map.path(),
      "schema = \"stiction.mapping/1\"\n[time]\ncolumn = \"time\"\n[[channel]]\nfrom = \"pos\"\nto = \"x\"\n"
      "unit = \"mm\"\n[[channel]]\nfrom = \"rest(:,2)\"\nto = \"u\"\nunit = \"V\"\n");
  const auto mapping = read_mapping(map.path());
  const auto log = apply_mapping(mapping, read_recording(vectors.path(), mapping.table));
  EXPECT_DOUBLE_EQ(log.period, 1e-3);
  EXPECT_DOUBLE_EQ(log.axes.at(0).x[99], 2.599e-3);
  EXPECT_DOUBLE_EQ(log.axes.at(0).u[99], 0.693);
}

}  // namespace
}  // namespace stiction::host
