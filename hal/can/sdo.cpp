#include "hal/can/sdo.hpp"

#include <algorithm>

namespace stiction::hal::can {
namespace {

// The three high bits of the first byte: of the client.
enum Request : std::uint8_t {
  download_segment_request = 0,
  initiate_download_request = 1,
  initiate_upload_request = 2,
  upload_segment_request = 3,
  abort_request = 4,
};
// And of the server, in place.
constexpr std::uint8_t upload_segment_answer = 0x00, download_segment_answer = 0x20, initiate_upload_answer = 0x40,
                       initiate_download_answer = 0x60, abort_answer = 0x80;
constexpr std::uint8_t expedited_bit = 0x02, size_bit = 0x01, toggle_bit = 0x10, last_bit = 0x01;

constexpr std::size_t frame_bytes = 8, segment_bytes = 7, expedited_bytes = 4, first_data = 4;

std::uint32_t word_at(const Frame& frame, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i) word |= std::uint32_t{frame.data[at + i]} << (8 * i);
  return word;
}
void put_word(Frame& frame, std::size_t at, std::uint32_t word) {
  for (std::size_t i = 0; i < 4; ++i) frame.data[at + i] = static_cast<std::uint8_t>(word >> (8 * i));
}

}  // namespace

// With the object's address.
Frame SdoServer::reply(std::uint8_t command) const {
  Frame frame{id_of(CobId::sdo_answer, node_), frame_bytes, {}};
  frame.data[0] = command;
  frame.data[1] = static_cast<std::uint8_t>(address_.index);
  frame.data[2] = static_cast<std::uint8_t>(address_.index >> 8);
  frame.data[3] = address_.sub;
  return frame;
}

Frame SdoServer::abort(SdoAbort code) {
  transfer_ = Transfer::none;
  Frame frame = reply(abort_answer);
  put_word(frame, first_data, static_cast<std::uint32_t>(code));
  return frame;
}

std::optional<Frame> SdoServer::answer(const Frame& request, std::int64_t now_ns) {
  if (request.id != id_of(CobId::sdo_request, node_) || request.size != frame_bytes) return {};
  touched_ns_ = now_ns;
  const auto what = static_cast<std::uint8_t>(request.data[0] >> 5);
  if (what == abort_request) {
    transfer_ = Transfer::none;
    return {};
  }
  if (what == upload_segment_request && transfer_ == Transfer::upload) return upload_segment(request);
  if (what == download_segment_request && transfer_ == Transfer::download) return download_segment(request);
  if (what == upload_segment_request || what == download_segment_request) {
    if (transfer_ == Transfer::none) address_ = {};
    return abort(SdoAbort::unknown_command);
  }
  // Who begins again has given up what was under way.
  transfer_ = Transfer::none;
  address_ = {static_cast<std::uint16_t>(request.data[1] | request.data[2] << 8), request.data[3]};
  if (what == initiate_upload_request) return initiate_upload();
  if (what == initiate_download_request) return initiate_download(request);
  return abort(SdoAbort::unknown_command);
}

std::optional<Frame> SdoServer::poll(std::int64_t now_ns) {
  if (transfer_ == Transfer::put_off) {
    const auto outcome = objects_.outcome(ticket_);
    return outcome ? done(*outcome) : std::optional<Frame>{};
  }
  if (transfer_ == Transfer::none || now_ns - touched_ns_ < timeout_ns) return {};
  return abort(SdoAbort::timed_out);
}

Frame SdoServer::initiate_upload() {
  auto read = objects_.read(address_);
  if (const auto* refused = std::get_if<SdoAbort>(&read)) return abort(*refused);
  data_ = std::get<std::vector<std::uint8_t>>(std::move(read));
  const std::size_t size = data_.size();
  if (size > 0 && size <= expedited_bytes) {
    Frame frame = reply(
        static_cast<std::uint8_t>(initiate_upload_answer | (expedited_bytes - size) << 2 | expedited_bit | size_bit));
    std::copy(data_.begin(), data_.end(), frame.data.begin() + first_data);
    return frame;
  }
  transfer_ = Transfer::upload;
  at_ = 0;
  toggle_ = false;
  Frame frame = reply(initiate_upload_answer | size_bit);
  put_word(frame, first_data, static_cast<std::uint32_t>(size));
  return frame;
}

Frame SdoServer::upload_segment(const Frame& request) {
  if (((request.data[0] & toggle_bit) != 0) != toggle_) return abort(SdoAbort::toggle_bit);
  const std::size_t size = std::min(segment_bytes, data_.size() - at_);
  const bool last = at_ + size == data_.size();
  Frame frame{id_of(CobId::sdo_answer, node_), frame_bytes, {}};
  frame.data[0] = static_cast<std::uint8_t>(upload_segment_answer | (toggle_ ? toggle_bit : 0) |
                                            (segment_bytes - size) << 1 | (last ? last_bit : 0));
  for (std::size_t i = 0; i < size; ++i) frame.data[1 + i] = data_[at_ + i];
  at_ += size;
  toggle_ = !toggle_;
  if (last) transfer_ = Transfer::none;
  return frame;
}

std::optional<Frame> SdoServer::initiate_download(const Frame& request) {
  const std::uint8_t command = request.data[0];
  const bool sized = (command & size_bit) != 0;
  if (const auto refused = objects_.write_rejection(address_); refused != SdoAbort::none) return abort(refused);
  segmented_ = (command & expedited_bit) == 0;
  if (!segmented_) {
    const std::size_t size = sized ? expedited_bytes - ((command >> 2) & 3u) : expedited_bytes;
    return written(std::span(request.data).subspan(first_data, size), sized);
  }
  size_ = sized ? std::optional(word_at(request, first_data)) : std::nullopt;
  if (size_ && *size_ > most_written) return abort(SdoAbort::too_long);
  transfer_ = Transfer::download;
  at_ = 0;
  toggle_ = false;
  return reply(initiate_download_answer);
}

std::optional<Frame> SdoServer::download_segment(const Frame& request) {
  const std::uint8_t command = request.data[0];
  if (((command & toggle_bit) != 0) != toggle_) return abort(SdoAbort::toggle_bit);
  const std::size_t size = segment_bytes - ((command >> 1) & 7u);
  if (at_ + size > most_written) return abort(SdoAbort::too_long);
  for (std::size_t i = 0; i < size; ++i) written_[at_ + i] = request.data[1 + i];
  at_ += size;
  last_toggle_ = toggle_;
  toggle_ = !toggle_;
  if ((command & last_bit) == 0) return done({});
  if (size_ && *size_ != at_) return abort(SdoAbort::length);
  return written(std::span(written_).first(at_), true);
}

std::optional<Frame> SdoServer::written(std::span<const std::uint8_t> bytes, bool exact) {
  const auto result = objects_.write(address_, bytes, exact);
  transfer_ = Transfer::none;
  return done(result);
}

// The answer to a segment, or to the whole of a download.
std::optional<Frame> SdoServer::done(const SdoWritten& written) {
  if (written.abort != SdoAbort::none) return abort(written.abort);
  if (written.put_off != 0) {
    transfer_ = Transfer::put_off;
    ticket_ = written.put_off;
    return {};
  }
  if (transfer_ == Transfer::put_off) transfer_ = Transfer::none;
  if (!segmented_) return reply(initiate_download_answer);
  Frame frame{id_of(CobId::sdo_answer, node_), frame_bytes, {}};
  frame.data[0] = static_cast<std::uint8_t>(download_segment_answer | (last_toggle_ ? toggle_bit : 0));
  return frame;
}

}  // namespace stiction::hal::can
