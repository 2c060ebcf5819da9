// Any bytes as frames from a CAN bus: refused, or a state that goes back to the same bytes; the watch counts each.
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "hal/can/answer_check.hpp"
#include "hal/can/frames.hpp"

namespace stiction::fuzz {
namespace {

using namespace hal::can;

[[noreturn]] void finding(const char* what) {
  std::fprintf(stderr, "finding: %s\n", what);
  std::abort();
}

// The checksum is made right half of the time: a fuzzer does not find it by trying.
void seal_like(Format format, Frame& frame) {
  NodeFeedback state;
  std::uint32_t counter = 0;
  const auto last = static_cast<std::size_t>(frame.size) - 1;
  for (int guess = 0; guess < 256 && format == Format::classical; ++guess) {
    frame.data[last] = static_cast<std::uint8_t>(guess);
    if (decode_feedback(format, Kind::position, frame, counter, state)) return;
  }
}

void try_frame(Format format, const Frame& frame, AnswerCheck& watch) {
  const auto address = address_of(frame, format);
  std::uint32_t counter = 0;
  NodeFeedback state;
  Command<FixedSignals> command;
  switch (address.kind) {
    case Kind::unknown:
    case Kind::sync:
      decode_sync(frame, counter);
      return;
    case Kind::command:
      if (decode_command(format, frame, counter, command) && counter > properties(format).counter_mask)
        finding("a counter beyond its bits");
      return;
    case Kind::position:
    case Kind::current:
      if (!decode_feedback(format, address.kind, frame, counter, state)) return watch.take_damaged();
      if (counter > properties(format).counter_mask) finding("a counter beyond its bits");
      watch.take(address.kind == Kind::current ? 1 : 0, counter, 1);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::array watches{AnswerCheck(2, 0x0F), AnswerCheck(1, 0xFF)};
  std::array<bool, 2> open{};
  std::uint32_t tick = 0;
  // Each frame: identifier in two bytes, what to do, size, data.
  for (std::size_t at = 0; at + 4 <= size;) {
    Frame frame;
    frame.id = static_cast<std::uint32_t>(data[at] | data[at + 1] << 8);
    const std::uint8_t what = data[at + 2];
    frame.size = static_cast<std::uint8_t>(data[at + 3] % 65);
    at += 4;
    for (std::size_t i = 0; i < frame.size && at < size; ++i) frame.data[i] = data[at++];
    const Format format = (what & 1) != 0 ? Format::fd : Format::classical;
    if ((what & 2) != 0 && frame.size == 8) seal_like(format, frame);
    auto& watch = watches[what & 1];
    bool& begun = open[what & 1];
    if ((what & 4) != 0) {
      if (begun) watch.end();
      watch.begin(++tick, 0);
      begun = true;
    }
    if (begun) try_frame(format, frame, watch);
    if (watch.counts().good > tick || watch.counts().lost > tick) finding("more answers than ticks");
  }
  return 0;
}

}  // namespace stiction::fuzz
