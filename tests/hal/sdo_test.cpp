// The server of objects against a client that is written from the standard (CiA 301, 7.2.4).
#include "hal/can/sdo.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <string>

#include "tests/hal/sdo_client.hpp"

namespace stiction::test {
namespace {

using hal::can::Frame, hal::can::ObjectAddress, hal::can::SdoAbort, hal::can::SdoServer, hal::can::SdoWritten;

// Objects of any size; 2000h can be written, and what is written to 2001h ends later.
class SomeObjects : public hal::can::ServedObjects {
 public:
  std::variant<std::vector<std::uint8_t>, SdoAbort> read(ObjectAddress address) override {
    const auto found = values.find({address.index, address.sub});
    if (found == values.end()) return address.index == 0x2000 ? SdoAbort::no_sub_index : SdoAbort::no_object;
    return found->second;
  }
  SdoAbort write_rejection(ObjectAddress address) override {
    return address.index == 0x2000 || address.index == 0x2001 ? SdoAbort::none : SdoAbort::read_only;
  }
  SdoWritten write(ObjectAddress address, std::span<const std::uint8_t> bytes, bool exact) override {
    was_exact = exact;
    values[{address.index, address.sub}].assign(bytes.begin(), bytes.end());
    if (address.index == 0x2001) return {.put_off = 7};
    return {};
  }
  std::optional<SdoWritten> outcome(std::uint64_t ticket) override {
    EXPECT_EQ(ticket, 7u);
    return ends;
  }

  std::map<std::pair<unsigned, unsigned>, std::vector<std::uint8_t>> values;
  std::optional<SdoWritten> ends;
  bool was_exact = false;
};

class Sdo : public ::testing::Test {
 protected:
  SomeObjects objects;
  SdoServer server{5, objects};
  std::int64_t now_ns = 0;
  SdoClient client{5, [this](const Frame& frame) { return server.answer(frame, now_ns); }};
};

TEST_F(Sdo, ReadsValuesOfEverySizeAsTheyAre) {
  for (std::size_t size = 0; size <= 40; ++size) {
    SdoClient::Bytes bytes;
    for (std::size_t i = 0; i < size; ++i) bytes.push_back(static_cast<std::uint8_t>(17 * i + size));
    objects.values[{0x2002, 3}] = bytes;
    const auto found = client.upload(0x2002, 3);
    ASSERT_TRUE(std::holds_alternative<SdoClient::Bytes>(found)) << size;
    EXPECT_EQ(std::get<SdoClient::Bytes>(found), bytes);
  }
}

// CiA 301, figure of the expedited transfer: command bytes 4Fh, 4Bh, 47h, 43h for one to four bytes.
TEST_F(Sdo, AnswersUpToFourBytesAtOnce) {
  for (const int size : {1, 2, 3, 4}) {
    objects.values[{0x2002, 0}] = SdoClient::Bytes(static_cast<std::size_t>(size), 0xab);
    const auto answer = client.raw({0x40, 0x02, 0x20, 0});
    ASSERT_TRUE(answer);
    EXPECT_EQ((*answer)[0], 0x53 - 4 * size);
  }
}

TEST_F(Sdo, TakesValuesExpeditedAndInSegments) {
  for (std::size_t size = 1; size <= 8; ++size) {
    SdoClient::Bytes bytes;
    for (std::size_t i = 0; i < size; ++i) bytes.push_back(static_cast<std::uint8_t>(31 * i + size));
    for (const bool sized : {true, false}) {
      EXPECT_EQ(client.download_segmented(0x2000, 1, bytes, sized), 0u);
      EXPECT_EQ((objects.values[{0x2000, 1}]), bytes);
    }
    if (size > 4) continue;
    EXPECT_EQ(client.download(0x2000, 2, bytes), 0u);
    EXPECT_EQ((objects.values[{0x2000, 2}]), bytes);
    EXPECT_TRUE(objects.was_exact);
  }
  // Without a size: the object takes what it has of four bytes.
  const auto answer = client.raw({0x22, 0x00, 0x20, 4, 1, 2, 3, 4});
  ASSERT_TRUE(answer);
  EXPECT_EQ((*answer)[0], 0x60);
  EXPECT_FALSE(objects.was_exact);
  EXPECT_EQ((objects.values[{0x2000, 4}]), (SdoClient::Bytes{1, 2, 3, 4}));
}

TEST_F(Sdo, SaysWhyThereIsNoObject) {
  EXPECT_EQ(client.abort_of(0x2fff), 0x06020000u);
  EXPECT_EQ(client.abort_of(0x2000, 9), 0x06090011u);
  EXPECT_EQ(client.download(0x2002, 0, {1}), 0x06010002u);
  EXPECT_EQ(client.download_segmented(0x2002, 0, SdoClient::Bytes(20)), 0x06010002u);
}

TEST_F(Sdo, EndsATransferWhoseToggleBitDoesNotAlternate) {
  objects.values[{0x2002, 0}] = SdoClient::Bytes(20, 1);
  client.raw({0x40, 0x02, 0x20, 0});
  client.raw({0x60});
  const auto again = client.raw({0x60});
  ASSERT_TRUE(again);
  EXPECT_EQ((*again), (SdoClient::Data{0x80, 0x02, 0x20, 0, 0x00, 0x00, 0x03, 0x05}));
  // It is over: a further segment is no command any more.
  EXPECT_EQ(SdoClient::word_of(client.raw({0x70}).value()), 0x05040001u);
  EXPECT_EQ(client.raw({0x21, 0x00, 0x20, 1, 8})->at(0), 0x60);
  EXPECT_EQ(SdoClient::word_of(client.raw({0x10}).value()), 0x05030000u) << "the first segment has 0";
  EXPECT_FALSE(objects.values.contains({0x2000, 1}));
}

TEST_F(Sdo, RefusesWhatIsTooLongOrNotAsLongAsItWasSaid) {
  EXPECT_EQ(client.download_segmented(0x2000, 1, SdoClient::Bytes(9)), 0x06070012u);
  EXPECT_EQ(client.download_segmented(0x2000, 1, SdoClient::Bytes(9), false), 0x06070012u);
  client.raw({0x21, 0x00, 0x20, 1, 5});
  EXPECT_EQ(SdoClient::word_of(client.raw({0x01 | 3 << 1}).value()), 0x06070010u) << "four bytes of five";
  EXPECT_TRUE(objects.values.empty());
}

TEST_F(Sdo, RefusesCommandsThatItDoesNotHave) {
  for (const int command : {5, 6, 7}) {  // block transfers, and none
    const auto answer = client.raw({static_cast<std::uint8_t>(command << 5), 0x02, 0x20, 0});
    ASSERT_TRUE(answer);
    EXPECT_EQ(SdoClient::word_of(*answer), 0x05040001u);
  }
}

TEST_F(Sdo, EndsATransferThatItsClientLeaves) {
  objects.values[{0x2002, 0}] = SdoClient::Bytes(20, 1);
  client.raw({0x40, 0x02, 0x20, 0});
  EXPECT_FALSE(server.poll(SdoServer::timeout_ns - 1));
  const auto said = server.poll(SdoServer::timeout_ns);
  ASSERT_TRUE(said);
  EXPECT_EQ(said->id, 0x585u);
  EXPECT_EQ(said->data[0], 0x80);
  EXPECT_EQ(said->data[7] << 8 | said->data[6], 0x0504);
  EXPECT_FALSE(server.poll(10 * SdoServer::timeout_ns)) << "once";
  // One that the client ends itself says nothing.
  client.raw({0x40, 0x02, 0x20, 0});
  EXPECT_FALSE(client.raw({0x80, 0x02, 0x20, 0}));
  EXPECT_FALSE(server.poll(100 * SdoServer::timeout_ns));
}

TEST_F(Sdo, AnswersWhatIsPutOffWhenItHasEnded) {
  EXPECT_EQ(client.download(0x2001, 0, {1}), SdoClient::no_answer);
  EXPECT_FALSE(server.poll(0));
  objects.ends = SdoWritten{};
  const auto done = server.poll(20 * SdoServer::timeout_ns);
  ASSERT_TRUE(done) << "a disk may take its time";
  EXPECT_EQ(done->data[0], 0x60);
  EXPECT_FALSE(server.poll(20 * SdoServer::timeout_ns));
  EXPECT_EQ(client.download(0x2001, 0, {1}), SdoClient::no_answer);
  objects.ends = SdoWritten{.abort = SdoAbort::not_stored};
  EXPECT_EQ(server.poll(0)->data[0], 0x80);
  // In segments too: the answer is that of the last one.
  objects.ends.reset();
  EXPECT_EQ(client.download_segmented(0x2001, 0, SdoClient::Bytes(8)), SdoClient::no_answer);
  objects.ends = SdoWritten{};
  EXPECT_EQ(server.poll(0)->data[0], 0x30);
}

TEST_F(Sdo, LeavesFramesOfOthersAlone) {
  objects.values[{0x2002, 0}] = {1};
  Frame frame{0x606, 8, {0x40, 0x02, 0x20}};
  EXPECT_FALSE(server.answer(frame, 0));
  frame.id = 0x605;
  EXPECT_TRUE(server.answer(frame, 0));
  frame.size = 7;  // CiA 301: eight bytes always
  EXPECT_FALSE(server.answer(frame, 0));
}

// Whatever comes, each answer is eight bytes on the node's identifier, and a client that begins again is served.
TEST_F(Sdo, ServesBehindAnyFrames) {
  objects.values[{0x2002, 0}] = SdoClient::Bytes(20, 1);
  std::mt19937 random(5);
  for (int i = 0; i < 100'000; ++i) {
    SdoClient::Data request{};
    for (auto& byte : request) byte = static_cast<std::uint8_t>(random());
    if (random() % 2 == 0) request[2] = 0x20;
    if (random() % 2 == 0) request[1] = static_cast<std::uint8_t>(random() % 4);
    client.raw(request);
    if (random() % 16 != 0) continue;
    objects.values[{0x2002, 0}] = SdoClient::Bytes(20, 1);
    const auto found = client.upload(0x2002, 0);
    ASSERT_TRUE(std::holds_alternative<SdoClient::Bytes>(found));
  }
}

}  // namespace
}  // namespace stiction::test
