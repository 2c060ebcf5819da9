// A client of SDO written from the text of CiA 301, 7.2.4.3, that knows nothing of the server's source: what it sends
// and how it judges an answer are the standard's figures.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "hal/can/frames.hpp"

namespace stiction::test {

class SdoClient {
 public:
  using Bytes = std::vector<std::uint8_t>;
  using Data = std::array<std::uint8_t, 8>;
  // Brings a request to the server and gives its answer; none: it does not answer.
  using Exchange = std::function<std::optional<hal::can::Frame>(const hal::can::Frame&)>;

  SdoClient(unsigned node, Exchange exchange) : node_(node), exchange_(std::move(exchange)) {}

  // Eight bytes to 600h + node; the eight of 580h + node.
  std::optional<Data> raw(const Data& request) const {
    hal::can::Frame frame;
    frame.id = 0x600 + node_;
    frame.size = 8;
    std::copy(request.begin(), request.end(), frame.data.begin());
    const auto answer = exchange_(frame);
    if (!answer) return {};
    EXPECT_EQ(answer->id, 0x580 + node_);
    EXPECT_EQ(answer->size, 8);
    Data data{};
    std::copy_n(answer->data.begin(), 8, data.begin());
    return data;
  }

  // Bytes, or an abort code.
  std::variant<Bytes, std::uint32_t> upload(unsigned index, unsigned sub) const {
    const auto first = raw(with_address(0x40, index, sub));
    if (!first) return no_answer;
    if (is_abort(*first)) return code_of(*first, index, sub);
    EXPECT_TRUE(has_address(*first, index, sub));
    EXPECT_EQ((*first)[0] >> 5, 2) << "scs of initiate upload";
    const bool expedited = ((*first)[0] & 2) != 0;
    EXPECT_EQ((*first)[0] & 1, 1) << "the size is told";
    if (expedited) return Bytes(first->begin() + 4, first->begin() + 8 - (((*first)[0] >> 2) & 3));
    Bytes bytes;
    const std::uint32_t size = word_of(*first);
    for (unsigned toggle = 0;; toggle ^= 1) {
      const auto segment = raw({static_cast<std::uint8_t>(0x60 | toggle << 4)});
      if (!segment) return no_answer;
      if (is_abort(*segment)) return word_of(*segment);
      EXPECT_EQ((*segment)[0] >> 5, 0) << "scs of an upload segment";
      EXPECT_EQ(((*segment)[0] >> 4) & 1u, toggle);
      const int unused = ((*segment)[0] >> 1) & 7;
      bytes.insert(bytes.end(), segment->begin() + 1, segment->end() - unused);
      if (((*segment)[0] & 1) != 0) break;
    }
    EXPECT_EQ(bytes.size(), size);
    return bytes;
  }

  // 0, or an abort code.
  std::uint32_t download(unsigned index, unsigned sub, const Bytes& bytes) const {
    Data request = with_address(static_cast<std::uint8_t>(0x23 | (4 - bytes.size()) << 2), index, sub);
    std::copy(bytes.begin(), bytes.end(), request.begin() + 4);
    return confirmed(raw(request), index, sub);
  }
  std::uint32_t download_segmented(unsigned index, unsigned sub, const Bytes& bytes, bool sized = true) const {
    Data request = with_address(sized ? 0x21 : 0x20, index, sub);
    for (std::size_t i = 0; i < 4 && sized; ++i) request[4 + i] = static_cast<std::uint8_t>(bytes.size() >> (8 * i));
    if (const auto code = confirmed(raw(request), index, sub); code != 0) return code;
    unsigned toggle = 0;
    for (std::size_t at = 0; at < bytes.size() || at == 0; at += 7, toggle ^= 1) {
      const std::size_t size = std::min<std::size_t>(7, bytes.size() - at);
      const bool last = at + 7 >= bytes.size();
      Data segment{static_cast<std::uint8_t>(toggle << 4 | (7 - size) << 1 | (last ? 1 : 0))};
      std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), size, segment.begin() + 1);
      const auto answer = raw(segment);
      if (!answer) return no_answer;
      if (is_abort(*answer)) return word_of(*answer);
      EXPECT_EQ((*answer)[0], 0x20 | toggle << 4) << "a segment is confirmed with its toggle bit";
    }
    return 0;
  }

  // Numbers, the lowest byte first.
  std::uint32_t number(unsigned index, unsigned sub = 0) const {
    const auto found = upload(index, sub);
    if (const auto* code = std::get_if<std::uint32_t>(&found)) {
      ADD_FAILURE() << std::hex << index << "h, " << sub << ": aborted with " << *code;
      return 0;
    }
    std::uint32_t value = 0;
    const auto& bytes = std::get<Bytes>(found);
    for (std::size_t i = 0; i < bytes.size(); ++i) value |= std::uint32_t{bytes[i]} << (8 * i);
    return value;
  }
  std::uint32_t abort_of(unsigned index, unsigned sub = 0) const {
    const auto found = upload(index, sub);
    const auto* code = std::get_if<std::uint32_t>(&found);
    return code == nullptr ? 0 : *code;
  }
  std::uint32_t set(unsigned index, unsigned sub, std::int64_t value, std::size_t size) const {
    Bytes bytes;
    for (std::size_t i = 0; i < size; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
    return download(index, sub, bytes);
  }

  static constexpr std::uint32_t no_answer = 0xffffffff;
  static Data with_address(std::uint8_t command, unsigned index, unsigned sub) {
    return {command, static_cast<std::uint8_t>(index), static_cast<std::uint8_t>(index >> 8),
            static_cast<std::uint8_t>(sub)};
  }
  static std::uint32_t word_of(const Data& data) {
    return std::uint32_t{data[4]} | std::uint32_t{data[5]} << 8 | std::uint32_t{data[6]} << 16 |
           std::uint32_t{data[7]} << 24;
  }
  static bool is_abort(const Data& data) { return data[0] == 0x80; }

 private:
  static bool has_address(const Data& data, unsigned index, unsigned sub) {
    return data[1] == (index & 0xff) && data[2] == index >> 8 && data[3] == sub;
  }
  static std::uint32_t code_of(const Data& data, unsigned index, unsigned sub) {
    EXPECT_TRUE(has_address(data, index, sub));
    return word_of(data);
  }
  static std::uint32_t confirmed(const std::optional<Data>& answer, unsigned index, unsigned sub) {
    if (!answer) return no_answer;
    if (is_abort(*answer)) return code_of(*answer, index, sub);
    EXPECT_EQ((*answer)[0], 0x60);
    EXPECT_TRUE(has_address(*answer, index, sub));
    return 0;
  }

  unsigned node_;
  Exchange exchange_;
};

}  // namespace stiction::test
