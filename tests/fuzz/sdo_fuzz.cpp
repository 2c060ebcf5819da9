// Any bytes as SDO frames before the objects of a node, between orders of the network's master and states of the axis:
// each answer is eight bytes on the node's identifier, nothing is taken where motion is not allowed or the window is
// closed, and behind all of it a client that begins again is served.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

#include "firmware/stictiond/object_server.hpp"
#include "firmware/stictiond/remote_setup.hpp"

namespace stiction::fuzz {
namespace {

[[noreturn]] void finding(const char* what) {
  std::fprintf(stderr, "finding: %s\n", what);
  std::abort();
}

drive::DriveConfiguration configuration() {
  drive::DriveOptions options;
  options.machine = STICTION_SOURCE_DIR "/firmware/machine/shipped/mcfv5050ln.toml";
  options.set = {"drive.can_server.interface=vcan1", "drive.axis.X.server_node=1", "drive.axis.Y.server_node=2",
                 "drive.can_server.motion=allowed"};
  return drive::read_configuration(options);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  static const auto c = configuration();
  auto config = drive::can_server_config(c);
  config.motion_allowed = (data[0] & 1) != 0;
  const bool window = (data[0] & 2) != 0;
  // Of the process: a desk has a thread of its own, which is dear to make.
  static const auto desk = std::make_shared<drive::ParameterDesk>(c.machine, c.setup, drive::KeptParameters{});
  desk->registers();
  if (window)
    desk->open_commissioning();
  else
    desk->close_commissioning();
  const auto before = desk->registers().written();
  const auto links = std::make_shared<drive::NodeLinks>();
  drive::ObjectServer server(c, config, desk, links);
  drive::CanopenNode node(1, links->at(0));
  std::int64_t now_ns = 0;
  bool commanded = false;
  const auto check = [](const hal::can::Frame& frame) {
    if (frame.size != 8 || (frame.id != 0x581 && frame.id != 0x582)) finding("an answer that is none");
  };
  for (std::size_t at = 1; at + 9 <= size; at += 9) {
    hal::can::Frame frame{0x601, 8, {}};
    for (std::size_t i = 0; i < 8; ++i) frame.data[i] = data[at + 1 + i];
    const std::uint8_t what = data[at];
    if ((what & 1) != 0) frame.id = 0x602;
    if ((what & 6) == 6) frame.size = static_cast<std::uint8_t>(what >> 4);
    if ((what & 8) != 0) node.step(now_ns, static_cast<Fault>(what >> 4), [](const hal::can::Frame&) {});
    now_ns += (what & 0x80) != 0 ? 600'000'000 : 1'000'000;
    if (const auto answer = server.answer(frame, now_ns)) check(*answer);
    server.poll(now_ns, check);
    server.loop().take_motion([&](const drive::MotionWrite&) { commanded = true; });
    desk->said().take(now_ns);
  }
  if (commanded && !config.motion_allowed) finding("a command without permission");
  if (!window && !(desk->registers().written() == before)) finding("a parameter without the window");
  const auto type = server.answer({0x601, 8, {0x40, 0x00, 0x10, 0}}, now_ns);
  if (!type || type->data[0] != 0x43 || type->data[4] != 0x92) finding("a client that is not served");
  return 0;
}

}  // namespace stiction::fuzz
