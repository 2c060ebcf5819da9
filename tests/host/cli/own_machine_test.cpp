// A machine of one's own, made from a shipped file: no figure, measured point or source of the shipped machine is
// printed for it, on any page.
#include <array>
#include <set>

#include "tests/host/cli/program.hpp"
#include "tests/host/report/page_text.hpp"

namespace stiction::test {
namespace {

struct Shipped {
  const char *name, *mass, *other_mass;  // as its file writes it, and that of the other machine
  std::array<const char*, 2> own;        // experiments whose figures are expected in the shipped file; empty: none
};
constexpr std::array<Shipped, 5> machines{
    {{"mcfv5050ln", "mass = \"225 kg\"", "mass = \"260 kg\"", {"impact", "stick-slip"}},
     {"emps", "mass = \"95.1089 kg\"", "mass = \"120 kg\"", {}},
     {"screw-motor-encoder", "mass = \"200 kg\"", "mass = \"240 kg\"", {}},
     {"screw-linear-scale", "mass = \"300 kg\"", "mass = \"340 kg\"", {}},
     {"stick-slip-feed", "mass = \"300 kg\"", "mass = \"240 kg\"", {"feed-cutting"}}}};
constexpr std::array experiments{"circle",       "constant-velocity", "impact",     "l-shape",
                                 "presliding",   "friction-lag",      "break-away", "stick-slip",
                                 "feed-cutting", "frequency-response"};

// A series of a chart, as the data of a page name it.
constexpr const char* measured_points = "\"name\":\"measured";

std::string text_of_shipped(const std::string& name) {
  return content(fs::path(STICTION_SOURCE_DIR) / "firmware/machine/shipped" / (name + ".toml"));
}

// Without the rows [[expected]] and the rows of [reference], measured or published. Both end where another table
// begins.
std::string without_rows(const std::string& text) {
  std::istringstream lines(text);
  std::string kept;
  bool in_rows = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("[")) in_rows = line == "[[expected]]" || line.starts_with("[reference");
    if (!in_rows) kept += line + "\n";
  }
  return kept;
}

// The sources that the rows of the file name.
std::set<std::string> sources_of(const std::string& text) {
  std::set<std::string> sources{"prototype"};
  const std::string key = "\nsource = \"";
  for (auto at = text.find(key); at != std::string::npos; at = text.find(key, at + 1)) {
    const auto begin = at + key.size();
    sources.insert(text.substr(begin, text.find('"', begin) - begin));
  }
  return sources;
}

// All texts of a page that are not part of its scripts, and the data that the scripts draw.
std::string words_of(std::string page) {
  for (auto begin = page.find("<script>"); begin != std::string::npos; begin = page.find("<script>", begin))
    page.erase(begin, page.find("</script>", begin) - begin);
  return page;
}

class OwnMachine : public Cli {
 protected:
  // "refused", or what the experiment printed as JSON.
  nlohmann::json json_of(const std::string& experiment, const std::string& machine) {
    fs::remove_all(work() / "page");
    const bool benches = experiment != "feed-cutting" && experiment != "frequency-response";
    const auto result = stiction(fmt::format("simulate {} --machine {} --out page --json{}", experiment, machine,
                                             benches ? " --friction all" : ""));
    if (result.code == 2) return "refused";
    EXPECT_EQ(result.code, 0) << experiment << ", " << machine << ": " << result.error;
    return nlohmann::json::parse(result.out);
  }
  std::string page() const { return content(work() / "page/report.html"); }
};

void expect_no_rows_of_a_circle(const nlohmann::json& json, const nlohmann::json& data, const std::string& run) {
  for (const auto& row : json["rows"])
    for (const char* key : {"measured", "published_simulation"}) EXPECT_FALSE(row.contains(key)) << run;
  EXPECT_TRUE(data["references"].empty()) << run;
}

void expect_no_figures_of_another(const nlohmann::json& json, const nlohmann::json& data, const std::string& run) {
  EXPECT_TRUE(json["expected"].empty()) << run << ": " << json["expected"].dump(2);
  EXPECT_TRUE(json["holds"].empty()) << run;
  for (const auto& figure : data["figures"]) {
    EXPECT_TRUE(figure["holds"].is_null()) << run << ": " << figure.dump();
    EXPECT_EQ(figure["source"], "") << run << ": " << figure.dump();
  }
  EXPECT_EQ(data["verdict"], "The machine file states no expected figures for this run.") << run;
}

TEST_F(OwnMachine, ShowsNothingOfTheMachineThatItWasMadeFrom) {
  for (const auto& shipped : machines) {
    const auto original = text_of_shipped(shipped.name);
    auto text = without_rows(original);
    const auto place = text.find(shipped.mass);
    ASSERT_NE(place, std::string::npos) << shipped.name;
    text.replace(place, std::string(shipped.mass).size(), shipped.other_mass);
    const auto file = work().parent_path() / "own.toml";
    std::ofstream(file) << text;
    std::size_t ran = 0;
    for (const std::string experiment : experiments) {
      const auto run = fmt::format("{} on a machine made from {}", experiment, shipped.name);
      const auto json = json_of(experiment, "'" + file.string() + "'");
      if (json == "refused") continue;
      ++ran;
      const auto shown = page();
      const auto data = host::data_of(shown);
      EXPECT_EQ(json["machine"], "own");
      experiment == "circle" && json.contains("rows") ? expect_no_rows_of_a_circle(json, data, run)
                                                      : expect_no_figures_of_another(json, data, run);
      const auto words = words_of(shown) + json.dump();
      for (const auto& source : sources_of(original)) EXPECT_EQ(words.find(source), std::string::npos) << run << source;
      for (const char* word : {"as expected", "measured value is", "published simulation gives", measured_points})
        EXPECT_EQ(words.find(word), std::string::npos) << run << ": " << word;
    }
    EXPECT_GE(ran, shipped.own[0] == nullptr ? 4u : 1u) << shipped.name;
  }
}

// The words that the test above looks for are on the pages of the shipped machines, or it could not fail.
TEST_F(OwnMachine, IsJudgedByWhatShippedMachinesShow) {
  for (const auto& shipped : machines)
    for (const char* experiment : shipped.own) {
      if (experiment == nullptr) continue;
      const auto json = json_of(experiment, shipped.name);
      EXPECT_FALSE(json["expected"].empty()) << experiment;
      const auto words = words_of(page());
      EXPECT_NE(words.find("as expected"), std::string::npos) << experiment;
      std::size_t found = 0;
      for (const auto& source : sources_of(text_of_shipped(shipped.name)))
        found += words.find(source) != std::string::npos;
      EXPECT_GT(found, 1u) << experiment;
    }
  const auto circle = json_of("circle", "mcfv5050ln");
  EXPECT_TRUE(circle["rows"][0].contains("measured"));
  EXPECT_FALSE(host::data_of(page())["references"].empty());
  const auto constant = json_of("constant-velocity", "mcfv5050ln");
  EXPECT_NE(words_of(page()).find(measured_points), std::string::npos);
}

}  // namespace
}  // namespace stiction::test
