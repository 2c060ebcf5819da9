// A log of any size streams through: what it takes of memory, and that a person sees how far it is.
// STICTION_LARGE_LOG_MB sets the size of the file (200 for the figure of docs/formats.md).
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "host/log/text_file.hpp"
#include "tests/support/figure.hpp"

namespace stiction::host {
namespace {

namespace fs = std::filesystem;

class LargeLog : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / fmt::format("stiction-large-{}", ::getpid());
    fs::create_directories(folder_);
    if (const char* wanted = std::getenv("STICTION_LARGE_LOG_MB")) megabytes_ = std::strtoul(wanted, nullptr, 10);
    std::ofstream out(folder_ / "run.csv");
    out << "t[s],x_set[m],x[m],i[A]\n";
    for (std::size_t k = 0, size = 0; size < megabytes_ << 20; ++k) {
      const double t = static_cast<double>(k) * 1e-3, x = 0.1 * std::sin(0.7 * t);
      const auto row = fmt::format("{:.3f},{:.9f},{:.9f},{:.5f}\n", t, x, x - 1e-6 * std::cos(t), std::cos(3.0 * t));
      out << row;
      size += row.size();
    }
  }
  void TearDown() override { fs::remove_all(folder_); }

  int run(const std::string& command) const {
    return WEXITSTATUS(std::system(fmt::format("cd '{}' && {}", folder_.string(), command).c_str()));
  }

  fs::path folder_;
  std::size_t megabytes_ = 32;
};

TEST_F(LargeLog, IsConvertedAndInspectedInBoundedMemoryWithProgress) {
  ASSERT_EQ(run("'" STICTION_PROGRAM "' convert run.csv again.csv >out 2>error"), 0);
  ASSERT_EQ(run("'" STICTION_PROGRAM "' inspect run.csv >out 2>error"), 0);
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);  // the largest of them
  const double resident = static_cast<double>(usage.ru_maxrss) / 1024.0;
  test::figure(fmt::format("convert and inspect a CSV log of {} MB", megabytes_), fmt::format("{:.0f} MiB", resident));
  // 1 GiB for 200 MB: its numbers, and what inspecting derives from them. 48 MiB are the program's own.
  EXPECT_LT(resident, 48.0 + 4.9 * static_cast<double>(megabytes_));
  // The numbers are those written, and a second conversion changes none.
  ASSERT_EQ(run("'" STICTION_PROGRAM "' convert again.csv third.csv >out 2>error && cmp again.csv third.csv"), 0);
}

// The line appears after a second: the program stands still for most of its time, as on a slow disk, however fast or
// busy the computer is.
TEST_F(LargeLog, ShowsHowMuchOfItWasRead) {
  const std::string slowed = "'" STICTION_PROGRAM
                             "' convert run.csv again.csv & p=$!; while kill -STOP $p; do sleep 0.3; kill -CONT $p; "
                             "sleep 0.04; done; wait $p\n";
  write_text_file(folder_ / "slowed", slowed);
  ASSERT_EQ(run("script -qec \"sh ./slowed\" typescript </dev/null >/dev/null"), 0);
  const auto shown = read_text_file(folder_ / "typescript");
  EXPECT_NE(shown.find(fmt::format(" of {}, ", megabytes_ + 1)), std::string::npos) << shown;
  EXPECT_NE(shown.find("reading MiB of run.csv ["), std::string::npos) << shown;
}

}  // namespace
}  // namespace stiction::host
