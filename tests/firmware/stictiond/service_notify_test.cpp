// The service manager's side is a datagram socket that the test reads.
#include "firmware/stictiond/service_notify.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "firmware/stictiond/service_thread.hpp"

namespace stiction::test {
namespace {

constexpr std::int64_t ms = 1'000'000;

class Manager : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / fmt::format("stiction-notify-{}", ::getpid());
    std::filesystem::create_directories(folder_);
    const std::string path = (folder_ / "socket").string();
    socket_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    ASSERT_GE(socket_, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    ASSERT_LT(path.size(), sizeof address.sun_path);
    path.copy(address.sun_path, path.size());
    ASSERT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    ::setenv("NOTIFY_SOCKET", path.c_str(), 1);
    ::setenv("WATCHDOG_USEC", "200000", 1);
    ::unsetenv("WATCHDOG_PID");
  }

  void TearDown() override {
    for (const char* name : {"NOTIFY_SOCKET", "WATCHDOG_USEC"}) ::unsetenv(name);
    ::close(socket_);
    std::filesystem::remove_all(folder_);
  }

  // What has come since the last call, a message an element. The kernel keeps ten; who sends more waits.
  std::vector<std::string> received() const {
    std::vector<std::string> messages;
    std::array<char, 512> buffer;
    for (;;) {
      const auto length = ::recv(socket_, buffer.data(), buffer.size(), MSG_DONTWAIT);
      if (length < 0) return messages;
      messages.emplace_back(buffer.data(), static_cast<std::size_t>(length));
    }
  }

 private:
  std::filesystem::path folder_;
  int socket_ = -1;
};

using Messages = std::vector<std::string>;

TEST_F(Manager, HearsNothingBeforeTheDriveIsReadyThenEachChangeInOneLine) {
  drive::ServiceNotify notify;
  EXPECT_EQ(received(), Messages{});
  notify.ready("2 axes at 62.5 us");
  notify.status("moving\nWATCHDOG=1");  // a line break must not become an assignment
  notify.stopping("told to stop");
  EXPECT_EQ(received(), (Messages{"READY=1\nSTATUS=2 axes at 62.5 us", "STATUS=moving WATCHDOG=1",
                                  "STOPPING=1\nSTATUS=told to stop"}));
}

TEST_F(Manager, IsFedAtMostFourTimesInItsTimeWhileTheLoopMovesOn) {
  drive::ServiceNotify notify;
  ASSERT_EQ(notify.watchdog_ns(), 200 * ms);
  int fed = 0;
  for (std::int64_t t = 0; t < 2000; t += 20) {
    const bool told = notify.feed(static_cast<std::uint64_t>(t), t * ms);
    EXPECT_EQ(received(), told ? Messages{"WATCHDOG=1"} : Messages{});
    fed += told;
  }
  EXPECT_EQ(fed, 34);  // every 60 ms: the first multiple of 20 ms from 50 on
}

TEST_F(Manager, IsNotFedWhenTheLoopStandsStill) {
  drive::ServiceNotify notify;
  EXPECT_TRUE(notify.feed(7, 0));
  for (std::int64_t t = 20; t < 1000; t += 20) EXPECT_FALSE(notify.feed(7, t * ms));
  EXPECT_TRUE(notify.feed(8, 1000 * ms));
  EXPECT_EQ(received(), Messages(2, "WATCHDOG=1"));
}

TEST(ServiceNotify, DoesNothingWithoutAManager) {
  drive::ServiceNotify notify;
  EXPECT_FALSE(notify.watchdog_ns());
  notify.ready("nobody hears");
  EXPECT_FALSE(notify.feed(1, 1));
}

TEST(ProgressWatch, IsStarvedOnceTheCounterStoodStillLongerThanTheLimit) {
  drive::ProgressWatch watch(100 * ms);
  EXPECT_FALSE(watch.moved(5, 0));
  EXPECT_TRUE(watch.moved(6, 10 * ms));
  EXPECT_FALSE(watch.moved(6, 110 * ms));
  EXPECT_FALSE(watch.starved());
  EXPECT_FALSE(watch.moved(6, 110 * ms + 1));
  EXPECT_TRUE(watch.starved());
  EXPECT_TRUE(watch.moved(7, 120 * ms));
  EXPECT_FALSE(watch.starved());
}

struct Service {
  std::unique_ptr<drive::LogRing> ring = std::make_unique<drive::LogRing>();
  std::vector<std::string> said;
  std::atomic<std::uint64_t> ticks = 0;
  int starved = 0;
  drive::LogSink sink = [this](drive::LogLevel, std::string_view text) { said.emplace_back(text); };
  drive::ServiceQuestions questions{[this] { return ticks.load(); }, [] { return std::string("running"); },
                                    [this] { ++starved; }};
};

TEST_F(Manager, IsToldTheStateOnceASecondAndTheStarvedLoopIsReportedOnce) {
  drive::ServiceNotify notify;
  Service service;
  drive::ServiceThread::Round round(*service.ring, service.sink, notify, service.questions, 100 * ms);
  constexpr std::int64_t start = 100'000 * ms;
  Messages running;
  for (std::int64_t t = 0; t <= 1000; t += 20) {
    ++service.ticks;
    round(start + t * ms);
    for (auto& message : received()) running.push_back(std::move(message));
  }
  EXPECT_EQ(std::count(running.begin(), running.end(), "STATUS=running"), 2);
  EXPECT_EQ(std::count(running.begin(), running.end(), "WATCHDOG=1"), 17);
  EXPECT_EQ(service.starved, 0);
  for (std::int64_t t = 1020; t < 1900; t += 20) round(start + t * ms);
  EXPECT_EQ(received(), Messages{"WATCHDOG=1"});  // for the ticks since it was told last
  EXPECT_EQ(service.starved, 1);                  // by the drive's own 100 ms
}

TEST_F(Manager, HearsOfTheLoopFromItsThreadAndTheLastMessagesAreSaid) {
  drive::ServiceNotify notify;
  Service service;
  {
    drive::ServiceThread thread(*service.ring, service.sink, notify, service.questions, 1000 * ms);
    // However slow the machine: until it has been heard.
    Messages messages;
    while (std::count(messages.begin(), messages.end(), "WATCHDOG=1") < 3) {
      ++service.ticks;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      for (auto& message : received()) messages.push_back(std::move(message));
    }
    service.ring->push(0, drive::LogLevel::info, "last words");
  }
  ASSERT_FALSE(service.said.empty());
  EXPECT_EQ(service.said.back(), "0.000000 s: last words");
}

}  // namespace
}  // namespace stiction::test
