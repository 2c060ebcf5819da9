// The server of a node's objects: SDO transfers of CiA 301 (7.2.4), expedited and segmented, one at a time on the
// node's one channel. Block transfers, which the standard leaves open, are refused. Without a bus and without a clock
// of its own; it may wait for who writes, so it is not for the loop's thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "hal/can/frames.hpp"

namespace stiction::hal::can {

// Abort codes of CiA 301, 7.2.4.3.17.
enum class SdoAbort : std::uint32_t {
  none = 0,
  toggle_bit = 0x0503'0000,
  timed_out = 0x0504'0000,
  unknown_command = 0x0504'0001,
  write_only = 0x0601'0001,
  read_only = 0x0601'0002,
  no_object = 0x0602'0000,
  length = 0x0607'0010,
  too_long = 0x0607'0012,
  too_short = 0x0607'0013,
  no_sub_index = 0x0609'0011,
  value = 0x0609'0030,
  value_too_high = 0x0609'0031,
  value_too_low = 0x0609'0032,
  not_stored = 0x0800'0020,
  local_control = 0x0800'0021,
  device_state = 0x0800'0022,
  no_data = 0x0800'0024,
};

struct ObjectAddress {
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
  bool operator==(const ObjectAddress&) const = default;
};

struct SdoWritten {
  SdoAbort abort = SdoAbort::none;
  std::uint64_t put_off = 0;  // a ticket for outcome(); 0: it is done
};

// Whose objects are served.
class ServedObjects {
 public:
  ServedObjects() = default;
  virtual ~ServedObjects() = default;
  ServedObjects(const ServedObjects&) = delete;
  ServedObjects& operator=(const ServedObjects&) = delete;

  // The bytes of an object, the lowest first, or why there are none.
  virtual std::variant<std::vector<std::uint8_t>, SdoAbort> read(ObjectAddress address) = 0;
  // Why the object cannot be written, whatever the value; none: it can.
  virtual SdoAbort write_rejection(ObjectAddress address) = 0;
  // `address`: an object that can be written; `bytes`: of its value; `exact`: as many as the client has, else the
  // object takes as many of them as it has.
  virtual SdoWritten write(ObjectAddress address, std::span<const std::uint8_t> bytes, bool exact) = 0;
  // How what was put off has ended; none: not yet. `ticket`: of write().
  virtual std::optional<SdoWritten> outcome([[maybe_unused]] std::uint64_t ticket) { return SdoWritten{}; }
};

class SdoServer {
 public:
  // For which a client may leave a transfer alone.
  static constexpr std::int64_t timeout_ns = 1'000'000'000;
  static constexpr std::size_t most_written = 8;  // bytes: no object that is written has more

  // `node`: 1 to 127; `objects`: of it, which must outlive this.
  SdoServer(int node, ServedObjects& objects) : node_(node), objects_(objects) {}

  // The answer to a frame; none: it is none of this node's requests, or an answer is put off. `now_ns`: of a clock that
  // does not go back.
  std::optional<Frame> answer(const Frame& request, std::int64_t now_ns);
  // Now and then: an answer that was put off, or the end of a transfer that its client has left. `now_ns`: as above.
  std::optional<Frame> poll(std::int64_t now_ns);

 private:
  enum class Transfer : std::uint8_t { none, upload, download, put_off };

  Frame initiate_upload();
  std::optional<Frame> initiate_download(const Frame& request);
  Frame upload_segment(const Frame& request);
  std::optional<Frame> download_segment(const Frame& request);
  std::optional<Frame> written(std::span<const std::uint8_t> bytes, bool exact);
  std::optional<Frame> done(const SdoWritten& written);
  Frame abort(SdoAbort code);
  Frame reply(std::uint8_t command) const;

  int node_;
  ServedObjects& objects_;
  Transfer transfer_ = Transfer::none;
  ObjectAddress address_{};
  std::vector<std::uint8_t> data_{};     // of an upload
  std::size_t at_ = 0;                   // bytes that went
  bool toggle_ = false;                  // of the segment that is expected
  bool segmented_ = false;               // a download, whose last answer is that of a segment
  bool last_toggle_ = false;             // of its last segment
  std::optional<std::uint32_t> size_{};  // of a download, where its client has told it
  std::array<std::uint8_t, most_written> written_{};
  std::uint64_t ticket_ = 0;
  std::int64_t touched_ns_ = 0;
};

}  // namespace stiction::hal::can
