// The Modbus server against independent clients (mbpoll, pymodbus) and against clients that do not behave.
#include <random>

#include "hal/modbus/server.hpp"
#include "hal/snapshot.hpp"
#include "tests/hal/modbus_support.hpp"
#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

std::unique_ptr<hal::ModbusServer> small_server(bool motion_allowed = false, const std::string& at = "127.0.0.1:0") {
  hal::ModbusServerConfig config;
  config.address = at;
  config.motion_allowed = motion_allowed;
  return std::make_unique<hal::ModbusServer>(hal::RegisterMap(small_registers()), config, small_values);
}

TEST(RegisterMap, HasTheHighWordFirst) {
  const hal::RegisterMap map(small_registers());
  std::vector<double> values(5);
  small_values(values);
  std::vector<std::uint16_t> input(map.size(hal::RegisterTable::input)), holding(map.size(hal::RegisterTable::holding));
  map.encode(values, input, holding);
  EXPECT_EQ(input, (std::vector<std::uint16_t>{1, 0, 0xff43, 0x9eb1}));
  EXPECT_EQ(holding[10], 0x40c8);
  EXPECT_EQ(holding[11], 0x0000);
}

TEST(RegisterMap, HoldsWhatATypeCannotAtItsEnds) {
  std::array<std::uint16_t, 2> words{};
  hal::put_words(hal::RegisterType::int32, 1e12, words);
  EXPECT_EQ(hal::number_in(hal::RegisterType::int32, words), 2147483647.0);
  hal::put_words(hal::RegisterType::uint16, -3.0, words);
  EXPECT_EQ(hal::number_in(hal::RegisterType::uint16, words), 0.0);
  hal::put_words(hal::RegisterType::int16, -3.0, words);
  EXPECT_EQ(hal::number_in(hal::RegisterType::int16, words), -3.0);
  hal::put_words(hal::RegisterType::float32, 1e300, words);
  EXPECT_EQ(hal::number_in(hal::RegisterType::float32, words), std::numeric_limits<float>::max());
}

TEST(RegisterMap, RefusesRegistersThatOverlap) {
  auto registers = small_registers();
  registers[2].address = 11;
  EXPECT_THROW(hal::RegisterMap{registers}, std::invalid_argument);
}

TEST(RegisterMap, TakesWritesWholeAndWithinTheirRights) {
  const hal::RegisterMap map(small_registers());
  const auto refusal = [&](std::size_t address, const std::vector<std::uint16_t>& words, bool motion = false) {
    const auto result = map.writes_of(address, words, motion);
    const auto* exception = std::get_if<hal::ModbusException>(&result);
    return exception == nullptr ? 0 : static_cast<int>(*exception);
  };
  EXPECT_EQ(refusal(0, {7}), 0);
  EXPECT_EQ(refusal(10, {0x40c8, 0}), 0);
  EXPECT_EQ(refusal(10, {0x40c8}), 3);     // half of a value
  EXPECT_EQ(refusal(11, {0}), 3);          // the other half
  EXPECT_EQ(refusal(10, {0, 0}), 3);       // 0 where more is expected
  EXPECT_EQ(refusal(10, {0x42c9, 0}), 3);  // 100.5
  EXPECT_EQ(refusal(10, {0x7fc0, 0}), 3);  // not a number
  EXPECT_EQ(refusal(1, {0}), 2);           // no register
  EXPECT_EQ(refusal(0, {7, 7}), 2);        // the second one
  EXPECT_EQ(refusal(65535, {0, 0}), 2);
  EXPECT_EQ(refusal(20, {1}), 1);  // motion
  EXPECT_EQ(refusal(20, {1}, true), 0);
}

TEST(WriteQueue, TakesARequestWholeOrNotAtAll) {
  hal::WriteQueue queue;
  const std::vector<hal::RegisterWrite> writes(100, {1, 2.0});
  EXPECT_TRUE(queue.push(writes));
  EXPECT_TRUE(queue.push(writes));
  EXPECT_FALSE(queue.push(writes));
  for (int i = 0; i < 200; ++i) EXPECT_TRUE(queue.take());
  EXPECT_FALSE(queue.take());
}

// Writer and reader at full speed: every state seen is one that was written whole, and none comes back.
TEST(Snapshot, IsNeverSeenHalfWrittenNorOlderThanBefore) {
  using State = std::array<std::uint64_t, 64>;
  hal::Snapshot<State> snapshot;
  std::atomic<bool> done{false};
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= 200'000; ++i) {
      snapshot.next().fill(i);
      snapshot.publish();
    }
    done = true;
  });
  std::uint64_t last = 0, torn = 0, backwards = 0;
  bool finished = false;
  do {
    finished = done;
    const State& state = snapshot.latest();
    torn += state.front() != state.back() ? 1 : 0;
    backwards += state.front() < last ? 1 : 0;
    last = state.front();
  } while (!finished);
  writer.join();
  EXPECT_EQ(torn, 0U);
  EXPECT_EQ(backwards, 0U);
  EXPECT_EQ(last, 200'000U);
}

TEST(ModbusServer, IsReadByMbpollOverTcp) {
  if (!has_mbpoll()) GTEST_SKIP() << "mbpoll is not installed";
  const auto server = small_server();
  const std::string mbpoll = "mbpoll -0 -1 -B -p " + std::to_string(server->port());
  EXPECT_NE(output_of(mbpoll + " -t 3 -r 0 127.0.0.1").find("[0]: \t1\n"), std::string::npos);
  EXPECT_NE(output_of(mbpoll + " -t 3:int -r 2 127.0.0.1").find("[2]: \t-12345679\n"), std::string::npos);
  EXPECT_NE(output_of(mbpoll + " -t 4:float -r 10 127.0.0.1").find("[10]: \t6.25\n"), std::string::npos);
}

TEST(ModbusServer, IsReadByMbpollOverASerialLine) {
  if (!has_mbpoll()) GTEST_SKIP() << "mbpoll is not installed";
  const SerialPair line;
  const auto server = small_server(false, line.name(0));
  const std::string mbpoll = "mbpoll -0 -1 -B -m rtu -b 115200 -o 5 ";
  EXPECT_NE(output_of(mbpoll + "-t 3:int -r 2 " + line.name(1)).find("[2]: \t-12345679\n"), std::string::npos);
  EXPECT_NE(output_of(mbpoll + "-t 4:float -r 10 " + line.name(1)).find("[10]: \t6.25\n"), std::string::npos);
}

constexpr const char* operations =
    "input:0:4 holding:10:2 input:4:1 write:0:9 write:20:1 write:10:16712,0 write:10:0,0 write:10:16712 write:5:1 "
    "both:0:7:10:2 both:20:1:10:2";
constexpr const char* answers =
    "1 0 65347 40625\n16584 0\nexception 2\ndone\nexception 1\ndone\nexception 3\nexception 3\nexception 2\n16584 0\n"
    "exception 1\n";

void expect_written(hal::ModbusServer& server) {
  for (const auto& [index, value] : {std::pair{2, 9.0}, {3, 12.5}, {2, 7.0}}) {
    const auto write = server.take_write();
    ASSERT_TRUE(write);
    EXPECT_EQ(write->index, static_cast<std::size_t>(index));
    EXPECT_EQ(write->value, value);
  }
  EXPECT_FALSE(server.take_write());
}

TEST(ModbusServer, IsReadAndWrittenByPymodbusOverTcp) {
  if (!has_pymodbus()) GTEST_SKIP() << "python3-pymodbus is not installed";
  const auto server = small_server();
  EXPECT_EQ(output_of(pymodbus("client tcp " + std::to_string(server->port()) + " " + operations)), answers);
  expect_written(*server);
}

TEST(ModbusServer, IsReadAndWrittenByPymodbusOverASerialLine) {
  if (!has_pymodbus()) GTEST_SKIP() << "python3-pymodbus is not installed";
  const SerialPair line;
  const auto server = small_server(false, line.name(0));
  EXPECT_EQ(output_of(pymodbus("client rtu " + line.name(1) + " " + operations)), answers);
  expect_written(*server);
}

TEST(ModbusServer, TakesMotionOnlyWhereItIsAllowed) {
  const auto write = request({6, 0, 20, 0, 1});
  for (const bool allowed : {false, true}) {
    const auto server = small_server(allowed);
    const RawClient client(server->port());
    client.send(write);
    const auto answer = client.receive();
    ASSERT_EQ(answer.size(), allowed ? 12U : 9U);
    EXPECT_EQ(answer[7], allowed ? 6 : 0x86);
    if (!allowed) {
      EXPECT_EQ(answer[8], 1);
    }
    EXPECT_EQ(server->take_write().has_value(), allowed);
  }
}

TEST(ModbusServer, RefusesFunctionsItDoesNotHaveAndRequestsOfAnotherLength) {
  const auto server = small_server();
  const RawClient client(server->port());
  const auto exception_of = [&](std::vector<std::uint8_t> pdu) {
    client.send(request(std::move(pdu)));
    const auto answer = client.receive();
    return answer.size() == 9 ? static_cast<int>(answer[8]) : 0;
  };
  EXPECT_EQ(exception_of({1, 0, 0, 0, 1}), 1);                          // coils
  EXPECT_EQ(exception_of({7}), 1);                                      // exception status
  EXPECT_EQ(exception_of({22, 0, 0, 0, 0, 0, 0}), 1);                   // mask write
  EXPECT_EQ(exception_of({4, 0, 0, 0}), 3);                             // too short
  EXPECT_EQ(exception_of({4, 0, 0, 0, 1, 0}), 3);                       // too long
  EXPECT_EQ(exception_of({16, 0, 0, 0, 2, 2, 0, 1}), 3);                // two registers in two bytes
  EXPECT_EQ(exception_of({23, 0, 10, 0, 99, 0, 0, 0, 1, 2, 0, 1}), 2);  // reads beyond the end: nothing is written
  EXPECT_EQ(exception_of({4, 0, 0, 0, 0}), 3);
  EXPECT_EQ(exception_of({4, 0, 0, 0, 126}), 3);
  EXPECT_FALSE(server->take_write());
}

TEST(ModbusServer, ClosesAConnectionThatSpeaksSomethingElse) {
  const auto server = small_server();
  const RawClient client(server->port());
  const std::string text = "GET / HTTP/1.1\r\n\r\n";
  client.send({text.begin(), text.end()});
  EXPECT_TRUE(client.receive().empty());
  EXPECT_EQ(server->counts().dropped, 1U);
}

// One client sends a byte now and then, one asks and never reads, one says nothing: a fourth is served all the same.
TEST(ModbusServer, ServesOthersBesideSlowClients) {
  const auto server = small_server();
  const auto read = request({4, 0, 0, 0, 4});
  const RawClient slow(server->port()), deaf(server->port()), mute(server->port()), good(server->port());
  ::fcntl(deaf.descriptor(), F_SETFL, O_NONBLOCK);
  for (int i = 0; i < 20'000; ++i) deaf.send(read);
  for (const std::uint8_t byte : read) {
    slow.send({byte});
    good.send(read);
    EXPECT_EQ(good.receive().size(), 17U);
  }
  EXPECT_EQ(slow.receive().size(), 17U);
}

TEST(ModbusServer, ServesManyClientsAndTurnsAFurtherOneAway) {
  const auto server = small_server();
  std::vector<std::unique_ptr<RawClient>> clients;
  const auto read = request({4, 0, 0, 0, 4});
  for (int i = 0; i < 32; ++i) clients.push_back(std::make_unique<RawClient>(server->port()));
  int served = 0;
  for (int round = 0; round < 20; ++round)
    for (const auto& client : clients) {
      client->send(read);
      served += client->receive().size() == 17 ? 1 : 0;
    }
  EXPECT_EQ(served, 640);
  const RawClient further(server->port());
  EXPECT_TRUE(further.receive().empty());
  for (const auto& client : clients) {
    client->send(read);
    EXPECT_EQ(client->receive().size(), 17U);
  }
  figure("Modbus server: requests of 32 clients beside a further one",
         fmt::format("{} of 672 answered, {} connection turned away (bound: all, 1)", server->counts().requests,
                     server->counts().dropped));
  EXPECT_EQ(server->counts().requests, 672U);
  // A place that is given back is had by the next one.
  clients.pop_back();
  EXPECT_TRUE(comes_true([&] {
    const RawClient next(server->port());
    next.send(read);
    return next.receive().size() == 17U;
  }));
}

TEST(ModbusServer, LivesThroughNoiseOnEitherTransport) {
  std::mt19937 random(3);
  const auto noise = [&](std::size_t size) {
    std::vector<std::uint8_t> bytes(size);
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
    return bytes;
  };
  const auto server = small_server();
  for (int i = 0; i < 50; ++i) RawClient(server->port()).send(noise(1 + random() % 600));
  const RawClient client(server->port());
  client.send(request({4, 0, 0, 0, 4}));
  EXPECT_EQ(client.receive().size(), 17U);

  const SerialPair line;
  const auto serial = small_server(false, line.name(0));
  const int far = ::open(line.name(1).c_str(), O_RDWR | O_NOCTTY);
  for (int i = 0; i < 5; ++i) {
    const auto bytes = noise(100 + random() % 400);
    ASSERT_EQ(::write(far, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }
  const std::uint64_t before = serial->counts().dropped;
  EXPECT_TRUE(comes_true([&] { return serial->counts().dropped > before; }));
  // Silence ends whatever that was; then a request as ever.
  const std::vector<std::uint8_t> read{1, 4, 0, 0, 0, 4, 0xf1, 0xc9};
  ASSERT_EQ(hal::modbus_crc(std::span(read).first(6)), 0xc9f1);
  EXPECT_TRUE(comes_true([&] {
    if (::write(far, read.data(), read.size()) != 8) return false;
    pollfd polled{far, POLLIN, 0};
    return ::poll(&polled, 1, 300) > 0;
  }));
  ::close(far);
}

std::string refusal_of(const std::string& address, int baud_rate = 115200) {
  hal::ModbusServerConfig config;
  config.address = address;
  config.baud_rate = baud_rate;
  try {
    const hal::ModbusServer server(hal::RegisterMap(small_registers()), config, small_values);
  } catch (const hal::ModbusError& error) {
    return error.what();
  }
  return "started";
}

TEST(ModbusServer, SaysWhyItCannotStart) {
  const auto first = small_server();
  const std::string taken = "127.0.0.1:" + std::to_string(first->port());
  EXPECT_EQ(
      refusal_of(taken),
      taken + ": cannot listen: Address already in use; a different programme listens there; choose a different port");
  EXPECT_EQ(
      refusal_of("192.0.2.1:1502"),
      "192.0.2.1:1502: cannot listen: Cannot assign requested address; no interface of this computer has that address");
  EXPECT_EQ(refusal_of("nowhere"), "found \"nowhere\"; expected HOST:PORT, such as 127.0.0.1:502");
  EXPECT_EQ(refusal_of("/dev/nowhere"),
            "/dev/nowhere: cannot be opened: No such file or directory; is it plugged in, "
            "and is the name right?");
  EXPECT_EQ(refusal_of("/dev/null", 123456),
            "/dev/null: found a rate of 123456 bit/s; expected a rate of serial lines, such as 115200");
}

}  // namespace
}  // namespace stiction::test
