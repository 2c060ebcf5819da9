// The scripts of `stiction completion`, asked as the shells ask them.
#include "tests/host/cli/program.hpp"

namespace stiction::test {
namespace {

class Completion : public Cli {
 protected:
  // What bash offers for the last of `words`, a line's words as bash splits them, sorted.
  std::string offered(const std::string& words) {
    const auto result = run_shell(
        "export PATH=\"$(dirname '{}'):$PATH\"; bash -uc 'source <(stiction completion bash); "
        "COMP_WORDS=(stiction " +
        words +
        "); COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); _stiction; printf \"%s\\n\" \"${{COMPREPLY[@]}}\" | sort | tr "
        "\"\\n\" \" \"'");
    EXPECT_EQ(result.error, "") << words;
    return result.out;
  }
};

TEST_F(Completion, BashCompletesCommandsAndOptions) {
  EXPECT_EQ(offered("si"), "simulate ");
  EXPECT_EQ(offered("simulate c"), "cam circle commissioning constant-velocity ");
  EXPECT_EQ(offered("machine \"\""), "check list new reference ");
  EXPECT_EQ(offered("simulate circle --ma"), "--machine ");
  EXPECT_EQ(offered("simulate impact --dir"), " ") << "an option of a different experiment";
}

TEST_F(Completion, BashCompletesTheValuesOfOptions) {
  EXPECT_EQ(offered("simulate circle --machine m"), "mcfv5050ln ");
  EXPECT_EQ(offered("simulate circle --machine = m"), "mcfv5050ln ") << "--machine=m";
  EXPECT_EQ(offered("simulate circle --friction lu"), "lugre ");
  EXPECT_EQ(offered("simulate circle --friction lugre,cl"), "lugre,classical ");
  EXPECT_EQ(offered("simulate circle --signals \"\""), "double fixed ");
  EXPECT_EQ(offered("simulate frequency-response --machine mcfv5050ln --axis \"\""), "X Y ");
  EXPECT_EQ(offered("compare --reference c"), "circle ");
  EXPECT_EQ(offered("machine check e"), "emps ");
  EXPECT_EQ(offered("simulate circle --feed \"\""), " ") << "nothing is known of a feed";
}

TEST_F(Completion, BashCompletesFilesAndFolders) {
  std::ofstream(work() / "run 1.csv") << "";
  std::ofstream(work() / "mine.toml") << "";
  fs::create_directories(work() / "results");
  EXPECT_EQ(offered("inspect run"), "run 1.csv ");
  EXPECT_EQ(offered("simulate circle --out r"), "results ");
  EXPECT_EQ(offered("simulate circle --machine mi"), "mine.toml ");
}

TEST_F(Completion, EveryCommandAndOptionIsInTheScripts) {
  const auto script = stiction("completion bash").out;
  for (const char* option : {"--machine", "--compensation", "--holdout", "--refine", "--no-pulse", "--axes"})
    EXPECT_NE(script.find(option), std::string::npos) << option;
  EXPECT_EQ(script.find('@' + std::string("COMMANDS")), std::string::npos);
}

TEST_F(Completion, TheScriptForZshIsValidAndOffersTheSame) {
  if (std::system("command -v zsh >/dev/null") != 0) GTEST_SKIP() << "zsh is not installed";
  ASSERT_EQ(stiction("completion zsh > _stiction").code, 0);
  const auto syntax = run_shell("zsh -n _stiction");
  EXPECT_EQ(syntax.code, 0) << syntax.error;
  // The functions of zsh's completion answer only to its line editor; these say what they are asked.
  const auto asked = run_shell(
      "export PATH=\"$(dirname '{}'):$PATH\"; zsh -fc 'compdef() {{ }}; compset() {{ }}; _describe() {{ print -l "
      "${{(P)2}}; }}; compadd() {{ print -l ${{(P)2}}; }}; source ./_stiction; words=(stiction simulate \"\"); "
      "CURRENT=3; _stiction; words=(stiction simulate frequency-response --machine mcfv5050ln --axis \"\"); CURRENT=7; "
      "_stiction'");
  EXPECT_NE(asked.out.find("circle:Circle of two axes"), std::string::npos) << asked.out << asked.error;
  EXPECT_NE(asked.out.find("X\nY\n"), std::string::npos) << asked.out << asked.error;
}

}  // namespace
}  // namespace stiction::test
