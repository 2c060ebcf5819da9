// The drive in logical time with a server of its nodes' objects before it, and a client from the standard's text.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "firmware/stictiond/modbus_motion.hpp"
#include "firmware/stictiond/object_server.hpp"
#include "firmware/stictiond/run.hpp"
#include "tests/firmware/stictiond/served_table.hpp"
#include "tests/hal/sdo_client.hpp"

namespace stiction::test {

class Objects : public ::testing::Test {
 protected:
  explicit Objects(const std::vector<std::string>& settings = {}, bool allowed = true, const ServedTable::Cam& cam = {})
      : folder(std::filesystem::temp_directory_path() / ("stiction-objects-" + std::to_string(::getpid()))),
        table(settings, allowed, cam) {
    std::filesystem::create_directories(folder);
    make({.file = folder / "parameters"});
  }
  ~Objects() override { std::filesystem::remove_all(folder); }

  void make(drive::KeptParameters kept) {
    desk =
        std::make_shared<drive::ParameterDesk>(table.configuration.machine, table.configuration.setup, std::move(kept));
    server = std::make_unique<drive::ObjectServer>(table.configuration, drive::can_server_config(table.configuration),
                                                   desk, table.frames.links(), [this] { return is_stale; });
  }
  // As the drive's loop does.
  void cycles(int count) {
    for (int i = 0; i < count; ++i) {
      server->loop().take_motion([&](const drive::MotionWrite& write) {
        drive::ask(write, period(), table.programme.remote()[write.axis], CommandSource::can);
      });
      table.cycle();
      table.frames.node(0).step(table.loop.now_ns(), table.loop.fault(0), [](const hal::can::Frame&) {});
      drive::show_to_clients(table.loop, table.programme, period(), *server);
    }
  }
  double period() const { return table.configuration.machine.timing.fast_period; }
  std::string said() {
    std::string lines;
    for (const auto& line : desk->said().take(now_ns += 2'000'000'000)) lines += line + "\n";
    return lines;
  }
  // In csp an axis wants a target each cycle, which SDO does not give.
  bool enable() {
    EXPECT_EQ(client.set(0x6060, 0, 1, 1), 0u);
    for (const int word : {6, 7, 15}) {
      EXPECT_EQ(client.set(0x6040, 0, word, 2), 0u);
      cycles(20);
    }
    return (client.number(0x6041) & 0x6f) == 0x27;
  }

  std::filesystem::path folder;
  bool is_stale = false;
  std::int64_t now_ns = 0;
  ServedTable table;
  std::shared_ptr<drive::ParameterDesk> desk;
  std::unique_ptr<drive::ObjectServer> server;
  SdoClient client{1, [this](const hal::can::Frame& frame) { return server->answer(frame, now_ns); }};
};

}  // namespace stiction::test
