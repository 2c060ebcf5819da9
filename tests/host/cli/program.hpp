// The program as its users call it, in a folder of its own.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

namespace stiction::test {

namespace fs = std::filesystem;

inline std::string content(const fs::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

struct Outcome {
  int code;
  std::string out, error;
};

class Cli : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / fmt::format("stiction-cli-{}", ::getpid());
    fs::create_directories(folder_ / "work");
  }
  void TearDown() override { fs::remove_all(folder_); }

  // Runs `stiction ARGUMENTS` in an empty folder.
  Outcome stiction(const std::string& arguments) { return run("'" STICTION_PROGRAM "' " + arguments); }
  // Runs a line of the shell there, in which {} is the program.
  Outcome run_shell(const std::string& line) { return run(fmt::format(fmt::runtime(line), STICTION_PROGRAM)); }
  // Before a command: a user whom permissions hold, which they do not hold root.
  static std::string as_nobody() {
    return ::getuid() == 0 ? "setpriv --reuid 65534 --regid 65534 --clear-groups " : "";
  }
  fs::path work() const { return folder_ / "work"; }
  bool nothing_written() const { return fs::is_empty(work()); }

  // The shipped machine with one piece of text replaced; next to the working folder.
  std::string machine_with(const std::string& from, const std::string& to) {
    auto text = content(fs::path(STICTION_SOURCE_DIR) / "firmware/machine/shipped/mcfv5050ln.toml");
    const auto place = text.find(from);
    EXPECT_NE(place, std::string::npos) << from;
    text.replace(place, from.size(), to);
    const auto file = folder_ / "m.toml";
    std::ofstream(file) << text;
    return "'" + file.string() + "'";
  }

  // The shipped machine without the text from `begin` up to `end`, which stays.
  std::string machine_without(const std::string& begin, const std::string& end) {
    const auto text = content(fs::path(STICTION_SOURCE_DIR) / "firmware/machine/shipped/mcfv5050ln.toml");
    const auto from = text.find(begin), to = text.find(end, from);
    EXPECT_NE(to, std::string::npos) << begin << ", " << end;
    return machine_with(text.substr(from, to - from), "");
  }

  // The shipped machine with its first axis alone.
  std::string machine_of_one_axis() {
    std::istringstream lines(content(fs::path(STICTION_SOURCE_DIR) / "firmware/machine/shipped/mcfv5050ln.toml"));
    std::string text, row;
    bool other_axis = false;
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("# Tab 6.1") || line.starts_with("[drive.can]")) other_axis = false;
      if (line == "[axis.Y]" || line == "[drive.axis.Y]") other_axis = true;
      if (other_axis || (line.starts_with("  {") && line.find("axis = \"Y\"") != std::string::npos)) continue;
      // A row [[expected]] goes as a whole.
      if (line == "[[expected]]" || !row.empty()) {
        row += line + "\n";
        if (!line.empty()) continue;
        if (row.find("axis = \"Y\"") == std::string::npos) text += row;
        row.clear();
        continue;
      }
      text += line + "\n";
    }
    const auto file = folder_ / "one.toml";
    std::ofstream(file) << text << (row.find("axis = \"Y\"") == std::string::npos ? row : "");
    return "'" + file.string() + "'";
  }

  // Bad input: exit 2, the message on standard error only, nothing written.
  void expect_refused(const std::string& arguments, const std::string& message) {
    const auto result = stiction(arguments);
    EXPECT_EQ(result.code, 2) << arguments;
    EXPECT_NE(result.error.find(message), std::string::npos) << arguments << "\n" << result.error;
    EXPECT_EQ(result.out, "") << arguments;
    EXPECT_TRUE(nothing_written()) << arguments;
  }

 private:
  Outcome run(const std::string& line) {
    const auto out = folder_ / "out", error = folder_ / "error";
    const std::string command =
        fmt::format("cd '{}' && {{ {}; }} >'{}' 2>'{}'", work().string(), line, out.string(), error.string());
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content(out), content(error)};
  }

  fs::path folder_;
};

}  // namespace stiction::test
