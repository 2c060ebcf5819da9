// `stiction cam` as its users call it: figures, messages and exit codes.
#include "tests/host/cli/program.hpp"

namespace stiction::test {
namespace {

class CamCli : public Cli {
 protected:
  static std::string example(const std::string& name) {
    return "'" + (fs::path(STICTION_SOURCE_DIR) / "examples/cams" / name).string() + "'";
  }
  std::string written(const std::string& name, const std::string& text) {
    std::ofstream(work() / name) << text;
    return name;
  }
  static std::string indexing() { return content(fs::path(STICTION_SOURCE_DIR) / "examples/cams/indexing.toml"); }
};

TEST_F(CamCli, ListsTheLawsOfATask) {
  const auto all = nlohmann::json::parse(stiction("cam laws --json").out);
  EXPECT_EQ(all["laws"].size(), 86u);
  const auto some = nlohmann::json::parse(stiction("cam laws --task R-U --json").out);
  EXPECT_GT(some["laws"].size(), 3u);
  for (const auto& law : some["laws"]) EXPECT_EQ(law["task"], "R-U");
  EXPECT_EQ(stiction("cam laws --task R-X").code, 2);
}

TEST_F(CamCli, ChecksShippedExamplesWithoutAJump) {
  for (const std::string name : {"indexing.toml", "flying_shear.toml"}) {
    const auto done = stiction("cam check " + example(name) + " --json");
    EXPECT_EQ(done.code, 0) << done.error;
    for (const auto& cam : nlohmann::json::parse(done.out)["cams"])
      for (const auto& jump : cam["jumps"]) EXPECT_EQ(jump["derivative"], "jerk");
  }
}

TEST_F(CamCli, FailsWithTheHighestSpeedWhereALimitBreaks) {
  const auto done = stiction("cam check " + example("indexing.toml") + " --machine servo-joint --speed '60 rpm'");
  EXPECT_EQ(done.code, 1);
  EXPECT_NE(done.out.find("LIMIT: the speed is"), std::string::npos);
  EXPECT_NE(done.error.find("the highest speed that keeps all is"), std::string::npos);
  EXPECT_EQ(stiction("cam check " + example("indexing.toml") + " --machine servo-joint --speed '20 rpm'").code, 0);
}

TEST_F(CamCli, FailsWhereTheMotionJumps) {
  const auto file = written("jump.toml", R"(schema = "stiction.cam/1"
[cam.a]
cycle = "360 deg"
[[cam.a.segment]]
end = "90 deg"
stroke = "10 deg"
law = "linear"
[[cam.a.segment]]
end = "360 deg"
stroke = "-10 deg"
law = "modified_sine"
)");
  const auto done = stiction("cam check " + file);
  EXPECT_EQ(done.code, 1);
  EXPECT_NE(done.out.find("The speed jumps by"), std::string::npos);
  EXPECT_NE(done.out.find("at 90°, between segments, segment 1"), std::string::npos);
  EXPECT_EQ(stiction("cam table " + file + " --out t.scam").code, 2);
  EXPECT_FALSE(fs::exists(work() / "t.scam"));
}

TEST_F(CamCli, RefusesBadFilesWithTheirPlace) {
  const auto open = indexing().replace(indexing().find("\"45 deg\"  "), 10, "\"40 deg\"  ");
  const auto done = stiction("cam check " + written("open.toml", open));
  EXPECT_EQ(done.code, 2);
  EXPECT_NE(done.error.find("open.toml:"), std::string::npos) << done.error;
  EXPECT_NE(done.error.find("expected a periodic cam to close"), std::string::npos) << done.error;
  EXPECT_EQ(stiction("cam check nothing.toml").code, 2);
  EXPECT_EQ(stiction("cam check " + example("indexing.toml") + " --machine servo-joint").code, 2);
  EXPECT_EQ(stiction("cam check " + example("indexing.toml") + " --machine emps --speed '20 rpm'").code, 2);
  EXPECT_EQ(stiction("cam check " + example("indexing.toml") + " --speed '-20 rpm'").code, 2);
  EXPECT_EQ(stiction("cam table " + example("flying_shear.toml") + " --out t.scam").code, 2);  // two cams
}

TEST_F(CamCli, WritesTheSameTableEachTime) {
  ASSERT_EQ(stiction("cam table " + example("indexing.toml") + " --tolerance 1e-9 --out a.scam").code, 0);
  ASSERT_EQ(stiction("cam table " + example("indexing.toml") + " --tolerance 1e-9 --out b.scam").code, 0);
  EXPECT_EQ(content(work() / "a.scam"), content(work() / "b.scam"));
  const auto done =
      stiction("cam table " + example("flying_shear.toml") + " --cam knife --tolerance '1 um' --out k.scam");
  EXPECT_EQ(done.code, 0) << done.error;
  EXPECT_NE(done.out.find("proven errors: position"), std::string::npos);
}

TEST_F(CamCli, RanksLawsAndDesignsAPage) {
  const auto ranked =
      stiction("cam rank --stroke '40 mm' --rise '180 deg' --speed '60 rpm' --machine screw-linear-scale --json");
  ASSERT_EQ(ranked.code, 0) << ranked.error;
  EXPECT_TRUE(nlohmann::json::parse(ranked.out)["recommended"].is_string());
  const auto page =
      stiction("cam design " + example("indexing.toml") + " --machine servo-joint --speed '20 rpm' --out page");
  ASSERT_EQ(page.code, 0) << page.error;
  EXPECT_GT(fs::file_size(work() / "page/report.html"), 1'000'000u);
}

TEST_F(CamCli, ExportsWithTheErrorAndImportsAgain) {
  const auto out = stiction("cam export " + example("flying_shear.toml") +
                            " --cam carriage --format codesys-xy --points 121 -o c.txt");
  ASSERT_EQ(out.code, 0) << out.error;
  EXPECT_NE(out.out.find("error of the position: at most"), std::string::npos);
  EXPECT_NE(out.out.find("error of the acceleration: at most"), std::string::npos);
  const auto in = stiction("cam import c.txt --format codesys-xy --master linear --slave linear -o back.toml");
  ASSERT_EQ(in.code, 0) << in.error;
  EXPECT_EQ(stiction("cam check back.toml").code, 0);
  const auto wrong = stiction("cam import c.txt --format sew -o no.toml");
  EXPECT_EQ(wrong.code, 2);
  EXPECT_NE(wrong.error.find("looks like codesys-xy"), std::string::npos) << wrong.error;
  EXPECT_EQ(stiction("cam export " + example("indexing.toml") + " --format isg --points 361 -o no.txt").code, 2);
  const auto comma = stiction("cam export " + example("indexing.toml") +
                              " --format csv --columns xyva --separator ';' --decimal , -o k.csv");
  ASSERT_EQ(comma.code, 0) << comma.error;
  EXPECT_TRUE(content(work() / "k.csv").starts_with("master;slave;speed;acceleration\n0;0;0;0\n"));
}

}  // namespace
}  // namespace stiction::test
